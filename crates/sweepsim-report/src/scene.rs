//! What the viewer shows: plain data, without any geometry of sweeps.

/// A rectangle of lines, in the frame of the lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    /// The lower corner.
    pub min: [f64; 2],
    /// The upper corner.
    pub max: [f64; 2],
    /// Lines along x and y: one through the centre of each cell.
    pub cells: [usize; 2],
}

/// An end of an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerEnd {
    /// Its height.
    pub z: f64,
    /// The unit normal of the surface, out of the material, in the frame of the lines.
    pub normal: [f32; 3],
    /// The signed distance from the target in millimetres, negative where too much was removed; NaN if it is not known.
    pub deviation: f32,
    /// 0 for the stock, otherwise 1 plus the number of the move that made it, counted over the whole program.
    pub maker: u32,
}

impl LayerEnd {
    /// An end of the stock, without a deviation.
    #[must_use]
    pub fn at(z: f64, normal: [f32; 3]) -> Self {
        Self {
            z,
            normal,
            deviation: f32::NAN,
            maker: 0,
        }
    }
}

/// Intervals of material on the lines of a rectangle, sorted by column, then row.
#[derive(Clone, Debug, PartialEq)]
pub struct DexelLayer {
    pub(crate) area: Area,
    pub(crate) counts: Vec<u16>,
    pub(crate) intervals: Vec<[LayerEnd; 2]>,
}

impl DexelLayer {
    /// Builds a layer line by line: `write` gets column and row, and appends the line's intervals `[lower, upper]` from
    /// the lowest up. Of a line with more than 65,535 intervals, the lowest are kept; intervals with an end that is not
    /// finite are left out.
    pub fn new(area: Area, mut write: impl FnMut(usize, usize, &mut Vec<[LayerEnd; 2]>)) -> Self {
        let mut layer = Self {
            area,
            counts: Vec::with_capacity(area.cells[0].saturating_mul(area.cells[1]).min(1 << 24)),
            intervals: Vec::new(),
        };
        let mut line = Vec::new();
        for i in 0..area.cells[0] {
            for j in 0..area.cells[1] {
                line.clear();
                write(i, j, &mut line);
                line.retain(|[lower, upper]| lower.z.is_finite() && upper.z.is_finite());
                line.truncate(usize::from(u16::MAX));
                layer.counts.push(line.len() as u16);
                layer.intervals.extend_from_slice(&line);
            }
        }
        layer
    }

    /// Every second line along both axes.
    pub(crate) fn halved(&self) -> Self {
        let [nx, ny] = self.area.cells;
        let mut starts = Vec::with_capacity(self.counts.len());
        let mut start = 0;
        for count in &self.counts {
            starts.push(start);
            start += usize::from(*count);
        }
        let cells = [nx.div_ceil(2), ny.div_ceil(2)];
        // The lines that remain stay where they are.
        let Area { min, max, .. } = self.area;
        let spacing = [0, 1].map(|k| (max[k] - min[k]) / self.area.cells[k].max(1) as f64);
        let min = [0, 1].map(|k| min[k] - 0.5 * spacing[k]);
        let max = [0, 1].map(|k| min[k] + 2.0 * spacing[k] * cells[k] as f64);
        let mut half = Self {
            area: Area { min, max, cells },
            counts: Vec::new(),
            intervals: Vec::new(),
        };
        for i in (0..nx).step_by(2) {
            for j in (0..ny).step_by(2) {
                let line = i * ny + j;
                half.counts.push(self.counts[line]);
                half.intervals
                    .extend_from_slice(&self.intervals[starts[line]..][..usize::from(self.counts[line])]);
            }
        }
        half
    }
}

/// The lines that changed since the moment before.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KeyFrame {
    pub(crate) clock: f64,
    pub(crate) lines: Vec<u32>,
    pub(crate) counts: Vec<u16>,
    pub(crate) intervals: Vec<[f64; 2]>,
    /// The deviations of both ends of each interval; NaN if they are not known.
    pub(crate) deviations: Vec<[f32; 2]>,
}

