//! The readers, and a file of each that is right. Certificates have their own test: a digest refuses whatever is
//! changed.

use crate::workspace;
use std::fmt::Display;
use std::fs;
use std::io;
use std::path::Path;
use sweepsim_dexel::{AnalyticSurface, Dexels, Grid, Mesh, Stock, SurfaceEnd, TriDexels, TriangleSoup};
use sweepsim_formats as formats;
use sweepsim_formats::Job;
use sweepsim_nc as nc;
use sweepsim_nc::{Machine, ReadOptions};
use sweepsim_solid::{Solid, SolidOptions, StepHeader, Surface, write_step};

/// A reader.
pub(super) struct Reader {
    pub name: &'static str,
    /// Of its files among the shared data.
    pub endings: &'static [&'static str],
    /// Files that are right, the last one of all at least.
    pub own: fn() -> Vec<Vec<u8>>,
    /// The error of a file, if it is wrong.
    pub read: fn(&[u8]) -> Option<String>,
}

const GCODE: &str = "%\nO1 (POCKET)\nG21 G90 G17 G40 G49 G80\nT1 M6\nS8000 M3\nG54 G0 X-8 Y5\nG43 H1 Z5\nG1 Z-2 F300\n\
    G41 D1 X48 F600\nG3 X58 Y15 I0 J10\nG40 G1 X-8\nG81 X1 Y1 Z-5 R2\nG80\n#1=[2*SIN[30]]\nWHILE [#1 GT 0] DO1\nG1 X#1\n\
    #1=[#1-0.5]\nEND1\nM98 P2 L2\nM30\nO2\nG91 G1 X1\nG90\nM99\n%\n";
const SIEMENS: &str = "N10 G71 G90 G17\nT=\"MILL\" D1 M6\nS5000 M3\nG0 X0 Y0 Z10\nR1=3\nWHILE R1>0\nG1 X=R1*2 Y=SIN(30) F500\n\
    R1=R1-1\nENDWHILE\nCYCLE83(10,0,2,-20,,,5,,,0.5,1,1)\nPOCKET3(10,0,2,-5,30,20,3,0,0,0,2,0.1,0.1,300,200,0,1)\nTRAORI\n\
    G1 X1 Y2 Z3 A3=0 B3=0.1 C3=1\nM30\n";
const HEIDENHAIN: &str = "BEGIN PGM PART MM\nBLK FORM 0.1 Z X+0 Y+0 Z-20\nBLK FORM 0.2 X+60 Y+40 Z+0\nTOOL CALL 1 Z S5000\n\
    L X-10 Y+5 Z+5 R0 FMAX M3\nL Z-2 F300\nAPPR LCT X+5 Y+5 R2 RL F500\nL X+50\nRND R3\nL Y+35\nCC X+25 Y+35\nC X+0 Y+35 DR+\n\
    DEP LCT X-10 Y+5 R2\nCYCL DEF 200 DRILLING Q200=2 Q201=-10 Q206=200 Q202=5 Q210=0 Q203=+0 Q204=20 Q211=0\nL X+10 Y+10 R0 FMAX M99\n\
    FN 1: Q1 = +2 + +3\nLBL 1\nL IX+1\nLBL 0\nCALL LBL 1 REP2\nEND PGM PART MM\n";
const APT: &str = "PARTNO/POCKET\nUNITS/MM\nCUTTER/10,2\nLOADTL/1\nSPINDL/5000,RPM,CLW\nRAPID\nGOTO/0,0,10\nFEDRAT/300,MMPM\nGOTO/0,0,-2\n\
    MULTAX/ON\nGOTO/10,0,-2,0.1,0,0.99\nCYCLE/DRILL,5,MMPM,200,2\nGOTO/20,0,0\nCYCLE/OFF\nFINI\n";
const TABLE: &str = "x,y,z,i,j,k\n0,0,0,0,0,1\n10,0,-1,0.1,0,0.99\n20,5,-2,0,0.2,0.98\n";
const LIBRARY: &str = r#"{"data": [{"type": "bull nose end mill", "unit": "millimeters",
    "geometry": {"DC": 6, "LCF": 20, "RE": 1, "OAL": 60, "SFDM": 6, "LB": 30}, "post-process": {"number": 3},
    "holder": {"segments": [{"height": 20, "lower-diameter": 30, "upper-diameter": 40}]}}], "version": 36}"#;
