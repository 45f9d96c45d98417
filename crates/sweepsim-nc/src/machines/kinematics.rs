//! From positions of the axes to poses of the tool.

use nalgebra::{Matrix3, Unit, Vector3};
use sweepsim_motion::{Pose, PoseError, TableTurns, TipArc};

use super::description::{LinearAxis, MachineDescription, Position, Rapid, RotaryAxis, check, check_axis};
use super::error::MachineError;
use super::rotaries::{Rotaries, rotation};

/// A machine's chain of axes from the part to the tool.
///
/// With all rotary axes at 0, a program's X, Y and Z are the tip in the part's frame. Otherwise the table's axes turn the part about their
/// pivots, and the head's turn the tool about theirs:
///
/// `tip = T₁ T₂ (D (x, y, z) + H₁ H₂ 0)`
///
/// where `T` and `H` turn about the pivots of table and head (the latter seen from the tip of a tool of the given length), from the part to
/// the tool, and `D` has the directions of the linear axes as columns.
///
/// ```
/// use sweepsim_nc::{Kinematics, MachineDescription, Position, RotaryAxis};
/// // A trunnion: C turns on A, 50 mm below the part's zero.
/// let mut machine = MachineDescription { name: "trunnion".into(), ..Default::default() };
/// machine.table.push(RotaryAxis::new('C', [0.0, 0.0, 1.0], [0.0; 3]));
/// machine.table.push(RotaryAxis::new('A', [1.0, 0.0, 0.0], [0.0, 0.0, -50.0]));
/// let machine = Kinematics::new(machine)?;
/// let pose = machine.pose(&Position::new([0.0, 0.0, 0.0], [90.0, 0.0, 0.0]), 0.0)?;
/// assert_eq!((pose.tip(), pose.axis()), ([0.0, -50.0, -50.0], [0.0, -1.0, 0.0]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Kinematics {
    description: MachineDescription,
    linear: [LinearAxis; 3],
    /// From the part to the linear axes, and from there to the tool.
    table: Vec<Joint>,
    head: Vec<Joint>,
    rotaries: Rotaries,
    /// From X, Y, Z to directions in space, and back.
    directions: Matrix3<f64>,
    inverse_directions: Matrix3<f64>,
}

/// A rotary axis, ready for use.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Joint {
    /// The index of its letter among A, B, C.
    pub letter: usize,
    pub axis: Unit<Vector3<f64>>,
    /// In the table from the program's zero; in the head from the spindle's nose.
    pub pivot: Vector3<f64>,
}

impl Joint {
    /// The turn of a point about a pivot that is `raised` along the tool's axis.
    pub fn turn(&self, point: Vector3<f64>, abc: [f64; 3], raised: f64) -> Vector3<f64> {
        let pivot = self.pivot + Vector3::z() * raised;
        rotation(&self.axis, abc[self.letter]) * (point - pivot) + pivot
    }
}

fn direction(what: impl Fn() -> String, vector: [f64; 3]) -> Result<Unit<Vector3<f64>>, MachineError> {
    let largest = vector
        .iter()
        .fold(0.0_f64, |m, c| if c.is_nan() { f64::NAN } else { m.max(c.abs()) });
    if !(largest > 0.0 && largest.is_finite()) {
        return Err(MachineError::Value {
            what: what(),
            found: format!("({}, {}, {})", vector[0], vector[1], vector[2]),
            expected: "a direction",
        });
    }
    Ok(Unit::new_normalize(Vector3::from(vector) / largest))
}

