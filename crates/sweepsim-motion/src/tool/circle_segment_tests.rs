use super::{Barrel, Lens, Oval, Taper, Tool};
use crate::profile::{ProfileError, ProfileSegment};

fn segments(tool: &Tool) -> Vec<ProfileSegment> {
    tool.profile().expect("a solid of revolution").segments().to_vec()
}

/// Directions on either side of every joint below the top, as unit vectors, from the definition of the segments alone.
fn joints(tool: &Tool) -> Vec<[[f64; 2]; 2]> {
    let unit = |v: [f64; 2]| v.map(|c| c / v[0].hypot(v[1]));
    let mut from = tool.profile().expect("a solid of revolution").start();
    let mut ends = Vec::new();
    for segment in segments(tool) {
        let (to, directions) = match segment {
            ProfileSegment::Line { to } => (to, [unit([to[0] - from[0], to[1] - from[1]]); 2]),
            ProfileSegment::Arc { to, centre, .. } => {
                let around = |p: [f64; 2]| unit([centre[1] - p[1], p[0] - centre[0]]);
                (to, [around(from), around(to)])
            }
            ProfileSegment::Spline { .. } => unreachable!("no circle-segment cutter has splines"),
        };
        ends.push(directions);
        from = to;
    }
    ends.windows(2).map(|pair| [pair[0][1], pair[1][0]]).collect()
}

fn angle([a, b]: [[f64; 2]; 2]) -> f64 {
    (a[0] * b[1] - a[1] * b[0])
        .atan2(a[0] * b[0] + a[1] * b[1])
        .to_degrees()
}

#[test]
fn everything_that_is_to_be_tangent_is() {
    let sizes = [(4.0, 1.0, 85.0), (8.0, 2.0, 1500.0), (3.0, 0.2, 3.5)];
    for (radius, tip, flank) in sizes {
        let oval = Tool::oval(Oval {
            radius,
            tip,
            flank,
            length: 200.0,
        })
        .expect("a cutter");
        let turns: Vec<f64> = joints(&oval).into_iter().map(angle).collect();
        assert!(turns[..2].iter().all(|turn| turn.abs() < 1e-10), "{turns:?}");
        // No sharp edge but the rim of the top: as a ball end has.
        let ball = Tool::ball(radius, 200.0).expect("a cutter");
        assert_eq!(oval.edges().len(), ball.edges().len(), "{radius} {tip} {flank}");
        let taper = Tool::taper(Taper {
            radius,
            tip,
            flank,
            angle: 12.0,
            length: 200.0,
        })
        .expect("a cutter");
        let turns: Vec<f64> = joints(&taper).into_iter().map(angle).collect();
        assert!(turns[0].abs() < 1e-10 && (turns[1] - 12.0).abs() < 1e-10, "{turns:?}");
        let lens = Tool::lens(Lens {
            radius,
            bottom: 2.0 * flank,
            corner: tip,
            length: 200.0,
        })
        .expect("a cutter");
        let turns: Vec<f64> = joints(&lens).into_iter().map(angle).collect();
        assert!(turns[..2].iter().all(|turn| turn.abs() < 1e-10), "{turns:?}");
        let barrel = Tool::barrel(Barrel {
            radius,
            flank: 2.0 * flank,
            height: 3.0 * tip,
            corner: tip,
            length: 200.0,
        })
        .expect("a cutter");
        let turns: Vec<f64> = joints(&barrel).into_iter().map(angle).collect();
        assert!(turns[..2].iter().all(|turn| turn.abs() < 1e-10), "{turns:?}");
    }
}

