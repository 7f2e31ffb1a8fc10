//! `gravity`: the weight of a vertical or inclined axis, less its counterweight.

use std::sync::Arc;

use super::Load;
use crate::effects::{Steepness, TableState};
use crate::part::units::FORCE;
use crate::part::{Known, PartKind, quantity};

pub(super) static KIND: PartKind<dyn Load> = PartKind {
    name: "gravity",
    summary: "weight of a vertical axis that its counterweight does not carry, positive downward",
    keys: &[quantity("weight", &FORCE, -1e7, 1e7)],
    known: &[Known::key("weight")],
    build: |v| Ok(Arc::new(Gravity(v.number("weight")?))),
};

#[derive(Debug)]
struct Gravity(f64);

impl Load for Gravity {
    fn force(&self, _: &TableState) -> f64 {
        self.0
    }

    fn steepness(&self) -> Steepness {
        Steepness::default()
    }
}
