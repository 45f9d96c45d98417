//! What earlier runs have proven.

use super::Proof;
use crate::base::cache::{Digest, Key, RunCache};
use sweepsim_proof::Recall;

/// What earlier runs have proven about something.
pub(super) struct Recalled<'a>(Option<(&'a RunCache, Key)>);

impl Recalled<'_> {
    fn entry(&self, question: &Key) -> Option<(&RunCache, Key)> {
        let (cache, about) = self.0?;
        Some((cache, Digest::of("answer").bytes(&about).bytes(question).key()))
    }
}

impl Recall for Recalled<'_> {
    fn keeps(&self) -> bool {
        self.0.is_some()
    }

    fn digest(&self, question: &[u8]) -> Key {
        Digest::of("question").bytes(question).key()
    }

    fn recall(&self, question: &Key) -> Option<Vec<u8>> {
        let (cache, key) = self.entry(question)?;
        cache.get(&key).map(<[u8]>::to_vec)
    }

    fn keep(&self, question: &Key, answer: Vec<u8>) {
        if let Some((cache, key)) = self.entry(question) {
            cache.put(key, answer);
        }
    }
}

impl<'a> Proof<'a> {
    /// What is known of the stock and of an obstacle, if it is about one.
    pub fn known(&self, obstacle: Option<usize>) -> Recalled<'a> {
        let digest = || {
            let own = Digest::of("proof").bytes(&self.session.digests().0);
            let obstacle = obstacle.map(|number| (number, &self.asked.obstacles[number]));
            let own = match obstacle {
                Some((number, obstacle)) => {
                    let own = own.number(1).floats(&[self.lift(number)]);
                    match &obstacle.triangles {
                        // Of the target, the digest is known.
                        Ok(_) if obstacle.setup.is_none() => own.bytes(&self.session.digests().1),
                        Ok(soup) => own.triangles(soup),
                        Err(reason) => own.value(reason),
                    }
                }
                None => own.number(0),
            };
            own.key()
        };
        let cache = self.session.cache().filter(|_| self.recalls);
        let about = obstacle.map_or(0, |number| number + 1);
        Recalled(cache.map(|cache| (cache, *self.digests[about].get_or_init(digest))))
    }
}
