//! Lines whose places on a strip are computed together: by columns of numbers, which processors take two or more at a time.

/// So many.
pub(super) const LANES: usize = 64;

/// Lines that are computed together, of any columns.
pub(super) struct Lanes {
    pub count: usize,
    pub line: [u32; LANES],
    pub p: [f64; LANES],
    pub q: [f64; LANES],
    /// How far `q` is beyond the curve.
    pub ahead: [f64; LANES],
    /// What the curve keeps of each.
    pub own: [f64; LANES],
    /// Whether the strip meets it beyond doubt.
    pub met: [bool; LANES],
    /// Of those that are met: time, height, and the normal in the coordinates of the move and in space.
    pub t: [f64; LANES],
    pub z: [f64; LANES],
    pub normal: [[f64; LANES]; 3],
    pub unit: [[f32; LANES]; 3],
}

impl Default for Lanes {
    fn default() -> Self {
        let none = [0.0; LANES];
        Self {
            count: 0,
            line: [0; LANES],
            p: none,
            q: none,
            ahead: none,
            own: none,
            met: [false; LANES],
            t: none,
            z: none,
            normal: [none; 3],
            unit: [[0.0; LANES]; 3],
        }
    }
}

impl Lanes {
    /// Adds lines from this one on, with these values of `y`: as many as there is room for, and returns how many.
    #[inline]
    pub fn add(&mut self, line: u32, y: &[f64], place: impl Fn(f64) -> [f64; 2]) -> usize {
        let places = self.p[self.count..].iter_mut().zip(&mut self.q[self.count..]);
        for ((p, q), y) in places.zip(y) {
            [*p, *q] = place(*y);
        }
        for (own, line) in self.line[self.count..].iter_mut().zip(line..).take(y.len()) {
            *own = line;
        }
        let added = y.len().min(LANES - self.count);
        self.count += added;
        added
    }
}