impl Kinematics {
    /// The chain of a machine.
    ///
    /// # Errors
    /// [`MachineError`]: letters, directions, limits or numbers that make no machine.
    pub fn new(description: MachineDescription) -> Result<Self, MachineError> {
        let mut seen: Vec<char> = Vec::new();
        let mut once = |letter: char| {
            if seen.contains(&letter) {
                return Err(MachineError::Twice(letter));
            }
            seen.push(letter);
            Ok(())
        };
        let mut linear = ['X', 'Y', 'Z'].map(LinearAxis::new);
        let mut directions = Matrix3::identity();
        for axis in &description.linear {
            let Some(k) = ['X', 'Y', 'Z'].iter().position(|letter| *letter == axis.letter) else {
                return Err(MachineError::Letter {
                    letter: axis.letter,
                    kind: "linear",
                    expected: "X, Y or Z",
                });
            };
            once(axis.letter)?;
            let rates = [axis.speed, axis.acceleration, axis.jerk, axis.rapid_acceleration];
            check_axis(axis.letter, axis.limits, rates, axis.start)?;
            if let Some(vector) = axis.direction {
                let unit = direction(|| format!("the direction of {}", axis.letter), vector)?;
                directions.set_column(k, &unit);
            }
            linear[k] = axis.clone();
        }
        let inverse_directions = directions
            .try_inverse()
            .filter(|_| directions.determinant().abs() > 1e-6)
            .ok_or(MachineError::Flat)?;
        let all = || description.table.iter().chain(&description.head);
        if all().count() > 2 {
            return Err(MachineError::TooMany(all().count()));
        }
        let mut joint = |axis: &RotaryAxis, zero: Vector3<f64>| {
            let Some(letter) = ['A', 'B', 'C'].iter().position(|letter| *letter == axis.letter) else {
                return Err(MachineError::Letter {
                    letter: axis.letter,
                    kind: "rotary",
                    expected: "A, B or C",
                });
            };
            once(axis.letter)?;
            check_axis(
                axis.letter,
                axis.limits,
                [axis.speed, axis.acceleration, axis.jerk, None],
                axis.start,
            )?;
            for coordinate in axis.pivot {
                let what = || format!("the pivot of {}", axis.letter);
                check(what, coordinate, coordinate.is_finite(), "three numbers")?;
            }
            Ok(Joint {
                letter,
                axis: direction(|| format!("the axis of {}", axis.letter), axis.axis)?,
                pivot: Vector3::from(axis.pivot) - zero,
            })
        };
        for coordinate in description.part_zero {
            check(
                || "part_zero".into(),
                coordinate,
                coordinate.is_finite(),
                "three numbers",
            )?;
        }
        let good = |value: f64| value > 0.0 && value.is_finite();
        let deviation = description.corner_deviation.unwrap_or(1.0);
        check(|| "corner_deviation".into(), deviation, good(deviation), "positive")?;
        let (smoothing, expected) = (description.smoothing, "positive, or 0");
        let averages = smoothing == 0.0 || good(smoothing);
        check(|| "smoothing".into(), smoothing, averages, expected)?;
        let zero = Vector3::from(description.part_zero);
        let table: Vec<Joint> = description
            .table
            .iter()
            .map(|axis| joint(axis, zero))
            .collect::<Result<_, _>>()?;
        let head: Vec<Joint> = description
            .head
            .iter()
            .map(|axis| joint(axis, Vector3::zeros()))
            .collect::<Result<_, _>>()?;
        let lengths = description
            .tool_lengths
            .iter()
            .map(|(tool, length)| (format!("the length of tool {tool}"), *length));
        for (what, length) in lengths.chain([("tool_length".to_owned(), description.tool_length)]) {
            check(|| what.clone(), length, length.is_finite(), "a number")?;
        }
        let joints: Vec<&Joint> = table.iter().chain(&head).collect();
        if let [first, second] = joints[..] {
            let letter = |joint: &Joint| ['A', 'B', 'C'][joint.letter];
            if first.axis.cross(&second.axis).norm() < 1e-6 {
                return Err(MachineError::Parallel(letter(first), letter(second)));
            }
            if second.axis.cross(&Vector3::z()).norm() < 1e-6 {
                return Err(MachineError::Idle(letter(second)));
            }
        }
        description.check_bodies()?;
        description.check_places()?;
        let rotaries = Rotaries::new(joints.iter().map(|joint| (joint.letter, joint.axis)));
        Ok(Self {
            description,
            linear,
            table,
            head,
            rotaries,
            directions,
            inverse_directions,
        })
    }

    /// What it is made of.
    #[must_use]
    pub fn description(&self) -> &MachineDescription {
        &self.description
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.description.name
    }

    /// The linear axes X, Y, Z.
    #[must_use]
    pub fn linear(&self) -> &[LinearAxis; 3] {
        &self.linear
    }

    /// The rotary axes from the part to the tool: those of the table, and those of the head.
    pub fn rotary(&self) -> impl Iterator<Item = &RotaryAxis> {
        self.description.table.iter().chain(&self.description.head)
    }

