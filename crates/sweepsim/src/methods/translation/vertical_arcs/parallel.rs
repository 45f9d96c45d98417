//! Cones and tori of an upright tool along an arc in a plane along the dexels: the curves parallel to their sections, at the distance of the arc's radius.
//!
//! For one line the unknown is `v`, the place in the section ahead of the tool's axis or, mirrored, behind it.

use super::roots::{Open, Root, Search};
use super::sheet::{Parallel, Sheet, SheetPoint};
use super::{ArcPlace, Directions, ROUNDING, Rolling};
use sweepsim_dexel::Source;

/// Directions of the arc that are this close to level may be on the other side.
const LEVEL: f64 = 1e-6;

impl<S: Fn(f64) -> Source> Rolling<'_, '_, S> {
    /// The lines that a cone or a torus passes.
    pub(super) fn sheet(&mut self, sheet: &Sheet) {
        let arc = self.arc;
        let outer = sheet.radii[1];
        let [low, high] = self.directions[0].map(|cosine| arc.radius * cosine);
        let [_, sines] = self.directions;
        // `(cos α, sin α)` is the normal of the section, or its opposite.
        let sides: Vec<f64> = [1.0, -1.0]
            .into_iter()
            .filter(|side| {
                if side * sheet.up > 0.0 {
                    sines[1] > -LEVEL
                } else {
                    sines[0] < LEVEL
                }
            })
            .collect();
        let ranges = [[-outer, outer], [low - outer, high + outer]];
        self.each(arc.centre, ranges, |own, (i, j), place| {
            let mark = own.lines.mark();
            for side in &sides {
                if own.over(sheet, *side, (i, j), place).is_err() {
                    own.lines.forget(mark);
                    own.lines.open(own.lines.lines.line(i, j));
                    return;
                }
            }
        });
    }

    #[inline]
    fn over(&mut self, sheet: &Sheet, side: f64, (i, j): (usize, usize), [q, p]: [f64; 2]) -> Result<(), Open> {
        let (r, [inner, outer]) = (self.arc.radius, sheet.radii);
        let slack = self.slack.max(16.0 * f64::EPSILON * outer);
        let doubt = 8.0 * slack * (outer + slack);
        let half_chord_sq = (outer - p) * (outer + p);
        if half_chord_sq < -doubt {
            return Ok(());
        }
        // The ends of the section, at least and at most.
        let root = |square: f64| square.max(0.0).sqrt();
        let to = [root(half_chord_sq - doubt), root(half_chord_sq + doubt)];
        let half_chord_sq = (inner - p) * (inner + p);
        let from = if inner == 0.0 {
            [0.0; 2]
        } else {
            [root(half_chord_sq - doubt), root(half_chord_sq + doubt)]
        };
        let parallel = Parallel {
            sheet,
            p,
            r,
            side,
            slack,
        };
        let [positive, negative] = sheet.sides().map(|certain| if certain { 0.0 } else { 1.0 });
        let margin = 8.0 * slack + ROUNDING * r;
        for mirror in [1.0, -1.0] {
            // Of `side ν`, which is `mirror cos α`.
            let cosines = self.directions[0].map(|cosine| mirror * cosine);
            let normals = if side > 0.0 {
                [-positive, negative]
            } else {
                [-negative, positive]
            };
            let low = cosines[0].min(cosines[1]).max(normals[0]);
            let high = cosines[0].max(cosines[1]).min(normals[1]);
            let y = mirror * q;
            let clip = [y - r * high - margin, y - r * low + margin];
            if !(low <= high + ROUNDING) || clip[1] < from[0] || clip[0] > to[1] {
                continue;
            }
            let search = Search {
                curve: parallel,
                y,
                mirror,
            };
            search.roots([from, to], clip, |root| self.root(&search, root, (i, j)))?;
        }
        Ok(())
    }

    fn root(&mut self, search: &Search<Parallel>, root: Root<SheetPoint>, (i, j): (usize, usize)) -> Result<(), Open> {
        let Search {
            curve: parallel,
            y,
            mirror,
        } = search;
        let (side, r, sheet) = (parallel.side, parallel.r, parallel.sheet);
        let Root { at, error, grows } = root;
        let cosine = mirror * side * at.nu;
        let off = (at.q - y).abs() + 2.0 * parallel.slack + error;
        let (sine, error) = match self.directions(cosine, off / r) {
            Directions::None | Directions::Level(false) => return Ok(()),
            Directions::Level(true) => return Err(Open),
            Directions::Pair(sine, error) => (side * sheet.up * sine, error),
        };
        let share = match self.place([cosine, sine], error) {
            ArcPlace::Outside => return Ok(()),
            ArcPlace::Near => return Err(Open),
            ArcPlace::Inside(share) => share,
        };
        let z = self.arc.centre[2] + r * sine + sheet.height(&at);
        let jump = if (sine > 0.0) == grows { -1 } else { 1 };
        let across = sheet.out * at.e / at.rho;
        let up = sheet.out * sheet.up * at.square.sqrt();
        let normal = self.in_space([across * mirror * at.v, across * parallel.p, up]);
        let source = (self.source)(share);
        self.lines
            .crossing(self.lines.lines.line(i, j), z, jump, normal, source);
        Ok(())
    }
}
