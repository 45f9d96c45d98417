//! The structure of the crates' sources: small folders, and no circles between them.

use super::{assert_none, files, root, text};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// More files and folders beside each other cannot be taken in at a glance.
const BESIDE: usize = 12;

/// A module's path in its crate; the folder `a/b` is the module `[a, b]`.
pub(super) type Module = Vec<String>;

pub(super) fn sources() -> Vec<PathBuf> {
    let folder = root().join("crates");
    let crates = fs::read_dir(folder).expect("the crates can be listed");
    let mut sources: Vec<PathBuf> = crates
        .map(|entry| entry.expect("an entry").path().join("src"))
        .filter(|source| source.is_dir())
        .collect();
    sources.sort();
    sources
}

#[test]
fn folders_are_small() {
    let mut large = Vec::new();
    let mut open = sources();
    while let Some(folder) = open.pop() {
        let mut modules = BTreeSet::new();
        for entry in fs::read_dir(&folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path.clone());
            }
            // `a.rs` and `a/` are one module; `mod.rs`, `lib.rs` and `main.rs` are the folder's own.
            let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            if !["mod", "lib", "main", "tests"].contains(&stem.as_str()) {
                modules.insert(stem);
            }
        }
        if modules.len() > BESIDE {
            large.push(format!("{}: {} modules", folder.display(), modules.len()));
        }
    }
    assert_none(&large, "a folder holds at most twelve modules beside each other");
}

/// The modules of a crate with the files they stand in.
pub(super) fn modules(source: &Path) -> BTreeMap<Module, PathBuf> {
    let mut modules = BTreeMap::new();
    for file in files(&[&source.to_string_lossy()], "rs") {
        let inner = file.strip_prefix(source).expect("below the source").with_extension("");
        let mut module: Module = inner.iter().map(|part| part.to_string_lossy().into_owned()).collect();
        if module
            .last()
            .is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str()))
        {
            module.pop();
        }
        modules.insert(module, file);
    }
    modules
}

/// What stands in a file outside of its tests.
pub(super) fn code(file: &Path) -> String {
    let text = text(file);
    let end = text.find("#[cfg(test)]\nmod ").unwrap_or(text.len());
    let lines = text[..end].lines();
    let code: Vec<&str> = lines.filter(|line| !line.trim_start().starts_with("//")).collect();
    code.join("\n")
}

/// Paths after `crate::` in a text, with those in braces.
fn references(code: &str) -> BTreeSet<Module> {
    let word = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    let path = |text: &str| -> Module {
        let end = text.find(|c| !word(c) && c != ':').unwrap_or(text.len());
        text[..end]
            .split("::")
            .filter(|part| !part.is_empty())
            .map(String::from)
            .collect()
    };
    let mut found = BTreeSet::new();
    for rest in code.split("crate::").skip(1) {
        match rest.strip_prefix('{') {
            Some(list) => {
                let end = list.find("};").unwrap_or(list.len());
                found.extend(list[..end].split(',').map(|item| path(item.trim())));
            }
            None => {
                found.insert(path(rest));
            }
        }
    }
    found
}

/// Folders of a crate, each with those whose modules it uses, and one such use.
fn uses(source: &Path) -> BTreeMap<Module, BTreeMap<Module, String>> {
    let modules = modules(source);
    let folder = |module: &[String]| -> Module {
        let own = source.join(module.join("/"));
        // Files beside `lib.rs` stand for themselves.
        let parts = if own.is_dir() { module.len() } else { module.len() - 1 };
        module[..parts.max(1)].to_vec()
    };
    let mut uses: BTreeMap<Module, BTreeMap<Module, String>> = BTreeMap::new();
    for (module, file) in modules.iter().filter(|(module, _)| !module.is_empty()) {
        if module.last().is_some_and(|last| last == "tests") {
            continue;
        }
        for mut used in references(&code(file)) {
            while !used.is_empty() && !modules.contains_key(&used) {
                used.pop();
            }
            if used.is_empty() {
                continue;
            }
            let (from, to) = (folder(module), folder(&used));
            // A folder and those within it are one house.
            if !from.starts_with(&to) && !to.starts_with(&from) {
                let what = format!("{} uses crate::{}", file.display(), used.join("::"));
                uses.entry(from).or_default().entry(to).or_insert(what);
            }
        }
    }
    uses
}

/// Everything that can be reached from a folder by uses.
fn reach(uses: &BTreeMap<Module, BTreeMap<Module, String>>, from: &Module) -> BTreeSet<Module> {
    let (mut seen, mut open) = (BTreeSet::new(), vec![from]);
    while let Some(folder) = open.pop() {
        for next in uses.get(folder).into_iter().flat_map(BTreeMap::keys) {
            if seen.insert(next.clone()) {
                open.push(next);
            }
        }
    }
    seen
}

#[test]
fn folders_have_no_circles() {
    let (mut circles, mut arrows) = (Vec::new(), 0);
    for source in sources() {
        let uses = uses(&source);
        for (from, used) in &uses {
            for (to, what) in used {
                arrows += 1;
                let round: Vec<Module> = reach(&uses, to).into_iter().collect();
                // Files beside `lib.rs` are in one folder: a circle of theirs alone is their own affair.
                let folders =
                    |module: &Module| source.join(module.join("/")).is_dir() && reach(&uses, module).contains(from);
                if round.contains(from) && round.iter().any(folders) {
                    circles.push(what.clone());
                }
            }
        }
    }
    assert!(arrows > 20, "only {arrows} uses between folders seen");
    assert_none(&circles, "uses between folders go one way, these go round");
}

#[test]
fn references_are_read() {
    let code = "use crate::a::b::C;\nuse crate::{d::E, f};\nlet x = crate::g::h(1);";
    let found: Vec<String> = references(code).iter().map(|path| path.join("/")).collect();
    assert_eq!(found, ["a/b", "d", "f", "g/h"]);
}