    /// How rapid moves are made.
    #[must_use]
    pub fn rapid(&self) -> Rapid {
        self.description.rapid
    }

    /// The length of a tool, in millimetres.
    #[must_use]
    pub fn tool_length(&self, tool: Option<u32>) -> f64 {
        let own = tool.and_then(|tool| self.description.tool_lengths.get(&tool));
        own.copied().unwrap_or(self.description.tool_length)
    }

    /// Where the axes stand at the start, for a tool of this length.
    #[must_use]
    pub fn start(&self, tool_length: f64) -> Position {
        let mut abc = [0.0; 3];
        for axis in self.rotary() {
            if let Some(k) = ['A', 'B', 'C'].iter().position(|letter| *letter == axis.letter) {
                abc[k] = axis.start;
            }
        }
        let machine = Vector3::from(self.linear.clone().map(|axis| axis.start));
        let xyz = machine - self.to_machine(tool_length);
        Position::new(xyz.into(), abc)
    }

    /// What machine coordinates of the spindle's nose are more than a program's.
    pub(crate) fn to_machine(&self, tool_length: f64) -> Vector3<f64> {
        self.inverse_directions * (Vector3::from(self.description.part_zero) + Vector3::z() * tool_length)
    }

    /// The pose of a tool of this length (mm) at a position of the axes, with the tool's own x.
    ///
    /// # Errors
    /// [`PoseError`] if a number is not finite, or overflows.
    pub fn pose(&self, at: &Position, tool_length: f64) -> Result<Pose, PoseError> {
        Pose::new(self.tip(at, tool_length).into(), self.rotaries.axis(at.abc).into())
    }

    /// The direction from the tip to the holder at angles A, B, C in degrees.
    #[must_use]
    pub fn axis(&self, abc: [f64; 3]) -> [f64; 3] {
        self.rotaries.axis(abc).into()
    }

    /// From X, Y, Z to directions in space, and back.
    pub(crate) fn directions(&self) -> [&Matrix3<f64>; 2] {
        [&self.directions, &self.inverse_directions]
    }

    /// The rotary axes of table and head.
    pub(super) fn joints(&self) -> [&[Joint]; 2] {
        [&self.table, &self.head]
    }

    pub(crate) fn rotaries(&self) -> &Rotaries {
        &self.rotaries
    }

    pub(crate) fn tip(&self, at: &Position, tool_length: f64) -> Vector3<f64> {
        let head = self.head_offset(at.abc, tool_length);
        let point = self.directions * Vector3::from(at.xyz) + head;
        self.table
            .iter()
            .rev()
            .fold(point, |point, joint| joint.turn(point, at.abc, 0.0))
    }

    /// Where the head's turns take the tip.
    fn head_offset(&self, abc: [f64; 3], tool_length: f64) -> Vector3<f64> {
        self.head
            .iter()
            .rev()
            .fold(Vector3::zeros(), |tip, joint| joint.turn(tip, abc, tool_length))
    }

    /// X, Y, Z of a tip at given angles.
    pub(crate) fn linear_at(&self, tip: [f64; 3], abc: [f64; 3], tool_length: f64) -> [f64; 3] {
        let at_zero = self.table.iter().fold(Vector3::from(tip), |point, joint| {
            rotation(&joint.axis, abc[joint.letter]).tr_mul(&(point - joint.pivot)) + joint.pivot
        });
        (self.inverse_directions * (at_zero - self.head_offset(abc, tool_length))).into()
    }

