//! `report.html`: what it says, and that nothing in a program or job can escape from its text.

use crate::support::{Workdir, text};
use std::fs;

/// A slot with a rapid through material, on a line that would leave a script.
const PROGRAM: &str = "G21 G90 G17
T1 M6
S8000 M3
G0 X-20 Y0 Z10
G0 Z5.5
G1 X20 F400
(</script><script>alert 1</script>)
G0 X-20 (</pre><img src=x onerror=alert> & \"'<!--)
G0 Y6 (AND ONE MORE)
G0 X20
G0 Z20
M30
";

const JOB: &str = "Job(
    name: \"<b>job</b>\",
    grid: Grid(min: (-15, -15), max: (15, 15), cells: (30, 30)),
    stock: Block(min: (-15, -15, 0), max: (15, 15, 8)),
    tools: { 1: Flat(radius: 3, length: 12) },
    paths: [Path(file: \"part.nc\")],
)";

fn page(command: &str, code: i32, more: &[&str]) -> String {
    let folder = Workdir::new(JOB);
    fs::write(folder.path("part.nc"), PROGRAM).unwrap();
    let output = folder.run_job(command, &[&["--only", "report"], more].concat());
    assert_eq!(output.status.code(), Some(code), "{}", text(&output.stderr));
    fs::read_to_string(folder.path("out/report.html")).unwrap()
}

#[test]
fn the_page_of_a_verification_says_what_is_wrong_and_where() {
    let html = page("verify", 1, &[]);
    for words in [
        "May not be run: one move does harm.",
        "1 rapid move through material",
        "Rapid move through material",
        "part.nc:10",
    ] {
        assert!(html.contains(words), "{words}");
    }
    // The line with its neighbours, as text.
    assert!(html.contains("<mark class=\"line\"><i>10</i>G0 X20\n</mark>"));
    assert!(html.contains("<i>8</i>G0 X-20 (&lt;/pre&gt;&lt;img src=x onerror=alert&gt; &amp; &quot;&#39;&lt;!--)"));
    assert!(html.contains("<h1>&lt;b&gt;job&lt;/b&gt;</h1>"));
    assert_eq!(html.matches("<script").count(), 4, "the page's own");
}

#[test]
fn every_run_has_its_page() {
    let simulated = page("simulate", 0, &[]);
    assert!(simulated.contains("What is left of the stock") && !simulated.contains("May "));
    assert!(simulated.contains("\"course\":{"), "with the course of the program");
    let still = page("simulate", 0, &["--moments", "0"]);
    assert!(still.contains("\"course\":null") && still.len() < simulated.len());
    let swept = page("sweep", 0, &[]);
    assert!(swept.contains("The swept volume") && swept.contains("\"course\":null"));
}

/// A facing tool goes straight down, so that every moment changes all of the surface.
const PLUNGE: &str = "G21 G90 G17
T1 M6
S8000 M3
G0 X0 Y0 Z10
G0 Z0.5
G1 Z-12 F100
G0 Z10
M30
";

const PLATE: &str = "Job(
    grid: Grid(min: (-20, -20), max: (20, 20), cells: (90, 90)),
    stock: Block(min: (-20, -20, -13), max: (20, 20, 0)),
    tools: { 1: Flat(radius: 18, length: 30) },
    paths: [Path(file: \"part.nc\")],
)";

/// Where there are dexels along three axes, the workpiece is shown by its surface at all moments; on lines as close as
/// those of the job, or farther apart if that needs too many triangles, which is said.
#[test]
fn the_surface_of_all_moments_has_a_limit() {
    let folder = Workdir::new(PLATE);
    fs::write(folder.path("part.nc"), PLUNGE).unwrap();
    let page = |moments: &str| {
        let options = [
            "--only",
            "report",
            "--no-proof",
            "--directions",
            "xyz",
            "--moments",
            moments,
        ];
        folder.run_job("verify", &options);
        fs::read_to_string(folder.path("out/report.html")).unwrap()
    };
    let triangles = |html: &str| {
        let (_, rest) = html
            .split_once("{\"name\":\"course.from\",\"kind\":\"U16\",\"count\":")
            .unwrap();
        rest.split(',').next().unwrap().parse::<u32>().unwrap()
    };
    let farther = "the workpiece during the program is that on lines ";
    let few = page("10");
    assert!(few.contains("\"course\":null") && !few.contains(farther));
    assert!(triangles(&few) > 100_000);
    let many = page("100");
    assert!(many.contains(farther));
    assert!((100_000..=600_000).contains(&triangles(&many)), "{}", triangles(&many));
}
