//! Tessellated solids of AP242: not read, but beside boundary representations of the same part they say nothing new.

use std::collections::{BTreeMap, BTreeSet};

use kentron::io::step::Exchange;

use super::audit::Refused;
use super::styles::numbers;

/// The number of tessellated solids that are another form of a part.
///
/// # Errors
/// One that is the only form of its part, as far as the file says.
pub(super) fn count(x: &Exchange) -> Result<usize, Refused> {
    let mut kinds = Vec::new();
    for kind in ["TESSELLATED_SOLID", "TESSELLATED_SHELL"] {
        kinds.extend(x.of_type(kind).map(|(number, instance)| (number, kind, instance)));
    }
    if kinds.is_empty() {
        return Ok(0);
    }
    let exact = exact(x);
    let copied: BTreeSet<usize> = x
        .of_type("TESSELLATED_SHAPE_REPRESENTATION")
        .filter(|(number, _)| exact.contains(number))
        .flat_map(|(_, own)| numbers(x, own.params()))
        .collect();
    for (number, kind, instance) in &kinds {
        let linked = numbers(x, instance.params());
        let is_linked = linked
            .iter()
            .any(|other| x.get(*other).is_ok_and(|other| is_exact(&other)));
        if !copied.contains(number) && !is_linked {
            let message = format!(
                "#{number} is a {kind}, and the file has no boundary representation of its part, which is what is read"
            );
            return Err((*number, message));
        }
    }
    Ok(kinds.len())
}

fn is_exact(instance: &kentron::io::step::Instance<'_>) -> bool {
    ["MANIFOLD_SOLID_BREP", "FACETED_BREP", "SHELL_BASED_SURFACE_MODEL"]
        .iter()
        .any(|kind| instance.has(kind))
}

/// Representations that have boundary representations, or are said to be of the same shape as one that has.
fn exact(x: &Exchange) -> BTreeSet<usize> {
    let mut same: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (_, instance) in x.of_type("SHAPE_REPRESENTATION_RELATIONSHIP") {
        if instance.has("REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION") {
            continue;
        }
        let values = instance
            .record("REPRESENTATION_RELATIONSHIP")
            .unwrap_or(instance.params());
        if let [_, _, one, other, ..] = values
            && let (Some(one), Some(other)) = (one.as_reference(), other.as_reference())
        {
            same.entry(one).or_default().push(other);
            same.entry(other).or_default().push(one);
        }
    }
    // Several representations of a product.
    let mut of_shape: BTreeMap<usize, usize> = BTreeMap::new();
    for (_, instance) in x.of_type("SHAPE_DEFINITION_REPRESENTATION") {
        let [shape, own, ..] = instance.params() else { continue };
        if let (Some(shape), Some(own)) = (shape.as_reference(), own.as_reference()) {
            let first = *of_shape.entry(shape).or_insert(own);
            same.entry(first).or_default().push(own);
            same.entry(own).or_default().push(first);
        }
    }
    let mut found = BTreeSet::new();
    let mut left: Vec<usize> = x
        .ids()
        .filter(|number| {
            x.get(*number).is_ok_and(|own| {
                let is_of_shape = own.records().any(|(name, _)| name.ends_with("SHAPE_REPRESENTATION"));
                let items = || own.records().flat_map(|(_, values)| numbers(x, values));
                is_of_shape && items().any(|item| x.get(item).is_ok_and(|item| is_exact(&item)))
            })
        })
        .collect();
    while let Some(number) = left.pop() {
        if found.insert(number) {
            left.extend(same.get(&number).into_iter().flatten());
        }
    }
    found
}
