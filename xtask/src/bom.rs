//! `cargo xtask bom`: what the command is made of, as a bill of materials in CycloneDX 1.6.
//!
//! Crates with their versions, licences and checksums, and who depends on whom: of all features, as built on this
//! system, without what only builds or tests need. The same workspace gives the same bytes.

use crate::workspace;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

/// What is described: all that this crate is built with.
const ROOT: &str = "sweepsim-cli";

/// The bill of materials as JSON.
pub fn bom() -> Result<String, String> {
    let metadata = metadata()?;
    let lock = workspace::root().join("Cargo.lock");
    let lock = std::fs::read_to_string(&lock).map_err(|error| format!("{}: {error}", lock.display()))?;
    let bom = described(&metadata, &checksums(&lock))?;
    serde_json::to_string_pretty(&bom)
        .map(|text| text + "\n")
        .map_err(|error| error.to_string())
}

fn metadata() -> Result<Value, String> {
    let version = Command::new("rustc").arg("-vV").output();
    let version = version.map_err(|error| format!("rustc: {error}"))?;
    let version = String::from_utf8_lossy(&version.stdout).into_owned();
    let host = version.lines().find_map(|line| line.strip_prefix("host: "));
    let host = host.ok_or("rustc does not say for which system it compiles")?;
    let output = Command::new(env!("CARGO"))
        .args([
            "metadata",
            "--locked",
            "--format-version",
            "1",
            "--filter-platform",
            host,
        ])
        .current_dir(workspace::root())
        .output();
    let output = output.map_err(|error| format!("cargo metadata: {error}"))?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    serde_json::from_slice(&output.stdout).map_err(|error| format!("cargo metadata: {error}"))
}

/// The checksums of a lock file, by name and version.
fn checksums(lock: &str) -> BTreeMap<(String, String), String> {
    let entry = |text: &str| {
        let value = |key: &str| {
            text.lines()
                .find_map(|line| line.strip_prefix(key)?.strip_prefix(" = \"")?.strip_suffix('"'))
                .map(String::from)
        };
        Some(((value("name")?, value("version")?), value("checksum")?))
    };
    lock.split("[[package]]\n").filter_map(entry).collect()
}

fn described(metadata: &Value, checksums: &BTreeMap<(String, String), String>) -> Result<Value, String> {
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let packages: BTreeMap<String, Value> = list(&metadata["packages"])
        .into_iter()
        .map(|package| (text(&package["id"]), package))
        .collect();
    let uses: BTreeMap<String, Vec<String>> = list(&metadata["resolve"]["nodes"])
        .into_iter()
        .map(|node| {
            // Those of builds and tests are not part of the command.
            let built = |used: &Value| list(&used["dep_kinds"]).iter().any(|kind| kind["kind"].is_null());
            let used = list(&node["deps"]).into_iter().filter(built);
            (text(&node["id"]), used.map(|used| text(&used["pkg"])).collect())
        })
        .collect();
    let root = packages.iter().find(|(_, package)| package["name"] == ROOT);
    let (root, _) = root.ok_or_else(|| format!("there is no crate {ROOT}"))?;
    let (mut seen, mut open) = (BTreeSet::from([root]), vec![root]);
    while let Some(next) = open.pop() {
        for used in uses.get(next).into_iter().flatten() {
            if seen.insert(used) {
                open.push(used);
            }
        }
    }
    let url = |id: &String| {
        let package = &packages[id];
        format!("pkg:cargo/{}@{}", text(&package["name"]), text(&package["version"]))
    };
    let component = |id: &String, kind: &str| {
        let package = &packages[id];
        let (name, version) = (text(&package["name"]), text(&package["version"]));
        let mut made = json!({
            "type": kind,
            "bom-ref": url(id),
            "name": name,
            "version": version,
            "purl": url(id),
        });
        if let Some(licence) = package["license"].as_str() {
            // An old notation of OR.
            made["licenses"] = json!([{ "expression": licence.replace(" / ", " OR ").replace('/', " OR ") }]);
        }
        if let Some(sum) = checksums.get(&(name, version)) {
            made["hashes"] = json!([{ "alg": "SHA-256", "content": sum }]);
        }
        made
    };
    let mut parts: Vec<&String> = seen.iter().copied().filter(|id| *id != root).collect();
    parts.sort_by_key(|id| url(id));
    let below = |id: &String| {
        let mut urls: Vec<String> = uses.get(id).into_iter().flatten().map(url).collect();
        urls.sort();
        urls.dedup();
        json!({ "ref": url(id), "dependsOn": urls })
    };
    Ok(json!({
        "$schema": "http://cyclonedx.org/schema/bom-1.6.schema.json",
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "metadata": { "component": component(root, "application") },
        "components": parts.iter().map(|id| component(id, "library")).collect::<Vec<_>>(),
        "dependencies": std::iter::once(&root).chain(&parts).map(|id| below(id)).collect::<Vec<_>>(),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_that_the_command_is_built_with_is_listed() {
        let bom: Value = serde_json::from_str(&bom().unwrap()).unwrap();
        let parts = bom["components"].as_array().unwrap();
        let names: BTreeSet<&str> = parts.iter().filter_map(|part| part["name"].as_str()).collect();
        for name in ["nalgebra", "clap", "rmcp", "sweepsim-check", "sweepsim"] {
            assert!(names.contains(name), "{name} is missing");
        }
        for name in ["proptest", "criterion", "pyo3"] {
            assert!(!names.contains(name), "{name} is no part");
        }
        let url = |part: &Value| part["bom-ref"].as_str().map(String::from);
        let known: BTreeSet<String> = parts
            .iter()
            .chain([&bom["metadata"]["component"]])
            .filter_map(url)
            .collect();
        assert_eq!(known.len(), parts.len() + 1);
        for part in parts {
            assert!(
                part["licenses"][0]["expression"]
                    .as_str()
                    .is_some_and(|text| !text.contains('/')),
                "{part}"
            );
            let own = part["name"].as_str().is_some_and(|name| name.starts_with("sweepsim"));
            assert_eq!(
                part["hashes"][0]["content"].as_str().map_or(0, str::len),
                if own { 0 } else { 64 },
                "{part}"
            );
        }
        let uses = bom["dependencies"].as_array().unwrap();
        assert_eq!(uses.len(), known.len());
        let used = uses.iter().flat_map(|one| one["dependsOn"].as_array().unwrap());
        let used: BTreeSet<String> = used.filter_map(|url| url.as_str().map(String::from)).collect();
        assert!(used.is_subset(&known) && used.len() + 1 == known.len());
    }
}