impl KeyFrame {
    /// The state at a time on the program's clock, as yet without changes.
    #[must_use]
    pub fn new(clock: f64) -> Self {
        Self {
            clock,
            ..Self::default()
        }
    }

    /// Sets the material of a line from now on: its number (column times rows, plus row), and its intervals from the
    /// lowest up.
    pub fn push(&mut self, line: u32, intervals: impl IntoIterator<Item = [f64; 2]>) {
        self.push_measured(line, intervals.into_iter().map(|ends| (ends, [f32::NAN; 2])));
    }

    /// The same with the deviations of both ends: their distances from the target, NaN if they are not known.
    pub fn push_measured(&mut self, line: u32, intervals: impl IntoIterator<Item = ([f64; 2], [f32; 2])>) {
        let before = self.intervals.len();
        let finite = intervals
            .into_iter()
            .filter(|([lower, upper], _)| lower.is_finite() && upper.is_finite());
        for (ends, deviations) in finite.take(usize::from(u16::MAX)) {
            self.intervals.push(ends);
            self.deviations.push(deviations);
        }
        self.lines.push(line);
        self.counts.push((self.intervals.len() - before) as u16);
    }

    /// Whether nothing changed.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }
}

/// The workpiece during the program, on lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// The stock before the first move.
    pub start: DexelLayer,
    /// What changed until each moment, in order.
    pub frames: Vec<KeyFrame>,
}

/// The part's surface as triangles, sharp at edges: what is shown where it is known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Corners, in the world. On sharp edges each side has its own.
    pub vertices: Vec<[f64; 3]>,
    /// The unit normal at each corner.
    pub normals: Vec<[f32; 3]>,
    /// The signed distance of each corner from the target along its normal, negative where too much was removed; NaN
    /// if it is not known. Empty without a target.
    pub deviations: Vec<f32>,
    /// Of each triangle, 0 for the stock, otherwise 1 plus the number of the move that made the surface there.
    pub makers: Vec<u32>,
    /// Numbers of corners, counter-clockwise seen from outside; triangles without a corner are left out.
    pub triangles: Vec<[u32; 3]>,
    /// The number of triangles of the surface, which may be more.
    pub whole: usize,
    /// How far corners of the whole surface are from these triangles at most.
    pub farthest: f64,
}

/// The workpiece during the program as triangles, sharp at edges. Moment 0 is the start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceCourse {
    /// The times of the moments from 1 on the program's clock.
    pub clocks: Vec<f64>,
    /// The triangles of all moments.
    pub surface: Surface,
    /// Of each triangle, the moment from which it is there, and that from which it is not.
    pub spans: Vec<[u16; 2]>,
}

/// Where the tool is at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackPoint {
    /// The time on the program's clock.
    pub clock: f64,
    /// The tip.
    pub tip: [f64; 3],
    /// The direction of the tool's axis: towards the holder.
    pub axis: [f64; 3],
    /// The move that ends here or later, counted over the whole program from 0.
    pub number: u32,
    /// Whether it is a rapid.
    pub rapid: bool,
    /// Whether the tool does not move to this point from the one before: a path begins.
    pub begins: bool,
    /// The tool: an index of [`Scene::tools`].
    pub tool: u16,
}

/// The way of the tools. Between two points, tip and axis are interpolated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Track {
    /// The points, by time.
    pub points: Vec<TrackPoint>,
    /// File and line (from 1) of each move; line 0 if there is none. Files are indices of [`Scene::programs`].
    pub lines: Vec<(u16, u32)>,
    /// The unit of the clock: `s`, or `mm` if there are no feeds.
    pub unit: String,
}

/// The shape of a part of a tool, in the frame of the tool: tip at the origin, axis along z.
#[derive(Clone, Debug, PartialEq)]
pub enum ToolShape {
    /// A solid of revolution, by points (radius, height) from its lower to its upper end on the axis.
    Profile(Vec<[f64; 2]>),
    /// Triangles, counter-clockwise seen from outside.
    Mesh {
        /// Corners.
        vertices: Vec<[f64; 3]>,
        /// Numbers of corners.
        triangles: Vec<[u32; 3]>,
    },
}

