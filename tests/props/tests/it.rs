//! The runner: all cases are tried, and what fails is shown.

use std::sync::atomic::{AtomicU32, Ordering};
use sweepsim_props::*;

static TRIED: AtomicU32 = AtomicU32::new(0);

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    #[should_panic(expected = "(n, text) = (17, \"\")")]
    fn the_smallest_values_that_fail_are_shown(n in 0..10_000_u32, text in "[ab]{0,5}") {
        prop_assert!(n < 17, "{text}");
    }

    #[test]
    #[should_panic(expected = "(n) = (17,)")]
    fn so_are_those_that_panic(n in 0..10_000_u32) {
        assert!(n < 17);
    }

    fn tried(n in 0..10_u32) {
        prop_assume!(n != 3);
        TRIED.fetch_add(1, Ordering::Relaxed);
    }
}

#[test]
fn as_many_cases_are_tried_as_were_asked_for() {
    tried();
    assert_eq!(TRIED.load(Ordering::Relaxed), 100);
}
