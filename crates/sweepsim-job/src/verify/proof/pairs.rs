//! Pairs of bodies on a path: the machine's own, and what is on the table and at the spindle. The stock is looked at as
//! it is at each time, where it was met as it was before the first cut.

use super::Proof;
use super::crowd::Crowd;
use super::process::of_tool;
use crate::base::JobError;
use crate::verify::asked::Moving;
use crate::verify::asked::material::{is_guessed, kept_from};
use nalgebra::Vector3;
use rayon::prelude::*;
use sweepsim_dexel::Frame;
use sweepsim_formats::Job;
use sweepsim_machine::{Course, Limits, Matter, Outcome, Values, contacts, meets};
use sweepsim_nc::AxesCourse;
use sweepsim_proof::{Remains, Work};

/// The most distances that are computed for a pair of bodies on a path: so many, and so many for each move.
const TESTS: usize = 100_000;
const TESTS_OF_MOVE: usize = 200;
/// How far what a cutter has removed may be from its path, in millimetres.
const DEVIATION: f64 = 0.01;

/// How far the part may be from its place, and how much longer or shorter a tool.
#[derive(Clone, Copy)]
pub(super) struct Range {
    pub offset: [f64; 3],
    pub length: f64,
}

impl Range {
    pub fn is_some(&self) -> bool {
        self.length > 0.0 || self.offset.iter().any(|way| *way > 0.0)
    }

    /// How far joints may be from their course.
    pub fn spread(&self, course: &AxesCourse) -> Values {
        course.chain().spread(course.machine(), self.offset, self.length)
    }
}

/// What is known of two bodies on a path.
pub(super) struct Judged {
    pub path: usize,
    pub names: [String; 2],
    /// Whether a contact is one for certain.
    pub is_sure: bool,
    pub outcome: Outcome,
}

/// All bodies on a path for a machine, which may be at another place than the program's own.
pub(super) struct OnPath<'a> {
    pub path: usize,
    pub course: &'a AxesCourse,
    pub frame: &'a Frame,
    crowd: Crowd,
    range: Range,
}

impl<'a> OnPath<'a> {
    pub fn new(job: &'a Job, path: usize, course: &'a AxesCourse, range: Range) -> Option<Self> {
        let own = &job.paths[path];
        let on = own.on_machine.as_ref().filter(|on| !on.bodies.is_empty())?;
        Some(Self {
            path,
            course,
            frame: &own.frame,
            crowd: Crowd::new(job, own, &on.bodies, course),
            range,
        })
    }

    pub fn pairs(&self) -> usize {
        self.crowd.pairs.len()
    }

    /// Limits for a pair, with what offsets do to the joints and to what is on the table.
    fn limits(&self, pair: usize, [offset, on_table]: [[f64; 3]; 2]) -> Limits {
        let (_, b) = self.crowd.pairs[pair];
        let (machine, length) = (self.course.machine(), self.range.length);
        let mut limits = Limits::new(machine.description().clearance + self.crowd.beside(b, on_table, length));
        limits.tests = TESTS + TESTS_OF_MOVE * self.course.moves();
        limits.slack = self.course.chain().spread(machine, offset, length);
        limits
    }

    /// Whether a pair is of what is on the table and of a body beyond all linear axes: the tool goes with the part.
    fn goes_along(&self, pair: usize) -> bool {
        let (a, b) = self.crowd.pairs[pair];
        let linear = |letter: &char| ('X'..='Z').contains(letter);
        let last = self.course.chain().letters().iter().rposition(linear);
        self.crowd.is_on_table(b) && last.is_none_or(|last| self.crowd.bodies[a].link > last)
    }

