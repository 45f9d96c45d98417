//! Agents, by the client of the protocol's own library.

use rmcp::model::{CallToolRequestParams, CallToolResult, ContentBlock};
use rmcp::service::{RoleClient, RunningService};
use rmcp::{ServiceError, ServiceExt};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, Instant};

/// A server of the files below a folder, and a client of it.
struct Served {
    client: RunningService<RoleClient, ()>,
    server: tokio::process::Child,
}

impl Served {
    async fn below(root: &Path, options: &[&str]) -> Self {
        let mut server = tokio::process::Command::new(env!("CARGO_BIN_EXE_sweepsim"))
            .args(["mcp", "--root"])
            .arg(root)
            .args(options)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the command starts");
        let streams = (server.stdout.take().unwrap(), server.stdin.take().unwrap());
        let client = ().serve(streams).await.expect("a server");
        Self { client, server }
    }

    async fn call(&self, tool: &'static str, arguments: Value) -> Result<CallToolResult, ServiceError> {
        let arguments = arguments.as_object().cloned().unwrap_or_default();
        let asked = CallToolRequestParams::new(tool).with_arguments(arguments);
        self.client.call_tool(asked).await
    }

    /// The data of a call that succeeds.
    async fn data(&self, tool: &'static str, arguments: Value) -> (Value, Vec<ContentBlock>) {
        let done = self.call(tool, arguments).await.unwrap();
        assert_ne!(done.is_error, Some(true), "{:?}", done.content);
        (done.structured_content.expect("data"), done.content)
    }

    /// Why a call fails.
    async fn refused(&self, tool: &'static str, arguments: Value) -> String {
        let done = self.call(tool, arguments).await.unwrap();
        assert_eq!(done.is_error, Some(true), "{done:?}");
        done.content[0].as_text().expect("words").text.clone()
    }

    /// Ends the server by closing its input.
    async fn end(mut self) {
        self.client.cancel().await.unwrap();
        assert!(self.server.wait().await.unwrap().success());
    }
}

fn run(test: impl Future<Output = ()>) {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    runtime.unwrap().block_on(test);
}

fn fixture(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures")).join(name)
}

fn temporary() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

/// The bracket in a folder of its own.
fn bracket(folder: &Path) {
    for name in [
        "bracket-faulty.nc",
        "bracket-faulty.ron",
        "bracket.nc",
        "bracket.ron",
        "bracket.stl",
    ] {
        let bytes = std::fs::read(fixture("verify").join(name)).unwrap();
        // Fewer lines than for people.
        let bytes = match String::from_utf8(bytes) {
            Ok(text) => text.replace("cells: (200, 120)", "cells: (100, 60)").into_bytes(),
            Err(mesh) => mesh.into_bytes(),
        };
        std::fs::write(folder.join(name), bytes).unwrap();
    }
}

fn image(content: &[ContentBlock]) -> Vec<u8> {
    use base64::Engine as _;
    let image = content.iter().find_map(ContentBlock::as_image).expect("a picture");
    assert_eq!(image.mime_type, "image/png");
    base64::prelude::BASE64_STANDARD.decode(&image.data).unwrap()
}

#[test]
fn tools_describe_themselves() {
    run(async {
        let root = temporary();
        let served = Served::below(root.path(), &[]).await;
        let tools = served.client.list_all_tools().await.unwrap();
        let names: Vec<&str> = tools.iter().map(|tool| &*tool.name).collect();
        let all = [
            "inspect_program",
            "verify_program",
            "simulate_program",
            "compare_parts",
            "section",
        ];
        assert_eq!(names, all);
        for tool in &tools {
            let schema = Value::Object((*tool.input_schema).clone());
            let first = if tool.name == "compare_parts" { "part" } else { "path" };
            let described = schema["properties"][first]["description"].as_str().unwrap_or_default();
            let described = described.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(described.contains("relative to the root"), "{}: {schema}", tool.name);
            assert!(schema["required"].as_array().unwrap().contains(&json!(first)));
        }
        served.end().await;
    });
}

