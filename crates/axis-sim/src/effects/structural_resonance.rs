//! `structural-resonance`: a body on the load that oscillates by itself, as of its structure.
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

use super::{
    Effect, EffectChannel, EffectVariable, Measure, MemoryLaw, Nature, TableStep, shape, size,
};
use crate::error::SetupError;
use crate::start::Start;

pub(super) const EFFECT: Effect = Effect {
    name: "structural-resonance",
    summary: "a body on the load that oscillates by itself",
    channel: EffectChannel::Torque,
    depends_on: "acceleration, near one frequency",
    shown_over: EffectVariable::Acceleration,
    parameters: &[
        size("mass", Measure::Inertia, 20.0, 1e3),
        shape(
            "frequency",
            Measure::Other("Hz"),
            Nature::Frequency(&[20.0, 35.0, 60.0, 100.0], [18.0, 120.0]),
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

#[cfg(test)]
mod tests {
    use super::*;

    const OMEGA: f64 = 250.0;

    fn body(damping: f64) -> Body {
        Body {
            mass: 3.0,
            omega: OMEGA,
            damping,
        }
    }

    /// A step of a load that stands still.
    fn still(length: f64) -> TableStep {
        TableStep {
            length,
            ..TableStep::default()
        }
    }

    /// Without damping a load that stands still leaves the body its energy, at any step;
    /// with some it takes e^(−2 ζ ω t).
    #[test]
    fn a_body_left_alone_keeps_its_energy_and_swings_at_its_frequency() {
        let energy = |m: &[f64; 2]| 0.5 * 3.0 * (m[1] * m[1] + (OMEGA * m[0]).powi(2));
        for step in [1e-5, 1e-3, 0.1] {
            let mut memory = [1e-3, 0.2];
            let first = energy(&memory);
            for _ in 0..2000 {
                body(0.0).step(&still(step), &mut memory);
            }
            assert!((energy(&memory) / first - 1.0).abs() < 1e-11);
        }
        let mut memory = [1e-3, 0.0];
        let first = energy(&memory);
        let quarter = TAU / OMEGA / 4.0 / 5000.0;
        for _ in 0..20_000 {
            body(0.02).step(&still(quarter), &mut memory);
        }
        let left = (-2.0 * 0.02 * TAU).exp();
        assert!((energy(&memory) / first / left - 1.0).abs() < 1e-3);
        // The damped period is longer by ζ²/2.
        assert!((memory[0] / 1e-3 - left.sqrt()).abs() < 1e-3);
    }

    /// What a load does that is swung: its mass far below the resonance, m / (1 − (Ω/ω)²)
    /// anywhere without damping.
    #[test]
    fn a_swung_load_feels_the_dynamic_mass() {
        for share in [0.01, 0.5, 2.0] {
            let (at, step) = (share * OMEGA, 1e-5);
            // Body in its steady motion from the start: q = ÿ / (Ω² − ω²) · ..., y = sin Ωt.
            let q = at * at / (OMEGA * OMEGA - at * at);
            let speed = |t: f64| at * (at * t).cos();
            let mut memory = [0.0, q * at];
            let (mut most, mut time) = (0.0_f64, 0.0);
            for _ in 0..(2.0 * TAU / at / step) as usize {
                let swung = TableStep {
                    length: step,
                    travel: 0.0,
                    speed_before: speed(time),
                    speed: speed(time + step),
                };
                most = most.max(body(0.0).step(&swung, &mut memory).abs());
                time += step;
            }
            let expected = 3.0 * at * at / (1.0 - share * share).abs();
            assert!((most / expected - 1.0).abs() < 1e-3, "{most} {expected}");
        }
    }

    #[test]
    fn the_force_is_no_steeper_than_said() {
        for damping in [1e-3, 0.03, 1.0] {
            let most = 3.0 * OMEGA * (0.5 + 2.0 * damping);
            for step in [1e-5, 1e-3, 2.0 / OMEGA, 0.1] {
                let force = |speed: f64| {
                    let mut memory = [1e-3, 0.1];
                    body(damping).step(
                        &TableStep {
                            speed,
                            ..still(step)
                        },
                        &mut memory,
                    )
                };
                let slope = force(1.0) - force(0.0);
                assert!(
                    (0.0..=most * (1.0 + 1e-12)).contains(&slope),
                    "{slope} {most}"
                );
            }
        }
    }
}