    /// What a way of looking at a pair finds, for a range of offsets.
    ///
    /// Where the tool goes the same way on the part, an offset changes nothing between both. Elsewhere, at places of
    /// the machine above all, each axis is off that way by no more than the offset moves it.
    fn looked(&self, pair: usize, look: impl Fn(&Limits, &dyn Course, Option<&[usize]>) -> Outcome) -> Outcome {
        let (offset, none) = (self.range.offset, [0.0; 3]);
        if offset == none || !self.goes_along(pair) {
            return look(&self.limits(pair, [offset; 2]), self.course, None);
        }
        let along = look(&self.limits(pair, [none; 2]), self.course, None);
        let Outcome::Apart(least) = along else { return along };
        let others = (0..self.course.moves()).filter(|piece| !self.course.follows_part(*piece));
        let others: Vec<usize> = others.collect();
        let some = Pieces {
            course: self.course,
            pieces: &others,
        };
        match look(&self.limits(pair, [offset, none]), &some, Some(&others)) {
            Outcome::Apart(other) => Outcome::Apart(least.min(other)),
            Outcome::Contact(contact) => Outcome::Open(others[contact.number], contact.time),
            Outcome::Open(number, time) => Outcome::Open(others.get(number).copied().unwrap_or_default(), time),
        }
    }

    /// What is known of some pairs, by their numbers, with the stock as it was before the first cut.
    pub fn judge(&self, pairs: std::ops::Range<usize>) -> Vec<Outcome> {
        let linkage = self.course.chain().linkage();
        let of_pair = |pair: usize| {
            let look = |limits: &Limits, course: &dyn Course, _: Option<&[usize]>| {
                let found = contacts(
                    linkage,
                    &self.crowd.bodies,
                    &self.crowd.pairs[pair..=pair],
                    course,
                    limits,
                );
                found.into_iter().next().unwrap_or(Outcome::Open(0, 0.0))
            };
            self.looked(pair, look)
        };
        pairs.into_par_iter().map(of_pair).collect()
    }

    /// Whether a pair is of the stock, and has met it as it was.
    pub fn needs_stock(&self, pair: usize, outcome: &Outcome) -> bool {
        self.crowd.stock.contains(&self.crowd.pairs[pair].1) && !matches!(outcome, Outcome::Apart(_))
    }

    /// What is known of a pair of the stock with what is left of it, by a share of the usual number of distances.
    pub fn with_remains(&self, pair: usize, remains: &Remains, share: usize) -> Outcome {
        let (a, _) = self.crowd.pairs[pair];
        let linkage = self.course.chain().linkage();
        let look = |limits: &Limits, course: &dyn Course, pieces: Option<&[usize]>| {
            let left = Left {
                remains,
                path: self.path,
                course: self.course,
                pieces,
                frame: self.frame,
                zero: Vector3::from(self.course.machine().description().part_zero),
            };
            let mut limits = *limits;
            limits.tests /= share;
            let stock = (&left as &dyn Matter, self.crowd.extent_of_stock());
            meets(linkage, &self.crowd.bodies[a], stock, course, &limits)
        };
        self.looked(pair, look)
    }

    /// A pair as it is told.
    pub fn told(&self, pair: usize, outcome: Outcome, is_raw: bool) -> Judged {
        let (a, b) = self.crowd.pairs[pair];
        let is_known = ![a, b].iter().any(|body| self.crowd.loose.contains(body));
        // With a range, bodies may be too near at some place of the part only, if they don't touch at this one.
        let touches = matches!(&outcome, Outcome::Contact(contact) if contact.distance == 0.0);
        let is_sure = (is_known || !is_raw) && (touches || !self.range.is_some());
        let mut names = [a, b].map(|body| self.crowd.bodies[body].name.clone());
        if !is_raw {
            names[1] = "stock".to_owned();
        }
        Judged {
            path: self.path,
            names,
            is_sure,
            outcome,
        }
    }
}

/// Some pieces of a course.
struct Pieces<'a> {
    course: &'a AxesCourse,
    pieces: &'a [usize],
}

impl Course for Pieces<'_> {
    fn moves(&self) -> usize {
        self.pieces.len()
    }

    fn at(&self, number: usize, time: f64) -> Values {
        self.course.at(self.pieces[number], time)
    }

    fn bend(&self, number: usize) -> Values {
        self.course.bend(self.pieces[number])
    }

    fn joined(&self, number: usize) -> bool {
        let joins = number
            .checked_sub(1)
            .is_some_and(|before| self.pieces[before] + 1 == self.pieces[number]);
        joins && self.course.joined(self.pieces[number])
    }
}

