//! Where the loop calls effects.

use std::fmt;
use std::sync::Arc;

use super::memory::{MemoryLaw, MemoryLaws};
use super::sensor_errors::SensorErrors;
use super::state::{ScrewState, Steepness, TableState};

type Load = Arc<dyn Fn(&TableState) -> f64 + Send + Sync>;

type Torque = Arc<dyn Fn(f64, f64) -> f64 + Send + Sync>;

type Offset = Arc<dyn Fn(&ScrewState) -> [f64; 3] + Send + Sync>;

/// Where the loop calls effects. The default has none, and costs nothing.
#[derive(Clone, Default)]
pub(crate) struct Hooks {
    loads: Vec<Load>,
    memories: MemoryLaws,
    /// That of all loads together.
    steepness: Steepness,
    torques: Vec<Torque>,
    offsets: Vec<Offset>,
    pub(crate) sensors: SensorErrors,
    pub(crate) clock_offset: f64,
    pub(crate) reference_delay: f64,
}

impl fmt::Debug for Hooks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Hooks")
            .field("loads", &self.loads.len())
            .field("memories", &self.memories)
            .field("torques", &self.torques.len())
            .field("offsets", &self.offsets.len())
            .finish_non_exhaustive()
    }
}

impl Hooks {
    /// Adds a load on the table, N, positive against positive motion, that changes with
    /// its motion by at most `steepness`.
    pub fn load(
        &mut self,
        steepness: Steepness,
        load: impl Fn(&TableState) -> f64 + Send + Sync + 'static,
    ) {
        self.steepness = self.steepness.and(steepness);
        self.loads.push(Arc::new(load));
    }

    /// Adds a load with a memory that changes with the motion at the end of a step by at
    /// most `steepness`.
    pub fn memory(&mut self, steepness: Steepness, law: impl MemoryLaw + 'static) {
        self.steepness = self.steepness.and(steepness);
        self.memories.push(law);
    }

    /// Adds a motor torque, N·m, from motor angle (rad) and air-gap torque (N·m).
    pub fn torque(&mut self, torque: impl Fn(f64, f64) -> f64 + Send + Sync + 'static) {
        self.torques.push(Arc::new(torque));
    }

    /// Adds a displacement of the nut, its rate, and how it grows with the motor's angle: m, m/s, m/rad.
    pub fn offset(&mut self, offset: impl Fn(&ScrewState) -> [f64; 3] + Send + Sync + 'static) {
        self.offsets.push(Arc::new(offset));
    }

    pub(crate) fn steepness(&self) -> Steepness {
        self.steepness
    }

    pub(crate) fn has_loads(&self) -> bool {
        !(self.loads.is_empty() && self.memories.is_empty())
    }

    pub(crate) fn memories(&self) -> &MemoryLaws {
        &self.memories
    }

    pub(crate) fn has_offsets(&self) -> bool {
        !self.offsets.is_empty()
    }

    pub(crate) fn loads_at(&self, table: &TableState) -> f64 {
        self.loads.iter().map(|load| load(table)).sum()
    }

    pub(crate) fn torque_at(&self, angle: f64, torque: f64) -> f64 {
        let added = |sum, hook: &Torque| sum + hook(angle, torque);
        self.torques.iter().fold(torque, added)
    }

    /// Displacement, rate and growth with the motor's angle of all together.
    pub(crate) fn offset_at(&self, screw: &ScrewState) -> [f64; 3] {
        self.offsets.iter().fold([0.0; 3], |sum, hook| {
            let own = hook(screw);
            std::array::from_fn(|i| sum[i] + own[i])
        })
    }
}
