//! What is asked of proofs: statements, limits, widths, budgets, and what moves along which paths.

pub(super) mod material;
pub(super) mod solids;

use super::targets;
use crate::request::Request;
use std::collections::BTreeMap;
use sweepsim_check::{Measure, Question, Scene};
use sweepsim_dexel::{Stock, TriangleSoup};
use sweepsim_formats::{Job, JobPath};
use sweepsim_proof::{Convex, Cutter, Limits, Movers, Room, cover, cover_and_cores, margin, motions, outline, regions};

/// An enclosure is no wider than this part of its limit, where nothing goes deeper than that.
pub(in crate::verify) const WIDTH: f64 = 0.1;
/// The same where something may only be touched.
const WIDTH_OF_CONTACT: f64 = 0.5;
/// Concave outlines are replaced by chords within this part of the limit.
pub(in crate::verify) const CHORDS: f64 = 0.01;
/// What goes no deeper into something than this touches it, in millimetres.
const CONTACT: f64 = 1e-3;
/// The most pairs of a cell and a time that are looked at in a request: so many, and so many for each move.
pub(in crate::verify) const PAIRS: usize = 500_000;
pub(in crate::verify) const PAIRS_OF_MOVE: usize = 400;
/// The most zones that are looked at in a statement about the stock: so many, and so many for each move.
const ZONES: usize = 200_000;
const ZONES_OF_MOVE: usize = 100;
/// There, paths are followed within this part of the room.
const DEVIATION: f64 = 2e-3;

/// The least and the largest of the limits that are allowed somewhere, of gouges or of excess.
pub(super) fn limits(job: &Job, of: impl Fn([f64; 2]) -> f64) -> [f64; 2] {
    let own = job.limits.as_ref();
    let general = own.map_or([targets::LIMIT; 2], |limits| [limits.gouge, limits.excess]);
    let regions = own.into_iter().flat_map(|limits| &limits.regions);
    let regions = regions.map(|region| [region.gouge, region.excess]);
    let mut all = std::iter::once(general)
        .chain(regions)
        .map(|limits| of(limits).max(floor(job)));
    let first = all.next().unwrap_or(targets::LIMIT);
    all.fold([first; 2], |[least, most], limit| [least.min(limit), most.max(limit)])
}

/// Below the tolerance of the dexels there is nothing to judge.
fn floor(job: &Job) -> f64 {
    2.0 * job.tolerance
}

/// What is followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moving {
    Cutters,
    Bodies,
    Both,
}

/// A solid that something may not get into, or come near; and the set-up in which it is there.
pub(super) struct Obstacle {
    pub setup: Option<usize>,
    pub triangles: Result<TriangleSoup, String>,
}

/// A statement of which a proof is asked, about some obstacles.
#[derive(Clone, Debug)]
pub(super) struct Asked {
    pub about: &'static str,
    pub measure: Measure,
    pub moving: Moving,
    /// Of distances, so much room.
    pub limit: f64,
    /// What is enclosed is so no wider.
    pub width: f64,
    /// The numbers of the obstacles.
    pub obstacles: Vec<usize>,
}

impl Asked {
    /// Whether it is about a distance.
    pub fn is_apart(&self) -> bool {
        self.measure == Measure::Depth && self.limit < 0.0
    }
}

/// All that is asked in a job.
pub(super) struct AskedAll<'a> {
    job: &'a Job,
    pub obstacles: Vec<Obstacle>,
    pub statements: Vec<Asked>,
    /// What must not touch the stock as it is at each time.
    pub beside_stock: Vec<Movers>,
    /// So much room is asked for around bodies; 0 if they may only not touch.
    pub clearance: f64,
    /// What goes no deeper into something touches it.
    pub contact: f64,
    /// Paths are followed within this, whatever is asked.
    deviation: f64,
    /// No point of a tool is farther from its tip.
    reach: BTreeMap<u32, f64>,
}

