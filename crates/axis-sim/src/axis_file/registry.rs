//! The kinds that an axis file may name.

use crate::actuator::{ACTUATORS, Actuator};
use crate::control::{CONTROLS, Control};
use crate::effects::{EFFECTS, Effect};
use crate::friction::{FRICTIONS, Friction};
use crate::load::{LOADS, Load};
use crate::mechanism::{MECHANISMS, Mechanism};
use crate::part::PartKind;
use crate::sensor::{SENSORS, Sensor};

/// The kinds that an axis file may name: those of this crate, and whatever a program adds.
#[derive(Clone, Debug)]
pub struct Registry {
    /// Of `[mechanism]`.
    pub mechanisms: Vec<&'static PartKind<dyn Mechanism>>,
    /// Of `[actuator]`.
    pub actuators: Vec<&'static PartKind<dyn Actuator>>,
    /// Of `[control]`.
    pub controls: Vec<&'static PartKind<dyn Control>>,
    /// Of `[friction]`.
    pub frictions: Vec<&'static PartKind<Friction>>,
    /// Of `[[load]]`.
    pub loads: Vec<&'static PartKind<dyn Load>>,
    /// Of `[sensors.load]` and `[sensors.motor]`.
    pub sensors: Vec<&'static PartKind<dyn Sensor>>,
    /// Of `[[effects]]`.
    pub effects: Vec<&'static Effect>,
}

impl Default for Registry {
    fn default() -> Self {
        Self {
            mechanisms: MECHANISMS.to_vec(),
            actuators: ACTUATORS.to_vec(),
            controls: CONTROLS.to_vec(),
            frictions: FRICTIONS.to_vec(),
            loads: LOADS.to_vec(),
            sensors: SENSORS.to_vec(),
            effects: EFFECTS.to_vec(),
        }
    }
}