/// What is known of all pairs on some paths.
pub(super) fn judged(proof: &Proof, paths: &[OnPath]) -> Result<Vec<Judged>, JobError> {
    let monitor = proof.session.monitor;
    let mut raw = Vec::with_capacity(paths.len());
    for own in paths {
        if monitor.cancelled() {
            return Err(JobError::Cancelled);
        }
        raw.push(own.judge(0..own.pairs()));
    }
    let met = paths.iter().zip(&raw).map(|(own, found)| {
        let pairs = found.iter().enumerate();
        pairs
            .filter(|(pair, outcome)| own.needs_stock(*pair, outcome))
            .map(|(pair, _)| pair)
            .collect()
    });
    let met: Vec<Vec<usize>> = met.collect();
    let is_met = met.iter().any(|pairs| !pairs.is_empty());
    let left = is_met.then(|| {
        with_remains(proof, |remains| {
            let of_path = |(own, pairs): (&OnPath, &Vec<usize>)| {
                let pairs = pairs.iter().map(|pair| (*pair, own.with_remains(*pair, remains, 1)));
                pairs.collect::<Vec<_>>()
            };
            paths.iter().zip(&met).map(of_path).collect::<Vec<_>>()
        })
    });
    let left = left.transpose()?.flatten().unwrap_or_default();
    let mut all = Vec::new();
    for (number, (own, found)) in paths.iter().zip(raw).enumerate() {
        for (pair, outcome) in found.into_iter().enumerate() {
            let known = left
                .get(number)
                .and_then(|own| own.iter().find(|(other, _)| *other == pair));
            all.push(match known {
                Some((_, outcome)) => own.told(pair, outcome.clone(), false),
                None => own.told(pair, outcome, true),
            });
        }
    }
    Ok(all)
}

/// Does something with what is left of the stock at all times; nothing with a stock that was guessed.
pub(super) fn with_remains<T>(proof: &Proof, then: impl FnOnce(&Remains) -> T) -> Result<Option<T>, JobError> {
    let (session, job) = (proof.session, proof.session.job);
    if is_guessed(session.plan) {
        return Ok(None);
    }
    let cutters = proof.asked.beside_stock(Moving::Cutters);
    let must_not_cut = job.paths.iter();
    let must_not_cut = must_not_cut.map(|path| |number: usize| kept_from(path, number).is_some());
    let must_not_cut: Vec<_> = must_not_cut.collect();
    let work = job.paths.iter().zip(&must_not_cut).map(|(path, is_rapid)| Work {
        cutter: proof.asked.cutter(path, of_tool(&cutters, path.tool)),
        bodies: &[],
        is_rapid,
    });
    let work: Vec<Work> = work.collect();
    Remains::of(&job.stock, &work, DEVIATION, then).map_err(|error| session.failure(format!("stock: {error}")))
}

/// The stock as it is left, in the machine's coordinates of the part's link.
struct Left<'a> {
    remains: &'a Remains<'a>,
    path: usize,
    course: &'a AxesCourse,
    /// The pieces of it that are looked at; all if none.
    pieces: Option<&'a [usize]>,
    frame: &'a Frame,
    zero: Vector3<f64>,
}

impl Left<'_> {
    fn place(&self, piece: usize, time: f64) -> (usize, f64) {
        let piece = self.pieces.map_or(piece, |pieces| pieces[piece]);
        let (number, time, _) = self.course.place(piece, time);
        (number, time)
    }

    fn world(&self, point: [f64; 3]) -> [f64; 3] {
        self.frame.to_world((Vector3::from(point) - self.zero).into())
    }
}

impl Matter for Left<'_> {
    fn is_gone(&self, corners: &[[f64; 3]; 8], piece: usize, time: f64) -> bool {
        let (number, time) = self.place(piece, time);
        let corners = corners.map(|corner| self.world(corner));
        self.remains.is_gone(&corners, (self.path, number, time))
    }

    fn is_whole(&self, corners: &[[f64; 3]; 8], piece: usize) -> bool {
        let (number, _) = self.place(piece, 1.0);
        let corners = corners.map(|corner| self.world(corner));
        self.remains.is_whole(&corners, (self.path, number))
    }

    fn is_left(&self, point: [f64; 3], piece: usize) -> bool {
        let (number, _) = self.place(piece, 1.0);
        self.remains.is_left(self.world(point), (self.path, number))
    }
}
