//! Solids that are prepared once and swept in parts.

use sweepsim::Options;
use sweepsim::internals::{LineMask, MovingSolid};
use sweepsim_dexel::Grid;
use sweepsim_motion::{Move, Path, Pose, TipArc, TipCourse, Tool, Turning};
use sweepsim_props::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A flat end on a level circle, in parts down to a few millionths of it: nothing stays open, and lines well inside
    /// are swept.
    #[test]
    fn short_parts_of_level_motions_are_certified(radius in 5.0..12.0_f64, at in 0.0..0.99_f64, halvings in 8_i32..30) {
        let at_rest = Pose::new([4.0 + radius, 3.0, -7.0], [0.0, 0.0, 1.0]).unwrap();
        let tip = at_rest.tip();
        let arc = TipArc::between(tip, tip, [4.0, 3.0, -7.0], [0.0, 0.0, 1.0], 1).unwrap();
        let circle = Move { course: TipCourse::Arc(arc), turning: Turning::Even };
        let path = Path::with_moves(vec![at_rest, at_rest], vec![circle]).unwrap();
        let grid = Grid::new([-20.0, -20.0], [28.0, 26.0], [96, 92]).unwrap();
        let (tool, options) = (Tool::flat(6.0, 26.0).unwrap(), Options::default());
        let solid = MovingSolid::new(&tool, (&path, 0..1), &[grid], &options).unwrap();
        let parts = solid.within(0, [at, at + 0.5_f64.powi(halvings)]);
        let mask = LineMask::new(&grid, 0..grid.len() as u32).unwrap();
        let swept = solid.swept(&parts, (&grid, f64::INFINITY), &mask, &options, &()).unwrap();
        prop_assert_eq!(swept.unresolved.len(), 0, "{:?}", swept.unresolved.first());
        let centre = parts[0].segment.tips()[0];
        let inside = |line: &u32| {
            let (i, j) = grid.place(*line as usize);
            (grid.x(i) - centre[0]).hypot(grid.y(j) - centre[1]) < 5.999
        };
        let expected = (0..grid.len() as u32).filter(inside).count();
        prop_assert_eq!(swept.lines.iter().filter(|(line, _)| inside(line)).count(), expected);
    }

    /// A solid that is prepared for one path sweeps the same along another as if it had been prepared for that alone.
    #[test]
    fn what_is_prepared_of_a_tool_serves_other_paths(
        tips in collection::vec(prop::array::uniform3(-12.0..12.0_f64), 2..5),
        lean in prop_oneof![Just(0.0), -0.5..0.5_f64],
    ) {
        let pose = |tip: [f64; 3], lean: f64| Pose::new(tip, [lean, 0.2 * lean, 1.0]).unwrap();
        let grid = Grid::new([-40.0, -40.0], [40.0, 40.0], [60, 60]).unwrap();
        let (tool, options) = (Tool::bull(3.0, 1.0, 26.0).unwrap(), Options::default());
        let first = Path::new(vec![pose([0.0; 3], 0.3), pose([5.0, 5.0, 1.0], -0.1)]).unwrap();
        let other = Path::new(tips.iter().map(|tip| pose(*tip, lean)).collect()).unwrap();
        let mask = LineMask::new(&grid, 0..grid.len() as u32).unwrap();
        let lines = |solid: &MovingSolid| {
            solid.swept(solid.slice(solid.parts(0..9)), (&grid, 10.0), &mask, &options, &()).unwrap().lines
        };
        let prepared = MovingSolid::new(&tool, (&first, 0..1), &[grid], &options).unwrap();
        lines(&prepared);
        let along = lines(&prepared.along(&other, &grid, &options).unwrap());
        prop_assert_eq!(along, lines(&MovingSolid::new(&tool, (&other, 0..other.moves()), &[grid], &options).unwrap()));
    }
}
