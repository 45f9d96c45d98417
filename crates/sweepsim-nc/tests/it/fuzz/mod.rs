//! Mutated and grammar-made files: none panics, hangs, or takes more memory than it may.

mod apt;
mod controls;
mod gcode;
mod tools;

use std::path::{Path, PathBuf};

/// A seeded generator (PCG-XSH-RR, O'Neill 2014).
pub struct Random(u64);

impl Random {
    /// Each seed makes another input.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub fn next(&mut self) -> u32 {
        let state = self.0;
        self.0 = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let xorshifted = (((state >> 18) ^ state) >> 27) as u32;
        xorshifted.rotate_right((state >> 59) as u32)
    }

    pub fn below(&mut self, bound: usize) -> usize {
        ((u64::from(self.next()) * bound.max(1) as u64) >> 32) as usize
    }

    pub fn one<'a>(&mut self, of: &[&'a str]) -> &'a str {
        of[self.below(of.len())]
    }

    /// One of the texts, or up to 30 lines of a real file, with a few bytes and pieces removed, inserted and replaced.
    pub fn mutated(&mut self, texts: &[&str], real: &[String], characters: &str) -> Vec<u8> {
        let mut text = if !real.is_empty() && self.below(2) == 0 {
            let file = &real[self.below(real.len())];
            let mut from = self.below(file.len());
            while !file.is_char_boundary(from) {
                from -= 1;
            }
            let lines: Vec<&str> = file[from..].lines().take(1 + self.below(30)).collect();
            lines.join("\n").into_bytes()
        } else {
            self.one(texts).as_bytes().to_vec()
        };
        let characters = characters.as_bytes();
        for _ in 0..=self.below(6) {
            let at = self.below(text.len() + 1);
            match self.below(6) {
                0 if at < text.len() => {
                    text.remove(at);
                }
                1 => text.insert(at, self.next() as u8),
                2 => {
                    let other = self.one(texts).as_bytes();
                    let from = self.below(other.len());
                    let to = (from + self.below(40)).min(other.len());
                    text.splice(at..at, other[from..to].iter().copied());
                }
                3 => {
                    let to = (at + self.below(20)).min(text.len());
                    text.drain(at..to);
                }
                4 => {
                    let number = self.one(&[
                        "0",
                        "-1",
                        "1e9",
                        "99999999999",
                        "1.",
                        ".",
                        "#",
                        "[",
                        "]",
                        "\n",
                        "0.0001",
                        "-0",
                    ]);
                    text.splice(at..at, number.bytes());
                }
                _ if at < text.len() => text[at] = characters[self.below(characters.len())],
                _ => {}
            }
        }
        text
    }
}

/// A number from the environment: `FUZZ_FROM` and `FUZZ_COUNT` choose a part of the ten million inputs.
fn number(name: &str, default: u64) -> u64 {
    std::env::var(name)
        .ok()
        .and_then(|text| text.parse().ok())
        .unwrap_or(default)
}

/// The real files under the folder `FUZZ_FILES`, if it is set, with one of these extensions.
fn seeds(extensions: &[&str]) -> Vec<String> {
    fn collect(folder: &Path, extensions: &[&str], found: &mut Vec<PathBuf>) {
        let Ok(entries) = std::fs::read_dir(folder) else { return };
        for entry in entries.flatten() {
            let path = entry.path();
            if path.is_dir() {
                collect(&path, extensions, found);
            } else if path
                .extension()
                .and_then(|ext| ext.to_str())
                .is_some_and(|ext| extensions.contains(&ext))
            {
                found.push(path);
            }
        }
    }
    let Ok(folder) = std::env::var("FUZZ_FILES") else {
        return Vec::new();
    };
    let mut files = Vec::new();
    collect(Path::new(&folder), extensions, &mut files);
    files.sort();
    let text = |file: PathBuf| {
        std::fs::read(file)
            .ok()
            .map(|bytes| String::from_utf8_lossy(&bytes).into_owned())
    };
    files
        .into_iter()
        .filter_map(text)
        .filter(|text| !text.is_empty())
        .collect()
}
