//! The files for Kubernetes against the fields of its published API, and against each other.

use crate::workspace;
use serde_json::Value;
use std::fs;

/// What a field holds.
enum Kind {
    Text,
    Whole,
    /// Amounts by their names, such as `memory: 1Gi`.
    Amounts,
    Texts,
    Wholes,
    Object(&'static [Field]),
    Objects(&'static [Field]),
}

use Kind::{Amounts, Object, Objects, Text, Texts, Whole, Wholes};

/// Its name, whether it is required, and what it holds.
type Field = (&'static str, bool, Kind);

/// The fields that the files use, as the reference of the API has them (version 1.33: Job of batch/v1, PodSpec and
/// Container of core/v1).
const JOB: &[Field] = &[
    ("apiVersion", true, Text),
    ("kind", true, Text),
    ("metadata", true, Object(&[("name", true, Text)])),
    (
        "spec",
        true,
        Object(&[
            ("completionMode", false, Text),
            ("completions", false, Whole),
            ("parallelism", false, Whole),
            ("backoffLimit", false, Whole),
            ("podFailurePolicy", false, Object(POLICY)),
            ("template", true, Object(&[("spec", true, Object(POD))])),
        ]),
    ),
];
const POLICY: &[Field] = &[(
    "rules",
    true,
    Objects(&[
        ("action", true, Text),
        (
            "onExitCodes",
            false,
            Object(&[
                ("containerName", false, Text),
                ("operator", true, Text),
                ("values", true, Wholes),
            ]),
        ),
    ]),
)];
const POD: &[Field] = &[
    ("restartPolicy", false, Text),
    ("containers", true, Objects(CONTAINER)),
    (
        "volumes",
        false,
        Objects(&[
            ("name", true, Text),
            ("persistentVolumeClaim", false, Object(&[("claimName", true, Text)])),
        ]),
    ),
];
const CONTAINER: &[Field] = &[
    ("name", true, Text),
    ("image", false, Text),
    ("workingDir", false, Text),
    ("command", false, Texts),
    ("args", false, Texts),
    (
        "resources",
        false,
        Object(&[("requests", false, Amounts), ("limits", false, Amounts)]),
    ),
    (
        "volumeMounts",
        false,
        Objects(&[("name", true, Text), ("mountPath", true, Text)]),
    ),
];

/// What is wrong with an object, if anything.
fn wrong(value: &Value, fields: &[Field], place: &str) -> Result<(), String> {
    let object = value.as_object().ok_or(format!("{place} is no object"))?;
    if let Some(unknown) = object.keys().find(|key| fields.iter().all(|field| field.0 != **key)) {
        return Err(format!("{place} has no field {unknown}"));
    }
    for (name, is_required, kind) in fields {
        let place = format!("{place}.{name}");
        match object.get(*name) {
            Some(value) => held(value, kind, &place)?,
            None if *is_required => return Err(format!("{place} is missing")),
            None => {}
        }
    }
    Ok(())
}

fn held(value: &Value, kind: &Kind, place: &str) -> Result<(), String> {
    let all = |good: &dyn Fn(&Value) -> bool| value.as_array().is_some_and(|list| list.iter().all(good));
    let is_good = match kind {
        Text => value.is_string(),
        Whole => value.is_i64(),
        Texts => all(&Value::is_string),
        Wholes => all(&Value::is_i64),
        Amounts => value.as_object().is_some_and(|map| map.values().all(Value::is_string)),
        Object(fields) => return wrong(value, fields, place),
        Objects(fields) => {
            let list = value.as_array().ok_or(format!("{place} is no list"))?;
            return list.iter().try_for_each(|own| wrong(own, fields, place));
        }
    };
    if is_good {
        Ok(())
    } else {
        Err(format!("{place} is {value}"))
    }
}

fn parsed(text: &str) -> Result<Value, String> {
    let value: Value = serde_saphyr::from_str(text).map_err(|error| error.to_string())?;
    wrong(&value, JOB, "Job")?;
    if value["apiVersion"] == "batch/v1" && value["kind"] == "Job" {
        Ok(value)
    } else {
        Err("this is another kind of object".to_owned())
    }
}

fn read(name: &str) -> String {
    fs::read_to_string(workspace::fixtures().join("cluster").join(name)).unwrap()
}

/// A file as the API reads it.
fn job(name: &str) -> Value {
    parsed(&read(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn parts(job: &Value) -> (&Value, &Value, &Value) {
    let spec = &job["spec"];
    let pod = &spec["template"]["spec"];
    assert_eq!(pod["containers"].as_array().unwrap().len(), 1);
    (spec, pod, &pod["containers"][0])
}

fn words(container: &Value) -> Vec<&str> {
    let all = container["args"].as_array().unwrap();
    all.iter().map(|word| word.as_str().unwrap()).collect()
}

fn after<'a>(arguments: &[&'a str], option: &str) -> &'a str {
    let at = arguments.iter().position(|argument| *argument == option).expect(option);
    arguments[at + 1]
}

/// Which exit statuses of which container fail the whole Job.
fn fatal(spec: &Value) -> (&Value, &Value) {
    let [rule] = &spec["podFailurePolicy"]["rules"].as_array().unwrap()[..] else {
        panic!("one rule");
    };
    assert_eq!(rule["action"], "FailJob");
    let codes = &rule["onExitCodes"];
    assert_eq!(codes["operator"], "In");
    (&codes["containerName"], &codes["values"])
}

#[test]
fn jobs_are_valid_and_belong_together() {
    for (command, shards, merge) in [
        ("simulate", "kubernetes-shards.yaml", "kubernetes-merge.yaml"),
        (
            "verify",
            "kubernetes-verify-shards.yaml",
            "kubernetes-verify-merge.yaml",
        ),
    ] {
        let (first, second) = (job(shards), job(merge));
        let (spec, pod, container) = parts(&first);
        let arguments = words(container);
        assert_eq!(arguments[0], command);
        // JOB_COMPLETION_INDEX exists in Indexed Jobs only, and runs from 0 to `completions` − 1.
        assert_eq!(spec["completionMode"], "Indexed");
        let count = spec["completions"].as_i64().unwrap();
        assert_eq!(after(&arguments, "--shard"), format!("auto/{count}"));
        assert!((1..=count).contains(&spec["parallelism"].as_i64().unwrap()));
        assert!(
            spec["backoffLimit"].as_i64().unwrap() >= count,
            "each shard may fail once"
        );
        assert!(arguments.contains(&"--resume"));
        // A policy for failures is for pods that are not restarted in place.
        assert_eq!(pod["restartPolicy"], "Never");
        assert_eq!(fatal(spec), (&container["name"], &serde_json::json!([2])));

        let (spec, other, merging) = parts(&second);
        let words = words(merging);
        assert_eq!(words[..2], ["merge", after(&arguments, "--out")]);
        assert_ne!(after(&words, "--out"), after(&arguments, "--out"));
        assert_eq!(spec["completions"], Value::Null);
        assert_eq!(other["restartPolicy"], "Never");
        assert_eq!(fatal(spec), (&merging["name"], &serde_json::json!([1, 2, 3])));
        // Both see the same folder.
        assert!(pod["volumes"].is_array());
        assert_eq!(pod["volumes"], other["volumes"]);
        for field in ["volumeMounts", "workingDir", "image"] {
            assert_eq!(container[field], merging[field], "{field}");
        }
        assert!(container["image"].is_string());
        assert_eq!(container["volumeMounts"][0]["mountPath"], container["workingDir"]);
        assert_ne!(first["metadata"]["name"], second["metadata"]["name"]);
    }
}

#[test]
fn what_the_api_refuses_is_refused() {
    let text = read("kubernetes-shards.yaml");
    for (from, to, expected) in [
        (
            "backoffLimit: 64",
            "backoffLimits: 64",
            "Job.spec has no field backoffLimits",
        ),
        (
            "completions: 64",
            "completions: many",
            "Job.spec.completions is \"many\"",
        ),
        ("values: [2]", "values: [two]", "onExitCodes.values is [\"two\"]"),
        ("action: FailJob", "do: FailJob", "rules has no field do"),
        (
            "        - name: shard\n          image",
            "        - image",
            "containers.name is missing",
        ),
        ("memory: 2Gi", "memory: 2", "resources.limits is {\"memory\":2}"),
        ("kind: Job", "kind: CronJob", "another kind of object"),
    ] {
        assert!(text.contains(from), "{from}");
        let error = parsed(&text.replacen(from, to, 1)).unwrap_err();
        assert!(error.contains(expected), "{error}");
    }
}
