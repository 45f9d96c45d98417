//! STEP files that cannot be read, or not as a whole.

use super::writer::Writer;
use super::{CHORD, assembly, block};
use sweepsim_formats::parse_step;

fn refused(text: &str) -> String {
    match parse_step(text.as_bytes(), CHORD) {
        Ok(part) => panic!("read as {:?}: {text}", part.bodies),
        Err(error) => error.to_string(),
    }
}

fn cube() -> String {
    block([0.0; 3], [10.0; 3])
}

/// Replaces the first entity of a kind by another text.
fn with(text: &str, kind: &str, other: &str) -> String {
    let at = text.find(&format!("={kind}(")).unwrap() + 1;
    let end = at + text[at..].find(';').unwrap();
    format!("{}{other}{}", &text[..at], &text[end..])
}

#[test]
fn faults_are_named_with_their_line() {
    let cube = cube();
    let unit = "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))";
    let short = cube.find("MANIFOLD").unwrap();
    let twice = cube.replace("ENDSEC;\nEND-", "#1=CARTESIAN_POINT('',(0.,0.,0.));\nENDSEC;\nEND-");
    let cases: Vec<(String, &str)> = vec![
        (String::new(), "1:1: this is no STEP file"),
        ("solid cube\nendsolid\n".into(), "1:1: this statement has no end"),
        ("PK\u{3}\u{4}".into(), "1:1: this STEP file is compressed"),
        (cube[..short].into(), "this statement has no end: expected a semicolon"),
        (
            cube[..short - 4].trim_end_matches(|c| c != ';').into(),
            "this STEP file ends before END-ISO-10303-21;",
        ),
        (twice, "#1 is there twice"),
        (
            cube.replace("ENDSEC;\nEND-", "ENDSEC;\nDATA;\nENDSEC;\nEND-"),
            "a second DATA section is not read",
        ),
        (
            format!("ISO-10303-21;\nDATA;\n#1=A({}1{});\n", "(".repeat(200), ")".repeat(200)),
            "more than 100 lists in one another",
        ),
        (cube.replace("'block'", "'block"), "expected"),
        (
            cube.replace(unit, "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.HECTO.,.METRE.))"),
            "8:1: #1 is no unit of length that is known",
        ),
        (
            cube.replace(unit, "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.SECOND.))"),
            "8:1: #1 is no unit of length that is known",
        ),
        (
            cube.replace("((#1,#2))", "((#2))"),
            "10:1: this context has no unit of length",
        ),
        (
            with(
                &cube,
                "(GEOMETRIC_REPRESENTATION_CONTEXT",
                "REPRESENTATION_CONTEXT('','')",
            ),
            "no unit of length is in this file",
        ),
        (
            with(&cube, "MANIFOLD_SOLID_BREP", "CSG_SOLID('',#1)"),
            "is a CSG_SOLID, which is not read",
        ),
        (
            with(&cube, "MANIFOLD_SOLID_BREP", "SHAPE_ASPECT()"),
            "no solid and no surface is in this STEP file (AUTOMOTIVE_DESIGN)",
        ),
        (
            with(&cube, "MANIFOLD_SOLID_BREP", "MANIFOLD_SOLID_BREP('')"),
            "the reader of STEP files failed at this one",
        ),
        (
            with(&cube, "PLANE", "PLANE('',#9999)"),
            "refers to #9999, which is not in this file",
        ),
        (
            with(&cube, "PLANE", "FREE_FORM('',#1)"),
            "surfaces of type FREE_FORM are not read yet",
        ),
        (with(&cube, "DIRECTION", "DIRECTION('',(0.,0.,0.))"), "a zero direction"),
        (
            with(&cube, "VERTEX_POINT", "VERTEX_POINT('',$)"),
            "expected a reference",
        ),
        (cube.replace("10.0", "1e999"), ""),
        (
            super::plate(false).text().replace(",5.0)", ",-5.0)"),
            "is a CIRCLE of radius -5: expected more than 0",
        ),
        (
            with(
                &super::plate(false).text(),
                "CYLINDRICAL_SURFACE",
                "CYLINDRICAL_SURFACE('',#1,0.)",
            ),
            "is a CYLINDRICAL_SURFACE of radius 0: expected more than 0",
        ),
    ];
    for (text, expected) in &cases {
        let message = refused(text);
        assert!(message.contains(expected), "expected {expected}, found {message}");
    }
}

