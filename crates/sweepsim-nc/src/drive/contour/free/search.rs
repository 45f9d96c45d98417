//! The contours that fit what all blocks say.

use super::carrier::{Carrier, Flat, SAME, distance, minus};
use super::element::{Before, Element, Given, Solved};

/// So many steps are tried.
const MOST_STEPS: usize = 20_000;
/// So many contours are compared.
const MOST_CONTOURS: usize = 1024;
/// Of the shortest ones it is known whether they cross themselves.
const MOST_LOOKED_AT: usize = 64;
/// Into so many chords an element is divided to see whether the contour crosses itself.
const CHORDS: usize = 24;

/// Why no contour was found: the number of the element, and whether it is not determined, rather than impossible.
pub(crate) struct Unsolved {
    pub number: usize,
    pub is_open: bool,
    pub steps: usize,
}

/// The contour that is taken of those that fit, and how many they are.
pub(crate) struct Found {
    pub contour: Vec<Solved>,
    pub crosses_itself: bool,
    pub count: usize,
    pub steps: usize,
}

impl Found {
    /// Whether there may be more.
    pub fn may_be_more(&self) -> bool {
        self.count >= MOST_CONTOURS
    }
}

/// The shortest contour that fits and does not cross itself; if all do, the shortest.
pub(crate) fn contour(elements: &[Element], start: Flat, way: Option<Flat>) -> Result<Found, Unsolved> {
    let mut search = Search {
        elements,
        done: Vec::new(),
        found: Vec::new(),
        steps: 0,
        stuck: Unsolved {
            number: 0,
            is_open: true,
            steps: 0,
        },
    };
    search.step(Before::At(start, way));
    let length = |contour: &Vec<Solved>| contour.iter().map(Solved::length).sum::<f64>();
    let mut all = search.found;
    all.sort_by(|a, b| length(a).total_cmp(&length(b)));
    let count = all.len();
    let simple = all
        .iter()
        .take(MOST_LOOKED_AT)
        .position(|contour| !crosses_itself(contour));
    let taken = all.into_iter().nth(simple.unwrap_or(0));
    Ok(Found {
        contour: taken.ok_or(Unsolved {
            steps: search.steps,
            ..search.stuck
        })?,
        crosses_itself: simple.is_none(),
        count,
        steps: search.steps,
    })
}

struct Search<'a> {
    elements: &'a [Element],
    /// The end of the last one may be open: then it is its start.
    done: Vec<Solved>,
    found: Vec<Vec<Solved>>,
    steps: usize,
    stuck: Unsolved,
}

impl Search<'_> {
    /// The farthest element counts.
    fn stop(&mut self, is_open: bool) {
        let number = self.done.len().min(self.elements.len().saturating_sub(1));
        if number > self.stuck.number || (number == self.stuck.number && is_open) || self.steps <= 1 {
            (self.stuck.number, self.stuck.is_open) = (number, is_open);
        }
    }

    fn given<'e>(&self, element: &'e Element, before: &Before) -> Given<'e> {
        let of = |number: u32| {
            let place = self.elements.iter().position(|one| one.number == Some(number))?;
            // An end that is open is no place to count from.
            let last_is_open = matches!(before, Before::On(..)) && place + 1 == self.done.len();
            self.done.get(place).copied().filter(|_| !last_is_open)
        };
        Given::new(element, before, of)
    }

    fn step(&mut self, before: Before) {
        self.steps += 1;
        if self.steps > MOST_STEPS || self.found.len() >= MOST_CONTOURS {
            return;
        }
        let number = self.done.len();
        let Some(element) = self.elements.get(number) else {
            self.finish(before);
            return;
        };
        let own = self.given(element, &before);
        let next = self.elements.get(number + 1);
        let carriers = own.carriers(&before, None).or_else(|| {
            // What comes after may determine it.
            let next = next.filter(|next| next.tangential)?;
            let nexts = self.given(next, &Before::Unknown).carriers(&Before::Unknown, None)?;
            let all: Option<Vec<Vec<Carrier>>> = nexts.iter().map(|next| own.carriers(&before, Some(next))).collect();
            Some(all?.into_iter().flatten().collect())
        });
        let Some(carriers) = carriers else {
            self.stop(true);
            return;
        };
        let tried = self.found.len();
        for carrier in carriers {
            for joint in joints(&before, &carrier, element.tangential) {
                self.go_on(element, before, carrier, joint);
            }
        }
        if self.found.len() == tried {
            self.stop(false);
        }
    }

    /// Goes on along a carrier from a joint.
    fn go_on(&mut self, element: &Element, before: Before, carrier: Carrier, joint: Flat) {
        let last = self.done.last().copied();
        if let (Before::On(..), Some(last)) = (before, self.done.last_mut()) {
            last.end = joint;
        }
        let way = match before {
            Before::At(_, way) => way,
            _ => last.map(|last| last.carrier.direction(joint)),
        };
        let own = self.given(element, &Before::At(joint, way));
        let ends = own.agrees(&carrier, joint).then(|| own.ends(&carrier, joint));
        let solved = |end: Flat| Solved {
            carrier,
            start: joint,
            end,
        };
        match ends {
            None => {}
            Some(None) => {
                self.done.push(solved(joint));
                self.step(Before::On(carrier, joint));
                self.done.pop();
            }
            Some(Some(ends)) => {
                for end in ends {
                    self.done.push(solved(end));
                    self.step(Before::At(end, Some(carrier.direction(end))));
                    self.done.pop();
                }
            }
        }
        if let (Some(last), Some(place)) = (last, self.done.last_mut()) {
            *place = last;
        }
    }

    /// After the last element: where its end is open, a closed contour goes back to its start.
    fn finish(&mut self, before: Before) {
        let begin = self.elements.iter().position(|one| one.closed == Some(true));
        let begin = begin.and_then(|number| self.done.get(number)).map(|one| one.start);
        let ends = self.elements.iter().any(|one| one.closed == Some(false));
        let mut contour = self.done.clone();
        match (before, begin.filter(|_| ends), contour.last_mut()) {
            (Before::On(carrier, from), Some(begin), Some(last)) => {
                if carrier.off(begin) > SAME || !carrier.is_ahead(from, begin) {
                    self.stop(false);
                    return;
                }
                last.end = begin;
            }
            (Before::On(..), ..) => {
                self.stop(true);
                return;
            }
            (_, Some(begin), Some(last)) if distance(last.end, begin) > SAME => {
                self.stop(false);
                return;
            }
            _ => {}
        }
        let same = |a: &[Solved]| {
            let mut pairs = a.iter().zip(&contour);
            pairs.all(|(a, b)| distance(a.end, b.end) < SAME && (a.length() - b.length()).abs() < SAME)
        };
        if !self.found.iter().any(|other| same(other)) {
            self.found.push(contour);
        }
    }
}

