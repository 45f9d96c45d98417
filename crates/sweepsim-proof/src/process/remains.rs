//! What is left of the stock at a time, for bodies that are no part of a tool.

use super::history::{History, Moment};
use super::samples::Samples;
use super::scene::Work;
use super::search::{Cut, cuts};
use crate::excess::{Before, Course};
use crate::tool::Convex;
use nalgebra::Vector3;
use sweepsim_dexel::{MeshError, Stock};

/// What is left of a stock at any time of a program, as far as it is certain.
pub struct Remains<'a> {
    history: History<'a>,
    cuts: &'a [Cut],
    /// Segments are so far from their path, and rounding is allowed for.
    margin: f64,
}

impl Remains<'_> {
    /// What is left of a stock that cutters cut along their paths, which are followed within a deviation; for as long
    /// as `then` asks for it. `None` of an empty stock.
    ///
    /// # Errors
    /// The stock has too many vertices.
    pub fn of<T>(
        stock: &Stock,
        work: &[Work],
        deviation: f64,
        then: impl FnOnce(&Remains) -> T,
    ) -> Result<Option<T>, MeshError> {
        let Some(bounds) = stock.bounds() else {
            return Ok(None);
        };
        let solids: Vec<Vec<Convex>> = work.iter().map(|own| own.cutter.solids.to_vec()).collect();
        let (cuts, rounding) = cuts(work, &solids, deviation, bounds.map(Vector3::from));
        let courses = work.iter().zip(&cuts);
        let history = History {
            before: Before::new(stock, 0.0)?,
            courses: courses
                .map(|(own, cut)| Course::new(own.cutter.solids, &cut.stretches, rounding))
                .collect(),
        };
        Ok(Some(then(&Remains {
            history,
            cuts: &cuts,
            margin: 2.0 * deviation + rounding,
        })))
    }

    /// Whether the hull of some points has no material from a time of a move of a path on, for certain.
    #[must_use]
    pub fn is_gone(&self, corners: &[[f64; 3]], (path, number, time): (usize, usize, f64)) -> bool {
        let corners = corners.iter().map(|corner| Vector3::from(*corner)).collect();
        let near = self.history.before.near(corners, self.margin);
        let Some(first) = near.first() else { return true };
        let centre = near.iter().sum::<Vector3<f64>>() / near.len() as f64;
        let normal = (first - centre).try_normalize(0.0).unwrap_or_else(Vector3::z);
        if self.history.before.is_beside(&near, &normal, self.margin) {
            return true;
        }
        let cut = self.cuts[path].before(number, time);
        let moment = Moment {
            path,
            cut,
            during: None,
        };
        let (_, holder, _) = self.history.held(&Samples::of_points(&near), moment, self.margin);
        holder.is_some()
    }

    /// Whether all of the hull of some points is still in material when a move of a path has ended, for certain.
    #[must_use]
    pub fn is_whole(&self, corners: &[[f64; 3]], (path, number): (usize, usize)) -> bool {
        let corners = corners.iter().map(|corner| Vector3::from(*corner));
        let centre = corners.clone().sum::<Vector3<f64>>() / corners.len() as f64;
        let radius = corners
            .clone()
            .map(|corner| (corner - centre).norm())
            .fold(0.0, f64::max);
        let moment = Moment {
            path,
            cut: self.cuts[path].before(number + 1, 0.0),
            during: None,
        };
        self.history.is_whole(corners, &centre, moment, radius + self.margin)
    }

    /// Whether a point is still in material when a move of a path has ended, for certain.
    #[must_use]
    pub fn is_left(&self, point: [f64; 3], (path, number): (usize, usize)) -> bool {
        let cut = self.cuts[path].before(number + 1, 0.0);
        let moment = Moment {
            path,
            cut,
            during: None,
        };
        self.history.is_material(&Vector3::from(point), moment, self.margin)
    }
}
