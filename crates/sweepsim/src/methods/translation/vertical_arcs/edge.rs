//! A sharp edge of an upright tool along an arc in a plane along the dexels.

use super::{ArcPlace, Directions, Rolling};
use crate::cutter::outline::Rim;
use sweepsim_dexel::Source;

impl<S: Fn(f64) -> Source> Rolling<'_, '_, S> {
    /// The lines that the circle passes.
    pub(super) fn rim(&mut self, rim: &Rim) {
        let [x, y, z] = self.arc.centre;
        let (r, big) = (self.arc.radius, rim.radius);
        let [low, high] = self.directions[0].map(|cosine| r * cosine);
        let level = z + rim.height;
        self.each(
            [x, y, level],
            [[-big, big], [low - big, high + big]],
            |own, place, line| {
                own.edge(rim, level, place, line);
            },
        );
    }

    #[inline]
    fn edge(&mut self, rim: &Rim, level: f64, (i, j): (usize, usize), [q, p]: [f64; 2]) {
        let (slack, r, big) = (self.slack, self.arc.radius, rim.radius);
        let half_chord_sq = (big - p) * (big + p);
        let line = self.lines.lines.line(i, j);
        let doubt = 8.0 * slack * (big + slack);
        if half_chord_sq < -doubt {
            return;
        }
        if !(half_chord_sq > 64.0 * doubt) {
            let wide = (66.0 * doubt).sqrt() + 4.0 * slack;
            let [low, high] = self.directions[0].map(|cosine| r * cosine);
            if q > low - wide && q < high + wide {
                self.lines.open(line);
            }
            return;
        }
        let half = half_chord_sq.sqrt();
        let off = 2.0 * slack * (1.0 + p.abs() / half);
        for arm in [half, -half] {
            let cosine = (q - arm) / r;
            let (sine, error) = match self.directions(cosine, (2.0 * slack + off) / r) {
                Directions::None | Directions::Level(false) => continue,
                Directions::Level(true) => {
                    self.lines.open(line);
                    return;
                }
                Directions::Pair(sine, error) => (sine, error),
            };
            for sine in [sine, -sine] {
                let share = match self.place([cosine, sine], error) {
                    ArcPlace::Outside => continue,
                    ArcPlace::Near => {
                        self.lines.open(line);
                        return;
                    }
                    ArcPlace::Inside(share) => share,
                };
                let side = self.arc.side();
                // The direction of the motion, on the edge outwards and up.
                let (ahead, up) = (-side * sine, side * cosine);
                let out = arm * ahead / big;
                let doubt = 2.0 * (off / big + error) + 16.0 * f64::EPSILON;
                let Some(envelope) = rim.envelope([out, up], doubt) else {
                    self.lines.open(line);
                    return;
                };
                let Some(([radial, along], first)) = envelope else {
                    continue;
                };
                // The line comes into the circle if it is in front of its centre.
                let orientation = if out > 0.0 { -1 } else { 1 };
                let jump = if first { -orientation } else { orientation };
                let normal = self.in_space([radial * arm / big, radial * p / big, along]);
                let source = (self.source)(share);
                self.lines.crossing(line, level + r * sine, jump, normal, source);
            }
        }
    }
}