#[test]
fn measures_are_those_that_were_asked_for() {
    let ends = |tool: &Tool| -> Vec<[f64; 2]> {
        let end = |segment: &ProfileSegment| match *segment {
            ProfileSegment::Line { to } | ProfileSegment::Arc { to, .. } => to,
            ProfileSegment::Spline { .. } => [f64::NAN; 2],
        };
        segments(tool).iter().map(end).collect()
    };
    // A right-angled triangle with sides 3, 4, 5: flank − tip = 5, flank − radius = 4.
    let oval = Tool::oval(Oval {
        radius: 2.0,
        tip: 1.0,
        flank: 6.0,
        length: 20.0,
    })
    .expect("a cutter");
    let [touch, top, ..] = ends(&oval)[..] else {
        panic!("{oval:?}")
    };
    assert!(
        (touch[0] - 0.8).abs() < 1e-14 && (touch[1] - 0.4).abs() < 1e-14,
        "{touch:?}"
    );
    assert_eq!(top, [2.0, 4.0]);
    // The same triangle: bottom − corner = 5, radius − corner = 3.
    let lens = Tool::lens(Lens {
        radius: 4.0,
        bottom: 6.0,
        corner: 1.0,
        length: 20.0,
    })
    .expect("a cutter");
    let [touch, rim, ..] = ends(&lens)[..] else {
        panic!("{lens:?}")
    };
    assert!(
        (touch[0] - 3.6).abs() < 1e-14 && (touch[1] - 1.2).abs() < 1e-14,
        "{touch:?}"
    );
    assert_eq!(rim, [4.0, 2.0]);
    // A barrel's widest point is in the middle of its height.
    let barrel = Tool::barrel(Barrel {
        radius: 5.0,
        flank: 40.0,
        height: 20.0,
        corner: 1.0,
        length: 50.0,
    })
    .expect("a cutter");
    let plain = Tool::barrel(Barrel {
        radius: 5.0,
        flank: 40.0,
        height: 20.0,
        corner: 0.0,
        length: 50.0,
    })
    .expect("a cutter");
    assert_eq!(ends(&barrel)[2], ends(&plain)[1]);
}

#[test]
fn what_fits_no_cutter_is_named() {
    let blame = |made: Result<Tool, ProfileError>| match made {
        Err(ProfileError::Measure { what, .. }) => what,
        other => panic!("{other:?}"),
    };
    assert_eq!(
        blame(Tool::oval(Oval {
            radius: 2.0,
            tip: 2.0,
            flank: 6.0,
            length: 20.0
        })),
        "tip"
    );
    assert_eq!(
        blame(Tool::oval(Oval {
            radius: 2.0,
            tip: 1.0,
            flank: 2.0,
            length: 20.0
        })),
        "flank"
    );
    assert_eq!(
        blame(Tool::oval(Oval {
            radius: 2.0,
            tip: 1.0,
            flank: 6.0,
            length: 4.0
        })),
        "length"
    );
    assert_eq!(
        blame(Tool::oval(Oval {
            radius: f64::NAN,
            tip: 1.0,
            flank: 6.0,
            length: 4.0
        })),
        "radius"
    );
    assert_eq!(
        blame(Tool::oval(Oval {
            radius: 2.0,
            tip: 1.0,
            flank: f64::INFINITY,
            length: 4.0
        })),
        "flank"
    );
    assert_eq!(
        blame(Tool::taper(Taper {
            radius: 2.0,
            tip: 1.0,
            flank: 6.0,
            angle: 90.0,
            length: 20.0
        })),
        "angle"
    );
    assert_eq!(
        blame(Tool::taper(Taper {
            radius: 2.0,
            tip: 1.0,
            flank: 6.0,
            angle: 75.0,
            length: 20.0
        })),
        "flank"
    );
    assert_eq!(
        blame(Tool::barrel(Barrel {
            radius: 5.0,
            flank: 40.0,
            height: 20.0,
            corner: 10.0,
            length: 50.0
        })),
        "corner"
    );
    assert_eq!(
        blame(Tool::barrel(Barrel {
            radius: 5.0,
            flank: 9.0,
            height: 20.0,
            corner: 1.0,
            length: 50.0
        })),
        "flank"
    );
    assert_eq!(
        blame(Tool::lens(Lens {
            radius: 4.0,
            bottom: 6.0,
            corner: 4.0,
            length: 20.0
        })),
        "corner"
    );
    assert_eq!(
        blame(Tool::lens(Lens {
            radius: 4.0,
            bottom: 6.0,
            corner: 1.0,
            length: 2.0
        })),
        "length"
    );
}
