//! `structural-resonance`: a body on the load that swings by itself, as of its structure.
//!
//! A modal mass m is held to the load by a spring and a damper of the natural frequency
//! ω = 2π f and damping ratio ζ. With q its position against the load's y
//!
//! ```text
//! q̈ + 2 ζ ω q̇ + ω² q = −ÿ,   force = m (ÿ + q̈) = −m (ω² q + 2 ζ ω q̇)
//! ```
//!
//! against positive motion: slow motion feels the mass m, fast motion nothing, and near f
//! the load is held still (Ormondroyd and Den Hartog, Trans. ASME 50 (1928), APM-50-7).
//! The step is the average acceleration's (Newmark, J. Eng. Mech. Div. ASCE 85 (1959)
//! 67–94, doi:10.1061/JMCEA3.0000098), implicit in the load's speed at its end: stable for
//! every step, and without damping of its own.

use std::f64::consts::TAU;

use super::{Effect, EffectChannel, Measure, MemoryLaw, Nature, TableStep, shape, size};
use crate::error::SetupError;
use crate::plant::Start;

pub(super) const EFFECT: Effect = Effect {
    name: "structural-resonance",
    summary: "a body on the load that swings by itself",
    channel: EffectChannel::Torque,
    depends_on: "acceleration, near one frequency",
    parameters: &[
        size("mass", Measure::Inertia, 20.0, 1e3),
        shape(
            "frequency",
            Measure::Other("Hz"),
            Nature::Extent(&[20.0, 35.0, 60.0, 100.0], [18.0, 120.0]),
            45.0,
            [1.0, 1e3],
        ),
        shape(
            "damping_ratio",
            Measure::Ratio,
            Nature::Extent(&[0.03], [0.01, 0.08]),
            0.03,
            [1e-3, 1.0],
        ),
    ],
    needs: &[],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let [mass, frequency, damping] = super::changes::array(values);
    let body = Body {
        mass,
        omega: TAU * frequency,
        damping,
    };
    // m (ω² h/2 + 2ζω) / (1 + ζωh + (ωh/2)²), whatever h: its first part has its most at
    // ωh = 2.
    let steepness = super::Steepness {
        speed: mass.abs() * body.omega * (0.5 + 2.0 * damping),
        ..super::Steepness::default()
    };
    to.load_with_memory(steepness, body);
    Ok(())
}

/// Remembers q and q̇.
struct Body {
    /// kg or kg·m².
    mass: f64,
    /// rad/s.
    omega: f64,
    damping: f64,
}

impl Body {
    fn force(&self, [q, rate]: [f64; 2]) -> f64 {
        -self.mass * self.omega * (self.omega * q + 2.0 * self.damping * rate)
    }
}

impl MemoryLaw for Body {
    fn size(&self) -> usize {
        2
    }

    fn settle(&self, start: &Start, memory: &mut [f64]) -> f64 {
        let settled = [-start.acceleration / (self.omega * self.omega), 0.0];
        memory.copy_from_slice(&settled);
        self.force(settled)
    }

    fn step(&self, step: &TableStep, memory: &mut [f64]) -> f64 {
        let [q, rate] = [memory[0], memory[1]];
        let half = 0.5 * step.length * self.omega;
        let (damped, stiff) = (2.0 * half * self.damping, half * half);
        let driven = step.speed - step.speed_before;
        let pulled = 2.0 * half * self.omega * q;
        let end = (rate * (1.0 - damped - stiff) - pulled - driven) / (1.0 + damped + stiff);
        let settled = [q + 0.5 * step.length * (rate + end), end];
        memory.copy_from_slice(&settled);
        self.force(settled)
    }
}
