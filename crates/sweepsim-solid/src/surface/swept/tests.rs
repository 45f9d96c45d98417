use super::*;

fn motion(t: f64) -> ([f64; 3], [f64; 3]) {
    let (s, c) = (0.1 + 0.5 * t).sin_cos();
    let (p, q) = (0.4 * t).sin_cos();
    (
        [20.0 * t - 3.0, 5.0 * t + 2.0 * t * t, 4.0 - 3.0 * t],
        [s * q, s * p, c],
    )
}

/// The least distance from a piece over all times, by brute force.
fn brute(p: Vector3<f64>, far: impl Fn(f64, f64) -> f64) -> f64 {
    let at = |t: f64| {
        let (tip, axis) = motion(t);
        let off = p - Vector3::from(tip);
        let h = off.dot(&Vector3::from(axis));
        far((off.norm_squared() - h * h).sqrt(), h)
    };
    let (mut best, mut step) = (0.5, 1.0);
    for _ in 0..12 {
        let from = best;
        for k in -20..=20 {
            let t = (from + step * f64::from(k) / 40.0).clamp(-ROOM, 1.0 + ROOM);
            if at(t).abs() < at(best).abs() {
                best = t;
            }
        }
        step *= 0.3;
    }
    at(best)
}

/// How many points beside the sheets of pieces are as far from them as from all places of the pieces.
fn tried(pieces: &[SweptPiece], far: &dyn Fn(f64, f64) -> f64, us: [f64; 2]) -> usize {
    let mut count = 0;
    let sheets = SweptSheet::all(&motion, pieces);
    assert_eq!(sheets.len(), pieces.len());
    for sheet in sheets {
        for i in 0..12 {
            for j in 0..8 {
                let uv = [
                    us[0] + (us[1] - us[0]) * f64::from(i) / 11.0,
                    0.08 + 0.12 * f64::from(j),
                ];
                let Some([p, by_u, by_t, by_both]) = sheet.jet(uv) else {
                    continue;
                };
                let Some((distance, grows)) = sheet.at(p) else { continue };
                // Points where the piece is inside the swept body are on no side of it.
                if brute(p, far).abs() > 1e-7 || distance.abs() > 1e-6 {
                    continue;
                }
                assert!(distance.abs() < 1e-10, "{distance}");
                let back = sheet.uv(p).unwrap();
                if (back[1] - uv[1]).abs() > 1e-5 {
                    continue;
                }
                assert!((back[0] - uv[0]).abs() < 1e-6, "{back:?} {uv:?}");
                // Where the way is all but along the circle, the sheet bends more than that.
                if by_u.normalize().cross(&by_t.normalize()).norm() < 0.8 {
                    continue;
                }
                for way in [by_u, by_t] {
                    assert!(grows.dot(&way.normalize()).abs() < 1e-4);
                }
                assert!(by_u.cross(&by_t).dot(&grows) > 0.0 || by_u.cross(&by_t).norm() < 1e-2);
                // Twists by differences of the first derivatives.
                let [one, two] = [-1e-4, 1e-4].map(|d| sheet.jet([uv[0], uv[1] + d]).unwrap()[1]);
                assert!(((two - one) / 2e-4 - by_both).norm() < 1e-3 * (1.0 + by_both.norm()));
                for off in [0.05, -0.05] {
                    let q = p + grows * off;
                    let (distance, direction) = sheet.at(q).unwrap();
                    // The sheet itself may come nearer from elsewhere.
                    if distance.abs() < f64::abs(off) - 1e-9 {
                        continue;
                    }
                    assert!((distance - off).abs() < 1e-9 && (direction - grows).norm() < 1e-7);
                    // No place of the piece is nearer, unless it comes by again, or the point is inside the tool.
                    let least = brute(q, far).abs();
                    assert!(least <= f64::abs(off) + 1e-6, "{least} {off}");
                    count += usize::from((least - f64::abs(off)).abs() < 1e-6);
                }
            }
        }
    }
    count
}

#[test]
fn distances_are_the_least_over_all_times() {
    let ball = SweptPiece::Ball {
        height: 4.0,
        radius: 4.0,
    };
    assert!(tried(&[ball], &|r, h| r.hypot(h - 4.0) - 4.0, [-3.1, 3.1]) > 60);
    let rim = SweptPiece::Circle {
        at: [5.0, 0.0],
        tube: 0.0,
        upper: true,
    };
    assert!(tried(&[rim], &|r, h| (r - 5.0).hypot(h), [-3.1, 3.1]) > 30);
    let corner = |upper| SweptPiece::Circle {
        at: [4.0, 1.0],
        tube: 1.0,
        upper,
    };
    assert!(
        tried(
            &[corner(true), corner(false)],
            &|r, h| (r - 4.0).hypot(h - 1.0) - 1.0,
            [-3.1, 3.1]
        ) > 30
    );
    let side = |left| SweptPiece::Line {
        from: [4.0, 0.0],
        to: [5.0, 12.0],
        left,
    };
    let size = 1f64.hypot(12.0);
    let cone = |r: f64, h: f64| ((r - 4.0) * 12.0 - h) / size;
    assert!(tried(&[side(true), side(false)], &cone, [0.0, size]) > 60);
}

/// The floor of a flat end on half a turn down: points of the circle's sweep in closed form.
#[test]
fn helices_have_sheets() {
    let at = |t: f64| {
        let (s, c) = (std::f64::consts::PI * t).sin_cos();
        ([30.0 + 10.0 * c, 20.0 + 10.0 * s, 14.0 - 5.0 * t], [0.0, 0.0, 1.0])
    };
    let pieces = [
        SweptPiece::Ball {
            height: 5.0,
            radius: 5.0,
        },
        SweptPiece::Circle {
            at: [5.0, 0.0],
            tube: 0.0,
            upper: true,
        },
    ];
    let sheets = SweptSheet::all(&at, &pieces);
    assert_eq!(sheets.len(), 2);
    for k in 0..20 {
        let t = 0.05 * f64::from(k);
        let (tip, _) = at(t);
        let p = Vector3::from(tip) + Vector3::new(5.0 * t.cos(), 5.0 * t.sin(), 0.0);
        let (distance, _) = sheets[1].at(p).unwrap();
        assert!(distance.abs() < 1e-10, "{t} {distance}");
        let below = Vector3::from(tip) - Vector3::z() * 4.0;
        let (distance, grows) = sheets[0].at(below).unwrap();
        let far = (0..=100_000).map(|n| {
            let (tip, _) = at(f64::from(n) / 100_000.0);
            (below - Vector3::from(tip) - Vector3::z() * 5.0).norm()
        });
        assert!(
            (distance + 5.0 - far.fold(f64::INFINITY, f64::min)).abs() < 1e-6,
            "{t} {distance} {grows}"
        );
    }
}