/// A block of 10 mm whose top is a B-spline surface: level, at a height, with the middle of its parameters at `x`.
fn capped(height: f64, x: f64) -> String {
    let mut file = Writer::new(false);
    let faces = file.block_faces([0.0; 3], [10.0; 3]);
    let rows = [0.0, x, 10.0].map(|x| [0.0, 10.0].map(|y| file.point([x, y, height])));
    let rows = rows.map(|[near, far]| format!("(#{near},#{far})")).join(",");
    let sheet = format!(
        "B_SPLINE_SURFACE_WITH_KNOTS('',2,1,({rows}),.UNSPECIFIED.,.F.,.F.,.F.,(3,3),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED.)"
    );
    let solid = file.solid("block", &faces);
    file.product("part", &[solid]);
    let text = file.text();
    let top = text.rfind("=PLANE(").unwrap();
    format!("{}{}", &text[..top], with(&text[top..], "PLANE", &sheet))
}

/// Edges that are not in the surfaces that they bound: said with their distance, as no triangles are nearer.
#[test]
fn edges_beside_their_surfaces_are_told() {
    let text = capped(10.001, 5.0);
    let part = parse_step(text.as_bytes(), 2e-4).unwrap();
    assert!((0.00095..0.00105).contains(&part.deviation), "{}", part.deviation);
    let notes = part.notes.join("\n");
    assert!(
        notes.contains("where 2.00e-4 mm was asked: edges of the file are up to 1.00e-3 mm from the surfaces"),
        "{notes}"
    );
    // Many times as far as asked.
    let message = parse_step(text.as_bytes(), 4e-5).unwrap_err().to_string();
    assert!(
        message.contains("edges of the file are up to 1.00e-3 mm") && message.contains("expected at most 20 times"),
        "{message}"
    );
    // As near as asked: nothing is said.
    assert!(parse_step(text.as_bytes(), 0.002).unwrap().notes.is_empty());
}

/// Parameters that are uneven say nothing of distances: a flat top is flat.
#[test]
fn distances_are_those_of_places() {
    let part = parse_step(capped(10.0, 1.0).as_bytes(), 1e-3).unwrap();
    assert!(
        part.deviation < 1e-9 && part.notes.is_empty(),
        "{} {:?}",
        part.deviation,
        part.notes
    );
    assert!((part.mesh.soup().unwrap().volume() - 1000.0).abs() < 1e-6);
}

/// A solid without one of its faces, with one twice, or with all turned inwards is no solid.
#[test]
fn solids_that_do_not_close_are_refused() {
    for missing in 0..6 {
        let mut file = Writer::new(false);
        let mut faces = file.block_faces([0.0; 3], [10.0; 3]);
        faces.remove(missing);
        let solid = file.solid("open", &faces);
        file.product("", &[solid]);
        let message = refused(&file.text());
        let told = format!("solid #{solid} is open: its edge #");
        assert!(
            message.contains(&told) && message.ends_with("bounds one face, expected two"),
            "{missing}: {message}"
        );
    }
    let inwards = cube().replace(",.T.);", ",.F.);");
    let message = refused(&inwards);
    assert!(
        message.contains("inside out") || message.contains("not closed") || message.contains("enclose"),
        "{message}"
    );
}

