//! Which faces belong to which bodies of a file, and their colours.

use std::collections::BTreeMap;

use kentron::io::step::{Exchange, Value};

use crate::meshes::Colour;

/// The most entities that lie between a style and its colour.
const MOST_LINKS: usize = 200;

/// A solid or a set of shells, as the file has it.
#[derive(Clone, Debug)]
pub(super) struct FileBody {
    /// Its entity.
    pub number: usize,
    /// Its name, which may be empty.
    pub name: String,
    /// Whether it is a solid.
    pub solid: bool,
}

/// A face of a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct FileFace {
    /// Its body's place in the list of bodies.
    pub body: usize,
    /// Its own colour, or that of its shell or body.
    pub colour: Option<Colour>,
}

/// The bodies of a file, and each of their faces by its entity.
pub(super) fn bodies(x: &Exchange) -> (Vec<FileBody>, BTreeMap<usize, FileFace>) {
    let colours = colours(x);
    let (mut bodies, mut faces) = (Vec::new(), BTreeMap::new());
    for number in x.ids() {
        let Ok(instance) = x.get(number) else { continue };
        let solid = instance
            .record("MANIFOLD_SOLID_BREP")
            .or(instance.record("FACETED_BREP"));
        let Some(values) = solid.or(instance.record("SHELL_BASED_SURFACE_MODEL")) else {
            continue;
        };
        let mut shells = numbers(x, values);
        shells.extend(
            instance
                .record("BREP_WITH_VOIDS")
                .map_or(Vec::new(), |voids| numbers(x, voids)),
        );
        let body = bodies.len();
        bodies.push(FileBody {
            number,
            name: values.first().and_then(Value::as_str).unwrap_or_default().to_owned(),
            solid: solid.is_some(),
        });
        // An oriented shell names another one.
        let mut left = MOST_LINKS;
        while let Some(shell) = shells.pop() {
            let Ok(entity) = x.get(shell) else { continue };
            if let (Some(oriented), true) = (entity.record("ORIENTED_CLOSED_SHELL"), left > 0) {
                left -= 1;
                shells.extend(numbers(x, oriented));
                continue;
            }
            let Some(values) = entity.record("CLOSED_SHELL").or(entity.record("OPEN_SHELL")) else {
                continue;
            };
            for face in numbers(x, values) {
                let own = [face, shell, number].iter().find_map(|item| colours.get(item));
                faces.insert(
                    face,
                    FileFace {
                        body,
                        colour: own.copied(),
                    },
                );
            }
        }
    }
    (bodies, faces)
}

/// The entities that are attributes, alone or in a list.
pub(super) fn numbers(x: &Exchange, values: &[Value]) -> Vec<usize> {
    let each = values.iter().flat_map(|value| match value {
        Value::List(_) => x.list(value).unwrap_or(&[]),
        one => std::slice::from_ref(one),
    });
    each.filter_map(Value::as_reference).collect()
}

/// The colours of styled items, by item. A style that overrides another one counts.
fn colours(x: &Exchange) -> BTreeMap<usize, Colour> {
    let mut found = BTreeMap::new();
    for kind in ["STYLED_ITEM", "OVER_RIDING_STYLED_ITEM"] {
        for (_, instance) in x.of_type(kind) {
            // In an entity of several types the name is elsewhere.
            let values = instance.record("STYLED_ITEM").unwrap_or(instance.params());
            let values = &values[usize::from(values.first().is_some_and(|first| first.as_str().is_some()))..];
            let [styles, item, ..] = values else { continue };
            if let (Some(item), Some(colour)) = (item.as_reference(), colour(x, styles)) {
                found.insert(item, colour);
            }
        }
    }
    found
}

fn colour(x: &Exchange, styles: &Value) -> Option<Colour> {
    let mut values = vec![styles];
    for _ in 0..MOST_LINKS {
        match values.pop()? {
            list @ Value::List(_) => values.extend(x.list(list)?),
            typed @ Value::Typed(_) => values.extend(x.typed(typed)?.1),
            Value::Reference(number) => {
                let Ok(instance) = x.get(*number) else { continue };
                if let Some([_, red, green, blue, ..]) = instance.record("COLOUR_RGB") {
                    let share = |value: &Value| Some((255.0 * x.real(value)?.clamp(0.0, 1.0)).round() as u8);
                    return Some([share(red)?, share(green)?, share(blue)?]);
                }
                if let Some([name, ..]) = instance.record("DRAUGHTING_PRE_DEFINED_COLOUR") {
                    return named(name.as_str()?);
                }
                // Colours of curves are those of edges.
                if !instance.has("CURVE_STYLE") {
                    values.extend(instance.records().flat_map(|(_, values)| values));
                }
            }
            _ => {}
        }
    }
    None
}

/// The colours of ISO 10303-46.
fn named(name: &str) -> Option<Colour> {
    Some(match name {
        "red" => [255, 0, 0],
        "green" => [0, 255, 0],
        "blue" => [0, 0, 255],
        "yellow" => [255, 255, 0],
        "magenta" => [255, 0, 255],
        "cyan" => [0, 255, 255],
        "black" => [0, 0, 0],
        "white" => [255, 255, 255],
        _ => return None,
    })
}
