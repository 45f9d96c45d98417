//! Deviations along normals, of parts in all their forms, against what is known of them in advance.

use sweepsim_dexel::{Dexels, Stock, Surface, SurfaceDeviations, TriDexels, TriangleSoup};
use sweepsim_props::*;

const TOLERANCE: f64 = 1e-6;
/// The distance of the lines.
const CELL: f64 = 0.5;

/// A part as dexels along three axes, as those along z alone, and as triangles of the first.
struct Forms {
    tri: TriDexels,
    mesh: TriangleSoup,
}

impl Forms {
    fn new(stock: &Stock) -> Self {
        Self::of_cells(stock, 2)
    }

    /// With this many cells a millimetre.
    fn of_cells(stock: &Stock, count: usize) -> Self {
        let cells = [25, 25, 14].map(|size| size * count);
        let tri = TriDexels::new([-12.5, -12.5, -1.0], [12.5, 12.5, 13.0], cells, stock).unwrap();
        let mesh = tri.surface().unwrap().soup().unwrap();
        Self { tri, mesh }
    }

    fn lines(&self) -> &Dexels {
        &self.tri.sets()[2]
    }

    /// As dexels along z, as dexels along three axes, and as triangles.
    fn surfaces(&self) -> [Surface<'_>; 3] {
        [
            Surface::of_dexels(self.lines()).unwrap(),
            Surface::of_tri_dexels(&self.tri).unwrap(),
            Surface::of_triangles(&self.mesh).unwrap(),
        ]
    }
}

/// Both ways, in all pairs of forms.
fn both_ways(part: &Forms, target: &Forms, mut check: impl FnMut([usize; 2], [SurfaceDeviations; 2])) {
    let (parts, targets) = (part.surfaces(), target.surfaces());
    for (i, part) in parts.iter().enumerate() {
        for (j, target) in targets.iter().enumerate() {
            let there = part.deviations_from(target, CELL, TOLERANCE);
            check([i, j], [there, target.missing_from(part, CELL, TOLERANCE)]);
        }
    }
}

/// Of a deviation of this size, in every pair of forms: where no part is dexels along z it is found within `off`, and
/// elsewhere it is within the range.
fn all_forms_tell(part: &Stock, target: &Stock, size: f64, off: f64) {
    let (part, target) = (Forms::new(part), Forms::new(target));
    let mut count = 0;
    both_ways(&part, &target, |[i, j], found| {
        for (way, found) in found.iter().enumerate() {
            let [least, most] = found.largest();
            assert!(
                least <= size + off && size - off <= most,
                "forms {i} {j}, way {way}: {least} {most} {found:?}",
                found = (found.inside, found.outside)
            );
            if i > 0 && j > 0 {
                assert!(
                    (least - size).abs() <= off && most == least,
                    "forms {i} {j}, way {way}: {least} {most}"
                );
                count += 1;
            } else {
                // Of each, anywhere in a square.
                let open = if i + j == 0 { 2.0 } else { 1.0 };
                assert!(
                    most <= size + off + open * 2.0_f64.sqrt() * CELL,
                    "forms {i} {j}, way {way}: {least} {most}"
                );
            }
        }
    });
    assert_eq!(count, 8);
}

fn block(min: [f64; 3], max: [f64; 3]) -> Stock {
    Stock::Block { min, max }
}

fn without(part: Stock, cut: Stock) -> Stock {
    Stock::Difference(Box::new(part), vec![cut])
}

fn slot(depth: f64) -> Stock {
    without(
        block([-12.1, -12.1, 0.0], [12.1, 12.1, 12.0]),
        block([-20.0, -4.1, 12.0 - depth], [20.0, 4.1, 20.0]),
    )
}

fn hole(radius: f64) -> Stock {
    without(
        block([-12.1, -12.1, 0.0], [12.1, 12.1, 2.0]),
        Stock::Cylinder {
            base: [0.3, -0.2, -1.0],
            axis: [0.0, 0.0, 1.0],
            radius,
            height: 20.0,
        },
    )
}

/// A block that leans by `slope`, whose upper side is lower by `down` along z.
fn slanted(slope: f64, down: f64) -> Stock {
    let cosine = 1.0 / slope.hypot(1.0);
    let mut soup = TriangleSoup::block([-8.1, -8.1, 0.0], [8.1, 8.1, 4.0 - down * cosine]);
    for p in soup.triangles.iter_mut().flatten() {
        *p = [
            cosine * (p[0] + slope * p[2]),
            p[1],
            4.5 + cosine * (p[2] - slope * p[0]),
        ];
    }
    Stock::Mesh(soup)
}

#[test]
fn a_slot_too_deep() {
    all_forms_tell(&slot(5.0), &slot(4.9), 0.1, 1e-9);
    // What dexels along z do know is on the floor, and certain.
    let (part, target) = (Forms::new(&slot(5.0)), Forms::new(&slot(4.9)));
    both_ways(&part, &target, |_, [there, back]| {
        for [least, _] in [there.largest(), back.largest()] {
            assert!((least - 0.1).abs() < 1e-9, "{least}");
        }
        // The part is inside the target, and so the target is outside of the part.
        assert!((there.inside.unwrap().least - 0.1).abs() < 1e-9);
        assert!((back.outside.unwrap().least - 0.1).abs() < 1e-9);
    });
}