/// Units that differ within a file, or whose factor is not that of their name.
#[test]
fn units_that_disagree_are_refused() {
    let inches = assembly().text();
    let wrong = inches.replace("LENGTH_MEASURE(25.4)", "LENGTH_MEASURE(1.)");
    let message = refused(&wrong);
    assert!(
        message.contains("is called INCH, but its factor is 1: expected 25.4"),
        "{message}"
    );
    let other = "#900=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.CENTI.,.METRE.));\n\
        #901=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#900))REPRESENTATION_CONTEXT('',''));\nENDSEC;\nEND-";
    let message = refused(&inches.replace("ENDSEC;\nEND-", other));
    assert!(
        message.contains("the unit of length differs from that of #"),
        "{message}"
    );
    // Colours say nothing of lengths, but what is placed by a context does.
    let styled = |kind: &str| {
        let user = format!("#902={kind}('',(),#901);\nENDSEC;\nEND-");
        inches.replace("ENDSEC;\nEND-", &other.replace("ENDSEC;\nEND-", &user))
    };
    let part = parse_step(
        styled("MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION").as_bytes(),
        CHORD,
    );
    let expected = parse_step(inches.as_bytes(), CHORD).unwrap();
    assert_eq!(part.unwrap().mesh, expected.mesh);
    let message = refused(&styled("SHAPE_REPRESENTATION"));
    assert!(
        message.contains("the unit of length differs from that of #"),
        "{message}"
    );
}

