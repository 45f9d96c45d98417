//! What the workspace may depend on: licences, sources, crates that are out of place, and versions beside each other.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

/// Licences that ask for no more than a notice.
const PERMISSIVE: [&str; 10] = [
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "MIT",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Crates that are out of place here, and why.
const BANNED: [(&str, &str); 7] = [
    (
        "openssl-sys",
        "a library of the system, for a network that is never used",
    ),
    ("native-tls", "the same, behind a façade"),
    ("reqwest", "nothing is fetched from a network"),
    ("bindgen", "needs a C compiler's library where the workspace is built"),
    ("cmake", "builds C++ along with the workspace"),
    ("lazy_static", "the standard library has LazyLock"),
    (
        "serde_yaml",
        "no longer maintained; serde-saphyr reads the clusters' files",
    ),
];

/// Crates that are out of place but for the protocol that agents speak, which only the command does; and why.
const FOR_AGENTS: [(&str, &str); 2] = [
    (
        "tokio",
        "work is divided by rayon; there is nothing to wait for but a question",
    ),
    ("chrono", "results do not depend on the time of day"),
];

/// Crates with several versions beside each other, and who asks for them.
const BESIDE: [(&str, &str); 5] = [
    ("getrandom", "proptest's generators, and tempfile's names"),
    ("glam", "nalgebra names every version that it converts to"),
    ("miniz_oxide", "png by way of flate2, and this workspace"),
    ("r-efi", "getrandom's, on no platform that is built for"),
    ("syn", "derives that have not followed yet"),
];

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// The crates that are built on this machine, as cargo describes them without a network: those for other systems need
/// not have been fetched.
fn packages() -> Vec<Value> {
    let version = Command::new("rustc").arg("-vV").output().expect("a compiler");
    let version = String::from_utf8(version.stdout).expect("UTF-8");
    let host = version
        .lines()
        .find_map(|line| line.strip_prefix("host: "))
        .expect("a host");
    let output = Command::new(env!("CARGO"))
        .args([
            "metadata",
            "--offline",
            "--locked",
            "--format-version",
            "1",
            "--filter-platform",
            host,
        ])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    found["packages"].as_array().expect("packages").clone()
}

/// The crates of all systems: names, versions and sources (none within the workspace).
fn locked() -> Vec<(String, String, Option<String>)> {
    let text = std::fs::read_to_string(root().join("Cargo.lock")).expect("a lock file");
    let entry = |text: &str| {
        let value = |key: &str| {
            text.lines()
                .find_map(|line| line.strip_prefix(key)?.strip_prefix(" = \"")?.strip_suffix('"'))
                .map(String::from)
        };
        (
            value("name").expect("a name"),
            value("version").expect("a version"),
            value("source"),
        )
    };
    text.split("[[package]]\n").skip(1).map(entry).collect()
}

/// Whether an expression can be met by permissive licences alone. `AND` binds more closely than `OR`, and `/` is an old
/// `OR`.
fn permissive(expression: &str) -> bool {
    fn alternatives<'a>(words: &mut std::iter::Peekable<impl Iterator<Item = &'a str>>) -> bool {
        let mut found = false;
        loop {
            let mut all = true;
            loop {
                let mut licence = String::new();
                if words.next_if_eq(&"(").is_some() {
                    all &= alternatives(words);
                    all &= words.next() == Some(")");
                } else {
                    while let Some(word) = words.next_if(|word| !["AND", "OR", "/", "(", ")"].contains(word)) {
                        licence = [licence.as_str(), word].join(" ").trim_start().to_string();
                    }
                    all &= PERMISSIVE.contains(&licence.as_str());
                }
                if words.next_if_eq(&"AND").is_none() {
                    break;
                }
            }
            found |= all;
            if words.next_if(|word| ["OR", "/"].contains(word)).is_none() {
                return found;
            }
        }
    }
    let spaced = expression.replace('(', " ( ").replace(')', " ) ").replace('/', " / ");
    let mut words = spaced.split_whitespace().peekable();
    alternatives(&mut words) && words.next().is_none()
}

