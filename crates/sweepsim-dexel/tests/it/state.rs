use sweepsim_dexel::*;
use sweepsim_props::*;

fn cut(line: u32, [lower, length]: [f64; 2], segment: u32, t: f32) -> (u32, Interval) {
    let mut interval = Interval::between(lower, lower + length);
    interval.lower.source = Source::Cut { path: 3, segment, t };
    interval.upper.source = Source::Cut { path: 4, segment, t };
    (line, interval)
}

proptest! {
    /// After the same further cuts, what was read again has the same state: also of chunks that so many moves cut
    /// that the times of their sources lose bits, and were cut away since.
    #[test]
    fn what_is_read_again_goes_on_the_same(
        first in collection::vec((0..150_u32, -5.0..5.0_f64, 0.01..2.0_f64, 0..2000_u32, 0.0..1.0_f32), 1..900),
        then in collection::vec((0..150_u32, -5.0..5.0_f64, 0.01..2.0_f64, 0..2000_u32, 0.0..1.0_f32), 1..60),
    ) {
        let grid = Grid::new([0.0; 2], [15.0, 10.0], [15, 10]).unwrap();
        let cuts = |all: &[(u32, f64, f64, u32, f32)]| -> Vec<_> {
            all.iter().map(|(line, lower, length, segment, t)| cut(*line, [*lower, *length], *segment, *t)).collect()
        };
        let mut dexels = Dexels::from_fn(grid, |_, line| line.push(Interval::between(-6.0, 6.0))).unwrap();
        for some in cuts(&first).chunks(40) {
            dexels.remove(some, 1e-6).unwrap();
        }
        let mut again = Dexels::from_state(grid, &dexels.state()).expect("its state");
        prop_assert_eq!(&again, &dexels);
        for all in [&mut dexels, &mut again] {
            all.update(Operation::Union, &cuts(&then)).unwrap();
            all.remove(&cuts(&then[then.len() / 2..]), 1e-6).unwrap();
        }
        prop_assert_eq!(again.state(), dexels.state());
    }

    /// Whatever is changed in a state, it is refused or read as some dexels; never a panic.
    #[test]
    fn changed_states_do_no_harm(at in 0..4000_usize, bit in 0..8_u32, cut_off in 0..4000_usize) {
        let grid = Grid::new([0.0; 2], [9.0, 9.0], [9, 9]).unwrap();
        let cuts: Vec<_> = (0..60).map(|k| cut(k, [f64::from(k % 7), 0.5], k, 0.5)).collect();
        let mut dexels = Dexels::from_fn(grid, |_, line| line.push(Interval::between(-6.0, 6.0))).unwrap();
        dexels.remove(&cuts, 1e-6).unwrap();
        let mut state = dexels.state();
        prop_assert!(state.len() > 4000);
        prop_assert_eq!(Dexels::from_state(grid, &state[..cut_off]), None);
        state[at] ^= 1 << bit;
        if let Some(other) = Dexels::from_state(grid, &state) {
            let _ = (other.volume(), other.iter().flat_map(|(_, line)| line.iter()).count());
            let _ = other.surface();
        }
    }
}
