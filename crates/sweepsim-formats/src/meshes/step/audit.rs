//! What must hold for the entities of a file so that nothing of it is lost without a word.
//!
//! The library places an occurrence without a transformation at the origin, and passes over kinds of solids that it
//! does not know. Each of these is an error here, at the entity.

use std::collections::{BTreeMap, BTreeSet};

use kentron::io::step::{Exchange, Instance, Value};

use super::styles::{FileBody, FileFace, numbers};

/// What is wrong, and with which entity.
pub(super) type Refused = (usize, String);

/// The most placed products of an assembly, and how deep they may be nested.
const MOST_OCCURRENCES: u64 = 100_000;
const DEEPEST: usize = 60;

/// Solids and items that are not read. A file with one of them has no B-rep of it.
const UNREAD: [&str; 18] = [
    "SOLID_REPLICA",
    "CSG_SOLID",
    "BOOLEAN_RESULT",
    "EXTRUDED_AREA_SOLID",
    "REVOLVED_AREA_SOLID",
    "EXTRUDED_FACE_SOLID",
    "REVOLVED_FACE_SOLID",
    "SWEPT_DISK_SOLID",
    "SURFACE_CURVE_SWEPT_AREA_SOLID",
    "HALF_SPACE_SOLID",
    "BLOCK",
    "RIGHT_CIRCULAR_CYLINDER",
    "RIGHT_CIRCULAR_CONE",
    "RIGHT_ANGULAR_WEDGE",
    "SPHERE",
    "TORUS",
    "POLY_LOOP",
    "SUBFACE",
];

/// Refuses what the library would leave out or not come back from.
pub(super) fn check(x: &Exchange) -> Result<(), Refused> {
    recursion(x)?;
    for kind in UNREAD {
        if let Some((number, _)) = x.of_type(kind).next() {
            let message = format!("#{number} is a {kind}, which is not read: expected boundary representations");
            return Err((number, message));
        }
    }
    for (number, instance) in x.of_type("MAPPED_ITEM") {
        // Pictures and symbols of annotations are mapped as well.
        if maps_bodies(x, &instance).unwrap_or(true) {
            let message = format!("#{number} places a solid as a MAPPED_ITEM, which is not read: expected an assembly");
            return Err((number, message));
        }
    }
    sizes(x)?;
    placements(x)?;
    occurrences(x)
}

/// Radii and half axes, by kind and number of the attribute.
const SIZES: [(&str, usize); 6] = [
    ("CIRCLE", 2),
    ("ELLIPSE", 2),
    ("ELLIPSE", 3),
    ("CYLINDRICAL_SURFACE", 2),
    ("SPHERICAL_SURFACE", 2),
    ("TOROIDAL_SURFACE", 3),
];

/// What has a radius has one that is more than nothing: the library panics.
fn sizes(x: &Exchange) -> Result<(), Refused> {
    for (kind, attribute) in SIZES {
        for (number, instance) in x.of_type(kind) {
            let size = instance.params().get(attribute).and_then(|value| x.real(value));
            if size.is_some_and(|size| !(size > 0.0)) {
                let size = size.unwrap_or_default();
                return Err((
                    number,
                    format!("#{number} is a {kind} of radius {size}: expected more than 0"),
                ));
            }
        }
    }
    Ok(())
}

pub(super) fn missing(at: usize, number: usize) -> Refused {
    (at, format!("#{at} refers to #{number}, which is not in this file"))
}

fn maps_bodies(x: &Exchange, item: &Instance<'_>) -> Option<bool> {
    let map = x
        .get(item.record("MAPPED_ITEM")?.iter().find_map(Value::as_reference)?)
        .ok()?;
    let representation = x.get(map.record("REPRESENTATION_MAP")?.get(1)?.as_reference()?).ok()?;
    let mut items = representation
        .records()
        .filter_map(|(_, values)| x.list(values.get(1)?))
        .flatten();
    Some(items.any(|item| {
        let instance = item.as_reference().and_then(|number| x.get(number).ok());
        instance.is_none_or(|instance| {
            let kinds = [
                "MANIFOLD_SOLID_BREP",
                "FACETED_BREP",
                "SHELL_BASED_SURFACE_MODEL",
                "MAPPED_ITEM",
            ];
            kinds.iter().any(|kind| instance.has(kind))
        })
    }))
}

