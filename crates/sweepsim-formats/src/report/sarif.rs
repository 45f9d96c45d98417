//! Findings as SARIF 2.1.0, which code hosts show at the lines of programs.
//!
//! Static Analysis Results Interchange Format, OASIS Standard 2.1.0 (2020), with errata 01.

use super::{Annotation, AnnotationLevel, CiProgram};
use serde_json::{Value, json};
use std::path::{Component, Path, Prefix};

const SCHEMA: &str = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json";
const HOME: &str = env!("CARGO_PKG_REPOSITORY");

/// The rules: the kinds of findings, and what else may be said.
const RULES: [(&str, &str); 11] = [
    ("gouge", "A cutter goes deeper into the target than the limit."),
    ("excess", "Material is left on the target, higher than the limit."),
    ("rapid", "A cutter removes material in a rapid."),
    (
        "collision",
        "A shank or holder touches the workpiece, or comes too near to it.",
    ),
    ("fixture", "A tool touches a fixture, or comes too near to it."),
    ("spindle", "A cutter removes material with the spindle stopped."),
    ("feed", "A cutter removes material before the first feed is given."),
    (
        "machine",
        "Bodies of the machine touch, or come too near to each other.",
    ),
    (
        "limit",
        "An axis of the machine is beyond its limits, or cannot reach a direction.",
    ),
    ("unresolved", "Some lines could not be judged."),
    ("input", "A file cannot be read, or what it says cannot be carried out."),
];

/// All annotations of some programs, as one run.
///
/// # Errors
/// Those of the serialiser; none are known for this data.
pub fn to_sarif(programs: &[CiProgram]) -> serde_json::Result<String> {
    let all = || {
        programs
            .iter()
            .flat_map(|program| &program.cases)
            .flat_map(|case| &case.annotations)
    };
    let rules: Vec<Value> = RULES.iter().map(|(id, text)| rule(id, text)).collect();
    let results: Vec<Value> = all().map(result).collect();
    let log = json!({
        "$schema": SCHEMA,
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "sweepsim",
                "semanticVersion": env!("CARGO_PKG_VERSION"),
                "informationUri": HOME,
                "rules": rules,
            } },
            "invocations": [{
                "executionSuccessful": all().all(|annotation| annotation.level != AnnotationLevel::Input),
            }],
            "columnKind": "unicodeCodePoints",
            "results": results,
        }],
    });
    let mut text = serde_json::to_string_pretty(&log)?;
    text.push('\n');
    Ok(text)
}

fn rule(id: &str, text: &str) -> Value {
    let level = if id == "unresolved" { "warning" } else { "error" };
    json!({
        "id": id,
        "shortDescription": { "text": text },
        "fullDescription": { "text": text },
        "helpUri": format!("{HOME}/blob/main/docs/verdicts.md#findings"),
        "defaultConfiguration": { "level": level },
    })
}

fn result(annotation: &Annotation) -> Value {
    let level = match annotation.level {
        AnnotationLevel::Harm | AnnotationLevel::Input => "error",
        AnnotationLevel::Open => "warning",
    };
    let mut place = json!({ "artifactLocation": artifact(&annotation.file) });
    if let Some(line) = annotation.line {
        let mut region = json!({ "startLine": line });
        if let Some([from, to]) = annotation.columns {
            region["startColumn"] = from.into();
            region["endColumn"] = to.into();
        }
        if let (Some(text), None) = (&annotation.text, annotation.columns) {
            region["snippet"] = json!({ "text": text });
        }
        place["region"] = region;
    }
    let mut result = json!({
        "ruleId": annotation.rule,
        "level": level,
        "message": { "text": literal(&annotation.message) },
        "locations": [{ "physicalLocation": place }],
    });
    if let Some(index) = RULES.iter().position(|(id, _)| *id == annotation.rule) {
        result["ruleIndex"] = index.into();
    }
    result
}

/// Text in which nothing is a placeholder (§3.11.5), and nothing a link (§3.11.6).
fn literal(text: &str) -> String {
    text.replace('{', "{{").replace('}', "}}").replace("](", "] (")
}

