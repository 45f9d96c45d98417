//! No circles between the files of a folder, but for those that are listed and may only become fewer.
//!
//! A module is one of its folder with everything below it. A folder's own file (`mod.rs`) belongs to none of its
//! modules: it names its children, and they may use what it says to all of them. So circles are looked for between
//! siblings alone.

use super::structure::{Module, code, modules, sources};
use super::{ratchet, root};
use std::collections::{BTreeMap, BTreeSet};

/// The paths in a text that begin with `crate::` or `super::`, as seen from the folder of a file, with those in braces.
fn paths(code: &str, module: &Module) -> BTreeSet<Module> {
    let mut found = BTreeSet::new();
    let begins = |at: usize| !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':');
    let crates = code.match_indices("crate::").filter(|(at, _)| begins(*at));
    for (at, _) in crates {
        tree(&code[at + "crate::".len()..], &[], &mut found);
    }
    for (at, _) in code.match_indices("super::").filter(|(at, _)| begins(*at)) {
        let mut rest = &code[at..];
        let mut base = module.as_slice();
        while let Some(next) = rest.strip_prefix("super::") {
            rest = next;
            base = &base[..base.len().saturating_sub(1)];
        }
        tree(rest, base, &mut found);
    }
    found
}

/// The paths of a tree of imports below a base; what follows it in the text is left.
fn tree<'a>(text: &'a str, base: &[String], found: &mut BTreeSet<Module>) -> &'a str {
    let mut rest = text.trim_start();
    let mut path = base.to_vec();
    loop {
        if let Some(mut list) = rest.strip_prefix('{') {
            loop {
                list = list.trim_start();
                if let Some(after) = list.strip_prefix('}') {
                    return after;
                }
                let before = list.len();
                list = tree(list, &path, found).trim_start();
                list = list.strip_prefix(',').unwrap_or(list);
                if list.len() == before {
                    // Not a tree of imports.
                    return list;
                }
            }
        }
        let end = rest
            .find(|c: char| !c.is_alphanumeric() && c != '_')
            .unwrap_or(rest.len());
        if end == 0 {
            break;
        }
        path.push(rest[..end].to_string());
        rest = &rest[end..];
        match rest.strip_prefix("::") {
            Some(next) => rest = next,
            None => break,
        }
    }
    found.insert(path);
    // Past `as name`, `*` and the like.
    let end = rest.find([',', '}', ';', '\n']).unwrap_or(rest.len());
    &rest[end..]
}

/// Who uses whom among the siblings of each folder.
fn arrows() -> BTreeMap<String, BTreeMap<String, BTreeSet<String>>> {
    let mut arrows: BTreeMap<String, BTreeMap<String, BTreeSet<String>>> = BTreeMap::new();
    for source in sources() {
        let modules = modules(&source);
        let name = source
            .strip_prefix(root())
            .expect("within the workspace")
            .to_string_lossy()
            .into_owned();
        for (module, file) in &modules {
            if module.is_empty() || module.last().is_some_and(|last| last == "tests") {
                continue;
            }
            for mut used in paths(&code(file), module) {
                while !used.is_empty() && !modules.contains_key(&used) {
                    used.pop();
                }
                let common = module.iter().zip(&used).take_while(|(a, b)| a == b).count();
                // A folder's own file, or one within the other.
                if common == module.len() || common == used.len() {
                    continue;
                }
                let folder = [std::slice::from_ref(&name), &module[..common]].concat().join("/");
                let uses = arrows.entry(folder).or_default();
                uses.entry(module[common].clone())
                    .or_default()
                    .insert(used[common].clone());
            }
        }
    }
    arrows
}

/// Everything that can be reached from a module by uses.
fn reach<'a>(uses: &'a BTreeMap<String, BTreeSet<String>>, from: &'a str) -> BTreeSet<&'a str> {
    let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(module) = open.pop() {
        for next in uses.get(module).into_iter().flatten() {
            if seen.insert(next.as_str()) {
                open.push(next);
            }
        }
    }
    seen
}

/// The circles as `folder: a b c`, where each can be reached from each.
fn circles() -> BTreeSet<String> {
    let mut circles = BTreeSet::new();
    for (folder, uses) in &arrows() {
        for module in uses.keys() {
            let there = reach(uses, module);
            if !there.contains(module.as_str()) {
                continue;
            }
            let circle: Vec<&str> = there
                .into_iter()
                .filter(|other| reach(uses, other).contains(module.as_str()))
                .collect();
            circles.insert(format!("{folder}: {}", circle.join(" ")));
        }
    }
    circles
}

#[test]
fn circles_between_files_become_fewer() {
    let seen: usize = arrows().values().flat_map(BTreeMap::values).map(BTreeSet::len).sum();
    assert!(seen > 100, "only {seen} uses between files seen");
    ratchet("circles.txt", &circles());
}

#[test]
fn imports_are_read() {
    let code = "use super::{a::{self, B}, c as d, e::*};\nuse crate::{\n    f::G,\n    h,\n};\nlet x = super::super::i::j(1) + mycrate::k;";
    let module: Module = ["x", "y", "z"].map(String::from).into();
    let found: Vec<String> = paths(code, &module).iter().map(|path| path.join("/")).collect();
    assert_eq!(found, ["f/G", "h", "x/i/j", "x/y/a/B", "x/y/a/self", "x/y/c", "x/y/e"]);
}