#[test]
fn assemblies_that_are_not_placed_are_refused() {
    let text = assembly().text();
    let unplaced = with(&text, "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION", "SHAPE_ASPECT()");
    let message = refused(&unplaced);
    assert!(message.contains("places a product, but not where"), "{message}");
    // An assembly that contains itself.
    let mut file = Writer::new(false);
    let faces = file.block_faces([0.0; 3], [1.0; 3]);
    let solid = file.solid("", &faces);
    let (one, other) = (file.product("one", &[solid]), file.product("other", &[]));
    let place = file.placement([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
    file.occurrence(one, other, place);
    file.occurrence(other, one, place);
    assert!(refused(&file.text()).contains("one that contains itself"));
    // Twice the one below it, forty times: 2⁴⁰ bricks.
    let mut file = Writer::new(false);
    let faces = file.block_faces([0.0; 3], [1.0; 3]);
    let solid = file.solid("", &faces);
    let mut below = file.product("0", &[solid]);
    for level in 1..=40 {
        let next = file.product(&level.to_string(), &[]);
        let place = file.placement([0.0; 3], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]);
        file.occurrence(below, next, place);
        file.occurrence(below, next, place);
        below = next;
    }
    assert!(refused(&file.text()).contains("more than 100000 placed products"));
}

/// Entities that are built on themselves, which would be followed without end, and very many on one another.
#[test]
fn circles_and_towers_are_refused() {
    let cube = cube();
    let circle = with(&cube, "PLANE", "OFFSET_SURFACE('',#900,1.,.F.)").replace(
        "ENDSEC;\nEND-",
        "#900=OFFSET_SURFACE('',#901,1.,.F.);\n#901=OFFSET_SURFACE('',#900,1.,.F.);\nENDSEC;\nEND-",
    );
    assert!(refused(&circle).contains("is built on itself"));
    let shell = with(&cube, "CLOSED_SHELL", "ORIENTED_CLOSED_SHELL('',*,#900,.T.)").replace(
        "ENDSEC;\nEND-",
        "#900=ORIENTED_CLOSED_SHELL('',*,#900,.T.);\nENDSEC;\nEND-",
    );
    assert!(refused(&shell).contains("is built on itself"));
    let mut tower = String::new();
    for level in 900..100_900 {
        tower += &format!("#{level}=OFFSET_SURFACE('',#{},1.,.F.);\n", level + 1);
    }
    let tower = with(&cube, "PLANE", "OFFSET_SURFACE('',#900,1.,.F.)")
        .replace("ENDSEC;\nEND-", &format!("{tower}ENDSEC;\nEND-"));
    assert!(refused(&tower).contains("one on the other"));
}

/// A sheet encloses nothing: it is read, and said to be one; beside a solid it is left out, which is said as well.
#[test]
fn sheets_are_never_solids() {
    let mut file = Writer::new(false);
    let faces = file.block_faces([0.0; 3], [10.0; 3]);
    let shell = file.shell(false, &faces[..5]);
    let sheet = file.add(&format!("SHELL_BASED_SURFACE_MODEL('skin',(#{shell}))"));
    let alone = file.product("skin", &[sheet]);
    let part = parse_step(file.text().as_bytes(), CHORD).unwrap();
    assert_eq!(
        (part.bodies.len(), part.bodies[0].solid, part.bodies[0].volume),
        (1, false, None)
    );
    assert!(part.mesh.soup().unwrap().check_closed().is_err());
    assert_eq!(part.notes, ["no solid: the faces are sheets, which enclose nothing"]);
    let _ = alone;
    let faces = file.block_faces([20.0; 3], [30.0; 3]);
    let solid = file.solid("block", &faces);
    file.product("block", &[solid]);
    let part = parse_step(file.text().as_bytes(), CHORD).unwrap();
    assert_eq!(part.mesh.triangles.len(), 12);
    part.mesh.soup().unwrap().check_closed().unwrap();
    assert_eq!(part.notes, ["left out: a sheet of 5 faces, as it encloses nothing"]);
}

/// A tessellated solid is another form of a part, or all that there is of one: then the file is not read as if it were
/// whole.
#[test]
fn tessellated_solids_are_left_out_beside_others() {
    let cube = cube();
    let representation = cube.find("=SHAPE_REPRESENTATION(").unwrap();
    let number = cube[..representation].rsplit('#').next().unwrap();
    let with_solid = |more: &str| {
        let own = "#900=TESSELLATED_SOLID('',(),$);\n#901=TESSELLATED_SHAPE_REPRESENTATION('',(#900),#3);\n";
        cube.replace("ENDSEC;\nEND-", &format!("{own}{more}\nENDSEC;\nEND-"))
    };
    let told = "left out: a tessellated solid, as its part has a boundary representation";
    let linked = format!("#902=SHAPE_REPRESENTATION_RELATIONSHIP('','',#{number},#901);");
    let part = parse_step(with_solid(&linked).as_bytes(), CHORD).unwrap();
    assert_eq!(
        (part.mesh.triangles.len(), &part.notes[..]),
        (12, &[told.to_owned()][..])
    );
    let moved = format!(
        "#902=(REPRESENTATION_RELATIONSHIP('','',#{number},#901)REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#3)SHAPE_REPRESENTATION_RELATIONSHIP());"
    );
    for alone in ["", &moved] {
        let message = refused(&with_solid(alone));
        assert!(
            message.contains("#900 is a TESSELLATED_SOLID") || message.contains("#902 moves a shape"),
            "{message}"
        );
    }
}

/// Random bytes changed, and the text cut anywhere: an error or a part that closes, never a panic.
#[test]
fn damaged_files_are_refused_or_close() {
    let text = super::plate(true).text();
    let bytes = text.as_bytes();
    let mut seed = 1_u64;
    let mut random = |below: usize| {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % below
    };
    let (mut read, mut failed) = (0, 0);
    for case in 0..400 {
        let mut damaged = bytes.to_vec();
        if case % 8 == 0 {
            damaged.truncate(random(bytes.len()));
        }
        for _ in 0..=random(2) {
            let at = random(damaged.len().max(1));
            let letters = b"0123456789#(),.;'$*ABCTF\n";
            if let Some(byte) = damaged.get_mut(at) {
                *byte = letters[random(letters.len())];
            }
        }
        match parse_step(&damaged, 0.1) {
            Ok(part) => {
                part.mesh.soup().unwrap().check_closed().unwrap();
                read += 1;
            }
            Err(error) => {
                assert!(!error.to_string().is_empty());
                failed += 1;
            }
        }
    }
    assert!(read > 20 && failed > 100, "{read} read, {failed} refused");
}