const MACHINE: &str = "Machine(name: \"trunnion\", table: [(letter: 'C', axis: (0, 0, 1), pivot: (0, 0, -50)),
    (letter: 'A', axis: (1, 0, 0), pivot: (0, 0, -50), limits: (-30, 120), speed: 7200)],
    linear: [(letter: 'X', limits: (-300, 300), speed: 30000)], rapid: DogLeg,
    bodies: [(name: \"table\", on: \"C\", shape: Cylinder(from: (0, 0, -80), to: (0, 0, -50), radius: 120))])";
pub(super) const READERS: [Reader; 17] = [
    Reader {
        name: "gcode",
        endings: &["nc", "ngc", "gcode", "tap"],
        own: || text(GCODE),
        read: |file| of_text(file, |text| said(nc::gcode::read(text, &options()))),
    },
    Reader {
        name: "siemens",
        endings: &["mpf", "spf"],
        own: || text(SIEMENS),
        read: |file| of_text(file, |text| said(nc::siemens::read(text, &options()))),
    },
    Reader {
        name: "heidenhain",
        endings: &["h"],
        own: || text(HEIDENHAIN),
        read: |file| of_text(file, |text| said(nc::heidenhain::read(text, &options()))),
    },
    Reader {
        name: "apt",
        endings: &["apt", "cls"],
        own: || text(APT),
        read: |file| of_text(file, |text| said(nc::apt::read(text, &options()))),
    },
    Reader {
        name: "table",
        endings: &["csv"],
        own: || text(TABLE),
        read: |file| of_text(file, |text| said(nc::table::read(text, 1.0))),
    },
    Reader {
        name: "tools",
        endings: &["json", "fctb", "fctl", "tbl", "camotics"],
        own: || text(LIBRARY),
        read: |file| {
            of_text(file, |text| {
                said(nc::tools::parse(text, Path::new("tools.json"), false))
            })
        },
    },
    Reader {
        name: "machine",
        endings: &[],
        own: || text(MACHINE),
        read: |file| of_text(file, |text| said(Machine::read(text))),
    },
    Reader {
        name: "job",
        endings: &[],
        own: || fs::read(bracket()).into_iter().collect(),
        read: |file| of_text(file, |text| said(Job::parse(text, &bracket()))),
    },
    Reader {
        name: "step",
        endings: &["step", "stp"],
        own: || made(step),
        read: |file| said(formats::parse_step(file, 0.1)),
    },
    Reader {
        name: "stl",
        endings: &["stl"],
        own: || made(|to| formats::write_stl(&block().triangles, to)),
        read: |file| said(formats::parse_stl(file)),
    },
    Reader {
        name: "ply",
        endings: &["ply"],
        own: || made(|to| formats::write_ply(&mesh(), to)),
        read: |file| said(formats::read_ply(file)),
    },
    Reader {
        name: "3mf",
        endings: &["3mf"],
        own: || made(|to| formats::write_3mf(&mesh(), to)),
        read: |file| said(formats::read_3mf(file)),
    },
    Reader {
        name: "vtp",
        endings: &["vtp"],
        own: || made(|to| formats::write_vtp(&mesh(), to)),
        read: |file| said(formats::read_vtp(file)),
    },
    Reader {
        name: "glb",
        endings: &["glb"],
        own: || made(|to| formats::write_glb(&mesh(), to)),
        read: |file| said(formats::read_glb(file)),
    },
    Reader {
        name: "dexels",
        endings: &[],
        own: || made(|to| formats::write_dexels_binary(&dexels(), to)),
        read: |mut file| said(formats::read_dexels_binary(&mut file)),
    },
    Reader {
        name: "npz",
        endings: &[],
        own: || made(|to| formats::write_dexels_npz(&dexels(), to)),
        read: |file| said(formats::read_dexels_npz(file)),
    },
    Reader {
        name: "csv-dexels",
        endings: &[],
        own: || made(|to| formats::write_dexels_csv(&dexels(), to)),
        read: |file| said(formats::read_dexels_csv(file)),
    },
];

fn text(file: &str) -> Vec<Vec<u8>> {
    vec![file.as_bytes().to_vec()]
}

fn made(write: impl Fn(&mut Vec<u8>) -> io::Result<()>) -> Vec<Vec<u8>> {
    let mut file = Vec::new();
    write(&mut file).map(|()| file).into_iter().collect()
}

/// A block with a ball cut out of one of its edges.
fn step(to: &mut Vec<u8>) -> io::Result<()> {
    let (low, high) = ([0.0; 3], [6.0, 4.0, 3.0]);
    let ball = Stock::Ball {
        centre: [3.0, 0.0, 3.0],
        radius: 1.75,
    };
    let part = Stock::Difference(Box::new(Stock::Block { min: low, max: high }), vec![ball]);
    let dexels = TriDexels::new([-0.5; 3], [6.5, 4.5, 3.5], [28, 20, 16], &part).map_err(io::Error::other)?;
    let (mesh, ends) = dexels.surface_with_ends().map_err(io::Error::other)?;
    let side = |origin: [f64; 3], axis: usize| {
        let mut normal = [0.0; 3];
        normal[axis] = 1.0;
        AnalyticSurface::Plane { origin, normal }
    };
    let sides = (0..3).flat_map(|axis| [side(low, axis), side(high, axis)]);
    let round = AnalyticSurface::Sphere {
        centre: [3.0, 0.0, 3.0],
        radius: 1.75,
    };
    let surfaces: Vec<Surface> = sides.chain([round]).map(Surface::Analytic).collect();
    let solid = Solid::new(
        &mesh,
        &ends,
        &|_: &SurfaceEnd| surfaces.clone(),
        SolidOptions::new(1e-6, 0.25),
    );
    let solid = solid.map_err(io::Error::other)?;
    let header = StepHeader {
        name: "block".into(),
        program: "xtask".into(),
        uncertainty: 1e-6,
    };
    write_step(&solid, &header, to)
}

fn block() -> TriangleSoup {
    TriangleSoup::block([0.0; 3], [3.0, 2.0, 1.0])
}

fn mesh() -> Mesh {
    block().indexed().unwrap_or_default()
}

fn dexels() -> Dexels {
    let grid = Grid::new([0.0; 2], [3.0, 2.0], [3, 2]).expect("a grid");
    let block = Stock::Block {
        min: [0.0; 3],
        max: [3.0, 2.0, 1.0],
    };
    block.dexels(&grid).expect("a block")
}

fn bracket() -> std::path::PathBuf {
    workspace::fixtures().join("verify").join("bracket.ron")
}

/// The error.
fn said<T, E: Display>(read: Result<T, E>) -> Option<String> {
    read.err().map(|error| error.to_string())
}

/// What does not show text is read as far as it can be, as files of programs are.
fn of_text(file: &[u8], read: impl Fn(&str) -> Option<String>) -> Option<String> {
    read(&String::from_utf8_lossy(file))
}

/// Bounded, as loops may have no end.
fn options() -> ReadOptions {
    let mut options = ReadOptions::default();
    (options.most_blocks, options.most_poses) = (100_000, 100_000);
    options
}
