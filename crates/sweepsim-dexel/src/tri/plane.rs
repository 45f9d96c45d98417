//! Where tangent planes meet.

use super::lattice::Hit;
use smallvec::SmallVec;

/// Points of a surface with their tangent planes.
#[derive(Default)]
pub(super) struct Planes {
    points: SmallVec<[([f64; 3], [f64; 3]); 8]>,
    /// Points whose normal is not known.
    bare: Vec<[f64; 3]>,
    cut: bool,
}

/// Where the vertices of a cell are held: nearer and nearer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Place {
    /// Half a cell beyond it, at most.
    Half,
    /// In the cell.
    Cell,
    /// In the middle of the ends.
    Middle,
}

impl Place {
    /// The next nearer one.
    pub fn nearer(self) -> Self {
        match self {
            Self::Half => Self::Cell,
            Self::Cell | Self::Middle => Self::Middle,
        }
    }
}

/// Directions in which the planes' normals spread by less than this (as a sine) do not determine where the planes meet.
const SPREAD: f64 = 0.1;

/// How far beyond its cell, in cells, a vertex may be. The vertex of a cell follows an edge of the solid that passes
/// close by; so do its neighbours, and their triangles are thin.
const BEYOND: f64 = 1.0;
/// The same of one that is held inside.
const WITHIN: f64 = -1.0 / 64.0;
/// The weight of the squared distance from the middle, relative to those from the planes, if the vertex is held near
/// its cell.
const WEIGHT: f64 = 1e-3;
/// The number of passes over the coordinates in that case.
const SWEEPS: usize = 40;

impl Planes {
    pub fn add(&mut self, place: [f64; 3], hit: &Hit) {
        match hit.normal {
            Some(normal) => self.points.push((place, normal.map(f64::from))),
            None => self.bare.push(place),
        }
        self.cut |= hit.cut;
    }

    pub fn is_cut(&self) -> bool {
        self.cut
    }

    /// The mean of the points.
    fn middle(&self) -> [f64; 3] {
        let places = || self.points.iter().map(|(place, _)| place).chain(&self.bare);
        let count = places().count().max(1) as f64;
        [0, 1, 2].map(|c| places().map(|p| p[c]).sum::<f64>() / count)
    }

    /// The mean direction; up, if there is none.
    pub fn normal(&self) -> [f32; 3] {
        let sum = [0, 1, 2].map(|c| self.points.iter().map(|(_, n)| n[c]).sum::<f64>());
        let length = sum.iter().map(|c| c * c).sum::<f64>().sqrt();
        if length > 1e-9 {
            sum.map(|c| (c / length) as f32)
        } else {
            [0.0, 0.0, 1.0]
        }
    }

    /// The vertex of a cell, or on a face, between its lower and upper corner. `place`: where it is held.
    pub fn vertex(&self, [lower, upper]: [[f64; 3]; 2], place: Option<Place>) -> [f64; 3] {
        match place {
            None => self.meet(lower, upper, BEYOND),
            Some(Place::Half) => self.meet(lower, upper, 0.5),
            Some(Place::Cell) => self.meet(lower, upper, WITHIN),
            Some(Place::Middle) => self.middle(),
        }
    }

