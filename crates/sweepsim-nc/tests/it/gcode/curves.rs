//! Curves of `G5.2` and `G5.3`.

use sweepsim_nc::{Controller, Program, ReadOptions, gcode};

fn options(controller: Controller) -> ReadOptions {
    let mut options = ReadOptions::default();
    options.controller = Some(controller);
    options
}

fn read(text: &str, controller: Controller) -> Program {
    gcode::read(text, &options(controller)).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn message(text: &str, controller: Controller) -> String {
    gcode::read(text, &options(controller)).unwrap_err().to_string()
}

/// The blending functions of LinuxCNC's reference: knots 0 … 0, 1, 2, … n − k + 1, n − k + 2 … n − k + 2.
fn blending(i: usize, k: usize, u: f64, knot: &dyn Fn(usize) -> f64) -> f64 {
    if k == 1 {
        return if u >= knot(i) && u < knot(i + 1) { 1.0 } else { 0.0 };
    }
    let part = |top: f64, bottom: f64| if bottom == 0.0 { 0.0 } else { top / bottom };
    part(u - knot(i), knot(i + k - 1) - knot(i)) * blending(i, k - 1, u, knot)
        + part(knot(i + k) - u, knot(i + k) - knot(i + 1)) * blending(i + 1, k - 1, u, knot)
}

fn on_curve(points: &[([f64; 2], f64)], k: usize, u: f64) -> [f64; 2] {
    let n = points.len() - 1;
    let knot = |i: usize| {
        if i < k {
            0.0
        } else if i <= n {
            (i - k + 1) as f64
        } else {
            (n - k + 2) as f64
        }
    };
    let (mut x, mut y, mut w) = (0.0, 0.0, 0.0);
    for (i, (point, weight)) in points.iter().enumerate() {
        let b = weight * blending(i, k, u, &knot);
        (x, y, w) = (x + b * point[0], y + b * point[1], w + b);
    }
    [x / w, y / w]
}

/// Curves of orders 3 to 6 in all planes: their points are within the tolerance of the chords, and the ends of the chords on the curve.
#[test]
fn rational_splines() {
    for (order, plane, letters) in [(3, "G17", "XY"), (4, "G18", "ZX"), (5, "G19", "YZ"), (6, "G17", "XY")] {
        let points: Vec<([f64; 2], f64)> = (0..order + 3)
            .map(|i| {
                let t = i as f64;
                (
                    [7.0 * t + (3.0 * t).sin() * 4.0, 10.0 * (1.7 * t).cos()],
                    1.0 + 0.8 * (2.3 * t).sin(),
                )
            })
            .collect();
        let [a, b]: [char; 2] = letters.chars().collect::<Vec<_>>().try_into().unwrap();
        let ([x, y], weight) = points[0];
        let mut text = format!("{plane} F100\nG0 X0 Y0 Z0\n{a}{x} {b}{y}\nG5.2 P{weight} L{order}\n");
        for ([x, y], weight) in &points[1..] {
            text += &format!("{a}{x} {b}{y} P{weight}\n");
        }
        text += "G5.3\nG1 X0 Y0 Z0\n";
        let mut options = options(Controller::LinuxCnc);
        options.arc_tolerance = 1e-3;
        let program = gcode::read(&text, &options).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let (u, v) = ("XYZ".find(a).unwrap(), "XYZ".find(b).unwrap());
        let end = program.poses.len() - 1;
        let tips: Vec<[f64; 2]> = program.poses[1..end]
            .iter()
            .map(|pose| [pose.pose.tip()[u], pose.pose.tip()[v]])
            .collect();
        let near = |p: [f64; 2], [a, b]: [[f64; 2]; 2]| {
            let (d, e) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
            let s = ((d[0] * e[0] + d[1] * e[1]) / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
            (e[0] - s * d[0]).hypot(e[1] - s * d[1])
        };
        let spans = (points.len() - order + 1) as f64;
        let curve: Vec<[f64; 2]> = (0..20_000)
            .map(|k| on_curve(&points, order, spans * f64::from(k) / 20_000.0))
            .collect();
        for point in curve.iter().step_by(20) {
            let off = tips
                .windows(2)
                .map(|pair| near(*point, [pair[0], pair[1]]))
                .fold(f64::MAX, f64::min);
            assert!(off <= 1e-3 + 1e-9, "{off}\n{text}");
        }
        for tip in &tips[..tips.len() - 1] {
            let off = curve
                .windows(2)
                .map(|pair| near(*tip, [pair[0], pair[1]]))
                .fold(f64::MAX, f64::min);
            assert!(off < 1e-5, "{off}\n{text}");
        }
        assert_eq!(*tips.last().unwrap(), points.last().unwrap().0);
        assert!(tips.len() > 20);
    }
}

/// A quarter of a circle is a quadratic curve with the weight √½ in its middle.
#[test]
fn a_circle_as_a_spline() {
    let text = format!(
        "G20 F10\nG0 X1 Y0 Z0\nG5.2\nX1 Y1 P{}\nX0 Y1 P1\nG5.3\n",
        0.5_f64.sqrt()
    );
    let program = read(&text, Controller::LinuxCnc);
    for pose in &program.poses {
        let [x, y, _] = pose.pose.tip();
        assert!((x.hypot(y) - 25.4).abs() < 1e-12);
    }
    // Within 1 µm: a chord over an angle a leaves r a²/8.
    assert!((80..260).contains(&program.poses.len()), "{}", program.poses.len());
    let note = "splines are divided into chords within the tolerance of arcs";
    assert!(program.notes.iter().any(|found| found.message == note));
}

#[test]
fn bad_splines() {
    for (text, expected) in [
        (
            "G0 X0 Y0 Z0\nF9\nG5.3",
            "3:1: G5.3 without a curve: expected G5.2 before it",
        ),
        (
            "G0 X0 Y0 Z0\nF9\nG5.2 P1 L4\nX1 Y1 P1\nG5.3",
            "5:1: the number of control points of this curve is 2, but must be at least its order, 4",
        ),
        (
            "G0 X0 Y0 Z0\nF9\nG5.2 P1\nX1 Y1 P1\nG1 X3",
            "5:1: the curve of G5.2 has no end: expected G5.3",
        ),
        (
            "G0 X0 Y0 Z0\nF9\nG5.2 P1\nX1 Y1 P1",
            "4:1: the curve of G5.2 has no end: expected G5.3",
        ),
        (
            "G0 X0 Y0 Z0\nF9\nG5.2 P1\nX1 P1",
            "4:1: a control point without X, Y or P: expected all of them",
        ),
        (
            "G0 X0 Y0 Z0\nF9\nG5.2 P1\nX1 Y1 P-1",
            "4:1: the weight P of a control point is -1, but must be a positive number",
        ),
        (
            "G0 X0 Y0 Z0\nF9\nG5.2 P1\nX1 Y1 Z1 P1",
            "4:1: Z in a curve of G5.2 is not supported yet: expected X and Y, P and L",
        ),
    ] {
        assert_eq!(message(text, Controller::LinuxCnc), expected);
    }
}

/// A feed in inverse time is that of the block of a curve, and of a whole spline.
#[test]
fn chords_of_curves_share_the_time_of_their_block() {
    let text = "G21 G90\nT1 M6\nG0 X0 Y0 Z0\nG93 G5 X10 Y0 I3 J4 P-3 Q4 F2\nG5.1 X20 Y0 I5 J5 F4\nG5.2 X25 Y5 P1 L3 F1\nX30 Y0 P1\nG5.3\nG1 X40 F3\n";
    let program = read(text, Controller::LinuxCnc);
    let times = program.times();
    for (line, expected) in [(4, 30.0), (5, 15.0), (8, 60.0), (9, 20.0)] {
        let all = || program.poses.iter().zip(&times).filter(|(pose, _)| pose.line == line);
        let seconds: f64 = all().filter_map(|(_, time)| time.seconds).sum();
        assert!((seconds - expected).abs() < 1e-9, "line {line}: {seconds}");
        assert!(line == 9 || all().count() > 2);
    }
}