/// Where an element on a carrier begins.
fn joints(before: &Before, carrier: &Carrier, tangential: bool) -> Vec<Flat> {
    let goes_on = |at: Flat, way: Flat| !tangential || distance(carrier.direction(at), way) < SAME;
    match *before {
        Before::At(at, way) => {
            let good = carrier.off(at) < SAME && way.is_none_or(|way| goes_on(at, way));
            Vec::from_iter(good.then_some(at))
        }
        Before::On(last, from) => {
            let all = match tangential {
                true => Vec::from_iter(last.touches(carrier)),
                false => last.meets(carrier),
            };
            all.into_iter().filter(|joint| last.is_ahead(from, *joint)).collect()
        }
        Before::Unknown => Vec::new(),
    }
}

/// Whether a contour meets itself elsewhere than where its elements join.
fn crosses_itself(contour: &[Solved]) -> bool {
    let mut chords: Vec<(usize, Flat, Flat)> = Vec::new();
    for (number, one) in contour.iter().enumerate() {
        let at = |k: usize| match one.carrier {
            _ if k == 0 => one.start,
            _ if k == CHORDS => one.end,
            Carrier::Line { .. } => one.end,
            Carrier::Circle { centre, radius } => {
                let turn = Carrier::sweep(centre, radius, one.start, one.end) * radius.signum();
                let (sin, cos) = (turn * k as f64 / CHORDS as f64).sin_cos();
                let [x, y] = minus(one.start, centre);
                [centre[0] + x * cos - y * sin, centre[1] + x * sin + y * cos]
            }
        };
        match one.carrier {
            Carrier::Line { .. } => chords.push((number, one.start, one.end)),
            Carrier::Circle { .. } => chords.extend((0..CHORDS).map(|k| (number, at(k), at(k + 1)))),
        }
    }
    let cross = |a: Flat, b: Flat, c: Flat| {
        let ([x, y], [u, v]) = (minus(b, a), minus(c, a));
        x * v - y * u
    };
    let far = |a: &(usize, Flat, Flat), b: &(usize, Flat, Flat)| {
        // Neighbours share an end.
        [a.1, a.2]
            .iter()
            .all(|p| [b.1, b.2].iter().all(|q| distance(*p, *q) > SAME))
    };
    let meet = |a: &(usize, Flat, Flat), b: &(usize, Flat, Flat)| {
        let sides = [
            cross(a.1, a.2, b.1),
            cross(a.1, a.2, b.2),
            cross(b.1, b.2, a.1),
            cross(b.1, b.2, a.2),
        ];
        sides[0] * sides[1] <= 0.0 && sides[2] * sides[3] <= 0.0 && reach(a, b)
    };
    chords
        .iter()
        .enumerate()
        .any(|(k, a)| chords[..k].iter().any(|b| far(a, b) && meet(a, b)))
}

/// Whether the boxes of two chords overlap: those on one line may be apart.
fn reach(a: &(usize, Flat, Flat), b: &(usize, Flat, Flat)) -> bool {
    (0..2).all(|k| a.1[k].max(a.2[k]) >= b.1[k].min(b.2[k]) && b.1[k].max(b.2[k]) >= a.1[k].min(a.2[k]))
}
