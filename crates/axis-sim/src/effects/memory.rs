//! Forces on the load that depend on what the load did before.

use std::fmt;
use std::sync::Arc;

use crate::start::Start;

/// How the load moved in one step, as a force with a memory sees it.
#[derive(Clone, Copy, Debug, Default)]
pub struct TableStep {
    /// Length of the step, s.
    pub length: f64,
    /// Travel of the load in it, m or rad.
    pub travel: f64,
    /// Speed of the load at its start, m/s or rad/s.
    pub speed_before: f64,
    /// Speed of the load at its end, m/s or rad/s.
    pub speed: f64,
}

/// The law of a force on the load that has a memory. The law is one for all runs; what it
/// remembers belongs to the run, and is copied with its state.
pub trait MemoryLaw: Send + Sync {
    /// How many numbers it remembers.
    fn size(&self) -> usize;

    /// Sets `memory` (all 0 before) to settled motion, and gives the force there, N or
    /// N·m, positive against positive motion.
    fn settle(&self, start: &Start, memory: &mut [f64]) -> f64;

    /// Moves `memory` over a step, and gives the force at its end, N or N·m, positive
    /// against positive motion.
    ///
    /// It is called several times a step, with better and better motions, each time with
    /// the memory of the step's start.
    fn step(&self, step: &TableStep, memory: &mut [f64]) -> f64;
}

/// All laws with a memory of an axis.
#[derive(Clone, Default)]
pub(crate) struct MemoryLaws {
    laws: Vec<Arc<dyn MemoryLaw>>,
}

impl fmt::Debug for MemoryLaws {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.laws.len().fmt(f)
    }
}

impl MemoryLaws {
    pub(crate) fn push(&mut self, law: impl MemoryLaw + 'static) {
        self.laws.push(Arc::new(law));
    }

    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.laws.is_empty()
    }

    /// The memory of settled motion, and the force there.
    pub(crate) fn settled(&self, start: &Start) -> (Memory, f64) {
        let size = self.laws.iter().map(|law| law.size()).sum();
        let mut now = vec![0.0; size];
        let force = self.sum(&mut now, |law, memory| law.settle(start, memory));
        let ahead = now.clone();
        (Memory { now, ahead }, force)
    }

    /// The force at the end of a step.
    pub(crate) fn step(&self, step: &TableStep, memory: &mut Memory) -> f64 {
        memory.ahead.copy_from_slice(&memory.now);
        self.sum(&mut memory.ahead, |law, memory| law.step(step, memory))
    }

    fn sum(
        &self,
        mut memory: &mut [f64],
        force: impl Fn(&dyn MemoryLaw, &mut [f64]) -> f64,
    ) -> f64 {
        let mut sum = 0.0;
        for law in &self.laws {
            let (own, rest) = memory.split_at_mut(law.size());
            sum += force(&**law, own);
            memory = rest;
        }
        sum
    }
}

/// What a run remembers: at the start of a step, and at its end as far as it is known.
#[derive(Clone, Debug, Default)]
pub(crate) struct Memory {
    now: Vec<f64>,
    ahead: Vec<f64>,
}

impl Memory {
    /// Takes the end of a step for the start of the next.
    pub(crate) fn accept(&mut self) {
        std::mem::swap(&mut self.now, &mut self.ahead);
    }
}
