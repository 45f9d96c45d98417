//! The bodies that are there during a path on a machine, and which of them must stay apart.

use crate::show::covered;
use crate::verify::texts::name_of;
use nalgebra::{Unit, Vector3};
use std::collections::BTreeSet;
use sweepsim_dexel::{Frame, Stock};
use sweepsim_formats::{Job, JobPath, may_touch, must_stay_apart};
use sweepsim_machine::{Body, Convex};
use sweepsim_motion::Tool;
use sweepsim_nc::AxesCourse;

/// All bodies during a path, and the pairs of them that must stay apart.
pub(super) struct Crowd {
    pub bodies: Vec<Body>,
    pub pairs: Vec<(usize, usize)>,
    /// Bodies that are known only by what they are within.
    pub loose: BTreeSet<usize>,
    /// The numbers of the stock as it was before the first cut, and
    pub stock: std::ops::Range<usize>,
    /// of all that is on the table; before it are the machine's bodies, after it what the spindle holds.
    table: std::ops::Range<usize>,
}

impl Crowd {
    pub fn new(job: &Job, path: &JobPath, machine: &[Body], course: &AxesCourse) -> Self {
        let (chain, description) = (course.chain(), course.machine().description());
        let mut bodies = machine.to_vec();
        let mut loose = BTreeSet::new();
        let own = bodies.len();
        let zero = Vector3::from(description.part_zero);
        let placed = Placed {
            frame: &path.frame,
            zero,
        };
        // What is on the table.
        let fixtures = job.setups.get(path.setup).map_or(&[][..], |setup| &setup.fixtures);
        let on_table = std::iter::once(("raw stock".to_owned(), &job.stock));
        let fixtures = fixtures.iter().enumerate();
        let on_table = on_table.chain(fixtures.map(|(k, solid)| (format!("fixture {}", k + 1), solid)));
        let mut stocks = own..own;
        for (number, (name, stock)) in on_table.enumerate() {
            let mut rough = false;
            for solid in placed.solids(stock, &mut rough) {
                let body = Body::new(name.clone(), chain.part(), solid);
                if rough {
                    loose.insert(bodies.len());
                }
                bodies.extend(body);
            }
            if number == 0 {
                stocks.end = bodies.len();
            }
        }
        let table = own..bodies.len();
        // What the spindle holds: its tip is a tool's length below the nose.
        let tip = [0.0, 0.0, -course.tool_length()];
        let tool = job
            .tools
            .get(&path.tool)
            .map(|tool| (format!("cutter of tool {}", path.tool), tool));
        let others = job.bodies.get(&path.tool).into_iter().flatten();
        let others = others.map(|body| (format!("{} of tool {}", name_of(body.kind), path.tool), &body.solid));
        for (name, tool) in tool.into_iter().chain(others) {
            let outline = covered(tool);
            if outline.is_none() {
                loose.insert(bodies.len());
            }
            let outline = outline.unwrap_or_else(|| within(tool));
            bodies.extend(Body::new(
                name,
                chain.spindle(),
                Convex::cones(tip, Vector3::z(), &outline),
            ));
        }
        let mut pairs = Vec::new();
        for a in 0..own {
            for b in a + 1..bodies.len() {
                let (first, second) = (&bodies[a], &bodies[b]);
                let apart = if b < own {
                    must_stay_apart(description, first, second)
                } else {
                    first.link != second.link && !may_touch(description, first, second)
                };
                if apart {
                    pairs.push((a, b));
                }
            }
        }
        Self {
            bodies,
            pairs,
            loose,
            stock: stocks,
            table,
        }
    }

    /// Whether a body is on the table: the stock, or a fixture.
    pub fn is_on_table(&self, body: usize) -> bool {
        self.table.contains(&body)
    }

    /// Lower and upper corner of a box around the stock, on the part's link.
    pub fn extent_of_stock(&self) -> [[f64; 3]; 2] {
        let all = self.bodies[self.stock.clone()].iter().map(Body::extent);
        let around = |[low, high]: [[f64; 3]; 2], [a, b]: [[f64; 3]; 2]| {
            [
                [0, 1, 2].map(|k| low[k].min(a[k])),
                [0, 1, 2].map(|k| high[k].max(b[k])),
            ]
        };
        all.reduce(around).unwrap_or_default()
    }

    /// How far a body may be beside its place on its link, if the part may be moved and the tool longer or shorter.
    pub fn beside(&self, body: usize, offset: [f64; 3], length: f64) -> f64 {
        if self.table.contains(&body) {
            Vector3::from(offset).norm()
        } else if body >= self.table.end {
            length
        } else {
            0.0
        }
    }
}

/// A ball around all of a tool, as an outline.
fn within(tool: &Tool) -> Vec<[f64; 2]> {
    let reach = tool.reach();
    vec![[reach, -reach], [reach, reach]]
}

/// Where the part is on the machine.
struct Placed<'a> {
    frame: &'a Frame,
    zero: Vector3<f64>,
}

impl Placed<'_> {
    fn point(&self, point: [f64; 3]) -> [f64; 3] {
        (Vector3::from(self.frame.from_world(point)) + self.zero).into()
    }

    fn direction(&self, way: Vector3<f64>) -> Vector3<f64> {
        let [from, to] = [[0.0; 3], way.into()].map(|point| Vector3::from(self.frame.from_world(point)));
        to - from
    }

    /// Solids of machine coordinates that cover a stock; `rough` where they may be larger.
    fn solids(&self, stock: &Stock, rough: &mut bool) -> Vec<Vec<Convex>> {
        match stock {
            Stock::Block { min, max } => {
                let corner = |bits: usize| [0, 1, 2].map(|k| if bits >> k & 1 == 1 { max[k] } else { min[k] });
                vec![vec![Convex::Hull(
                    (0..8).map(|bits| self.point(corner(bits))).collect(),
                )]]
            }
            Stock::Cylinder {
                base,
                axis,
                radius,
                height,
            } => {
                let axis = Unit::new_normalize(self.direction(Vector3::from(*axis)));
                vec![Convex::cones(
                    self.point(*base),
                    axis.into_inner(),
                    &[[*radius, 0.0], [*radius, *height]],
                )]
            }
            Stock::Mesh(mesh) => {
                let triangles = mesh
                    .triangles
                    .iter()
                    .map(|corners| Convex::Triangle(corners.map(|p| self.point(p))));
                vec![triangles.collect()]
            }
            Stock::Union(parts) => parts.iter().flat_map(|part| self.solids(part, rough)).collect(),
            other => {
                *rough = true;
                let block = other.bounds().map(|[min, max]| Stock::Block { min, max });
                block.map_or_else(Vec::new, |block| self.solids(&block, rough))
            }
        }
    }
}