impl<'a> AskedAll<'a> {
    /// `is_guessed`: whether the stock was guessed; then nothing is asked about it.
    pub fn new(job: &'a Job, request: &Request, is_guessed: bool) -> Self {
        let mut obstacles = Vec::new();
        let mut statements = Vec::new();
        let clearance = request.judging.clearance.unwrap_or(job.clearance);
        let contact = floor(job).max(CONTACT);
        let has_bodies = job.bodies.values().any(|own| !own.is_empty());
        let mut ask = |about, measure, moving, limit: f64, obstacles: Vec<usize>| {
            let width = if about == "gouge" || about == "excess" || limit < 0.0 {
                WIDTH * limit.abs()
            } else {
                WIDTH_OF_CONTACT * limit
            };
            statements.push(Asked {
                about,
                measure,
                moving,
                limit,
                width,
                obstacles,
            });
        };
        let room = if clearance > 0.0 { -clearance } else { contact };
        if let Some(target) = &job.target {
            obstacles.push(Obstacle {
                setup: None,
                triangles: Ok(target.mesh.clone()),
            });
            let [gouge, _] = limits(job, |[gouge, _]| gouge);
            ask("gouge", Measure::Depth, Moving::Cutters, gouge, vec![0]);
            if !request.judging.first {
                let [excess, _] = limits(job, |[_, excess]| excess);
                ask("excess", Measure::Height, Moving::Cutters, excess, vec![0]);
            }
            if has_bodies {
                ask("holder", Measure::Depth, Moving::Bodies, room, vec![0]);
            }
        }
        let first = obstacles.len();
        for (setup, own) in job.setups.iter().enumerate() {
            for fixture in &own.fixtures {
                let own = solids::around(fixture, "a fixture");
                let all = own.map_or_else(|why| vec![Err(why)], |all| all.into_iter().map(Ok).collect());
                obstacles.extend(all.into_iter().map(|triangles| Obstacle {
                    setup: Some(setup),
                    triangles,
                }));
            }
        }
        let fixtures: Vec<usize> = (first..obstacles.len()).collect();
        if !fixtures.is_empty() {
            let is_apart = has_bodies && room < 0.0;
            let moving = if is_apart { Moving::Cutters } else { Moving::Both };
            ask("fixture", Measure::Depth, moving, contact, fixtures.clone());
            if is_apart {
                ask("fixture", Measure::Depth, Moving::Bodies, room, fixtures);
            }
        }
        let widths = statements
            .iter()
            .map(|asked| Limits::new(asked.limit, asked.width, 0).deviation);
        let beside_stock = if is_guessed { Vec::new() } else { material::movers(job) };
        let mut all = Self {
            job,
            obstacles,
            deviation: widths.fold(f64::INFINITY, f64::min),
            statements,
            beside_stock,
            clearance,
            contact,
            reach: BTreeMap::new(),
        };
        let rooms = all
            .beside_stock
            .iter()
            .map(|movers| DEVIATION * all.distance(*movers).abs());
        all.deviation = rooms.fold(all.deviation, f64::min);
        if !all.deviation.is_finite() {
            all.deviation = 0.0;
        }
        let largest = all
            .statements
            .iter()
            .map(|asked| CHORDS * asked.limit.abs())
            .fold(0.0, f64::max);
        let mut reach = BTreeMap::<u32, f64>::new();
        let beside_stock = all.beside_stock(Moving::Both);
        for (number, solids) in all.covers(Moving::Both, largest).iter().chain(&beside_stock) {
            let own = reach.entry(*number).or_default();
            *own = solids.iter().map(Convex::reach).fold(*own, f64::max);
        }
        all.reach = reach;
        all
    }

    /// The solids of tools.
    fn covers(&self, moving: Moving, tolerance: f64) -> BTreeMap<u32, Vec<Convex>> {
        let mut all: BTreeMap<u32, Vec<Convex>> = BTreeMap::new();
        if moving != Moving::Bodies {
            let tools = self.job.tools.iter();
            all.extend(tools.map(|(number, tool)| (*number, cover_and_cores(tool, tolerance))));
        }
        if moving != Moving::Cutters {
            for (number, bodies) in &self.job.bodies {
                let solids = bodies.iter().flat_map(|body| cover(&body.solid, tolerance));
                all.entry(*number).or_default().extend(solids);
            }
        }
        all
    }

    /// What a statement follows, as solids.
    pub fn solids(&self, asked: &Asked) -> BTreeMap<u32, Vec<Convex>> {
        self.covers(asked.moving, CHORDS * asked.limit.abs())
    }

