//! What is parallel to the arc's plane or to the dexels, and so moves along itself but where the tip turns back: all of
//! it is met at once.

use super::{Chord, END, Rolling};
use crate::algebra::certain::certainly_within;
use crate::methods::sheets::Undecided::Close;
use crate::methods::sheets::intervals::{Range, scaled};
use sweepsim_dexel::Source;

impl<S: Fn(f64) -> Source> Rolling<'_, '_, S> {
    /// The jump where the velocity along the dexels changes its sign, on what faces up or down.
    fn jump_at_turn(&self, up: f64) -> i8 {
        let [before, after] = self.rates.map(|rate| up * rate < 0.0);
        let change = i8::from(after) - i8::from(before);
        if up > 0.0 { -change } else { change }
    }

    /// A disc or ring of an upright tool, with this normal along the axis: where the tool is highest or lowest.
    pub(super) fn disc(&mut self, height: f64, [inner, outer]: Range, up: f64) {
        let jump = self.jump_at_turn(up);
        if jump == 0 {
            return;
        }
        let (top, share) = self.turn([0.0, 1.0]);
        let [x, y, z] = self.arc.centre;
        let z = z + height + top * self.arc.radius;
        let error = 4.0 * self.slack;
        let radii = [if inner == 0.0 { f64::NEG_INFINITY } else { inner }, outer];
        self.each([x, y, z], [[-outer, outer]; 2], |own, line, [q, p]| {
            if certainly_within((q * q + p * p).sqrt(), radii, error).ok_or(Close)? {
                own.crossing(line, z, jump, [0.0, 0.0, up], share);
            }
            Ok(())
        });
    }

    /// A cylinder of a tool whose axis lies in the arc's plane, with a normal that is `out` across the axis: where the
    /// tool moves along its axis.
    pub(super) fn wall(&mut self, radius: f64, heights: Range, out: f64) {
        let jumps = [out, -out].map(|up| self.jump_at_turn(up));
        if jumps == [0; 2] {
            return;
        }
        let (top, share) = self.turn([0.0, 1.0]);
        let along = scaled(self.axis[0], heights);
        let (slack, wide) = (self.slack, END * self.slack);
        let level = self.arc.centre[2] + top * self.arc.radius;
        let ranges = [[-radius, radius], [along[0] - wide, along[1] + wide]];
        self.each(self.arc.centre, ranges, |own, line, [q, p]| {
            let inside = certainly_within(q, along, wide);
            let Some(Chord { half, certain, .. }) = own.chord(radius, p, slack).filter(|_| inside != Some(false))
            else {
                return Ok(());
            };
            if inside.is_none() || !certain {
                return Err(Close);
            }
            for (jump, side) in jumps.into_iter().zip([1.0, -1.0]) {
                if jump != 0 {
                    let normal = [0.0, out * p, out * side * half];
                    own.crossing(line, level + side * half, jump, normal, share);
                }
            }
            Ok(())
        });
    }
}
