//! Envelope surfaces bound the swept volume.

use sweepsim::{BoundaryPiece, BoundaryPoint, Cut, EnvelopeSurfaces, Options, Ray, envelope_surfaces, probe, sweep};
use sweepsim_dexel::{Grid, Interval};
use sweepsim_motion::{Path, Pose, Tool};

fn path(poses: &[([f64; 3], [f64; 3])]) -> Path {
    Path::new(
        poses
            .iter()
            .map(|(tip, axis)| Pose::new(*tip, *axis).unwrap())
            .collect(),
    )
    .unwrap()
}

/// Volume by the divergence theorem, and area.
fn measures(surfaces: &EnvelopeSurfaces, trimmed: bool) -> (f64, f64) {
    let (points, triangles) = surfaces.triangles(trimmed);
    let (mut volume, mut area) = (0.0, 0.0);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|v| points[v as usize].position);
        let cross = |p: [f64; 3], q: [f64; 3]| {
            [
                p[1] * q[2] - p[2] * q[1],
                p[2] * q[0] - p[0] * q[2],
                p[0] * q[1] - p[1] * q[0],
            ]
        };
        let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
        let side = |p: [f64; 3]| [p[0] - a[0], p[1] - a[1], p[2] - a[2]];
        let normal = cross(side(b), side(c));
        volume += dot(a, cross(b, c)) / 6.0;
        area += 0.5 * dot(normal, normal).sqrt();
    }
    (volume, area)
}

#[test]
fn the_pieces_of_a_move_that_meets_itself_nowhere_enclose_it() {
    // All of the tool goes forwards: no sheet of the envelope lies inside.
    let path = path(&[
        ([-12.0, -4.0, 0.0], [0.0, 0.1, 1.0]),
        ([12.0, 5.0, 3.0], [0.1, 0.2, 1.0]),
    ]);
    for tool in [Tool::ball(5.0, 30.0).unwrap(), Tool::bull(5.0, 1.0, 30.0).unwrap()] {
        let cut = Cut::new(&tool, &path);
        let options = Options::new(1e-6);
        let grid = Grid::new([-30.0, -30.0], [30.0, 30.0], [400, 400]).unwrap();
        let swept = sweep(&tool, &path, &grid, &options, &()).unwrap().volume.volume();
        for chord in [0.1, 0.02] {
            let surfaces = envelope_surfaces(&[cut], chord, &options, &()).unwrap();
            assert!(surfaces.open.is_empty(), "{:?}", surfaces.open);
            let (volume, area) = measures(&surfaces, false);
            // Triangles are off by the chord; the rectangle rule on 400 × 400 lines is off by less than a thousandth.
            let slack = chord * area + 1e-3 * swept;
            assert!(
                (volume - swept).abs() < slack,
                "chord {chord}: {volume} for {swept}, area {area}"
            );
        }
    }
}

#[test]
fn corners_that_bound_the_volume_lie_where_dexels_end() {
    // Down and up again: the sheets of the two moves intersect.
    let path = path(&[
        ([-10.0, 0.0, 6.0], [0.2, 0.0, 1.0]),
        ([0.0, 1.0, 0.0], [0.0, 0.3, 1.0]),
        ([9.0, -1.0, 5.0], [-0.3, 0.0, 1.0]),
    ]);
    let tool = Tool::bull(4.0, 1.5, 20.0).unwrap();
    let cut = Cut::new(&tool, &path);
    let options = Options::new(1e-6);
    let surfaces = envelope_surfaces(&[cut], 0.2, &options, &()).unwrap();
    assert!(
        surfaces
            .surfaces
            .iter()
            .any(|s| matches!(s.piece, BoundaryPiece::Placed(_)))
    );
    let (mut outer, mut inner) = (0, 0);
    for surface in &surfaces.surfaces {
        // Along walls an end of a line says little, and edges may be the volume's outline seen from above, where lines
        // only touch it.
        if matches!(surface.piece, BoundaryPiece::Edge(_)) {
            continue;
        }
        let chosen = surface.vertices.iter().zip(&surface.outer).step_by(17);
        let chosen: Vec<_> = chosen.filter(|(point, _)| point.normal[2].abs() > 0.2).collect();
        let probed = |at: Vec<[f64; 2]>| {
            let ray = |[x, y]: [f64; 2]| Ray::new([x, y, 0.0], [0.0, 0.0, 1.0]).unwrap();
            let rays: Vec<Ray> = at.into_iter().map(ray).collect();
            let found = probe(&tool, &path, &rays, &options, &()).unwrap();
            found.into_iter().map(|intervals| intervals.expect("established"))
        };
        let place = |p: &BoundaryPoint| [p.position[0], p.position[1]];
        let found = probed(chosen.iter().map(|(p, _)| place(p)).collect());
        for ((point, is_outer), intervals) in chosen.iter().zip(found) {
            let z = point.position[2];
            let off = |intervals: &[Interval]| {
                let ends = intervals.iter().flat_map(|i| [i.lower.z, i.upper.z]);
                ends.map(|end| (end - z).abs()).fold(f64::INFINITY, f64::min)
            };
            if **is_outer {
                let mut nearest = off(&intervals);
                if intervals.is_empty() {
                    // On the outline of a flat face, displaced lines may miss the volume; of those a little beside them
                    // some do not.
                    let [x, y] = place(point);
                    let beside = [[5e-6, 0.0], [-5e-6, 0.0], [0.0, 5e-6], [0.0, -5e-6]];
                    let beside = probed(beside.map(|[dx, dy]| [x + dx, y + dy]).into());
                    nearest = beside.map(|intervals| off(&intervals)).fold(f64::INFINITY, f64::min);
                }
                // Twenty tolerances along the normal, on a slope of at most 5.
                assert!(nearest < 1.1e-4, "{:?}: {nearest} from {intervals:?}", surface.piece);
                outer += 1;
            } else {
                assert!(intervals.iter().any(|i| i.lower.z - 1e-5 < z && z < i.upper.z + 1e-5));
                inner += 1;
            }
        }
    }
    assert!(outer > 50 && inner > 5, "{outer} {inner}");
}

#[test]
fn bad_chords_are_refused() {
    let path = path(&[([0.0; 3], [0.0, 0.0, 1.0]), ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0])]);
    let tool = Tool::ball(1.0, 5.0).unwrap();
    let cut = Cut::new(&tool, &path);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(envelope_surfaces(&[cut], bad, &Options::default(), &()).is_err());
    }
}