    /// Solids along the paths on which they move beside an obstacle, each with the number of the path.
    pub fn along<'s>(
        &'s self,
        solids: &'s BTreeMap<u32, Vec<Convex>>,
        setup: Option<usize>,
    ) -> Vec<(usize, Cutter<'s>)> {
        let all = self.job.paths.iter().enumerate();
        let all = all.filter(|(_, path)| setup.is_none_or(|setup| path.setup == setup));
        let cutter = |(number, path): (usize, &'s JobPath)| {
            let solids = solids.get(&path.tool).filter(|solids| !solids.is_empty())?;
            Some((number, self.cutter(path, solids)))
        };
        all.filter_map(cutter).collect()
    }

    /// Some solids along a path.
    pub fn cutter<'s>(&self, path: &'s JobPath, solids: &'s [Convex]) -> Cutter<'s> {
        Cutter {
            solids,
            path: &path.path,
            others: Some(&path.other_courses),
            reach: self.reach.get(&path.tool).copied().unwrap_or(0.0),
        }
    }

    /// How deep something may go into an obstacle, of all statements about it.
    pub fn deepest(&self, obstacle: usize) -> f64 {
        let own = self.statements.iter().filter(|own| own.obstacles.contains(&obstacle));
        let own = own.filter(|own| own.measure == Measure::Depth).map(|own| own.limit);
        own.fold(0.0, f64::max)
    }

    pub fn limits(&self, asked: &Asked) -> Limits {
        Limits {
            deviation: self.deviation,
            ..Limits::new(asked.limit.abs(), asked.width, PAIRS + PAIRS_OF_MOVE * self.job.moves())
        }
    }

    /// How much room is asked for beside the stock.
    pub fn room(&self, movers: Movers) -> Room {
        Room {
            distance: self.distance(movers),
            deviation: self.deviation,
            zones: ZONES + ZONES_OF_MOVE * self.job.moves(),
        }
    }

    /// So far from the stock; if negative, so deep in it is allowed.
    fn distance(&self, movers: Movers) -> f64 {
        match movers {
            Movers::Bodies if self.clearance > 0.0 => self.clearance,
            _ => -self.contact,
        }
    }

    /// The solids of tools, beside the stock.
    pub fn beside_stock(&self, moving: Moving) -> BTreeMap<u32, Vec<Convex>> {
        self.covers(moving, CHORDS * self.clearance.max(self.contact))
    }

    /// All of it in plain numbers: a question for each statement and obstacle.
    pub fn scene(&self) -> Scene {
        let job = self.job;
        let mut scene = Scene {
            deviation: self.deviation,
            ..Scene::default()
        };
        // Without a question, nothing says how near to the paths their motions must be.
        if self.statements.is_empty() && self.beside_stock.is_empty() {
            return scene;
        }
        for obstacle in &self.obstacles {
            let triangles = obstacle.triangles.as_ref();
            scene
                .solids
                .push(triangles.map_or(Vec::new(), |soup| soup.triangles.clone()));
        }
        let mut outlines: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (number, tool) in &job.tools {
            let bodies = job.bodies.get(number).into_iter().flatten();
            let bodies = bodies.map(|body| outline(&body.solid, false));
            let own = outlines.entry(*number).or_default();
            for outline in std::iter::once(outline(tool, true)).chain(bodies) {
                own.push(scene.outlines.len());
                scene.outlines.push(outline);
            }
        }
        for path in &job.paths {
            let is_idle = |number: usize| material::kept_from(path, number).is_some();
            let motions = motions(&self.cutter(path, &[]), self.deviation, &is_idle);
            scene.paths.push(motions);
        }
        for asked in &self.statements {
            if asked.measure == Measure::Height {
                scene.margin = self.margin(asked);
                scene.skin = 6.0 * scene.margin;
                let within = || job.stock.bounds().map(|[min, max]| Stock::Block { min, max });
                let all = regions(&job.stock, scene.skin);
                scene.stock = all.or_else(|| regions(&within()?, scene.skin)).unwrap_or_default();
            }
            for solid in &asked.obstacles {
                let setup = self.obstacles[*solid].setup;
                let paths = job.paths.iter().enumerate();
                let paths = paths.filter(|(_, path)| setup.is_none_or(|setup| path.setup == setup));
                let movers = paths.flat_map(|(number, path)| {
                    let own = outlines.get(&path.tool).map_or(&[][..], Vec::as_slice);
                    let own = match asked.moving {
                        Moving::Cutters => own.get(..1),
                        Moving::Bodies => own.get(1..),
                        Moving::Both => Some(own),
                    };
                    own.unwrap_or_default().iter().map(move |outline| (number, *outline))
                });
                scene.questions.push(Question {
                    about: asked.about.to_owned(),
                    measure: asked.measure,
                    limit: asked.limit,
                    solid: *solid,
                    movers: movers.collect(),
                    cutters: Vec::new(),
                });
            }
        }
        if scene.stock.is_empty() {
            scene.stock = regions(&job.stock, scene.skin).unwrap_or_default();
        }
        let outlines = job.paths.iter().map(|path| outlines.get(&path.tool));
        let outlines: Vec<&[usize]> = outlines.map(|own| own.map_or(&[][..], Vec::as_slice)).collect();
        let beside_stock = self.beside_stock.iter();
        let questions =
            beside_stock.filter_map(|movers| material::question(job, *movers, -self.distance(*movers), &outlines));
        scene.questions.extend(questions);
        scene
    }

    /// Of heights, what a checker may not tell.
    fn margin(&self, asked: &Asked) -> f64 {
        let size = self.obstacles[asked.obstacles[0]]
            .triangles
            .as_ref()
            .map_or(0.0, |soup| {
                let all = soup.triangles.as_flattened().as_flattened().iter();
                all.fold(0.0, |size: f64, c| size.max(c.abs()))
            });
        let solids = self.solids(asked);
        let own: Vec<Cutter> = self
            .along(&solids, None)
            .into_iter()
            .map(|(_, cutter)| cutter)
            .collect();
        margin(size, &own, &self.limits(asked))
    }
}
