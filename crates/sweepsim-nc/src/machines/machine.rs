//! Machines: their axes, and the meaning of a program's coordinates on them.

use std::path::Path;
use std::sync::Arc;

use sweepsim_motion::{RotaryTable, Turning};

use super::description::MachineDescription;
use super::error::MachineError;
use super::fcm;
use super::kinematics::Kinematics;
use super::ready;

/// A machine, as far as it is known.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Machine {
    /// The rotary axes of the table, if only their directions are known. `None` if there are none, or if they follow from the letters that a
    /// program uses. Ignored if `kinematics` are given.
    pub table: Option<RotaryTable>,
    /// Whether coordinates are those of the tip in the part's frame from the start, without a code in the program (`M428`, `M128`,
    /// `G43.4`).
    pub tip_control: bool,
    /// All axes with their pivots. Without them a program can turn rotary axes only under tip control.
    pub kinematics: Option<Arc<Kinematics>>,
}

impl Machine {
    /// A machine with two rotary axes in its table.
    #[must_use]
    pub fn with_table(table: RotaryTable) -> Self {
        Self {
            table: Some(table),
            ..Self::default()
        }
    }

    /// Sets whether coordinates are those of the tip from the start.
    #[must_use]
    pub fn tip_control(self, on: bool) -> Self {
        Self {
            tip_control: on,
            ..self
        }
    }

    /// A machine with all its axes.
    ///
    /// # Errors
    /// [`MachineError`] if the description makes no machine.
    pub fn new(description: MachineDescription) -> Result<Self, MachineError> {
        let tip_control = description.tip_control;
        let kinematics = Kinematics::new(description)?;
        let table = match kinematics.rotaries().turning([0.0; 3], [0.0; 3]) {
            Some(Turning::Rotary { table, .. }) if kinematics.rotary().count() == 2 => Some(table),
            _ => None,
        };
        Ok(Self {
            table,
            tip_control,
            kinematics: Some(Arc::new(kinematics)),
        })
    }

    /// A ready machine of the commonest kinds: one of [`names`](Self::names). With sizes after its name it has limits and
    /// bodies: `docs/machines.md` has the words.
    ///
    /// ```
    /// use sweepsim_nc::Machine;
    /// assert!(Machine::named("trunnion-ac").is_some());
    /// assert!(Machine::names().contains(&"nutating-head-bc"));
    /// assert!(Machine::named("trunnion-ac,table=320,travel=500x400x400,zero=60,length=120").is_some());
    /// assert_eq!(Machine::named("hexapod"), None);
    /// ```
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        ready::named(name)?.and_then(Self::new).ok()
    }

    /// The names of the ready machines.
    #[must_use]
    pub fn names() -> &'static [&'static str] {
        &ready::NAMES
    }

    /// Reads a machine from text in RON: see [`MachineDescription`] and `docs/machines.md`.
    ///
    /// # Errors
    /// [`MachineError`]: the text is not RON, has unknown fields, or makes no machine.
    ///
    /// ```
    /// use sweepsim_nc::Machine;
    /// let text = r#"Machine(
    ///     name: "trunnion",
    ///     table: [
    ///         (letter: 'C', axis: (0, 0, 1), pivot: (0, 0, -50)),
    ///         (letter: 'A', axis: (1, 0, 0), pivot: (0, 0, -50), limits: (-30, 120), speed: 7200),
    ///     ],
    ///     linear: [(letter: 'X', limits: (-300, 300), speed: 30000)],
    ///     rapid: DogLeg,
    /// )"#;
    /// let machine = Machine::read(text)?;
    /// assert!(machine.kinematics.is_some());
    /// let error = Machine::read("Machine(name: \"x\",\n    colour: \"grey\")").unwrap_err();
    /// assert!(error.to_string().starts_with("2:5: Unexpected field named `colour`"), "{error}");
    /// # Ok::<(), sweepsim_nc::MachineError>(())
    /// ```
    pub fn read(text: &str) -> Result<Self, MachineError> {
        Self::new(description(text)?)
    }

    /// Reads a machine from a file, also from FreeCAD's `.fcm`, or takes the ready one of this name.
    ///
    /// # Errors
    /// [`MachineError`]: as [`read`](Self::read), or no such file.
    pub fn read_file(file: &Path) -> Result<Self, MachineError> {
        if let Some(ready) = file.to_str().and_then(ready::named) {
            return ready.and_then(Self::new);
        }
        let text = crate::text::whole::text(file).map_err(|error| {
            MachineError::Read(match error.kind() {
                std::io::ErrorKind::NotFound => {
                    format!("there is no such file, and ready ones are {}", ready::NAMES.join(", "))
                }
                _ => error.to_string(),
            })
        })?;
        let is_of_freecad = file
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("fcm"));
        let mut found = if is_of_freecad {
            fcm::description(&text)?
        } else {
            description(&text)?
        };
        found.beside(file);
        Self::new(found)
    }

    /// The text of `machine.ron`, if all axes are known.
    #[must_use]
    pub fn to_ron(&self) -> Option<String> {
        let options = ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
        let pretty = ron::ser::PrettyConfig::new().struct_names(true);
        options
            .to_string_pretty(self.kinematics.as_ref()?.description(), pretty)
            .ok()
    }
}

/// What text in RON says of a machine.
fn description(text: &str) -> Result<MachineDescription, MachineError> {
    let options = ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
    options.from_str(text).map_err(|error| MachineError::Syntax {
        line: error.span.start.line,
        column: error.span.start.col,
        message: error.code.to_string(),
    })
}
