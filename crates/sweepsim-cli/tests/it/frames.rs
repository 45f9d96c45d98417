//! `--frames`: pictures of the workpiece while it is cut.

use crate::support::{Workdir, text};
use std::fs;
use sweepsim_picture::Image;

/// A slot in a block from above, then a slanted one from the side.
const JOB: &str = "Job(
    grid: Grid(min: (0, 0), max: (30, 20), cells: (45, 30)),
    stock: Block(min: (0, 0, 0), max: (30, 20, 8)),
    tools: { 1: Ball(radius: 2, length: 15), 2: Flat(radius: 1.5, length: 12) },
    bodies: { 2: [Shank(Profile(start: (0, 12), segments: [Line((2, 12)), Line((2, 20)), Line((0, 20))]))] },
    paths: [
        Path(tool: 1, poses: [((-5, 6, 5), (0, 0, 1)), ((15, 6, 5), (0, 0, 1)), ((20, 8, 4), (0.3, 0, 1))]),
        Path(tool: 2, poses: [((-5, 14, 6), (0, 0.2, 1)), ((35, 15, 6.5), (0, -0.2, 1))]),
    ],
)";

const SMALL: [&str; 4] = ["--size", "240x180", "--only", "picture"];

fn frames(folder: &Workdir) -> Vec<String> {
    let mut names = folder.written();
    names.retain(|name| name.starts_with("frame-"));
    names
}

fn image(folder: &Workdir, name: &str) -> Image {
    let bytes = fs::read(folder.path(&format!("out/{name}"))).unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let size = [reader.info().width as usize, reader.info().height as usize];
    Image::new(size, pixels).unwrap()
}

/// The share of pixels that differ by more than a few levels.
fn differing(a: &Image, b: &Image) -> f64 {
    assert_eq!(a.size(), b.size());
    let pixels = a.rgb().chunks(3).zip(b.rgb().chunks(3));
    let far = pixels
        .filter(|(p, q)| p.iter().zip(*q).any(|(a, b)| a.abs_diff(*b) > 8))
        .count();
    far as f64 / (a.rgb().len() / 3) as f64
}

/// The machine's bodies are in the frames, where they are then; without bodies, none are.
#[test]
fn frames_show_the_machine() {
    let folder = Workdir::new(JOB);
    let program = "G21 G90\nT1 M6\nS900 M3\nG1 X0 Y0 Z60 F900\nG1 A0\nG1 A60\nM30\n";
    fs::write(folder.path("turn.nc"), program).unwrap();
    let drawn = |machine: &str| {
        let job = format!(
            "Job(grid: Grid(min: (-20, -20), max: (20, 20), cells: (8, 8)), stock: Block(min: (-20, -20, -30), max: (20, 20, 0)), \
             tools: {{1: Flat(radius: 5, length: 30)}}, paths: [Path(file: \"turn.nc\", machine: \"{machine}\")])"
        );
        fs::write(folder.path("turn.ron"), job).unwrap();
        let job = folder.path("turn.ron").display().to_string();
        let out = folder.path("out").display().to_string();
        let words = [
            "simulate",
            &job,
            "--out",
            &out,
            "--frames",
            "3",
            "--size",
            "240x180",
            "--no-axes",
            "--only",
            "picture",
        ];
        let output = folder.run(&words);
        assert!(output.status.success(), "{}", text(&output.stderr));
        [2, 3].map(|number| image(&folder, &format!("frame-000{number}.png")))
    };
    let of_tool = |image: &Image| {
        let background = image.pixel(0, 0).unwrap();
        image.rgb().chunks(3).filter(|pixel| *pixel != background).count()
    };
    let [_, bare] = drawn("trunnion-ac");
    let [before, after] = drawn("trunnion-ac,table=320");
    assert!(of_tool(&after) > 0 && differing(&bare, &after) > 0.1);
    // The cradle has tilted between both.
    assert!(differing(&before, &after) > 0.02);
}

