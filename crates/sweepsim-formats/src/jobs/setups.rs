//! The set-ups of a job: how the part lies, what holds it, and the paths that are cut meanwhile.

use sweepsim_dexel::{Frame, Grid, Stock};

use super::paths::{JobPath, PathPlace};
use super::place::Step;
use super::read::JobReader;
use super::schema;
use super::tools::ToolBox;
use crate::error::{FormatError, Problem};

/// One clamping of the part. A job without `setups` has one, in the frame of the part.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Setup {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// Where its coordinates are in those of the part.
    pub frame: Frame,
    /// Clamps, vices and tables, which nothing may touch: in the coordinates of the part, like all that a
    /// [`Job`](super::Job) has.
    pub fixtures: Vec<Stock>,
}

impl JobReader<'_> {
    /// The set-ups, and the paths of all of them in the order of cutting.
    pub(super) fn setups(
        &self,
        raw: &schema::Job,
        tool_box: &mut ToolBox,
        tolerance: f64,
        grid: &Grid,
    ) -> Result<(Vec<Setup>, Vec<JobPath>), FormatError> {
        let Some(list) = &raw.setups else {
            let Some(paths) = &raw.paths else {
                let problem = Problem::syntax("this job has no paths: expected `paths` or `setups`");
                return Err(self.error(problem, &[]));
            };
            let setup = Setup {
                name: None,
                frame: Frame::WORLD,
                fixtures: self.fixtures(&raw.fixtures, &[], &Frame::WORLD, grid)?,
            };
            let place = PathPlace {
                at: &[],
                setup: 0,
                frame: Frame::WORLD,
            };
            return Ok((vec![setup], self.paths(paths, &place, tool_box, tolerance)?));
        };
        for (name, given) in [("paths", raw.paths.is_some()), ("fixtures", !raw.fixtures.is_empty())] {
            if given {
                let problem = Problem::syntax(format!(
                    "`{name}` beside `setups`: each set-up has its own, expected them there"
                ));
                return Err(self.error(problem, &[name.into()]));
            }
        }
        let (mut setups, mut paths) = (Vec::with_capacity(list.len()), Vec::new());
        for (number, raw) in list.iter().enumerate() {
            let at: [Step; 2] = ["setups".into(), Step::Item(number)];
            let frame = self.frame(raw.frame.as_ref(), &at)?;
            let place = PathPlace {
                at: &at,
                setup: number,
                frame,
            };
            paths.extend(self.paths(&raw.paths, &place, tool_box, tolerance)?);
            setups.push(Setup {
                name: raw.name.clone(),
                frame,
                fixtures: self.fixtures(&raw.fixtures, &at, &frame, grid)?,
            });
        }
        Ok((setups, paths))
    }

    fn paths(
        &self,
        list: &[schema::Path],
        place: &PathPlace,
        tool_box: &mut ToolBox,
        tolerance: f64,
    ) -> Result<Vec<JobPath>, FormatError> {
        let mut paths = Vec::new();
        for (index, path) in list.iter().enumerate() {
            paths.extend(self.path(index, path, place, tool_box, tolerance)?);
        }
        Ok(paths)
    }

    /// The field `frame` of what the steps lead to.
    pub(crate) fn frame(&self, raw: Option<&schema::Frame>, at: &[Step]) -> Result<Frame, FormatError> {
        let Some(raw) = raw else { return Ok(Frame::WORLD) };
        let origin = raw.origin.map(|c| c * self.unit);
        let steps: Vec<Step> = at.iter().cloned().chain([Step::from("frame")]).collect();
        Frame::new(origin, raw.z, raw.x).map_err(|error| self.error(Problem::Frame(error), &steps))
    }

    /// Fixtures in a frame.
    fn fixtures(
        &self,
        list: &[schema::Stock],
        at: &[Step],
        frame: &Frame,
        grid: &Grid,
    ) -> Result<Vec<Stock>, FormatError> {
        let each = list.iter().enumerate().map(|(index, fixture)| {
            let steps: Vec<Step> = at
                .iter()
                .cloned()
                .chain(["fixtures".into(), Step::Item(index)])
                .collect();
            let refused = || {
                let problem = Problem::syntax("a fixture cannot be dexels: expected a solid or a mesh");
                self.error(problem, &steps)
            };
            if has_dexels(fixture) {
                return Err(refused());
            }
            self.stock(fixture, &steps, grid)?.placed(frame).ok_or_else(refused)
        });
        each.collect()
    }
}

/// Whether a solid is made of dexels, in part or as a whole.
pub(crate) fn has_dexels(stock: &schema::Stock) -> bool {
    match stock {
        schema::Stock::Dexels(_) => true,
        schema::Stock::Union(parts) | schema::Stock::Intersection(parts) => parts.iter().any(has_dexels),
        schema::Stock::Difference(whole, parts) => has_dexels(whole) || parts.iter().any(has_dexels),
        _ => false,
    }
}