/// Every occurrence of a product has one place, which says where the product is in its assembly.
fn placements(x: &Exchange) -> Result<(), Refused> {
    let mut placed = BTreeSet::new();
    let mut used = BTreeSet::new();
    for (number, instance) in x.of_type("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION") {
        let [relation, shape, ..] = instance.params() else {
            continue;
        };
        let (Some(relation), Some(shape)) = (relation.as_reference(), shape.as_reference()) else {
            continue;
        };
        let entity = x.get(relation).map_err(|_| missing(number, relation))?;
        let shape = x.get(shape).map_err(|_| missing(number, shape))?;
        let occurrence = shape
            .record("PRODUCT_DEFINITION_SHAPE")
            .and_then(|values| values.get(2)?.as_reference());
        let transformation = entity.record("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION");
        let transformation = transformation.and_then(|values| values.first()?.as_reference());
        let by_items = transformation
            .and_then(|t| x.get(t).ok())
            .is_some_and(|t| t.has("ITEM_DEFINED_TRANSFORMATION"));
        if let (Some(occurrence), true) = (occurrence, by_items) {
            placed.insert(occurrence);
            used.insert(relation);
            direction(x, occurrence, relation)?;
        }
    }
    for (number, _) in x.of_type("NEXT_ASSEMBLY_USAGE_OCCURRENCE") {
        if !placed.contains(&number) {
            let message =
                format!("#{number} places a product, but not where: expected a transformation between two placements");
            return Err((number, message));
        }
    }
    for (number, _) in x.of_type("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION") {
        if !used.contains(&number) {
            let message = format!("#{number} moves a shape that is no product of an assembly, which is not read");
            return Err((number, message));
        }
    }
    Ok(())
}

/// The transformation goes from the product to the assembly, not the other way.
fn direction(x: &Exchange, occurrence: usize, relation: usize) -> Result<(), Refused> {
    let entity = x.get(occurrence).map_err(|_| missing(relation, occurrence))?;
    let child = entity.params().get(4).and_then(Value::as_reference);
    let relation_of = x.get(relation).map_err(|_| missing(occurrence, relation))?;
    let pair = relation_of
        .record("REPRESENTATION_RELATIONSHIP")
        .and_then(|values| values.get(2..4));
    let (Some(child), Some([first, second])) = (child, pair) else {
        return Ok(());
    };
    let own = |wanted: &Value| {
        x.of_type("SHAPE_DEFINITION_REPRESENTATION").any(|(_, definition)| {
            let [shape, representation] = definition.params() else {
                return false;
            };
            let shape = shape.as_reference().and_then(|shape| x.get(shape).ok());
            let product = shape.and_then(|shape| shape.record("PRODUCT_DEFINITION_SHAPE")?.get(2)?.as_reference());
            product == Some(child) && representation.as_reference() == wanted.as_reference()
        })
    };
    if own(second) && !own(first) {
        let message =
            format!("#{relation} goes from the assembly to its part: expected the part's representation first");
        return Err((relation, message));
    }
    Ok(())
}

/// Bounds how often products are placed, and refuses one that contains itself.
fn occurrences(x: &Exchange) -> Result<(), Refused> {
    let mut children: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (_, instance) in x.of_type("NEXT_ASSEMBLY_USAGE_OCCURRENCE") {
        let [_, _, _, parent, child, ..] = instance.params() else {
            continue;
        };
        if let (Some(parent), Some(child)) = (parent.as_reference(), child.as_reference()) {
            children.entry(parent).or_default().push(child);
        }
    }
    let mut counts: BTreeMap<usize, u64> = BTreeMap::new();
    for root in children.keys() {
        count(*root, &children, &mut counts, 0)?;
    }
    match counts.iter().find(|(_, count)| **count > MOST_OCCURRENCES) {
        None => Ok(()),
        Some((number, _)) => Err((
            *number,
            format!("more than {MOST_OCCURRENCES} placed products: expected fewer"),
        )),
    }
}

fn count(
    product: usize,
    children: &BTreeMap<usize, Vec<usize>>,
    counts: &mut BTreeMap<usize, u64>,
    depth: usize,
) -> Result<u64, Refused> {
    if let Some(count) = counts.get(&product) {
        return Ok(*count);
    }
    if depth > DEEPEST {
        let message = format!("assemblies more than {DEEPEST} deep, or one that contains itself: expected a tree");
        return Err((product, message));
    }
    let mut sum = 1_u64;
    for child in children.get(&product).into_iter().flatten() {
        sum = sum.saturating_add(count(*child, children, counts, depth + 1)?);
    }
    counts.insert(product, sum);
    Ok(sum)
}

