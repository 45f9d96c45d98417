//! Consecutive things in blocks that begin where their own content says so.
//!
//! What is put in, or left out, changes the block that it is in, and perhaps the next one or two: the others are what
//! they were, and so are answers about them.

use nalgebra::Vector3;
use std::ops::Range;

/// How long blocks are: at least, on the average beyond that, and at most.
pub(crate) type Lengths = [usize; 3];

/// The numbers from 0, so many, in blocks. `digest`: of the content of one of them.
pub(crate) fn blocks(
    count: usize,
    [least, beyond, most]: Lengths,
    digest: impl Fn(usize) -> u64,
) -> impl Iterator<Item = Range<usize>> {
    let mut first = 0;
    std::iter::from_fn(move || {
        let begins = |number: &usize| digest(*number).is_multiple_of(beyond as u64);
        let end = count.min(first + most);
        let end = (first + least..end).find(begins).unwrap_or(end);
        let own = first..end;
        first = end;
        (!own.is_empty()).then_some(own)
    })
}

/// A digest of a place, of which all digits are as good.
pub(crate) fn digest(place: &Vector3<f64>) -> u64 {
    place.iter().fold(0, |digest, c| mixed(digest ^ c.to_bits()))
}

/// A step of SplitMix64 (Steele, Lea, Flood 2014).
fn mixed(bits: u64) -> u64 {
    let mut mixed = bits.wrapping_add(0x9e37_79b9_7f4a_7c15);
    mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ (mixed >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENGTHS: Lengths = [32, 32, 128];

    fn of(places: &[Vector3<f64>]) -> Vec<&[Vector3<f64>]> {
        let all = blocks(places.len(), LENGTHS, |k| digest(&places[k]));
        all.map(|own| &places[own]).collect()
    }

    /// Passes to and fro.
    fn places() -> Vec<Vector3<f64>> {
        let place = |k: usize| Vector3::new(0.25 * (k % 100) as f64, 0.5 * (k / 100) as f64, -1.0);
        (0..20_000).map(place).collect()
    }

    #[test]
    fn blocks_hold_all_and_have_their_lengths() {
        let places = places();
        let all = of(&places);
        assert_eq!(all.concat(), places);
        let (last, others) = all.split_last().unwrap();
        assert!(!last.is_empty() && last.len() <= 128);
        assert!(others.iter().all(|own| (32..=128).contains(&own.len())));
        let mean = places.len() / all.len();
        assert!((50..80).contains(&mean), "{mean}");
    }

    #[test]
    fn a_place_more_or_less_changes_few_blocks() {
        let places = places();
        let all = of(&places);
        for number in (0..places.len()).step_by(997) {
            let (mut more, mut less) = (places.clone(), places.clone());
            more.insert(number, Vector3::new(7.0, number as f64, 3.0));
            less.remove(number);
            for other in [more, less] {
                let other = of(&other);
                let before = all.iter().zip(&other).take_while(|(a, b)| a == b).count();
                let after = all
                    .iter()
                    .rev()
                    .zip(other.iter().rev())
                    .take_while(|(a, b)| a == b)
                    .count();
                assert!(
                    before + after + 6 >= all.len(),
                    "{number}: {before} and {after} of {}",
                    all.len()
                );
            }
        }
    }

    #[test]
    fn nothing_has_no_blocks() {
        assert_eq!(blocks(0, LENGTHS, |_| 0).count(), 0);
        // Where all is the same, every place that may begin a block does, or none.
        assert_eq!(
            blocks(100, LENGTHS, |_| 0).collect::<Vec<_>>(),
            [0..32, 32..64, 64..96, 96..100]
        );
        assert_eq!(blocks(200, LENGTHS, |_| 1).collect::<Vec<_>>(), [0..128, 128..200]);
    }
}
