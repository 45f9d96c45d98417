//! Jobs whose motion of B-splines has one fault.

use crate::support::check;

#[test]
fn one_message_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let poses = "poses: [((0, 0, 9), (0, 0, 1)), ((9, 9, 3), (1, 0, 1))]";
    file(
        "bad-motion.ron",
        "Motion(\n    tip: Curve(degree: 2, points: [(0, 0, 0), (1, 0, 0)]),\n)\n",
    );
    let motion = |from: &str, to: &str| {
        let good = "motion: Motion(tip: Curve(degree: 2, points: [(0, 0, 5), (1, 1, 5), (2, 0, 5)]), \
                    orientation: Quaternions(degree: 1, points: [(1, 0, 0, 0), (1, 0, 0, 0.1)]))";
        assert!(good.contains(from), "{from}");
        good.replacen(from, to, 1)
    };
    let cases: Vec<(&str, String, &str)> = vec![
        (
            poses,
            motion("degree: 2", "degree: 3"),
            "job.ron:10:68: the number of points of the tip is 3",
        ),
        (poses, motion("(2, 0, 5)", "(2, 0)"), "job.ron:10:"),
        (
            poses,
            motion("(2, 0, 5)", "(2, 0, NaN)"),
            "job.ron:10:91: point 2 of the tip has a number that is not finite",
        ),
        (
            poses,
            motion("(2, 0, 5)]", "(2, 0, 5)], weights: [1, -1, 1]"),
            "job.ron:10:112: the tip: ",
        ),
        (
            poses,
            motion("(2, 0, 5)]", "(2, 0, 5)], weights: [1, 1]"),
            "job.ron:10:112: the number of weights of the tip is 2",
        ),
        (
            poses,
            motion("(2, 0, 5)]", "(2, 0, 5)], knots: [0, 0, 1, 1]"),
            "job.ron:10:110: the number of knots of the tip is 4, but must be 6",
        ),
        (
            poses,
            motion("(2, 0, 5)]", "(2, 0, 5)], knots: [0, 0, 0, 1, 0, 1]"),
            "job.ron:10:110: the knots of the tip: ",
        ),
        (
            poses,
            motion("(1, 0, 0, 0.1)]", "(-1, 0, 0, 0)]"),
            "job.ron:10:148: the quaternion vanishes",
        ),
        (
            poses,
            motion("(1, 0, 0, 0.1)]", "(-1, 0, 0, 0)], knots: [0, 0, 2, 2]"),
            "job.ron:10:148: the quaternion vanishes",
        ),
        (
            poses,
            motion(
                "Quaternions(degree: 1, points: [(1, 0, 0, 0), (1, 0, 0, 0.1)])",
                "Matrices(degree: 0, points: [((1, 0, 0), (0, 1, 0), (0, 0.1, 1))])",
            ),
            "job.ron:10:145: the orientation is not a rotation",
        ),
        (
            poses,
            motion(
                "Quaternions(degree: 1, points: [(1, 0, 0, 0), (1, 0, 0, 0.1)])",
                "Matrices(degree: 0, points: [((1, 0, 0), (0, 1, 0), (0, 0, -1))])",
            ),
            "job.ron:10:145: the orientation is a reflection",
        ),
        (
            poses,
            motion(
                "Quaternions(degree: 1, points: [(1, 0, 0, 0), (1, 0, 0, 0.1)])",
                "Matrices(degree: 0, points: [((1, 0, 0), (0, 1, 0), (0, 0, 1))], tolerance: 1)",
            ),
            "job.ron:10:193: the tolerance must be positive and at most 1e-6, but is 1",
        ),
        (
            poses,
            motion("(2, 0, 5)]", "(2, 0, 5)], knots: [0, 0, 0, 1, 1, 1]")
                .replace("0.1)]", "0.1)], knots: [0, 0, 2, 2]"),
            "job.ron:10:214: the orientation runs over [0, 2] and the tip over [0, 1]",
        ),
        (
            poses,
            format!("{poses}, {}", motion("", "")),
            "job.ron:10:88: `motion` with `poses`",
        ),
        (
            poses,
            "file: \"bad-motion.ron\"".into(),
            "bad-motion.ron:2:35: the number of points of the tip is 2",
        ),
        (
            poses,
            "law: ConstantSpeed, file: \"bad-motion.ron\"".into(),
            "job.ron:10:28: `law` with the file of a motion",
        ),
    ];
    check(&cases, folder.path());
}
