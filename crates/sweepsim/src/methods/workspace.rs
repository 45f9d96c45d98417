//! The memory that one worker reuses from one part of a path to the next.

use crate::cutter::Cutter;
use crate::cutter::cells::Cells;
use crate::methods::planes::slicer::Slicer;
use crate::methods::translation::Grazing;
use crate::tolerances::Tolerances;
use sweepsim_solve::{BundleSolver, ChartOptions, ChartSolver, ChartStatistics};

/// The cells of a tool, and solvers.
pub(crate) struct Workspace {
    pub patches: Vec<Cells>,
    pub edges: Vec<Cells>,
    pub solvers: Solvers,
    pub grazing: Grazing,
    pub done: Done,
    /// What all of this is for.
    pub tolerances: Tolerances,
}

/// The patches and edges of a tool that closed forms have settled for one part of a path.
#[derive(Debug)]
pub(crate) struct Done {
    /// Under the motion.
    pub patches: Vec<bool>,
    pub edges: Vec<bool>,
    /// At rest.
    pub placed: Vec<bool>,
}

impl Done {
    /// Nothing yet.
    pub fn clear(&mut self) {
        self.patches.fill(false);
        self.edges.fill(false);
        self.placed.fill(false);
    }
}

/// The solvers of all methods, with their memory.
pub(crate) struct Solvers {
    /// Charts of patches and edges under a motion.
    pub moving: ChartSolver<(u32, u32)>,
    /// Charts of patches at rest.
    pub placed: ChartSolver<u32>,
    pub slicer: Slicer,
    pub bundles: BundleSolver,
}

impl Workspace {
    pub fn new(cutter: &Cutter, tolerances: Tolerances) -> Self {
        let options = ChartOptions::default().accept(tolerances.last_step());
        let mut bundles = BundleSolver::new(options);
        bundles.patience = PATIENCE;
        Self {
            patches: cutter.patches.iter().map(Cells::new).collect(),
            edges: cutter.edges.iter().map(Cells::new).collect(),
            grazing: Grazing::default(),
            done: Done {
                patches: vec![false; cutter.patches.len()],
                edges: vec![false; cutter.edges.len()],
                placed: vec![false; cutter.patches.len()],
            },
            solvers: Solvers {
                moving: ChartSolver::new(options),
                placed: ChartSolver::new(options),
                slicer: Slicer::new(),
                bundles,
            },
            tolerances,
        }
    }
}

/// The most boxes of one system: more than any that is not degenerate needs, on as many lines.
const MOST_BOXES: u64 = 400_000;
/// For one line, and for each further one.
const CHART_BOXES: [u64; 2] = [100_000, 100];
/// The same for the systems of [lines](crate::methods::lines), which charts repair.
const BUNDLE_BOXES: [u64; 2] = [10_000, 100];
/// The most boxes of such a system that may leave a line undecided before charts take it over. One in a thousand lines of generic moves is undecided in more.
const PATIENCE: u32 = 4;

impl Workspace {
    /// Drops the cells of a patch if there are many, and what refers to them.
    pub fn trim_patch(&mut self, number: usize) {
        if self.patches[number].trim() {
            self.grazing.forget(number);
        }
    }
}

impl Solvers {
    /// Limits the searches for some lines.
    pub fn limit(&mut self, lines: usize) {
        let most = |[first, each]: [u64; 2]| (first + each * lines as u64).min(MOST_BOXES);
        self.moving.options.boxes = most(CHART_BOXES);
        self.placed.options.boxes = most(CHART_BOXES);
        self.bundles.options.boxes = most(BUNDLE_BOXES);
        self.moving.start_over();
        self.placed.start_over();
    }

    /// The statistics since the last call.
    pub fn take_statistics(&mut self) -> ChartStatistics {
        let solved = [
            &mut self.moving.statistics,
            &mut self.placed.statistics,
            &mut self.bundles.statistics,
            &mut self.slicer.statistics,
        ];
        let mut sum = ChartStatistics::default();
        for own in solved {
            let own = std::mem::take(own);
            sum.boxes += own.boxes;
            sum.charts += own.charts;
            sum.evaluations += own.evaluations;
        }
        sum
    }
}
