//! Turns preimages into crossings as they are found.

use crate::methods::lattice::Lattice;
use nalgebra::Vector3;
use sweepsim_dexel::{Crossing, Source};
use sweepsim_solve::{Cause, ChartStatistics, Preimage, Sink, UnresolvedTarget};

/// A crossing and the number of its line.
pub(crate) type Numbered = (u32, Crossing);

/// The result of a search.
#[derive(Clone, Debug, Default)]
pub(crate) struct Harvest {
    pub crossings: Vec<Numbered>,
    /// Lines with a box that could not be decided.
    pub open: Vec<(u32, Cause)>,
    pub statistics: ChartStatistics,
}

/// Collects crossings of the lines of a lattice.
pub(crate) struct Collector<'a> {
    pub lines: &'a Lattice<'a>,
    pub harvest: &'a mut Harvest,
}

impl Collector<'_> {
    #[inline]
    pub fn crossing(&mut self, line: usize, z: f64, jump: i8, normal: [f32; 3], source: Source) {
        let crossing = Crossing {
            z,
            jump,
            normal,
            source,
        };
        self.harvest.crossings.push((line as u32, crossing));
    }

    /// Leaves a line to the general method.
    pub fn open(&mut self, line: usize) {
        self.harvest.open.push((line as u32, Cause::Smallest));
    }

    /// The number of crossings and open lines so far.
    pub fn mark(&self) -> [usize; 2] {
        [self.harvest.crossings.len(), self.harvest.open.len()]
    }

    /// Drops what came after a mark.
    pub fn forget(&mut self, [crossings, open]: [usize; 2]) {
        self.harvest.crossings.truncate(crossings);
        self.harvest.open.truncate(open);
    }
}

/// The results of all searches of a chunk, in an order that does not depend on the number of threads.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gathered {
    pub crossings: Vec<Vec<Numbered>>,
    pub open: Vec<(u32, Cause)>,
    pub statistics: ChartStatistics,
}

impl Gathered {
    /// Adds the results of another search.
    pub fn add(&mut self, harvest: Harvest) {
        self.crossings.push(harvest.crossings);
        self.open.extend(harvest.open);
        self.statistics.add(&harvest.statistics);
    }

    /// The number of crossings.
    pub fn len(&self) -> usize {
        self.crossings.iter().map(Vec::len).sum()
    }
}

/// Turns preimages into crossings as they are found.
pub(super) struct Reaper<'a, F> {
    crossings: &'a mut Vec<Numbered>,
    open: &'a mut Vec<(u32, Cause)>,
    make: F,
}

impl<const N: usize, S, F: Fn(&Preimage<N, S>) -> Option<Crossing>> Sink<N, S> for Reaper<'_, F> {
    fn found(&mut self, preimage: Preimage<N, S>) {
        if let Some(crossing) = (self.make)(&preimage) {
            self.crossings.push((preimage.target as u32, crossing));
        }
    }

    fn mark(&self) -> usize {
        self.crossings.len()
    }

    fn forget(&mut self, mark: usize) {
        self.crossings.truncate(mark);
    }

    fn forget_targets(&mut self, mark: usize, targets: &[usize]) {
        let kept = self.crossings.split_off(mark);
        let is_kept = |(line, _): &Numbered| targets.binary_search(&(*line as usize)).is_err();
        self.crossings.extend(kept.into_iter().filter(is_kept));
    }

    fn unresolved(&mut self, target: UnresolvedTarget<N>) {
        self.open.push((target.target as u32, target.cause));
    }
}

pub(crate) fn unit(normal: Vector3<f64>) -> [f32; 3] {
    let length = normal.norm();
    let normal = if length > 0.0 { normal / length } else { normal };
    [normal.x as f32, normal.y as f32, normal.z as f32]
}

impl Harvest {
    /// Receives preimages, which `make` turns into crossings.
    pub(super) fn reaper<F>(&mut self, make: F) -> Reaper<'_, F> {
        Reaper {
            crossings: &mut self.crossings,
            open: &mut self.open,
            make,
        }
    }

    /// Drops the crossings since a mark that are above a height; the lines of those nearer to it than `near` are open.
    pub fn keep_below(&mut self, mark: usize, height: f64, height_tolerance: f64) {
        // NaN is near.
        let near = |z: f64| !((z - height).abs() > height_tolerance);
        let is_kept = |(_, crossing): &Numbered| !near(crossing.z) && crossing.z < height;
        // Mostly all of them.
        let first = mark + self.crossings[mark..].iter().take_while(|own| is_kept(own)).count();
        let mut kept = first;
        for at in first..self.crossings.len() {
            let (line, crossing) = self.crossings[at];
            if near(crossing.z) {
                self.open.push((line, Cause::Smallest));
            } else if crossing.z < height {
                self.crossings[kept] = self.crossings[at];
                kept += 1;
            }
        }
        self.crossings.truncate(kept);
    }

    /// Adds the statistics of another search.
    pub fn count(&mut self, statistics: &ChartStatistics) {
        self.statistics.add(statistics);
    }
}

/// Sums of statistics.
trait Add {
    fn add(&mut self, other: &Self);
}

impl Add for ChartStatistics {
    fn add(&mut self, other: &Self) {
        self.boxes += other.boxes;
        self.charts += other.charts;
        self.evaluations += other.evaluations;
    }
}
