//! Where along a column of lines the sign of `g` changes on a ball at rest: at a joint of two similar moves that is in a thin lune, and the lines beside
//! it need no look.
//!
//! On the half of the ball above or below its centre, at `(x, y, h)` from it, `g r = x d_x + y d_y + h d_z`. In a column this is the distance from a straight
//! line in the plane of `y` and `h`, so that its sign changes where the line meets the circle of radius `R = √(r² − x²)`.

use super::placed::Neighbour;

/// Of the distance of lines: what is so close to the rim of the ball is looked at in any case,
const RIM: f64 = 2e-3;
/// and all lines of a column with less than this between the line and a tangent.
const TANGENT: f64 = 0.05;

/// The half of a ball between two moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lune {
    radius: f64,
    /// The sign of `h`.
    half: f64,
    line_error: f64,
    /// The distance of lines along a column.
    spacing: f64,
    sides: [Option<Slice>; 2],
}

/// A move.
#[derive(Clone, Copy, Debug)]
struct Slice {
    way: [f64; 3],
    /// `d_y² + d_z²`, and its root.
    square: f64,
    size: f64,
    /// Of `g r`, off the rim.
    error: f64,
}

/// Places along a column, ascending, and how far from each signs are uncertain.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Marks {
    places: [[f64; 2]; 4],
    count: usize,
}

impl Marks {
    fn put(&mut self, y: f64, off: f64) {
        let mut at = self.count;
        while at > 0 && self.places[at - 1][0] > y {
            self.places[at] = self.places[at - 1];
            at -= 1;
        }
        self.places[at] = [y, off];
        self.count += 1;
    }

    pub fn places(&self) -> &[[f64; 2]] {
        &self.places[..self.count]
    }
}

impl Lune {
    /// `line_error`: how far a line may be off; `half`: the sign of `h`.
    pub fn new(radius: f64, half: f64, sides: &[Neighbour; 2], line_error: f64, spacing: f64) -> Self {
        // Beyond the rim, |h| is at least `√(RIM spacing R)` with R ≥ spacing; so the normal turns by no more than this with a line, times the radius.
        let bend = radius / (RIM.sqrt() * spacing);
        let slice = |side: &Neighbour| match *side {
            Neighbour::Beyond(_) => None,
            Neighbour::Along(way) => {
                let [x, y, z] = way.map(f64::abs);
                let rounding = 8.0 * f64::EPSILON * radius * (x + y + z);
                let square = y * y + z * z;
                Some(Slice {
                    way,
                    square,
                    size: square.sqrt(),
                    error: 4.0 * (line_error * ((x + y) * (1.0 + bend) + z * bend) + rounding),
                })
            }
        };
        Self {
            radius,
            half,
            line_error,
            spacing,
            sides: [slice(&sides[0]), slice(&sides[1])],
        }
    }

    /// Where signs may change in the column at `x` from the centre. `None` if all its lines have to tell.
    pub fn marks(&self, x: f64) -> Option<Marks> {
        let square = (self.radius - x) * (self.radius + x);
        if !(square > self.spacing * self.spacing) {
            return None;
        }
        let mut marks = Marks::default();
        for Slice {
            way: [dx, dy, dz],
            square: a,
            size,
            error,
        } in self.sides.iter().flatten()
        {
            let c = -x * dx;
            let rest = a * square - c * c;
            let reach = square.sqrt();
            if rest < 0.0 {
                if !(c.abs() > size * reach + error) {
                    return None;
                }
                continue;
            }
            let least = (a * (TANGENT * self.spacing).powi(2)).max(4.0 * error * reach * size);
            if !(rest > least) {
                return None;
            }
            let w = rest.sqrt();
            let off = 2.0 * error * reach / w + 8.0 * self.line_error;
            if !(off < 0.25 * self.spacing) {
                return None;
            }
            for side in [-1.0, 1.0] {
                let (y, h) = ((c * dy - side * dz * w) / a, (c * dz + side * dy * w) / a);
                // Those of the other half are no harm.
                if h * self.half > -self.spacing {
                    marks.put(y, off);
                }
            }
        }
        Some(marks)
    }

    /// How far from an end of a column in the ball at `y`, or at the edge of a hole there, lines are looked at in any case.
    pub fn margin(&self, y: f64) -> Option<f64> {
        let margin = RIM * self.spacing + 8.0 * self.line_error * (1.0 + self.radius / y.abs());
        (margin < 0.25 * self.spacing).then_some(margin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweepsim_props::*;

    fn side() -> impl Strategy<Value = Neighbour> {
        let part = || prop_oneof![3 => -1.0..1.0_f64, 1 => Just(0.0), 1 => -1e-9..1e-9_f64];
        prop_oneof![
            6 => [part(), part(), part()].prop_map(Neighbour::Along),
            1 => any::<bool>().prop_map(Neighbour::Beyond),
        ]
    }

    proptest! {
        /// Between the marks, and inside the margins of a column, both signs are certain and the same.
        #[test]
        fn signs_change_at_marks_alone(
            sides in [side(), side()], radius in 0.5..20.0_f64, half in prop::sample::select(vec![-1.0, 1.0]),
            x in -1.0..1.0_f64, lines in 3..60_i32, line_error in prop::sample::select(vec![1e-15, 1e-13, 1e-11])
        ) {
            let (spacing, x) = (2.0 * radius / f64::from(lines), x * radius);
            let lune = Lune::new(radius, half, &sides, line_error * radius, spacing);
            let column = (radius * radius - x * x).sqrt();
            let (Some(marks), Some(margin)) = (lune.marks(x), lune.margin(column)) else { return Ok(()) };
            let value = |way: &[f64; 3], y: f64| x * way[0] + y * way[1] + half * (column * column - y * y).sqrt() * way[2];
            let mut before: Option<(f64, Vec<bool>)> = None;
            for n in 0..=4000 {
                let y = (column - margin) * (f64::from(n) / 2000.0 - 1.0);
                if marks.places().iter().any(|[place, off]| (y - place).abs() <= *off) {
                    before = None;
                    continue;
                }
                let mut signs = Vec::new();
                for side in &sides {
                    if let Neighbour::Along(way) = side {
                        let (g, size) = (value(way, y), way[0].abs() + way[1].abs() + way[2].abs());
                        prop_assert!(g.abs() > line_error * radius * size, "{y} {g} {marks:?}");
                        signs.push(g < 0.0);
                    }
                }
                if let Some((last, old)) = before.replace((y, signs.clone())) {
                    let between = marks.places().iter().any(|[place, _]| *place > last && *place < y);
                    prop_assert!(between || old == signs, "{last} {y} {marks:?}");
                }
            }
        }
    }

    /// The test above would pass if no column had marks.
    #[test]
    fn most_columns_have_marks() {
        let sides = [[1.0, 0.1, 0.2], [1.0, 0.15, 0.1]].map(Neighbour::Along);
        let lune = Lune::new(3.0, -1.0, &sides, 1e-13, 0.1);
        let marked = (-29..30).filter(|n| {
            lune.marks(0.1 * f64::from(*n) + 0.01)
                .is_some_and(|marks| marks.count > 0)
        });
        assert!(marked.count() > 8);
        let settled = (-29..30).filter(|n| lune.marks(0.1 * f64::from(*n) + 0.01).is_some());
        assert!(settled.count() > 50);
    }
}
