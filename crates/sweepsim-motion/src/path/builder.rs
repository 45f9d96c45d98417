//! Paths pose by pose, in little memory however long they are.

use super::compact::PackedPoses;
use super::packed_moves::PackedMoves;
use super::{Law, Move, Path, PathError, Poses, Turning, Ways};
use crate::pose::Pose;

/// Shorter paths are kept as they are.
const SHORT: usize = 1 << 12;

/// Makes a [`Path`] pose by pose. A long one is packed: it takes a few bytes a move, from which [`Path::part`] makes
/// any part of it.
///
/// ```
/// use sweepsim_motion::{Law, Move, PathBuilder, Pose};
/// let up = [0.0, 0.0, 1.0];
/// let mut builder = PathBuilder::default();
/// for k in 0..100_000 {
///     builder.push(Pose::new([0.01 * f64::from(k), 0.0, 5.0], up)?, Move::default());
/// }
/// let path = builder.finish(Law::Slerp)?;
/// assert_eq!((path.moves(), path.pose(70_000).tip()[0]), (99_999, 700.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct PathBuilder {
    poses: Vec<Pose>,
    /// Of all moves; empty as long as all are straight, by SLERP.
    moves: Vec<Move>,
    packed: Option<(PackedPoses, Option<PackedMoves>)>,
}

impl PathBuilder {
    /// Adds a pose, and how the tool moves there: for the first pose, that is ignored.
    pub fn push(&mut self, pose: Pose, way: Move) {
        if let Some((poses, ways)) = &mut self.packed {
            if way != Move::default() || ways.is_some() {
                ways.get_or_insert_with(|| straight(poses.len() - 1)).push(&way);
            }
            poses.push(&pose);
            return;
        }
        if let Some(before) = self.poses.len().checked_sub(1)
            && (way != Move::default() || !self.moves.is_empty())
        {
            self.moves.resize(before, Move::default());
            self.moves.push(way);
        }
        self.poses.push(pose);
        if self.poses.len() == SHORT {
            self.pack();
        }
    }

    /// The number of poses so far.
    #[must_use]
    pub fn len(&self) -> usize {
        self.packed.as_ref().map_or(self.poses.len(), |(poses, _)| poses.len())
    }

    /// Whether there is no pose yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn pack(&mut self) {
        let mut poses = PackedPoses::default();
        std::mem::take(&mut self.poses).iter().for_each(|pose| poses.push(pose));
        let moves = std::mem::take(&mut self.moves);
        let ways = (!moves.is_empty()).then(|| packed_ways(moves.into_iter()));
        self.packed = Some((poses, ways));
    }

    /// The path. The tool turns according to `law` if all moves are straight, by SLERP: then they said nothing of it.
    ///
    /// # Errors
    /// As [`Path::with_law`] and [`Path::with_moves`].
    pub fn finish(self, law: Law) -> Result<Path, PathError> {
        let Some((poses, ways)) = self.packed else {
            return if self.moves.is_empty() {
                Path::with_law(self.poses, law)
            } else {
                Path::with_moves(self.poses, self.moves)
            };
        };
        let moves = poses.len() - 1;
        let moves = match (ways, law) {
            (Some(moves), _) => Some(moves),
            (None, Law::Slerp) => None,
            (None, Law::ConstantSpeed) => {
                let even = std::iter::repeat_n(Move::straight(Turning::Even), moves);
                Some(packed_ways(even))
            }
            (None, Law::Rotary(table)) => {
                let mut last = [0.0; 2];
                let mut angles = poses.range(0..poses.len()).map(|pose| {
                    last = table.angles(pose.axis(), last);
                    last
                });
                let mut from = angles.next().unwrap_or_default();
                let turned = angles.map(|to| {
                    let way = Move::straight(Turning::Rotary { table, from, to });
                    from = to;
                    way
                });
                Some(packed_ways(turned))
            }
        };
        let ways = moves.map_or(Ways::Slerp, |moves| Ways::Packed {
            moves: Box::new(moves),
            size: 0.0,
        });
        let mut path = Path::checked_of(Poses::Packed(Box::new(poses)), ways)?;
        if matches!(path.ways, Ways::Packed { .. }) {
            let arcs = path.size_of_arcs();
            if let Ways::Packed { size, .. } = &mut path.ways {
                *size = arcs;
            }
        }
        Ok(path)
    }
}

fn straight(count: usize) -> PackedMoves {
    packed_ways(std::iter::repeat_n(Move::default(), count))
}

fn packed_ways(moves: impl Iterator<Item = Move>) -> PackedMoves {
    let mut ways = PackedMoves::default();
    moves.for_each(|way| ways.push(&way));
    ways
}
