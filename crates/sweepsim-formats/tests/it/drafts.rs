//! Jobs for programs, and the tools and grids that jobs need not say.

use std::path::{Path, PathBuf};

use sweepsim_formats::{Draft, DraftOptions, DraftStock, Job, draft, parse_stl, write_stl};
use tempfile::TempDir;

const CL: &str = "PARTNO plate\nUNITS/MM\nINSERT/Stock Size X60. Y40. Z10.\nCUTTER/10,0,5,0,0,0,60\nLOAD/TOOL,3\nCSI_SET_FLUTE_LENGTH/25\n\
CSI_SET_EXTENSION_LENGTH/40\nRAPID\nGOTO/-10,20,5\nFEDRAT/500,MMPM\nGOTO/-10,20,-2\nGOTO/30,20,-2\nCIRCLE/30,25,-2,0,0,1\nGOTO/30,20,-2\n\
RAPID\nGOTO/30,20,20\nCUTTER/6,0,3,1.802582,31,0,80\nLOAD/TOOL,7\nRAPID\nGOTO/50,10,20\nCYCLE/DRILL,DEPTH,8,MMPM,100,CLEAR,2\nGOTO/50,10,0\n\
CYCLE/OFF\nFINI\n";

const GCODE: &str = "%\n(T1 D=6. CR=0. - ZMIN=-3. - flat end mill)\nG21 G90\nT1 M6\nG0 X0 Y0 Z5\nG1 Z-3 F200\nX50\nG3 X50 Y20 J10\nG0 Z5\nM30\n";

fn file(folder: &TempDir, name: &str, text: &str) -> PathBuf {
    let file = folder.path().join(name);
    std::fs::write(&file, text).unwrap();
    file
}

fn options(folder: &TempDir) -> DraftOptions {
    let mut options = DraftOptions::default();
    options.folder = folder.path().to_owned();
    options
}

fn made(file: &Path, options: &DraftOptions) -> (Draft, Job) {
    let draft = draft(file, options).unwrap_or_else(|error| panic!("{error}"));
    let job =
        Job::parse(&draft.text, &file.with_extension("ron")).unwrap_or_else(|error| panic!("{}\n{error}", draft.text));
    (draft, job)
}

/// The guesses as people read them.
fn guessed(draft: &Draft) -> Vec<String> {
    draft.guessed.iter().map(ToString::to_string).collect()
}

#[test]
fn a_cl_file_alone_is_a_job() {
    let folder = tempfile::tempdir().unwrap();
    let (draft, job) = made(&file(&folder, "plate.cls", CL), &options(&folder));
    assert_eq!(job.tools.keys().copied().collect::<Vec<_>>(), [3, 7]);
    assert_eq!(job.bodies[&3].len(), 1);
    let ([x0, y0], [x1, y1]) = (job.grid.min(), job.grid.max());
    assert_eq!([x0, y0, x1, y1], [0.0, 0.0, 60.0, 40.0], "the grid covers the stock");
    assert_eq!(
        guessed(&draft),
        [
            "stock: the zero of the program is at the lower left corner of its top",
            "grid: cells of 0.6 mm, from the smallest tool and the size of the stock"
        ]
    );
    assert!(draft.text.contains("Path(file: \"plate.cls\")"), "{}", draft.text);
    // Each pose knows its line, and the cycle that made it.
    assert_eq!(job.paths.len(), 2);
    let drill = &job.paths[1];
    let places: Vec<Vec<usize>> = (0..4)
        .map(|pose| drill.places(pose).iter().map(|(_, line)| *line).collect())
        .collect();
    assert_eq!(places, [vec![20], vec![22, 21], vec![22, 21], vec![22, 21]]);
    assert!(drill.places(0)[0].0.ends_with("plate.cls"));
    assert_eq!((job.paths[0].rapid_moves(), drill.rapid_moves()), (1, 2));
    assert_eq!(job.moves(), 4 + 3);
}

