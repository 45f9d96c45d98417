//! Along which directions moves are judged. Lines along z hardly meet upright walls: those are looked at along x and y.

use crate::base::{JobError, words};
use crate::request::Directions;
use crate::session::{Session, check, coarse_grids_aside, grids_aside, stock_heights, too_many};
use crate::shards::{Purpose, Tiling, TilingSet};
use sweepsim::verify::AreaShare;
use sweepsim_dexel::{Grid, Stock};
use sweepsim_formats::Job;

/// Steeper surfaces are walls: the component of their normal along z is smaller than this.
const WALL: f64 = 0.1;
/// Where lines along x and y cost more than those along z, they are so many times as far apart: a wall is wide, and how
/// deep it was cut is exact on each line.
const COARSE: usize = 4;

/// The grids along x and y, with the box of the stock in which they look; and what is to be said of them.
#[derive(Debug, Default)]
pub(super) struct Aside {
    pub grids: Option<([Grid; 2], Stock)>,
    pub note: Option<String>,
}

/// The directions beside z along which moves are judged: those that were asked for; otherwise both, if the target has
/// walls.
pub(super) fn aside(session: Session, along_z: &TilingSet) -> Result<Aside, JobError> {
    let (job, request) = (session.job, session.request);
    let along = |grids| Aside { grids, note: None };
    match request.directions {
        Some(Directions::Xyz) => {
            let grids = grids_aside(job);
            let grids = grids.map_err(|error| session.failure(format!("--directions xyz: {error}")))?;
            return Ok(along(grids));
        }
        Some(Directions::Z) => return Ok(along(None)),
        None if request.judging.first || !has_walls(job) => return Ok(along(None)),
        None => {}
    }
    let refused = |what: &str| Aside {
        grids: None,
        note: Some(format!("walls of the target are looked at along z only: {what}")),
    };
    if let Err(what) = check(job) {
        return Ok(refused(&format!("x and y would need {what}")));
    }
    if too_many(&job.grid, stock_heights(job)) {
        return Ok(refused(
            "the part is so much taller than the distance of its dexels that x and y must be asked for: --directions xyz",
        ));
    }
    let cuts = session.cuts();
    let work = |sets| Tiling { sets }.work(job, &cuts);
    let of = |grids: &Option<([Grid; 2], Stock)>| grids.as_ref().map_or(0.0, |grids| work(sets(session, grids)));
    let least = work(vec![
        TilingSet::new("", along_z.grid, None, request.sweeping.tile).to(along_z.purpose),
    ]);
    let same = grids_aside(job).unwrap_or_default();
    if of(&same) <= least {
        return Ok(along(same));
    }
    let Some(coarse) = coarse_grids_aside(job, COARSE) else {
        return Ok(along(same));
    };
    let step = words::length(coarse.0[0].spacing()[0]);
    let coarse = Some(coarse);
    let mut note = format!("walls of the target are looked at along x and y on lines {step} mm apart");
    let times = of(&coarse) / least;
    if times > 1.0 {
        let times = words::length((10.0 * times).round() / 10.0);
        note.push_str(&format!(
            ", which takes about {times} times as long as along z: --directions z leaves it out"
        ));
    }
    let note = Some(note);
    Ok(Aside { grids: coarse, note })
}

/// The tiles along x and y.
pub(super) fn sets(session: Session, (grids, within): &([Grid; 2], Stock)) -> Vec<TilingSet> {
    let request = session.request;
    let compare = compared(session).then_some(AreaShare::OfThree);
    let purpose = Purpose::Judge {
        each_move: false,
        compare,
    };
    let set = |(grid, name): (&Grid, &'static str)| {
        TilingSet::new(name, *grid, Some(within.clone()), request.sweeping.tile).to(purpose)
    };
    grids.iter().zip(["along x", "along y"]).map(set).collect()
}

/// Whether the second and third of these sets are judged on just the lines along x and y that a solid is made of,
/// together with those along z.
pub(crate) fn judges_solid(session: Session, sets: &[TilingSet]) -> bool {
    let judged = |set: &TilingSet| matches!(set.purpose, Purpose::Judge { .. });
    let [_, along_x, along_y, ..] = sets else { return false };
    let same = |grids: [Grid; 2]| grids == [along_x.grid, along_y.grid];
    judged(along_x) && judged(along_y) && matches!(grids_aside(session.job), Ok(Some((grids, _))) if same(grids))
}

/// Whether the part is compared with a target.
pub(super) fn compared(session: Session) -> bool {
    session.job.target.is_some() && !session.request.judging.first
}

/// Whether the target has walls, as seen along z of the grid.
pub(super) fn has_walls(job: &Job) -> bool {
    let Some(target) = &job.target else { return false };
    let frame = job.grid.frame();
    target.mesh.triangles.iter().any(|[a, b, c]| {
        let (u, v) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
        let normal = [0, 1, 2].map(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
        let length = normal.iter().map(|c| c * c).sum::<f64>().sqrt();
        length > 0.0 && frame.turn_from_world(normal)[2].abs() < WALL * length
    })
}