    /// The least-squares point of the planes, displaced from the [middle](Self::middle) only in directions that the
    /// planes determine; if that is `beyond` the box by more than so many of its sizes, the best point within that.
    fn meet(&self, lower: [f64; 3], upper: [f64; 3], beyond: f64) -> [f64; 3] {
        let middle = self.middle();
        // AᵀA and Aᵀb of the normals, with b as distances from the middle.
        let (mut a, mut b) = ([[0.0; 3]; 3], [0.0; 3]);
        for (p, n) in &self.points {
            let distance: f64 = (0..3).map(|c| n[c] * (p[c] - middle[c])).sum();
            for r in 0..3 {
                b[r] += n[r] * distance;
                for c in 0..3 {
                    a[r][c] += n[r] * n[c];
                }
            }
        }
        // A face instead of a cell: the vertex stays in it.
        for c in 0..3 {
            if lower[c] == upper[c] {
                a[c] = [0.0; 3];
                a.iter_mut().for_each(|row| row[c] = 0.0);
                b[c] = 0.0;
            }
        }
        let directions = eigen(a);
        let told = directions
            .iter()
            .take_while(|(value, _)| *value > SPREAD * SPREAD * directions[0].0.max(f64::MIN_POSITIVE))
            .count();
        let mut place = middle;
        for (value, v) in &directions[..told] {
            let along = (0..3).map(|c| v[c] * b[c]).sum::<f64>() / value;
            place = [0, 1, 2].map(|c| place[c] + along * v[c]);
        }
        let beyond = |c: usize| beyond * (upper[c] - lower[c]);
        let bounds = [0, 1, 2].map(|c| [lower[c] - beyond(c) - middle[c], upper[c] + beyond(c) - middle[c]]);
        let off = [0, 1, 2].map(|c| place[c] - middle[c]);
        if (0..3).all(|c| bounds[c][0] <= off[c] && off[c] <= bounds[c][1]) {
            return place;
        }
        let nearest = minimiser(a, b, bounds, WEIGHT * directions[0].0);
        [0, 1, 2].map(|c| middle[c] + nearest[c])
    }
}

/// Minimises `xᵀAx − 2bᵀx + weight·xᵀx` within bounds around 0, one coordinate after the other, which converges for
/// convex functions.
fn minimiser(a: [[f64; 3]; 3], b: [f64; 3], bounds: [[f64; 2]; 3], weight: f64) -> [f64; 3] {
    let mut x = [0.0; 3];
    for _ in 0..SWEEPS {
        for c in 0..3 {
            let others: f64 = (0..3).filter(|d| *d != c).map(|d| a[c][d] * x[d]).sum();
            let best = (b[c] - others) / (a[c][c] + weight).max(f64::MIN_POSITIVE);
            x[c] = best.clamp(bounds[c][0].min(0.0), bounds[c][1].max(0.0));
        }
    }
    x
}

/// Eigenvalues of a symmetric matrix in decreasing order, with unit eigenvectors, by Jacobi rotations.
fn eigen(mut a: [[f64; 3]; 3]) -> [(f64, [f64; 3]); 3] {
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    // Entries this small relative to the trace of a positive semidefinite matrix are rounding errors.
    let small = f64::EPSILON * (a[0][0] + a[1][1] + a[2][2]) / 4.0;
    // Convergence is quadratic: five sweeps are enough for double precision.
    for _ in 0..8 {
        if [a[0][1], a[0][2], a[1][2]].iter().all(|off| off.abs() <= small) {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q].abs() <= small {
                continue;
            }
            // Below 1/small, so that the square does not overflow.
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            for row in &mut a {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            for k in 0..3 {
                (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
                (v[p][k], v[q][k]) = (c * v[p][k] - s * v[q][k], s * v[p][k] + c * v[q][k]);
            }
        }
    }
    let mut pairs = [0, 1, 2].map(|k| (a[k][k], v[k]));
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
    pairs
}

#[cfg(test)]
mod tests {
    use super::eigen;

    #[test]
    fn eigenvectors_are_those_of_the_matrix() {
        let a = [[4.0, 1.0, -2.0], [1.0, 3.0, 0.5], [-2.0, 0.5, 1.0]];
        for (value, v) in eigen(a) {
            for r in 0..3 {
                let image: f64 = (0..3).map(|c| a[r][c] * v[c]).sum();
                assert!((image - value * v[r]).abs() < 1e-12);
            }
            assert!((v.iter().map(|c| c * c).sum::<f64>() - 1.0).abs() < 1e-12);
        }
        assert_eq!(eigen([[0.0; 3]; 3]).map(|(value, _)| value), [0.0; 3]);
    }
}