#[test]
fn a_job_can_name_the_program_alone() {
    let folder = tempfile::tempdir().unwrap();
    file(&folder, "plate.cls", CL);
    let read = |text: &str| Job::parse(text, &folder.path().join("job.ron"));
    let stock = "stock: Block(min: (0, 0, -10), max: (60, 40, 0))";
    let job = read(&format!("Job({stock}, paths: [Path(file: \"plate.cls\")])")).unwrap();
    assert_eq!((job.tools.len(), job.grid.cells()), (2, [300, 200]));
    let job = read(&format!(
        "Job(grid: Grid(cell: 2), {stock}, paths: [Path(file: \"plate.cls\")])"
    ))
    .unwrap();
    assert_eq!(job.grid.cells(), [30, 20]);
    // The tools of the job come first.
    let job = read(&format!(
        "Job({stock}, tools: {{3: Ball(radius: 4, length: 30)}}, paths: [Path(file: \"plate.cls\")])"
    ))
    .unwrap();
    assert!(job.tools[&3].profile().unwrap().segments().len() == 3 && !job.bodies.contains_key(&3));
    let bad = |text: &str| {
        let message = read(text).unwrap_err().to_string();
        message[message.find("job.ron").unwrap_or(0)..].to_owned()
    };
    assert_eq!(
        bad(&format!("Job(grid: Grid(min: (0, 0)), {stock}, paths: [])")),
        "job.ron:1:21: a grid with only one corner, or with a frame but no corners: expected `min` and `max`"
    );
    assert_eq!(
        bad(&format!("Job(grid: Grid(cell: 0), {stock}, paths: [])")),
        "job.ron:1:22: cell is 0, but must be a positive length"
    );
    assert_eq!(
        bad(&format!("Job(grid: Grid(cell: 1, cells: (2, 2)), {stock}, paths: [])")),
        "job.ron:1:22: both `cells` and `cell` in one grid: expected one of them"
    );
    for (field, message) in [
        (
            "format: \"pdf\"",
            "the format of this program is \"pdf\", but must be one of gcode, apt, table, rows",
        ),
        (
            "controller: \"abacus\"",
            "the controller of this program is \"abacus\", but must be one of linuxcnc, fanuc, haas, siemens, heidenhain, grbl, okuma",
        ),
    ] {
        let found = bad(&format!("Job({stock}, paths: [Path(file: \"plate.cls\", {field})])"));
        assert!(found.ends_with(message), "{found}");
    }
    let found = bad(&format!(
        "Job({stock}, paths: [Path(file: \"plate.cls\", machine: \"no.ron\")])"
    ));
    assert!(found.contains("machine no.ron: "), "{found}");
    let found = bad(&format!("Job({stock}, library: \"no.json\", paths: [])"));
    assert!(
        found.starts_with("job.ron:1:") && found.contains("cannot read the tool file"),
        "{found}"
    );
}

#[test]
fn tools_of_two_programs() {
    let folder = tempfile::tempdir().unwrap();
    let cl = |d: u8| format!("UNITS/MM\nCUTTER/{d},0,2,0,0,0,30\nLOAD/TOOL,1\nGOTO/0,0,0\nGOTO/9,0,0\n");
    file(&folder, "a.cls", &cl(4));
    file(&folder, "b.cls", &cl(4));
    file(&folder, "c.cls", &cl(5));
    let read = |other: &str| {
        let text = format!(
            "Job(stock: Block(min: (0, 0, 0), max: (9, 9, 9)), paths: [Path(file: \"a.cls\"), Path(file: \"{other}\")])"
        );
        Job::parse(&text, &folder.path().join("job.ron"))
    };
    let job = read("b.cls").unwrap();
    assert_eq!((job.tools.len(), job.paths.len()), (1, 2));
    let message = read("c.cls").unwrap_err().to_string();
    assert!(
        message.ends_with("c.cls:4:1: tool 1 is another cutter in c.cls than in a.cls: expected `tools` in the job"),
        "{message}"
    );
}

#[test]
fn stock_above_zero_is_faced() {
    let folder = tempfile::tempdir().unwrap();
    let top = |moves: &str| {
        let text =
            format!("G21 G90\n(T1 D=6. CR=0. - flat end mill)\nT1 M6\nG0 X0 Y0 Z9\n{moves}G0 Z9\nG1 Z-1 F100\nX40\n");
        let program = file(&folder, "face.nc", &text);
        let (draft, _) = made(&program, &options(&folder));
        let stock = guessed(&draft)
            .into_iter()
            .find(|guess| guess.starts_with("stock"))
            .unwrap();
        stock.split("its top at ").nth(1).unwrap().to_owned()
    };
    // Two levels 0.5 mm apart: there is as much above the first one.
    let faced = "G1 Z1 F100\nX40\nG0 Z9\nX0\nG1 Z0.5\nX40\n";
    assert_eq!(top(faced), "z = 1.5, a level above the highest cut to the side");
    // No more than where the tool comes down at feed from.
    assert_eq!(
        top(&faced.replacen("G1 Z1", "Z1.2\nG1 Z1", 1)),
        "z = 1.2, a level above the highest cut to the side"
    );
    // Ways at feed above the part are no cuts: after a rapid, or upwards at feed.
    for leads in [
        "Z2\nG1 X40 F100\nX0\n",
        "G1 Z-1 F100\nX5\nZ2\nX0\n",
        "G1 Z0 F100\nX40\n",
    ] {
        assert_eq!(top(leads), "z = 0", "{leads}");
    }
}