/// Curves, surfaces, shells and units that are built on one another must end, and soon: the library follows them one
/// call within another.
fn recursion(x: &Exchange) -> Result<(), Refused> {
    struct Visit {
        number: usize,
        rest: Vec<usize>,
        /// How many entities are built on one another below this one.
        deep: usize,
    }
    let visit = |number: usize| {
        let followed = x.get(number).ok().filter(|instance| {
            let kinds = ["SURFACE", "CURVE", "SHELL", "UNIT"];
            instance
                .records()
                .any(|(name, _)| kinds.iter().any(|kind| name.contains(kind)))
        });
        let rest = followed.map_or(Vec::new(), |instance| references(x, &instance).into_iter().collect());
        Visit { number, rest, deep: 0 }
    };
    // How deep each entity goes; `None` while it is on the stack.
    let mut known: BTreeMap<usize, Option<usize>> = BTreeMap::new();
    for root in x.ids() {
        if known.contains_key(&root) {
            continue;
        }
        known.insert(root, None);
        let mut stack = vec![visit(root)];
        while let Some(top) = stack.last_mut() {
            let number = top.number;
            if let Some(next) = top.rest.pop() {
                match known.get(&next) {
                    Some(Some(deep)) => top.deep = top.deep.max(*deep + 1),
                    Some(None) => {
                        return Err((
                            number,
                            format!("#{number} is built on itself, by #{next}: expected no circle"),
                        ));
                    }
                    None => {
                        known.insert(next, None);
                        stack.push(visit(next));
                    }
                }
                continue;
            }
            let deep = top.deep;
            if deep > DEEPEST {
                return Err((
                    number,
                    format!("#{number} is built on {deep} others, one on the other: expected fewer"),
                ));
            }
            known.insert(number, Some(deep));
            stack.pop();
            if let Some(below) = stack.last_mut() {
                below.deep = below.deep.max(deep + 1);
            }
        }
    }
    Ok(())
}

/// The entities that an entity refers to, each once.
fn references(x: &Exchange, instance: &Instance<'_>) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    let mut values: Vec<&Value> = instance.records().flat_map(|(_, values)| values).collect();
    while let Some(value) = values.pop() {
        match value {
            Value::Reference(number) => {
                found.insert(*number);
            }
            Value::List(_) => values.extend(x.list(value).unwrap_or(&[])),
            Value::Typed(_) => values.extend(x.typed(value).map_or(&[][..], |(_, values)| values)),
            _ => {}
        }
    }
    found
}

/// An edge of a solid that bounds a single face is the border of a hole, whatever the triangles look like.
pub(super) fn open_solid(x: &Exchange, bodies: &[FileBody], faces: &BTreeMap<usize, FileFace>) -> Result<(), Refused> {
    let of = |number: usize, kind: &str, attribute: usize| {
        let found = x
            .get(number)
            .ok()
            .and_then(|instance| instance.record(kind)?.get(attribute..attribute + 1));
        found.map_or(Vec::new(), |values| numbers(x, values))
    };
    let mut uses: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for (face, place) in faces.iter().filter(|(_, place)| bodies[place.body].solid) {
        let bounds = [of(*face, "ADVANCED_FACE", 1), of(*face, "FACE_SURFACE", 1)].concat();
        let ways = bounds
            .iter()
            .flat_map(|bound| [of(*bound, "FACE_OUTER_BOUND", 1), of(*bound, "FACE_BOUND", 1)].concat());
        let edges = ways
            .flat_map(|way| of(way, "EDGE_LOOP", 1))
            .flat_map(|edge| of(edge, "ORIENTED_EDGE", 3));
        for edge in edges {
            *uses.entry((place.body, edge)).or_default() += 1;
        }
    }
    match uses.iter().find(|(_, count)| *count % 2 == 1) {
        None => Ok(()),
        Some(((body, edge), count)) => {
            let solid = bodies[*body].number;
            let faces = if *count == 1 {
                "one face"
            } else {
                "an odd number of faces"
            };
            Err((
                *edge,
                format!("solid #{solid} is open: its edge #{edge} bounds {faces}, expected two"),
            ))
        }
    }
}

/// The first entity that refers to another.
pub(super) fn referring(x: &Exchange, number: usize) -> Option<usize> {
    x.ids().find(|id| {
        x.get(*id)
            .is_ok_and(|instance| references(x, &instance).contains(&number))
    })
}