#[test]
fn a_program_is_judged_and_shown() {
    run(async {
        let root = temporary();
        bracket(root.path());
        let served = Served::below(root.path(), &[]).await;
        let asked = json!({"path": "bracket-faulty.ron", "proof": false});
        let (data, content) = served.data("verify_program", asked).await;
        assert_eq!(data["verdict"], "fail");
        assert_eq!(data["findings_count"], data["findings"].as_array().unwrap().len());
        let kinds: Vec<&str> = data["findings"]
            .as_array()
            .unwrap()
            .iter()
            .filter_map(|f| f["kind"].as_str())
            .collect();
        for kind in ["fixture", "rapid", "gouge", "collision", "excess"] {
            assert!(kinds.contains(&kind), "{kinds:?}");
        }
        let words = &content[0].as_text().unwrap().text;
        assert!(
            words.starts_with("FAIL: ") && words.contains("bracket-faulty.nc:22: "),
            "{words}"
        );
        let decoder = png::Decoder::new(std::io::Cursor::new(image(&content)));
        assert_eq!(decoder.read_info().unwrap().info().size(), (800, 600));

        let asked = json!({"path": "bracket.nc", "stock": "block:0,0,-24,100,60,0", "cell": 1.0, "picture": false});
        let (data, content) = served.data("simulate_program", asked).await;
        assert_eq!((&data["verdict"], &data["cells"]), (&Value::Null, &json!([100, 60])));
        assert!(data["volume_removed"].as_f64().unwrap() > 1e4 && content.len() == 1);

        let (data, _) = served.data("inspect_program", json!({"path": "bracket.nc"})).await;
        assert!(
            data["lines"]
                .as_array()
                .unwrap()
                .iter()
                .any(|line| line["label"] == "moves")
        );

        let (data, content) = served
            .data("compare_parts", json!({"part": "bracket.stl", "target": "bracket.stl"}))
            .await;
        assert_eq!(data["excess_volume"], 0.0);
        image(&content);

        let asked = json!({"path": "bracket.ron", "plane": "z=-2"});
        let (data, content) = served.data("section", asked).await;
        assert_eq!(data["certified"], true);
        assert!(
            data["outline_count"].as_u64() > Some(0) && data["outline"][0][0][2] == json!(-2.0),
            "{data}"
        );
        assert!(content.iter().any(|block| {
            block
                .as_resource()
                .is_some_and(|drawing| drawing.get_text().contains("<svg"))
        }));
        served.end().await;
    });
}

