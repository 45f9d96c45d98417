//! Outlines cut off at a height.

use super::{Profile, ProfileSegment, Shape};

impl Profile {
    /// The outline of the part of the solid below a height. `None` unless exactly one straight segment rises through
    /// that height, with everything before it below and everything after it above: then the section there is one disc.
    ///
    /// ```
    /// use sweepsim_motion::{Profile, ProfileSegment};
    /// // A drill.
    /// let corners = [[3.0, 2.0], [3.0, 20.0], [0.0, 20.0]];
    /// let drill = Profile::new([0.0, 0.0], corners.map(|to| ProfileSegment::Line { to }).into())?;
    /// let ends = |profile: &Profile| profile.segments().to_vec();
    /// let corners = [[3.0, 2.0], [3.0, 5.0], [0.0, 5.0]];
    /// assert_eq!(drill.below(5.0).map(|short| ends(&short)), Some(corners.map(|to| ProfileSegment::Line { to }).into()));
    /// assert_eq!(drill.below(20.0), None);
    /// # Ok::<(), sweepsim_motion::ProfileError>(())
    /// ```
    #[must_use]
    pub fn below(&self, height: f64) -> Option<Self> {
        let pieces = self.pieces();
        let at = pieces
            .iter()
            .position(|piece| matches!(piece.shape, Shape::Line) && piece.from.y < height && piece.to.y > height)?;
        // Control points: their hull holds the curves.
        let beyond = pieces.iter().enumerate().any(|(n, piece)| {
            let points = piece.curves().into_iter().flat_map(|curve| curve.points);
            let mut heights = points.map(|point| point.y);
            n != at && !heights.all(|y| if n < at { y < height } else { y > height })
        });
        if beyond {
            return None;
        }
        let line = &pieces[at];
        let share = (height - line.from.y) / (line.to.y - line.from.y);
        let radius = line.from.x + share * (line.to.x - line.from.x);
        let mut segments = self.segments[..line.segment].to_vec();
        segments.extend([[radius, height], [0.0, height]].map(|to| ProfileSegment::Line { to }));
        Self::checked(self.start, segments).ok()
    }
}
