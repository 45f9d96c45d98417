//! The files for Kubernetes against the types of its published API, and against each other.

use crate::workspace;
use k8s_openapi::api::batch::v1::{Job, JobSpec};
use k8s_openapi::api::core::v1::{Container, PodSpec};
use std::fs;

/// A file as the API reads it.
fn job(name: &str) -> Job {
    let text = fs::read_to_string(workspace::fixtures().join("cluster").join(name)).unwrap();
    let value: serde_json::Value = serde_saphyr::from_str(&text).unwrap();
    let job: Job = serde_json::from_value(value.clone()).unwrap_or_else(|error| panic!("{name}: {error}"));
    // Unknown fields are dropped by the types, so nothing may be missing.
    assert_eq!(serde_json::to_value(&job).unwrap(), value, "{name}");
    job
}

fn parts(job: &Job) -> (&JobSpec, &PodSpec, &Container) {
    let spec = job.spec.as_ref().unwrap();
    let pod = spec.template.spec.as_ref().unwrap();
    assert_eq!(pod.containers.len(), 1);
    (spec, pod, &pod.containers[0])
}

fn after<'a>(arguments: &'a [String], option: &str) -> &'a str {
    let at = arguments.iter().position(|argument| argument == option).expect(option);
    &arguments[at + 1]
}

/// Which exit statuses of which container fail the whole Job.
fn fatal(spec: &JobSpec) -> (String, Vec<i32>) {
    let [rule] = &spec.pod_failure_policy.as_ref().unwrap().rules[..] else {
        panic!("one rule");
    };
    assert_eq!(rule.action, "FailJob");
    let codes = rule.on_exit_codes.as_ref().unwrap();
    assert_eq!(codes.operator, "In");
    (codes.container_name.clone().unwrap(), codes.values.clone())
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
        let arguments = container.args.as_ref().unwrap();
        assert_eq!(arguments[0], command);
        // JOB_COMPLETION_INDEX exists in Indexed Jobs only, and runs from 0 to `completions` − 1.
        assert_eq!(spec.completion_mode.as_deref(), Some("Indexed"));
        let count = spec.completions.unwrap();
        assert_eq!(after(arguments, "--shard"), format!("auto/{count}"));
        assert!((1..=count).contains(&spec.parallelism.unwrap()));
        assert!(spec.backoff_limit.unwrap() >= count, "each shard may fail once");
        assert!(arguments.iter().any(|argument| argument == "--resume"));
        // A policy for failures is for pods that are not restarted in place.
        assert_eq!(pod.restart_policy.as_deref(), Some("Never"));
        assert_eq!(fatal(spec), (container.name.clone(), vec![2]));

        let (spec, other, merging) = parts(&second);
        let words = merging.args.as_ref().unwrap();
        assert_eq!([&words[0][..], &words[1]], ["merge", after(arguments, "--out")]);
        assert_ne!(after(words, "--out"), after(arguments, "--out"));
        assert_eq!(spec.completions, None);
        assert_eq!(other.restart_policy.as_deref(), Some("Never"));
        assert_eq!(fatal(spec), (merging.name.clone(), vec![1, 2, 3]));
        // Both see the same folder.
        assert_eq!(pod.volumes, other.volumes);
        assert_eq!(
            (&container.volume_mounts, &container.working_dir, &container.image),
            (&merging.volume_mounts, &merging.working_dir, &merging.image)
        );
        let folder = container.working_dir.as_ref().unwrap();
        assert_eq!(container.volume_mounts.as_ref().unwrap()[0].mount_path, *folder);
        assert_ne!(first.metadata.name, second.metadata.name);
    }
}
