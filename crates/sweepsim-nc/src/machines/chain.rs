//! A machine as a chain of joints, from the part to the tool.

use nalgebra::{Unit, Vector3};
use sweepsim_machine::{JOINTS, Joint, Linkage, Values};

use super::bodies::{BASE, Carries};
use super::description::Position;
use super::kinematics::Kinematics;

/// The chain of a machine's axes: the rotary axes that carry the part, the linear ones that do, the base, the linear axes that carry the tool,
/// and the rotary ones that do. All links have the machine's coordinates where all axes are at 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    linkage: Linkage,
    /// The letters of the joints.
    letters: Vec<char>,
    /// The link that stands still.
    base: usize,
}

impl Kinematics {
    /// Its chain of axes.
    #[must_use]
    pub fn chain(&self) -> Chain {
        let [table, head] = self.joints();
        let zero = Vector3::from(self.description().part_zero);
        // Pivots of the table are kept from the part's zero.
        let rotary = |joint: &super::kinematics::Joint, zero: Vector3<f64>| {
            let letter = ['A', 'B', 'C'][joint.letter];
            let (axis, pivot) = (joint.axis, joint.pivot + zero);
            (letter, Joint::Rotary { axis, pivot })
        };
        let linear = |carries: Carries| {
            let axes = self.linear().iter().enumerate();
            axes.filter(move |(_, axis)| axis.carries == carries).map(|(k, axis)| {
                let along = self.directions()[0].column(k).into_owned();
                (axis.letter, Joint::Linear(Unit::new_normalize(along)))
            })
        };
        let mut joints: Vec<(char, Joint)> = table.iter().map(|joint| rotary(joint, zero)).collect();
        joints.extend(linear(Carries::Part));
        let base = joints.len();
        joints.extend(linear(Carries::Tool));
        joints.extend(head.iter().map(|joint| rotary(joint, Vector3::zeros())));
        let (letters, joints) = joints.into_iter().unzip();
        Chain {
            // Five axes at most.
            linkage: Linkage::new(joints).unwrap_or_default(),
            letters,
            base,
        }
    }
}

impl Chain {
    /// The chain itself.
    #[must_use]
    pub fn linkage(&self) -> &Linkage {
        &self.linkage
    }

    /// The letters of its joints, from the part to the tool.
    #[must_use]
    pub fn letters(&self) -> &[char] {
        &self.letters
    }

    /// The link that the part is on.
    #[must_use]
    pub fn part(&self) -> usize {
        0
    }

    /// The link that the spindle is on.
    #[must_use]
    pub fn spindle(&self) -> usize {
        self.letters.len()
    }

    /// The link that stands still.
    #[must_use]
    pub fn base(&self) -> usize {
        self.base
    }

    /// The link that an axis carries, or the base.
    #[must_use]
    pub fn link(&self, on: &str) -> Option<usize> {
        if on == BASE {
            return Some(self.base);
        }
        let joint = self.letters.iter().position(|letter| on == letter.to_string())?;
        Some(if joint < self.base { joint } else { joint + 1 })
    }

    /// How far its joints may be from where they are, if the part is moved by up to `offset` along x, y and z, one way or the other, and the
    /// tool is up to `length` longer or shorter: the tip stays on the part.
    ///
    /// A table that turns carries a shift of the part any way, and so does a head that of the tip.
    #[must_use]
    pub fn spread(&self, machine: &Kinematics, offset: [f64; 3], length: f64) -> Values {
        let [table, head] = machine.joints();
        let [directions, inverse] = machine.directions();
        let (offset, size) = (Vector3::from(offset), Vector3::from(offset).norm());
        let is_plain = *directions == nalgebra::Matrix3::identity();
        let mut spread = [0.0; JOINTS];
        for (own, letter) in spread.iter_mut().zip(&self.letters) {
            let Some(k) = ['X', 'Y', 'Z'].iter().position(|linear| linear == letter) else {
                continue;
            };
            let most = inverse.row(k).norm();
            let of_part = if table.is_empty() && is_plain {
                offset[k]
            } else {
                most * size
            };
            let of_tool = if head.is_empty() { inverse[(k, 2)].abs() } else { most };
            *own = of_part + of_tool * length;
        }
        spread
    }

    /// The values of its joints where all axes stand before a program: at their homes, or where they start.
    #[must_use]
    pub fn home(&self, machine: &Kinematics) -> Values {
        let mut values = [0.0; JOINTS];
        for (own, letter) in values.iter_mut().zip(&self.letters) {
            *own = machine.at_home(*letter);
        }
        values
    }

    /// The values of its joints, in machine coordinates of the spindle's nose, at a position of the axes with a tool of this length (mm).
    pub(crate) fn values(&self, machine: &Kinematics, at: &Position, tool_length: f64) -> Values {
        let offset = machine.to_machine(tool_length);
        let value = |letter: char| match letter {
            'X' | 'Y' | 'Z' => {
                let k = letter as usize - 'X' as usize;
                at.xyz[k] + offset[k]
            }
            _ => at.abc[letter as usize - 'A' as usize],
        };
        let mut values = [0.0; JOINTS];
        for (own, letter) in values.iter_mut().zip(&self.letters) {
            *own = value(*letter);
        }
        values
    }
}