    /// Bounds the second derivatives of X, Y, Z while the tip moves straight between two points and the rotary axes turn at constant speed, in
    /// mm over the square of the move's duration.
    ///
    /// As for [`chords`](Self::chords), but from the part to the tool: the tip is turned by the table, and what the head's turns add is taken off.
    pub(crate) fn bend(&self, tips: [[f64; 3]; 2], from: [f64; 3], to: [f64; 3], tool_length: f64) -> [f64; 3] {
        let [first, last] = tips.map(Vector3::from);
        let middle: [f64; 3] = std::array::from_fn(|k| 0.5 * (from[k] + to[k]));
        let mut acceleration = 0.0;
        let mut turn = |point: &Vector3<f64>, speed: &mut f64, joint: &Joint, raised: f64| {
            let rate = (to[joint.letter] - from[joint.letter]).abs().to_radians();
            let pivot = joint.pivot + Vector3::z() * raised;
            let distance = joint.axis.cross(&(point - pivot)).norm() + 0.5 * *speed;
            acceleration += 2.0 * rate * *speed + rate * rate * distance;
            *speed += rate * distance;
        };
        let (mut point, mut speed) = (0.5 * (first + last), (last - first).norm());
        for joint in &self.table {
            turn(&point, &mut speed, joint, 0.0);
            point = rotation(&joint.axis, middle[joint.letter]).tr_mul(&(point - joint.pivot)) + joint.pivot;
        }
        let (mut point, mut speed) = (Vector3::zeros(), 0.0);
        for joint in self.head.iter().rev() {
            turn(&point, &mut speed, joint, tool_length);
            point = joint.turn(point, middle, tool_length);
        }
        std::array::from_fn(|k| acceleration * self.inverse_directions.row(k).norm())
    }

    /// How X, Y, Z change with the tip at fixed angles.
    pub(crate) fn linear_along(&self, way: [f64; 3], abc: [f64; 3]) -> [f64; 3] {
        let turned = self.table.iter().fold(Vector3::from(way), |way, joint| {
            rotation(&joint.axis, abc[joint.letter]).tr_mul(&way)
        });
        (self.inverse_directions * turned).into()
    }

    /// The turns, in the part's frame, by which the table carries the part between two positions, while no axis of the head turns: the tip goes straight
    /// in the frame that turns so. `None` if the part does not turn, or the head does.
    pub(crate) fn carries(&self, from: [f64; 3], to: [f64; 3]) -> Option<TableTurns> {
        let turns = |joint: &Joint| from[joint.letter] != to[joint.letter];
        let one = |(number, joint): (usize, &Joint)| {
            // Through the axes that are nearer to the part, where they are at the start.
            let within = self.table[..number].iter().rev();
            let ends = [joint.pivot, joint.pivot + joint.axis.into_inner()];
            let [centre, above] = ends.map(|point| within.clone().fold(point, |point, own| own.turn(point, from, 0.0)));
            let angle = (to[joint.letter] - from[joint.letter]).to_radians();
            TipArc::new(centre.into(), (above - centre).into(), angle).ok()
        };
        let mut all = self.table.iter().enumerate().filter(|(_, joint)| turns(joint)).map(one);
        let first = all.next().flatten().filter(|_| !self.head.iter().any(turns))?;
        match all.next() {
            None => Some(TableTurns::new(first)),
            Some(second) => Some(TableTurns::new(first).on(second?)),
        }
    }

    /// The number of chords within `tolerance` of the tip's course while all axes move at constant speed.
    ///
    /// The tip is a product of turns and shifts. Going from the tool to the part, a shift adds to its speed, and a turn by `ω` about an axis
    /// at distance `r` adds `ω r` to it, and `2 ω v + ω² r` to its acceleration, where `r` exceeds that in the middle of the move by at most
    /// half of the way. A chord of duration `1/n` is within `a/(8 n²)`.
    pub(crate) fn chords(&self, from: &Position, to: &Position, tool_length: f64, tolerance: f64) -> f64 {
        let middle = from.towards(to, 0.5);
        let (mut point, mut speed, mut acceleration) = (Vector3::zeros(), 0.0, 0.0);
        let mut turn = |point: &mut Vector3<f64>, speed: &mut f64, joint: &Joint, raised: f64| {
            let rate = (to.abc[joint.letter] - from.abc[joint.letter]).abs().to_radians();
            let pivot = joint.pivot + Vector3::z() * raised;
            let distance = joint.axis.cross(&(*point - pivot)).norm() + 0.5 * *speed;
            acceleration += 2.0 * rate * *speed + rate * rate * distance;
            *speed += rate * distance;
            *point = joint.turn(*point, middle.abc, raised);
        };
        for joint in self.head.iter().rev() {
            turn(&mut point, &mut speed, joint, tool_length);
        }
        point += self.directions * Vector3::from(middle.xyz);
        speed += (self.directions * (Vector3::from(to.xyz) - Vector3::from(from.xyz))).norm();
        for joint in self.table.iter().rev() {
            turn(&mut point, &mut speed, joint, 0.0);
        }
        (acceleration / (8.0 * tolerance)).sqrt().ceil().max(1.0)
    }
}
