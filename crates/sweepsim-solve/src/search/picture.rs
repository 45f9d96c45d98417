//! Pictures of a subdivision: every box with its fate, as SVG.

use super::Fate;
use crate::{Enclosure, Monitor};
use std::fmt::Write;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A box with the number of splits above it.
type Drawn = ([Enclosure; 2], u32, Fate);

/// Watches a search and draws two of its variables.
///
/// ```
/// use sweepsim_solve::{Bernstein, Enclosure, Picture, PointSolver, System};
///
/// let circle = Bernstein::from_fn(&[2, 2], |i| [1.0, -1.0, 1.0][i[0]] + [1.0, -1.0, 1.0][i[1]] - 0.25)?;
/// let diagonal = Bernstein::variable(2, 1).sub(&Bernstein::variable(2, 0));
/// let system = System::mapped(&[Enclosure::new(-1.0, 1.0)?; 2], [&circle, &diagonal])?;
/// let mut picture = Picture::new([0, 1]);
/// let points = PointSolver::default().solve(&system, &picture)?;
/// points.roots.iter().for_each(|root| picture.mark(&root.point));
/// let svg = picture.svg(600.0);
/// assert!(svg.starts_with("<svg") && svg.contains("<circle"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Default)]
pub struct Picture {
    axes: [usize; 2],
    boxes: Mutex<Vec<Drawn>>,
    marks: Vec<[f64; 2]>,
    lines: Vec<Vec<[f64; 2]>>,
}

impl Picture {
    /// A picture of these two variables, the first to the right, the second upwards.
    #[must_use]
    pub fn new(axes: [usize; 2]) -> Self {
        Self {
            axes,
            ..Self::default()
        }
    }

    /// The boxes so far. A thread that panicked while it held the lock cannot have left half a box behind.
    fn boxes(&self) -> MutexGuard<'_, Vec<Drawn>> {
        self.boxes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a dot.
    pub fn mark(&mut self, point: &[f64]) {
        let [a, b] = self.axes;
        if let (Some(x), Some(y)) = (point.get(a), point.get(b)) {
            self.marks.push([*x, *y]);
        }
    }

    /// Adds a polyline.
    pub fn line<'a>(&mut self, points: impl IntoIterator<Item = &'a [f64]>) {
        let [a, b] = self.axes;
        let pick = |p: &[f64]| Some([*p.get(a)?, *p.get(b)?]);
        self.lines.push(points.into_iter().filter_map(pick).collect());
    }

    /// The picture, `size` wide or high, whichever is more.
    #[must_use]
    pub fn svg(&self, size: f64) -> String {
        let mut span = [(f64::INFINITY, f64::NEG_INFINITY); 2];
        let boxes = self.boxes();
        let all = boxes.iter().map(|b| b.0);
        let dots = self.marks.iter().chain(self.lines.iter().flatten());
        for b in all.chain(dots.map(|m| m.map(|x| Enclosure::hull(x, x)))) {
            for (s, side) in span.iter_mut().zip(b) {
                *s = (s.0.min(side.lo()), s.1.max(side.hi()));
            }
        }
        let width = span.map(|(lo, hi)| if hi > lo { hi - lo } else { 1.0 });
        let scale = size / width[0].max(width[1]);
        let (w, h) = (width[0] * scale, width[1] * scale);
        let place = |x: f64, y: f64| ((x - span[0].0) * scale, h - (y - span[1].0) * scale);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w:.1}\" height=\"{h:.1}\" viewBox=\"-4 -4 {:.1} {:.1}\">\n",
            w + 8.0,
            h + 8.0
        );
        for (bounds, depth, fate) in boxes.iter() {
            let (x, y) = place(bounds[0].lo(), bounds[1].hi());
            let (w, h) = (
                (bounds[0].hi() - bounds[0].lo()) * scale,
                (bounds[1].hi() - bounds[1].lo()) * scale,
            );
            let fill = match fate {
                Fate::Sign => "#dce6f0",
                Fate::Linear => "#c3d8ea",
                Fate::Projection => "#a9c6df",
                Fate::Elsewhere => "#e6e0f0",
                Fate::Certified => "#b7e3b0",
                Fate::Unresolved => "#f2a59a",
                Fate::Split => "none",
            };
            // Writing to a string cannot fail.
            let _ = writeln!(
                svg,
                "<rect x=\"{x:.3}\" y=\"{y:.3}\" width=\"{w:.3}\" height=\"{h:.3}\" fill=\"{fill}\" stroke=\"#456\" stroke-width=\"0.4\">\
                 <title>{fate:?}, depth {depth}</title></rect>"
            );
        }
        for line in &self.lines {
            let points: Vec<String> = line
                .iter()
                .map(|p| {
                    let (x, y) = place(p[0], p[1]);
                    format!("{x:.3},{y:.3}")
                })
                .collect();
            let _ = writeln!(
                svg,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"#a22\" stroke-width=\"1.2\"/>",
                points.join(" ")
            );
        }
        for mark in &self.marks {
            let (x, y) = place(mark[0], mark[1]);
            let _ = writeln!(svg, "<circle cx=\"{x:.3}\" cy=\"{y:.3}\" r=\"2.5\" fill=\"#a22\"/>");
        }
        svg.push_str("</svg>\n");
        svg
    }
}

impl Monitor for Picture {
    fn visits(&self) -> bool {
        true
    }

    fn visit(&self, bounds: &[Enclosure], depth: u32, fate: Fate) {
        let [a, b] = self.axes;
        if let (Some(x), Some(y)) = (bounds.get(a), bounds.get(b)) {
            self.boxes().push(([*x, *y], depth, fate));
        }
    }
}