/// A tool as it is shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ToolPart {
    /// What people call it.
    pub name: String,
    /// The part that cuts.
    pub cutter: Vec<ToolShape>,
    /// Shank, holder, and all else that moves along.
    pub bodies: Vec<ToolShape>,
}

/// What a solid is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolidKind {
    /// The stock before the first move.
    Stock,
    /// The part that is wanted.
    Target,
    /// Something that holds the workpiece.
    Fixture,
    /// A body of the machine, in the coordinates of a link of its chain: see [`Machine`].
    Body {
        /// The link.
        link: u16,
    },
}

/// The most joints of a machine.
pub const JOINTS: usize = 6;

/// A joint of a machine: it says where points of the next link are, as seen from the one before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MachineJoint {
    /// The direction of a shift, or the axis of a turn: a unit vector.
    pub axis: [f64; 3],
    /// A point of the axis of a turn by degrees; a joint without one shifts by millimetres.
    pub pivot: Option<[f64; 3]>,
}

/// The values of all joints at a time. Between two points they are interpolated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MachinePoint {
    /// The time on the program's clock.
    pub clock: f64,
    /// The values.
    pub values: [f64; JOINTS],
    /// Whether nothing leads here from the point before.
    pub begins: bool,
}

/// A machine: a chain of links from the part, link 0, to the tool.
#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    /// The joints; at most [`JOINTS`].
    pub joints: Vec<MachineJoint>,
    /// The link that stands still.
    pub base: usize,
    /// The origin and the axes of link 0 in the world.
    pub place: [[f64; 3]; 4],
    /// What the joints do, by time.
    pub points: Vec<MachinePoint>,
    /// When bodies meet, and which: by their order among the solids that are bodies.
    pub contacts: Vec<(f64, Vec<u16>)>,
}

/// A solid as triangles in the world, or on a link of the machine, counter-clockwise seen from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// What it is.
    pub kind: SolidKind,
    /// The set-up to which it belongs, from 0: an index of [`Scene::setups`] if there are any. `None`: it is always
    /// there.
    pub setup: Option<u16>,
    /// Corners.
    pub vertices: Vec<[f64; 3]>,
    /// Numbers of corners; those without a corner are left out.
    pub triangles: Vec<[u32; 3]>,
}

/// The text of a program.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProgramText {
    /// The name of its file.
    pub name: String,
    /// All lines.
    pub text: String,
}

/// What the viewer shows.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Scene {
    /// The part at the end of the program.
    pub part: DexelLayer,
    /// Its surface, where more is known of it than the lines tell.
    pub surface: Option<Surface>,
    /// The origin and the axes of the frame of all lines, in the world.
    pub frame: [[f64; 3]; 4],
    /// The limits of deviations: for gouges and for excess.
    pub limits: Option<[f64; 2]>,
    /// The workpiece during the program. Its lines are in the same frame as those of the part.
    pub course: Option<Course>,
    /// The workpiece during the program, where more is known of it than lines tell: in place of the course on lines.
    pub surface_course: Option<SurfaceCourse>,
    /// The way of the tools.
    pub track: Option<Track>,
    /// The tools.
    pub tools: Vec<ToolPart>,
    /// The last move of each tool's paths, in order: `(number of moves up to there, tool)`.
    pub paths: Vec<(u32, u16)>,
    /// The set-ups, in order: `(number of moves up to there, name)`; none if there is only one, without a name.
    pub setups: Vec<(u32, String)>,
    /// Stock, target and fixtures.
    pub solids: Vec<Solid>,
    /// The machine with what its axes do, if it is shown.
    pub machine: Option<Machine>,
    /// The programs.
    pub programs: Vec<ProgramText>,
}

impl Scene {
    /// A part alone, in the frame of the world.
    #[must_use]
    pub fn new(part: DexelLayer) -> Self {
        Self {
            part,
            surface: None,
            frame: [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            limits: None,
            course: None,
            surface_course: None,
            track: None,
            tools: Vec::new(),
            paths: Vec::new(),
            setups: Vec::new(),
            solids: Vec::new(),
            machine: None,
            programs: Vec::new(),
        }
    }
}
