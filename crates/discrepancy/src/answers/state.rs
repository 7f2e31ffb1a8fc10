//! A point in the space of models.

use axis_sim::Axis;
use axis_sim::effects::{ActiveEffect, FrictionForm};

/// A point in the space of models.
#[derive(Clone, Debug)]
pub struct State {
    /// Shares by which the known parameters are off.
    pub shares: Vec<f64>,
    /// Effects.
    pub effects: Vec<ActiveEffect>,
}

impl State {
    /// The machine as its file says.
    pub fn initial(machine: &Axis) -> Self {
        Self {
            shares: vec![0.0; machine.known().len()],
            effects: Vec::new(),
        }
    }

    /// The same with a number of an effect (which effect, which of its numbers) moved by so much.
    pub(crate) fn with_moved(&self, (effect, parameter): (usize, usize), by: f64) -> Self {
        let mut moved = self.clone();
        moved.effects[effect].values[parameter] += by;
        moved
    }

    /// Takes an effect out, and with it the forms of it; their places, each as it was
    /// when its turn came.
    pub(crate) fn remove(&mut self, index: usize) -> Vec<usize> {
        let taken = self.effects.remove(index);
        let mut places = vec![index];
        while let Some(place) = self.effects.iter().position(|a| is_form_of(a, &taken)) {
            self.effects.remove(place);
            places.push(place);
        }
        places
    }
}

/// Whether one active effect is a form of another.
pub(crate) fn is_form_of(active: &ActiveEffect, other: &ActiveEffect) -> bool {
    let base = FrictionForm::of(active).and_then(|form| form.base());
    base.is_some_and(|base| base.effect.name == other.effect.name)
}
