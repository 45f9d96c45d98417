//! Programs and subprograms on their way, and calls of them.

use std::collections::BTreeMap;

use super::language::cursor::without_comment;
use super::language::expression::Value;
use super::language::structures::VariableKind;
use super::state::SavedModes;

/// A call of a subprogram that is still to be made.
#[derive(Clone, Debug)]
pub(super) struct Call {
    pub name: String,
    pub values: Vec<Value>,
    /// The caller's variables among the arguments, each in its place.
    pub variables: Vec<Option<String>>,
    pub times: usize,
    pub modally: bool,
}

/// A part of a program that is repeated.
pub(super) struct Section {
    pub(super) from: usize,
    pub(super) end: usize,
    pub(super) times: usize,
    pub(super) then: usize,
}

/// A program or subprogram on its way.
pub(super) struct Level {
    pub(super) routine: usize,
    pub(super) next: usize,
    pub(super) locals: BTreeMap<String, Value>,
    /// What locals hold, if it is not any number or text.
    kinds: BTreeMap<String, VariableKind>,
    /// Parameters that the caller's variables get at its end.
    pub(super) returned: Vec<(String, String)>,
    /// The caller's modes that come back at its end.
    pub(super) saved: Option<Box<SavedModes>>,
    /// Whether it is what a modal call calls, or a contour: moves in it call nothing.
    pub(super) called_modally: bool,
    pub(super) sections: Vec<Section>,
    /// How often it starts again.
    pub(super) times: usize,
}

impl Level {
    pub(super) fn new(routine: usize, times: usize) -> Self {
        Self {
            routine,
            next: 0,
            locals: BTreeMap::new(),
            kinds: BTreeMap::new(),
            returned: Vec::new(),
            saved: None,
            called_modally: false,
            sections: Vec::new(),
            times,
        }
    }

    pub(super) fn define(&mut self, name: String, value: Value, kind: VariableKind) {
        if kind != VariableKind::Real {
            self.kinds.insert(name.clone(), kind);
        }
        self.locals.insert(name, value);
    }

    /// A value as a local, or an element of a local array, holds it.
    pub(super) fn held(&self, name: &str, value: Value) -> Value {
        let array = name.split_once('[').map_or(name, |(array, _)| array);
        match self.kinds.get(array) {
            Some(kind) => kind.held(value),
            None => value,
        }
    }
}

/// Whether a text changes tools by M6, not by T alone.
pub(super) fn changes_by_m6(text: &str) -> bool {
    let codes = text.lines().map(without_comment);
    let mut pieces = codes.flat_map(|code| code.split(|c: char| !c.is_ascii_alphanumeric()));
    pieces.any(|piece| {
        let upper = piece.to_ascii_uppercase();
        upper.match_indices('M').any(|(at, _)| {
            let digits: String = upper[at + 1..].chars().take_while(char::is_ascii_digit).collect();
            // In T1M6 too, not in a name.
            let before = upper[..at].chars().next_back();
            matches!(digits.as_str(), "6" | "06") && before.is_none_or(|c| c.is_ascii_digit())
        })
    })
}
