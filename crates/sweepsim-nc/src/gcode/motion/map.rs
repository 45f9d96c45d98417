//! Affine maps between coordinate systems, of which some coordinates may be unknown.

/// `x ↦ matrix x + add`; without a matrix, a translation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Map {
    pub matrix: Option<[[f64; 3]; 3]>,
    pub add: [f64; 3],
}

type Matrix = [[f64; 3]; 3];

fn times(matrix: &Matrix, x: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| matrix[i][0] * x[0] + matrix[i][1] * x[1] + matrix[i][2] * x[2])
}

fn determinant(m: &Matrix) -> f64 {
    m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
}

/// The inverse; `None` for a matrix without one.
fn inverse(m: &Matrix) -> Option<Matrix> {
    let determinant = determinant(m);
    if determinant == 0.0 || !determinant.is_finite() {
        return None;
    }
    let minor = |i: usize, j: usize| {
        let (a, b) = ((i + 1) % 3, (i + 2) % 3);
        let (c, d) = ((j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    Some(std::array::from_fn(|i| {
        std::array::from_fn(|j| minor(j, i) / determinant)
    }))
}

impl Map {
    pub(crate) fn shift(add: [f64; 3]) -> Self {
        Self { matrix: None, add }
    }

    /// A linear map about a point that stays.
    pub(crate) fn about(matrix: Matrix, centre: [f64; 3]) -> Self {
        let turned = times(&matrix, centre);
        Self {
            matrix: Some(matrix),
            add: std::array::from_fn(|k| centre[k] - turned[k]),
        }
    }

    /// A turn about the axis `w` of a plane `[u, v, w]`, in degrees; counter-clockwise from u to v.
    pub(crate) fn turn([u, v, w]: [usize; 3], degrees: f64) -> Self {
        if degrees == 0.0 {
            return Self::default();
        }
        let (sin, cos) = degrees.to_radians().sin_cos();
        let mut matrix = [[0.0; 3]; 3];
        matrix[u][u] = cos;
        matrix[u][v] = -sin;
        matrix[v][u] = sin;
        matrix[v][v] = cos;
        matrix[w][w] = 1.0;
        Self {
            matrix: Some(matrix),
            add: [0.0; 3],
        }
    }

    pub(crate) fn is_shift(&self) -> bool {
        self.matrix.is_none()
    }

    pub(crate) fn apply(&self, x: [f64; 3]) -> [f64; 3] {
        let turned = match &self.matrix {
            Some(matrix) => times(matrix, x),
            None => x,
        };
        std::array::from_fn(|k| turned[k] + self.add[k])
    }

    /// A direction's image.
    pub(crate) fn apply_direction(&self, x: [f64; 3]) -> [f64; 3] {
        match &self.matrix {
            Some(matrix) => times(matrix, x),
            None => x,
        }
    }

    /// First `inner`, then this.
    pub(crate) fn after(&self, inner: &Self) -> Self {
        let matrix = match (&self.matrix, &inner.matrix) {
            (None, inner) => *inner,
            (Some(outer), None) => Some(*outer),
            (Some(outer), Some(inner)) => Some(std::array::from_fn(|i| {
                std::array::from_fn(|j| (0..3).map(|k| outer[i][k] * inner[k][j]).sum())
            })),
        };
        Self {
            matrix,
            add: self.apply(inner.add),
        }
    }

    /// `None` if it has none.
    pub(crate) fn inverse(&self) -> Option<Self> {
        let Some(matrix) = &self.matrix else {
            return Some(Self::shift(self.add.map(|x| -x)));
        };
        let matrix = inverse(matrix)?;
        Some(Self {
            matrix: Some(matrix),
            add: times(&matrix, self.add).map(|x| -x),
        })
    }

    /// The image of a point of which some coordinates may be unknown.
    pub(crate) fn partial(&self, x: [Option<f64>; 3]) -> [Option<f64>; 3] {
        std::array::from_fn(|i| match &self.matrix {
            None => x[i].map(|x| x + self.add[i]),
            Some(matrix) => {
                let mut sum = self.add[i];
                for (factor, x) in matrix[i].iter().zip(x) {
                    if *factor != 0.0 {
                        sum += factor * x?;
                    }
                }
                Some(sum)
            }
        })
    }

    /// The factor by which it changes all lengths, negative if it mirrors; `None` if that depends on the direction.
    pub(crate) fn scale(&self) -> Option<f64> {
        let Some(matrix) = &self.matrix else { return Some(1.0) };
        let scale = determinant(matrix).cbrt();
        let square = scale * scale;
        for i in 0..3 {
            for j in 0..3 {
                let dot: f64 = (0..3).map(|k| matrix[k][i] * matrix[k][j]).sum();
                let expected = if i == j { square } else { 0.0 };
                if (dot - expected).abs() > 1e-9 * square.max(1e-9) {
                    return None;
                }
            }
        }
        Some(scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverses_and_products() {
        let turn = Map::turn([0, 1, 2], 30.0);
        let map = Map::shift([1.0, 2.0, 3.0])
            .after(&turn)
            .after(&Map::shift([5.0, 0.0, 0.0]));
        let x = [0.3, -4.0, 2.5];
        let back = map.inverse().unwrap().apply(map.apply(x));
        assert!((0..3).all(|k| (back[k] - x[k]).abs() < 1e-12), "{back:?}");
        assert!((turn.scale().unwrap() - 1.0).abs() < 1e-12);
        let mirror = Map::about([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [5.0, 0.0, 0.0]);
        assert_eq!(mirror.apply([6.0, 1.0, 2.0]), [4.0, 1.0, 2.0]);
        assert!((mirror.scale().unwrap() + 1.0).abs() < 1e-12);
        assert_eq!(
            Map::about([[2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.0; 3]).scale(),
            None
        );
        // A turn about Z needs both X and Y.
        assert_eq!(turn.partial([Some(1.0), None, Some(2.0)]), [None, None, Some(2.0)]);
        assert_eq!(map.inverse().unwrap().partial([None, None, Some(4.0)])[2], Some(1.0));
    }
}
