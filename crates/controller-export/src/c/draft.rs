//! C code that is being put together.

use std::collections::BTreeSet;

use super::part::{self, Part};
use super::{Input, Memory, Precision};

/// A struct of the state: one member of the compensator's own.
#[derive(Debug)]
pub(super) struct State {
    /// Name of the member, and of its type after the compensator's name.
    pub name: &'static str,
    /// Its type, with placeholders.
    pub declaration: String,
    /// Numbers and 32-bit integers in it.
    pub reals: usize,
    pub integers: usize,
}

/// What has come together so far.
#[derive(Debug)]
pub(super) struct Draft {
    pub precision: Precision,
    pub states: Vec<State>,
    /// Tables and constants.
    pub data: String,
    pub parts: Vec<&'static Part>,
    pub inputs: BTreeSet<Input>,
    /// What the offsets of position and command are, as C.
    pub position: Option<&'static str>,
    pub effort: Option<&'static str>,
    /// For a plan, which steps otherwise: its look-ahead in cycles, and whether a feedback
    /// stands around it.
    pub plan: Option<(usize, bool)>,
    /// The guard's limits as C.
    pub limits: String,
    /// Numbers in constants and tables, and 32-bit counts.
    pub constants: usize,
    pub counts: usize,
    /// Numbers on the stack.
    pub stack: usize,
}

impl Draft {
    pub fn new(precision: Precision) -> Self {
        Self {
            precision,
            states: Vec::new(),
            data: String::new(),
            parts: Vec::new(),
            inputs: BTreeSet::new(),
            position: None,
            effort: None,
            plan: None,
            limits: String::new(),
            constants: 0,
            counts: 0,
            stack: 0,
        }
    }

    /// Takes in a part of the evaluator.
    pub fn part(&mut self, part: &'static Part) {
        part.join(&mut self.parts);
    }

    /// Whether a part needs `<math.h>`.
    pub fn needs_library(&self) -> bool {
        self.parts
            .iter()
            .any(|part| std::ptr::eq(*part, &part::ROOT))
    }

    /// Bytes that it takes.
    pub fn memory(&self) -> Memory {
        let word = self.precision.bytes();
        let state = |s: &State| (s.reals * word + s.integers * 4).next_multiple_of(word);
        Memory {
            // And the word that says that it was inited.
            state: self.states.iter().map(state).sum::<usize>() + word,
            constants: self.constants * word + self.counts * 4,
            greatest_array: self.stack * word,
        }
    }
}