#[test]
fn a_hole_too_wide() {
    all_forms_tell(&hole(10.0), &hole(9.9), 0.1, 0.005);
    all_forms_tell(&hole(9.9), &hole(10.0), 0.1, 0.005);
}

#[test]
fn a_wall_moved() {
    let part = |side: f64| block([-11.1, -9.3, 0.0], [side, 9.3, 7.1]);
    all_forms_tell(&part(8.13), &part(8.15), 0.02, 1e-9);
}

/// The floor of one set of lines is the wall of another, and grids may lie in frames.
#[test]
fn lines_along_a_wall_do_not_know_it_and_lines_across_do() {
    let part = |side: f64| Forms::new(&block([-11.1, -9.3, 0.0], [side, 9.3, 7.1]));
    let (part, target) = (part(8.13), part(8.15));
    for (axis, lines) in part.tri.sets().iter().enumerate() {
        let (lines, target) = (Surface::of_dexels(lines).unwrap(), &target.surfaces()[2]);
        for found in [
            lines.deviations_from(target, CELL, TOLERANCE),
            target.missing_from(&lines, CELL, TOLERANCE),
        ] {
            let [least, most] = found.largest();
            assert!(
                least <= 0.02 + 1e-9 && (0.02 - 1e-9..0.75).contains(&most),
                "{axis}: {least} {most}"
            );
            assert_eq!(axis == 0, (least - 0.02).abs() < 1e-9, "{axis}: {least} {most}");
        }
    }
}

#[test]
fn a_slanted_plane_too_low() {
    for slope in [0.2_f64, 0.45] {
        let cosine = 1.0 / slope.hypot(1.0);
        all_forms_tell(&slanted(slope, 0.05), &slanted(slope, 0.0), 0.05 * cosine, 1e-4);
    }
}

#[test]
fn a_part_is_itself() {
    // Flat faces: nothing but rounding, or normals of 6.5e-5 radians.
    for (stock, off) in [(slot(5.0), 1e-9), (slanted(0.3, 0.0), 1e-4)] {
        all_forms_tell(&stock, &stock, 0.0, off);
    }
    // A mesh is off from the arc by what its triangles are: chords of a cell rise by d² / 8 r.
    all_forms_tell(&hole(10.0), &hole(10.0), 0.0, 2.0 * CELL * CELL / 80.0);
    let forms = Forms::new(&hole(10.0));
    for surface in forms.surfaces() {
        let found = surface.deviations_from(&surface, CELL, TOLERANCE);
        assert!(found.largest()[0] <= 1e-9, "{:?}", found.largest());
    }
}

#[test]
fn means_are_of_areas() {
    let raised = |top: f64| block([-10.0, -10.0, 0.0], [10.0, 10.0, top]);
    let (part, target) = (Forms::new(&raised(6.1)), Forms::new(&raised(6.0)));
    let found = part.surfaces()[2].deviations_from(&target.surfaces()[2], CELL, TOLERANCE);
    let area = 2.0 * 400.0 + 4.0 * 20.0 * 6.1;
    assert!((found.area - area).abs() < 1e-6 * area);
    assert!((found.mean[0] - 0.1 * 400.0 / area).abs() < 1e-3 && found.mean[0] == found.mean[1]);
    assert!((found.rms[0] - (0.01_f64 * 400.0 / area).sqrt()).abs() < 1e-3);
    let total: f64 = found.points.iter().map(|point| point.area).sum();
    assert!((total - area).abs() < 1e-6 * area);
    // Along z, the walls are not known: a fifth of all.
    let found = part.surfaces()[0].deviations_from(&target.surfaces()[2], CELL, TOLERANCE);
    assert!(
        found.mean[0] < 0.1 * 400.0 / area && 0.1 * 400.0 / area < found.mean[1],
        "{:?}",
        found.mean
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Whatever the walls and floors: the truth is in the range, both ways, and the sides are those of the solids.
    #[test]
    fn ranges_hold_the_truth(walls in [-10.9_f64..-8.0, -10.9..-8.0, 8.0..10.9, 8.0..10.9], top in 3.0_f64..9.0,
        moved in 0.0_f64..0.7, which in 0_usize..3) {
        let solid = |moved: f64| {
            let mut max = [walls[2], walls[3], top];
            max[which] += moved;
            Forms::of_cells(&block([walls[0], walls[1], 0.0], max), 1)
        };
        let (part, target) = (solid(moved), solid(0.0));
        both_ways(&part, &target, |forms, found| {
            for (way, found) in found.iter().enumerate() {
                let [least, most] = found.largest();
                assert!(least <= moved + 1e-9 && moved - 1e-6 <= most, "{forms:?} {way}: {least} {most}, moved {moved}");
                let wrong = if way == 0 { found.inside } else { found.outside };
                assert!(wrong.is_none_or(|at| at.least == 0.0), "{forms:?} {way}: {wrong:?}");
            }
        });
    }
}

#[test]
fn thin_triangles_have_few_samples_whatever_the_spacing() {
    let thin = TriangleSoup {
        triangles: vec![[[0.0; 3], [1e9, 0.0, 0.0], [0.0, 1e-9, 0.0]]],
    };
    let surface = Surface::of_triangles(&thin).unwrap();
    for spacing in [f64::NAN, -1.0, 0.0, 1.0] {
        let found = surface.deviations_from(&surface, spacing, 1e-6);
        assert!(found.points.len() <= 2_000_003, "{spacing}: {}", found.points.len());
    }
}
