//! How much of the suite runs: a seeded sample in the gate, everything under `cargo xtask brute-force`.

use std::hash::{DefaultHasher, Hash, Hasher};

/// Set by `cargo xtask brute-force`: everything is run, with this many times the random cases.
const EVERYTHING: &str = "SWEEPSIM_BRUTE_FORCE";
/// Selects another sample.
const SEED: &str = "SWEEPSIM_SEED";

fn number(variable: &str) -> Option<u64> {
    let text = std::env::var(variable).ok()?;
    Some(
        text.parse()
            .unwrap_or_else(|_| panic!("{variable}={text}: expected a number")),
    )
}

/// The factor for the number of random cases of a test.
pub fn times() -> u32 {
    number(EVERYTHING).map_or(1, |times| u32::try_from(times).expect("a reasonable number").max(1))
}

/// `share` cases of a named list in the gate, in their order; all of them where everything is run.
pub fn sample<T: Clone>(test: &str, all: &[T], share: usize) -> Vec<T> {
    if number(EVERYTHING).is_some() {
        return all.to_vec();
    }
    let seed = number(SEED).unwrap_or(0x5eed);
    let rank = |place: usize| {
        // The default hasher of `std` has fixed keys.
        let mut hasher = DefaultHasher::new();
        (seed, test, place).hash(&mut hasher);
        hasher.finish()
    };
    let mut places: Vec<usize> = (0..all.len()).collect();
    places.sort_by_key(|&place| rank(place));
    places.truncate(share);
    places.sort_unstable();
    println!("{test}: {} of {} cases, seed {seed}", places.len(), all.len());
    places.into_iter().map(|place| all[place].clone()).collect()
}

#[test]
fn a_sample_is_fixed_and_has_its_size() {
    let all: Vec<u32> = (0..100).collect();
    let one = sample("a", &all, 10);
    if number(EVERYTHING).is_some() {
        assert_eq!(one, all);
        return;
    }
    assert_eq!(one.len(), 10);
    assert_eq!(one, sample("a", &all, 10));
    assert_ne!(one, sample("b", &all, 10));
    assert!(one.is_sorted());
    assert_eq!(sample("a", &all[..5], 10), all[..5]);
}