#[test]
fn gcode_with_comments_and_libraries() {
    let folder = tempfile::tempdir().unwrap();
    let program = file(&folder, "slot.nc", GCODE);
    let (draft, job) = made(&program, &options(&folder));
    assert_eq!(
        guessed(&draft),
        [
            "stock: a block around the feed moves, 3 mm wider on each side, its top at z = 0",
            "tool 1: flutes of 24 mm",
            "grid: cells of 0.6 mm, from the smallest tool and the size of the stock",
        ]
    );
    // The arc reaches x = 60: the block is around it, not around its ends.
    assert!((job.grid.max()[0] - 63.0).abs() < 0.02 && job.grid.min()[0] == -3.0);
    assert_eq!(job.paths[0].path.moves(), 4, "an arc is one move");
    // A library fills in what the comment leaves open.
    let mut with = options(&folder);
    let library = r#"{"data": [{"type": "flat end mill", "unit": "millimeters", "geometry": {"DC": 6, "LCF": 13, "SFDM": 6, "LB": 30},
        "post-process": {"number": 1}}], "version": 36}"#;
    with.tools = Some(file(&folder, "tools.json", library));
    with.stock = DraftStock::Block {
        min: [-5.0, -5.0, -8.0],
        max: [65.0, 25.0, 0.0],
    };
    with.controller = Some("fanuc".into());
    with.cells = Some([70, 30]);
    let (draft, job) = made(&program, &with);
    assert!(draft.guessed.is_empty(), "{:?}", draft.guessed);
    assert_eq!((job.grid.cells(), job.bodies[&1].len()), ([70, 30], 1));
    assert!(draft.text.contains("controller: \"fanuc\""));
}

#[test]
fn what_is_missing_is_asked_for_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let program = file(&folder, "a.nc", "G21\nT1 M6\nG0 X0 Y0 Z0\nG1 X9 F1\nT2 M6\nG1 X5 Y5\n");
    let refused = |options: &DraftOptions| draft(&program, options).unwrap_err().to_string();
    let say = "expected a tool library (`--tools`) or comments in the program that say it; `sweepsim new` writes a job to edit";
    assert!(refused(&options(&folder)).ends_with(&format!(
        "a.nc: tool 1: nothing is known of it; tool 2: nothing is known of it: {say}"
    )));
    let mut with = options(&folder);
    with.tools = Some(file(&folder, "t.tbl", "T1 P1 D6 ;mill\nT2 P2 Z5 ;what\n"));
    assert!(
        refused(&with).ends_with(&format!("a.nc: tool 2: the shape is missing: {say}")),
        "{}",
        refused(&with)
    );
    with.invent = true;
    with.tools = None;
    let (draft, _) = made(&program, &with);
    assert!(
        draft
            .guessed
            .iter()
            .any(|guess| guess.to_string() == "tool 1: nothing is known of it; a flat end mill of 6 mm: correct it")
    );
    with.format = Some("pdf".into());
    assert!(refused(&with).ends_with("the format is \"pdf\", but must be one of gcode, apt, table, rows"));
    let rapids = file(&folder, "r.nc", "G21\nG0 X0 Y0 Z0\nG0 X9\n");
    let message = draft_error(&rapids, &options(&folder));
    assert!(
        message.contains("no feed moves around which stock could be guessed: expected `--stock`"),
        "{message}"
    );
}

fn draft_error(file: &Path, options: &DraftOptions) -> String {
    draft(file, options).unwrap_err().to_string()
}

#[test]
fn projects_and_meshes() {
    let folder = tempfile::tempdir().unwrap();
    file(&folder, "p.nc", "G21\nT1 M6\nG0 X0 Y0 Z1\nG1 Z-1 F1\nX9\n");
    let project = r#"{"units": "metric", "tools": {"1": {"units": "metric", "shape": "ballnose", "length": 10, "diameter": 2}},
        "workpiece": {"bounds": {"min": [-1, -1, -3], "max": [10, 2, 0]}}, "files": ["no.nc", "p.nc"]}"#;
    let project = file(&folder, "p.camotics", project);
    let (draft, job) = made(&project, &options(&folder));
    assert!(draft.program.ends_with("p.nc") && draft.text.contains("Path(file: \"p.nc\""));
    assert_eq!((job.grid.min(), job.grid.max()), ([-1.0, -1.0], [10.0, 2.0]));
    // A mesh as stock, and another folder: names are then absolute.
    let cube = "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 9 0\nvertex 9 0 0\nendloop\nendfacet\n\
                facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 0 0 9\nendloop\nendfacet\n\
                facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 9\nvertex 0 9 0\nendloop\nendfacet\n\
                facet normal 0 0 0\nouter loop\nvertex 9 0 0\nvertex 0 9 0\nvertex 0 0 9\nendloop\nendfacet\nendsolid\n";
    let soup = parse_stl(cube.as_bytes()).unwrap();
    let mesh = folder.path().join("s.stl");
    let mut bytes = Vec::new();
    write_stl(&soup.triangles, &mut bytes).unwrap();
    std::fs::write(&mesh, bytes).unwrap();
    let mut with = options(&folder);
    with.stock = DraftStock::Mesh(mesh.clone());
    with.target = Some(mesh.clone());
    let (draft, job) = made(&project, &with);
    assert!(draft.text.contains("stock: Mesh(\"s.stl\")") && job.target.is_some());
    assert_eq!((job.grid.max(), job.grid.cells()), ([9.0, 9.0], [300, 300]));
    with.folder = folder.path().join("elsewhere");
    let draft = sweepsim_formats::draft(&project, &with).unwrap();
    assert!(
        draft.text.contains(&format!("stock: Mesh(\"{}\")", mesh.display())),
        "{}",
        draft.text
    );
}
