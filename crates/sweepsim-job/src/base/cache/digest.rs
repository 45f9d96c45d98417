//! Digests of what results depend on.

use sha2::{Digest as _, Sha256};
use std::fmt::{self, Debug, Write};
use sweepsim_dexel::{Dexels, Stock, TriangleSoup};
use sweepsim_motion::Pose;

/// By what something is known.
pub(crate) type Key = [u8; 32];

/// A digest of values, one after the other.
#[derive(Clone)]
pub(crate) struct Digest(Sha256);

impl Write for Digest {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

impl Digest {
    /// Of something of this kind.
    pub fn of(kind: &str) -> Self {
        Self(Sha256::new()).number(kind.len()).bytes(kind.as_bytes())
    }

    /// With bytes whose number is known.
    pub fn bytes(mut self, bytes: &[u8]) -> Self {
        self.0.update(bytes);
        self
    }

    pub fn number(self, number: usize) -> Self {
        self.bytes(&(number as u64).to_le_bytes())
    }

    /// With a value in the notation of this version of the program.
    pub fn value(mut self, value: &impl Debug) -> Self {
        // Writing to a digest does not fail.
        let _ = write!(self, "{value:?};");
        self
    }

    pub fn floats(mut self, all: &[f64]) -> Self {
        // Some at a time: each update takes time of its own.
        for some in all.chunks(16) {
            let mut bytes = [[0; 8]; 16];
            for (to, number) in bytes.iter_mut().zip(some) {
                *to = number.to_bits().to_le_bytes();
            }
            self.0.update(bytes[..some.len()].as_flattened());
        }
        self
    }

    pub fn pose(self, pose: &Pose) -> Self {
        let ([x, y, z], [i, j, k]) = (pose.tip(), pose.axis());
        let own = self.floats(&[x, y, z, i, j, k]);
        match pose.side() {
            Some(side) => own.number(1).floats(&side),
            None => own.number(0),
        }
    }

    pub fn triangles(mut self, soup: &TriangleSoup) -> Self {
        self = self.number(soup.triangles.len());
        let triangles = soup.triangles.iter();
        triangles.fold(self, |own, corners| own.floats(corners.as_flattened()))
    }

    fn dexels(self, dexels: &Dexels) -> Self {
        let state = dexels.state();
        self.value(dexels.grid()).number(state.len()).bytes(&state)
    }

    pub fn stock(self, stock: &Stock) -> Self {
        let all = |own: Self, parts: &[Stock]| parts.iter().fold(own.number(parts.len()), Self::stock);
        match stock {
            Stock::Mesh(soup) => self.number(1).triangles(soup),
            Stock::Dexels(dexels) => self.number(2).dexels(dexels),
            Stock::TriDexels(sets) => sets.iter().fold(self.number(3), Self::dexels),
            Stock::Union(parts) => all(self.number(4), parts),
            Stock::Intersection(parts) => all(self.number(5), parts),
            Stock::Difference(whole, parts) => all(self.number(6).stock(whole), parts),
            simple => self.number(0).value(simple),
        }
    }

    pub fn key(self) -> Key {
        self.0.finalize().into()
    }
}
