//! The same hole on all controls.

use sweepsim_nc::{Program, ReadOptions, apt, gcode, heidenhain, siemens};

/// The depths of all feed moves, and how many rapids reach the surface.
fn depths(program: &Program) -> (Vec<f64>, usize) {
    let feeds = program.poses.iter().filter(|pose| !pose.rapid);
    assert!(
        feeds
            .clone()
            .all(|pose| pose.feed == Some(100.0) && pose.pose.tip()[..2] == [5.0, 6.0])
    );
    let surface = program
        .poses
        .iter()
        .filter(|pose| pose.rapid && pose.pose.tip()[2] == 0.0);
    (feeds.map(|pose| pose.pose.tip()[2]).collect(), surface.count())
}

#[test]
fn pecks_are_the_same_on_all_controls() {
    let options = ReadOptions::default();
    for (peck, expected) in [(3, vec![-3.0, -6.0, -8.0]), (4, vec![-4.0, -8.0]), (9, vec![-8.0])] {
        let texts = [
            format!("F100\nG0 X5 Y6 Z10\nG98 G83 X5 Y6 Z-8 R0 Q{peck}\nG80\n"),
            format!("F100\nG0 X5 Y6 Z10\nCYCLE83(10,0,0,-8,,-{peck},,0,0,,,1)\n"),
            format!(
                "TOOL CALL 1 Z S9\nL X+5 Y+6 Z+10 R0 FMAX\n\
                 CYCL DEF 200 Q200=0 Q201=-8 Q206=100 Q202={peck} Q203=0 Q204=10\nCYCL CALL\n"
            ),
            format!("RAPID\nGOTO/5,6,10\nCYCLE/DEEP,DEPTH,8,STEP,{peck},MMPM,100,CLEAR,0,RTRCTO,10\nGOTO/5,6,0\n"),
        ];
        let programs = [
            gcode::read(&texts[0], &options),
            siemens::read(&texts[1], &options),
            heidenhain::read(&texts[2], &options),
            apt::read(&texts[3], &options),
        ];
        for (program, text) in programs.into_iter().zip(&texts) {
            let program = program.unwrap_or_else(|error| panic!("{error}\n{text}"));
            let (found, returns) = depths(&program);
            assert_eq!(found, expected, "{text}");
            // To the surface first, and between pecks; Heidenhain also goes on from there to where it ends.
            let further = usize::from(text.starts_with("TOOL"));
            assert_eq!(returns, expected.len() + further, "{text}");
            assert_eq!(
                program.poses.last().map(|pose| pose.pose.tip()[2]),
                Some(10.0),
                "{text}"
            );
        }
    }
}

#[test]
fn boring_has_feeds_of_its_own() {
    let text = "G0 X0 Y0 Z10 F100\nCYCLE85(10,0,2,-5,,0,150,300)\nG1 X9";
    let program = siemens::read(text, &ReadOptions::default()).unwrap();
    let feeds: Vec<_> = program.poses.iter().filter_map(|pose| pose.feed).collect();
    // Down, up, and the feed of the program again.
    assert_eq!(feeds, [150.0, 300.0, 100.0]);
}

#[test]
fn infeeds_decrease_to_the_least() {
    let cycle = "CYCL DEF 203 Q200=2 Q201=-20 Q206=150 Q202=7 Q203=0 Q204=40 Q212=2 Q205=3 Q208=500";
    let text = format!("TOOL CALL 1 Z S9\nL X+5 Y+6 Z+50 R0 FMAX\n{cycle}\nCYCL CALL\n");
    let program = heidenhain::read(&text, &ReadOptions::default()).unwrap();
    let feeds = program.poses.iter().filter(|pose| !pose.rapid);
    let found: Vec<_> = feeds.map(|pose| (pose.pose.tip()[2], pose.feed)).collect();
    let expected = [-7.0, -12.0, -15.0, -18.0, -20.0].map(|depth| (depth, Some(150.0)));
    // Q208 is the feed out of the hole.
    assert_eq!(found, [&expected[..], &[(2.0, Some(500.0))]].concat());
}