#[test]
fn nothing_outside_of_the_root_is_read() {
    run(async {
        let folder = temporary();
        let root = folder.path().join("root");
        std::fs::create_dir_all(root.join("inner")).unwrap();
        bracket(&root);
        std::fs::copy(root.join("bracket.stl"), folder.path().join("secret.stl")).unwrap();
        let secret = "G21 G90\nG0 X1 Y1 Z1\nG1 X12345 F100\n";
        std::fs::write(folder.path().join("secret.nc"), secret).unwrap();
        std::fs::write(folder.path().join("1000.nc"), "O1000\nG1 X12345 F100\nM99\n").unwrap();
        let job = |field: &str| {
            format!(
                "Job(stock: Block(min: (0, 0, 0), max: (9, 9, 9)), tools: {{1: Ball(radius: 1, length: 5)}}, {field})"
            )
        };
        for (name, field) in [
            ("up.ron", r#"paths: [Path(tool: 1, file: "../secret.nc")]"#),
            ("escaped.ron", r#"paths: [Path(tool: 1, file: "\u{2e}./secret.nc")]"#),
            ("target.ron", r#"paths: [], target: Mesh("inner/../../secret.stl")"#),
            ("missing.ron", r#"paths: [], target: Mesh("../missing.stl")"#),
            ("library.ron", r#"paths: [], library: "/etc/passwd""#),
        ] {
            std::fs::write(root.join(name), job(field)).unwrap();
        }
        let body = r#"(name: "guard", on: "Z", shape: File("../secret.stl"))"#;
        let machine = format!("Machine(name: \"mill\", bodies: [{body}])");
        std::fs::write(root.join("machine.ron"), machine).unwrap();
        let mut outside = vec![
            json!({"path": "bracket.nc", "machine": "machine.ron"}),
            json!({"path": "../secret.nc"}),
            json!({"path": folder.path().join("secret.nc")}),
            json!({"path": "inner/../../secret.nc"}),
            json!({"path": "../missing.nc"}),
            json!({"path": "bracket.nc", "target": "../secret.stl"}),
            json!({"path": "bracket.nc", "stock": "../secret.stl"}),
            json!({"path": "bracket.nc", "tools": "../secret.nc"}),
            json!({"path": "bracket.nc", "machine": "/etc/passwd"}),
            json!({"path": "up.ron"}),
            json!({"path": "escaped.ron"}),
            json!({"path": "target.ron"}),
            json!({"path": "missing.ron"}),
            json!({"path": "library.ron"}),
        ];
        #[cfg(unix)]
        {
            use std::os::unix::fs::symlink;
            symlink("../secret.nc", root.join("link.nc")).unwrap();
            symlink("..", root.join("above")).unwrap();
            outside.extend([json!({"path": "link.nc"}), json!({"path": "above/secret.nc"})]);
        }
        let served = Served::below(&root, &[]).await;
        for asked in outside {
            let why = served.refused("verify_program", asked.clone()).await;
            let said = why.contains("below the root") || why.contains("expected a file there");
            assert!(said && !why.contains("12345"), "{asked}: {why}");
            if asked.get("path").is_some() && asked.as_object().unwrap().len() == 1 {
                served.refused("inspect_program", asked).await;
            }
        }
        let asked = json!({"part": "../secret.stl", "target": "bracket.stl"});
        assert!(served.refused("compare_parts", asked).await.contains("below the root"));

        // A subprogram that a link leads to is missing.
        std::fs::write(root.join("calls.nc"), "G21 G90\nG0 X0 Y0 Z0\nM98 P1000\nM30\n").unwrap();
        let (without, _) = served.data("inspect_program", json!({"path": "calls.nc"})).await;
        assert!(
            without.to_string().contains("O1000, a program that is missing"),
            "{without}"
        );
        #[cfg(unix)]
        std::os::unix::fs::symlink("../1000.nc", root.join("1000.nc")).unwrap();
        assert_eq!(
            served.data("inspect_program", json!({"path": "calls.nc"})).await.0,
            without
        );
        let _ = std::fs::remove_file(root.join("1000.nc"));
        std::fs::copy(folder.path().join("1000.nc"), root.join("1000.nc")).unwrap();
        let (with, _) = served.data("inspect_program", json!({"path": "calls.nc"})).await;
        assert!(with.to_string().contains("12,345"), "{with}");

        // Names within the root may go up and down.
        served
            .data("inspect_program", json!({"path": root.join("inner/../bracket.nc")}))
            .await;
        served.end().await;
    });
}

#[test]
fn a_call_that_takes_too_long_ends_and_says_so() {
    run(async {
        let root = temporary();
        bracket(root.path());
        let served = Served::below(root.path(), &["--limit", "0.5"]).await;
        let start = Instant::now();
        let asked = json!({"path": "bracket.ron", "cell": 0.02, "picture": false});
        let why = served.refused("verify_program", asked).await;
        assert!(
            why.contains("the limit of 500 ms for a call was reached") && why.contains("cell"),
            "{why}"
        );
        assert!(start.elapsed() < Duration::from_secs(5), "{:?}", start.elapsed());
        // An endless program is no work without end.
        std::fs::write(
            root.path().join("endless.nc"),
            "G21 G90\nG0 X0 Y0 Z0\n#1=0\nWHILE [#1 LT 1] DO1\nG1 X1 F100\nEND1\nM30\n",
        )
        .unwrap();
        let why = served.refused("inspect_program", json!({"path": "endless.nc"})).await;
        assert!(why.contains("the limit of") || why.contains("expected"), "{why}");
        served.end().await;
    });
}

#[test]
fn calls_that_cannot_be_carried_out_say_why() {
    run(async {
        let root = temporary();
        bracket(root.path());
        std::fs::write(root.path().join("wrong.nc"), "G21 G90\nG1 X1 F100\nG1 X2 Q#\n").unwrap();
        let served = Served::below(root.path(), &[]).await;
        let why = served.refused("verify_program", json!({"path": "wrong.nc"})).await;
        assert!(why.contains("wrong.nc:3:8") && why.contains("G1 X2 Q#"), "{why}");
        let why = served.refused("verify_program", json!({"path": "missing.nc"})).await;
        assert!(why.contains("no such file"), "{why}");
        let why = served
            .refused("section", json!({"path": "bracket.ron", "plane": "w=1"}))
            .await;
        assert!(why.contains("expected a plane"), "{why}");
        let why = served
            .refused("verify_program", json!({"path": "bracket.ron", "cell": -1.0}))
            .await;
        assert!(why.contains("positive"), "{why}");
        for (tool, asked) in [
            ("verify_program", json!({"file": "bracket.ron"})),
            (
                "compare_parts",
                json!({"part": "bracket.stl", "target": "bracket.stl", "limit": 1}),
            ),
            ("erase_disk", json!({})),
        ] {
            let error = served.call(tool, asked).await.unwrap_err();
            assert!(matches!(error, ServiceError::McpError(_)), "{error:?}");
        }
        served.end().await;
    });
}