#[test]
fn licences_are_permissive() {
    let packages = packages();
    assert!(packages.len() > 100, "only {} packages seen", packages.len());
    let others: Vec<String> = packages
        .iter()
        .filter(|package| !package["license"].as_str().is_some_and(permissive))
        .map(|package| format!("{} {}: {}", package["name"], package["version"], package["license"]))
        .collect();
    assert!(others.is_empty(), "no permissive licence:\n{}", others.join("\n"));
}

#[test]
fn expressions_of_licences_are_read() {
    for good in [
        "MIT",
        "MIT/GPL-3.0",
        "GPL-2.0 OR MIT",
        "(MIT OR Apache-2.0) AND Unicode-3.0",
        "MIT AND Zlib OR GPL-3.0",
    ] {
        assert!(permissive(good), "{good}");
    }
    for bad in [
        "",
        "GPL-3.0",
        "MIT AND GPL-3.0",
        "(MIT OR Zlib) AND MPL-2.0",
        "(MIT",
        "MIT)",
        "GPL-2.0 WITH Classpath-exception-2.0",
        "MIT Zlib",
    ] {
        assert!(!permissive(bad), "{bad}");
    }
}

#[test]
fn every_crate_comes_from_the_registry() {
    let locked = locked();
    let elsewhere: Vec<_> = locked
        .iter()
        .filter(|(_, _, source)| {
            source
                .as_ref()
                .is_some_and(|source| source != "registry+https://github.com/rust-lang/crates.io-index")
        })
        .collect();
    assert!(
        elsewhere.is_empty(),
        "neither of the workspace nor of the registry: {elsewhere:?}"
    );
    let (own, total) = (locked.iter().filter(|entry| entry.2.is_none()).count(), locked.len());
    assert!(own > 10 && total > 100, "only {own} of {total} seen");
}

#[test]
fn no_crate_is_out_of_place() {
    let locked = locked();
    let found: Vec<String> = BANNED
        .iter()
        .filter(|(name, _)| locked.iter().any(|entry| entry.0 == *name))
        .map(|(name, why)| format!("{name}: {why}"))
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// Those that a crate is built with, by way of all others.
fn below<'a>(name: &'a str, uses: &'a BTreeMap<String, BTreeSet<String>>) -> BTreeSet<&'a str> {
    let (mut seen, mut open) = (BTreeSet::new(), vec![name]);
    while let Some(next) = open.pop() {
        for used in uses.get(next).into_iter().flatten() {
            if seen.insert(used.as_str()) {
                open.push(used);
            }
        }
    }
    seen
}

#[test]
fn what_agents_need_is_for_agents_alone() {
    let packages = packages();
    let mut uses: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for package in &packages {
        let name = package["name"].as_str().expect("a name");
        let built = package["dependencies"].as_array().expect("dependencies").iter();
        // Optional ones count, too, but for those of other crates' features.
        let own = package["source"].is_null();
        let built = built.filter(|used| used["kind"].as_str() != Some("dev") && (own || used["optional"] != true));
        let names = built.filter_map(|used| used["name"].as_str().map(String::from));
        uses.entry(name.to_string()).or_default().extend(names);
    }
    for library in ["sweepsim-job", "sweepsim-python"] {
        let reached = below(library, &uses);
        assert!(reached.len() > 40, "only {} crates below {library}", reached.len());
        for (name, why) in FOR_AGENTS {
            assert!(!reached.contains(name), "{library} needs {name}: {why}");
        }
    }
    assert!(
        below("sweepsim-cli", &uses).contains("tokio"),
        "nobody speaks to agents"
    );
}

#[test]
fn versions_beside_each_other_are_known() {
    let mut versions: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for (name, version, _) in locked() {
        versions.entry(name).or_default().insert(version);
    }
    versions.retain(|_, versions| versions.len() > 1);
    let known: BTreeSet<&str> = BESIDE.iter().map(|(name, _)| *name).collect();
    let found: BTreeSet<&str> = versions.keys().map(String::as_str).collect();
    assert_eq!(
        found, known,
        "new ones need a reason, and those that are gone leave the list: {versions:?}"
    );
}