#[test]
fn frames_lead_from_the_raw_stock_to_the_part() {
    let folder = Workdir::new(JOB);
    let output = folder.run_job("simulate", &[&SMALL[..], &["--frames", "4", "--no-tool"]].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let summary = text(&output.stdout);
    assert!(summary.contains("frame-0001.png … frame-0004.png"), "{summary}");
    assert_eq!(frames(&folder).len(), 4);
    let last = image(&folder, "frame-0004.png");
    assert!(differing(&last, &image(&folder, "part.png")) < 2e-3);
    let images: Vec<Image> = frames(&folder).iter().map(|name| image(&folder, name)).collect();
    for pair in images.windows(2) {
        assert!(differing(&pair[0], &pair[1]) > 5e-3);
    }
    // What is cut stays cut: each frame is nearer to the last than those before.
    let left: Vec<f64> = images.iter().map(|image| differing(image, &last)).collect();
    assert!(left.windows(2).all(|pair| pair[1] < pair[0]), "{left:?}");
    // A stock that no tool has touched.
    let raw = Workdir::new(
        &JOB.replace(
            "(-5, 6, 5), (0, 0, 1)), ((15, 6, 5), (0, 0, 1)), ((20, 8, 4)",
            "(-5, 6, 50), (0, 0, 1)), ((15, 6, 50), (0, 0, 1)), ((20, 8, 40)",
        )
        .replace("14, 6)", "14, 60)")
        .replace("15, 6.5)", "15, 60)"),
    );
    let output = raw.run_job("simulate", &SMALL);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(differing(&images[0], &image(&raw, "part.png")), 0.0);

    // Fewer of them: those of the run before are gone. With the tool, which is seen.
    let output = folder.run_job("verify", &[&SMALL[..], &["--frames", "2"]].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(frames(&folder), ["frame-0001.png", "frame-0002.png"]);
    assert!(differing(&image(&folder, "frame-0002.png"), &last) > 0.01);
    // A single one is of the end.
    let output = folder.run_job("simulate", &[&SMALL[..], &["--frames", "1", "--no-tool"]].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(differing(&image(&folder, "frame-0001.png"), &last), 0.0);
}

#[test]
fn moves_are_cut_once_whatever_the_number_of_frames() {
    let folder = Workdir::new(JOB);
    let run = |count: &str| {
        let more = ["--frames", count, "--no-tool", "--directions", "z", "--section", "y=10"];
        let output = folder.run_job("simulate", &[&SMALL[..], &more].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        image(&folder, frames(&folder).last().unwrap())
    };
    // Moments within moves, and moves cut one by one or together, lead to the same part.
    assert!(differing(&run("1"), &run("6")) < 1e-3);
}

#[test]
fn what_cannot_be_shown_is_said() {
    let folder = Workdir::new(JOB);
    let job = ["simulate", "job.ron", "--out", "out"];
    let none = folder.bad(&[&job[..], &["--frames", "0"]].concat());
    assert!(none.contains("0 is not in 1..=9999"), "{none}");
    let sweep = folder.bad(&["sweep", "job.ron", "--out", "out", "--frames", "3"]);
    assert!(sweep.contains("--frames: expected `simulate` or `verify`"), "{sweep}");
    let lonely = folder.bad(&[&job[..], &["--no-tool"]].concat());
    assert!(lonely.contains("--frames"), "{lonely}");
    let empty = Workdir::new(&JOB.replace(
        "Block(min: (0, 0, 0), max: (30, 20, 8))",
        "Difference(Block(min: (0, 0, 0), max: (30, 20, 8)), [Block(min: (-1, -1, -1), max: (31, 21, 9))])",
    ));
    let empty = empty.bad(&[&job[..], &SMALL, &["--frames", "3"]].concat());
    assert!(
        empty.contains("--frames: expected a stock that is not empty"),
        "{empty}"
    );
    // A path of one pose goes nowhere: the stock as it is.
    let still = Workdir::new(
        "Job(grid: Grid(min: (0, 0), max: (9, 9), cells: (9, 9)), stock: Block(min: (0, 0, 0), max: (9, 9, 5)),
        tools: { 1: Ball(radius: 2, length: 9) }, paths: [Path(tool: 1, poses: [((4, 4, 9), (0, 0, 1))])])",
    );
    let output = still.run_job("simulate", &[&SMALL[..], &["--frames", "2"]].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(frames(&still).len(), 2);
}