/// A file: an address relative to the root of the sources, or one from the root of the disk.
fn artifact(file: &Path) -> Value {
    let (mut parts, mut is_absolute) = (Vec::new(), false);
    for component in file.components() {
        match component {
            Component::Prefix(prefix) => match prefix.kind() {
                Prefix::Disk(letter) | Prefix::VerbatimDisk(letter) => parts.push(format!("{}:", char::from(letter))),
                _ => parts.push(encoded(&prefix.as_os_str().to_string_lossy())),
            },
            Component::RootDir => is_absolute = true,
            Component::CurDir => {}
            Component::ParentDir => parts.push("..".to_owned()),
            Component::Normal(name) => parts.push(encoded(&name.to_string_lossy())),
        }
    }
    let path = parts.join("/");
    match is_absolute {
        true => json!({ "uri": format!("file:///{path}") }),
        false => json!({ "uri": path, "uriBaseId": "%SRCROOT%" }),
    }
}

/// A part of a path with all but unreserved characters as percents (RFC 3986, §2.3).
fn encoded(name: &str) -> String {
    let one = |byte: u8| match byte {
        b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' => char::from(byte).to_string(),
        byte => format!("%{byte:02X}"),
    };
    name.bytes().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::super::CiCase;
    use super::*;

    fn written(annotations: Vec<Annotation>) -> Value {
        let mut program = CiProgram::new("part.nc");
        program.cases.push(CiCase::looked_at("gouge", annotations));
        serde_json::from_str(&to_sarif(&[program]).unwrap()).unwrap()
    }

    /// What the schema requires of each object, and lists as the only values.
    #[test]
    fn what_the_standard_requires_is_there() {
        let harm =
            Annotation::new("gouge", AnnotationLevel::Harm, "deep", "a/part.nc").at(Some(8), Some("G1 X".into()));
        let open = Annotation::new("rapid", AnnotationLevel::Open, "open", "a/part.nc");
        let log = written(vec![harm, open]);
        assert_eq!(
            (&log["version"], log["runs"].as_array().unwrap().len()),
            (&json!("2.1.0"), 1)
        );
        let run = &log["runs"][0];
        assert_eq!(run["tool"]["driver"]["name"], "sweepsim");
        assert_eq!(run["columnKind"], "unicodeCodePoints");
        assert_eq!(run["invocations"][0]["executionSuccessful"], true);
        let rules = run["tool"]["driver"]["rules"].as_array().unwrap();
        assert_eq!(rules.len(), RULES.len());
        let results = run["results"].as_array().unwrap();
        assert_eq!(results.len(), 2);
        for result in results {
            assert!(!result["message"]["text"].as_str().unwrap().is_empty());
            let rule = &rules[result["ruleIndex"].as_u64().unwrap() as usize];
            assert_eq!(rule["id"], result["ruleId"]);
            assert!(!rule["shortDescription"]["text"].as_str().unwrap().is_empty());
            let place = &result["locations"][0]["physicalLocation"];
            assert_eq!(
                place["artifactLocation"],
                json!({ "uri": "a/part.nc", "uriBaseId": "%SRCROOT%" })
            );
        }
        assert_eq!([&results[0]["level"], &results[1]["level"]], ["error", "warning"]);
        let region = |k: usize| &results[k]["locations"][0]["physicalLocation"]["region"];
        assert_eq!(region(0), &json!({ "startLine": 8, "snippet": { "text": "G1 X" } }));
        assert_eq!(region(1), &Value::Null);
    }

    #[test]
    fn nothing_found_is_an_empty_list() {
        assert_eq!(written(Vec::new())["runs"][0]["results"], json!([]));
    }

    #[test]
    fn a_file_that_cannot_be_read_is_no_success() {
        let mut broken =
            Annotation::new("input", AnnotationLevel::Input, "{bad} [#1](2)", "a b/ä.nc").at(Some(1), None);
        broken.columns = Some([3, 5]);
        let log = written(vec![broken]);
        assert_eq!(log["runs"][0]["invocations"][0]["executionSuccessful"], false);
        let result = &log["runs"][0]["results"][0];
        assert_eq!(result["message"]["text"], "{{bad}} [#1] (2)");
        let place = &result["locations"][0]["physicalLocation"];
        assert_eq!(place["artifactLocation"]["uri"], "a%20b/%C3%A4.nc");
        assert_eq!(
            place["region"],
            json!({ "startLine": 1, "startColumn": 3, "endColumn": 5 })
        );
    }

    #[cfg(unix)]
    #[test]
    fn files_elsewhere_have_whole_addresses() {
        assert_eq!(
            artifact(Path::new("/tmp/x y.nc")),
            json!({ "uri": "file:///tmp/x%20y.nc" })
        );
    }
}
