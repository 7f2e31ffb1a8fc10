//! `maxwell-slip-hysteresis`: dry friction with a memory of its reversals.
//!
//! Four springs side by side, each of which slides when it has reached its greatest
//! deflection:
//!
//! ```text
//! ζᵢ ← clamp(ζᵢ + Δy, −dᵢ, dᵢ),   force = Σ (F/4) ζᵢ / dᵢ,   dᵢ = D · (1/8, 1/4, 1/2, 1)
//! ```
//!
//! F is the force where all slide, D the travel from rest until they do. A travel back inside of
//! another closes its own loop, which one bristle does not. It is the generalised
//! Maxwell-slip model (Al-Bender, Lampaert and Swevers, IEEE Trans. Automat. Contr. 50
//! (2005) 1883–1887, doi:10.1109/TAC.2005.858676) with a constant Stribeck curve and an
//! attraction without lag: it does not depend on the rate, and is exact for any step in
//! which the load does not turn back.

use super::{
    Effect, EffectChannel, EffectVariable, Measure, MemoryLaw, Nature, TableStep, shape, size,
};
use crate::error::SetupError;
use crate::start::Start;

/// Greatest deflections as shares of the pre-sliding distance.
const REACHES: [f64; 4] = [0.125, 0.25, 0.5, 1.0];

/// Share of the force that each element has.
const SHARE: f64 = 1.0 / REACHES.len() as f64;

/// Greatest pre-sliding distance, m: rolling contacts slide after some 0.1 mm. Over
/// millimetres this would be a force that comes up with a motion, and explain slow noise.
const LONGEST: f64 = 3e-4;

pub(super) const EFFECT: Effect = Effect {
    name: "maxwell-slip-hysteresis",
    summary: "dry friction with a memory of its reversals",
    channel: EffectChannel::Torque,
    depends_on: "displacement after a reversal",
    shown_over: EffectVariable::Time,
    parameters: &[
        size("force", Measure::Force, 60.0, 5e3),
        shape(
            "presliding_distance",
            Measure::Displacement,
            Nature::Extent(&[3e-5, 2e-4], [2e-5, 2e-4]),
            1e-4,
            [1e-6, LONGEST],
        ),
    ],
    needs: &[],
    install,
};

fn install(values: &[f64], to: &mut super::Changes<'_>) -> Result<(), SetupError> {
    let [force, distance] = super::changes::array(values);
    let softest = SHARE * (force / distance).abs();
    let steepness = super::Steepness {
        position: REACHES.iter().map(|reach| softest / reach).sum(),
        ..super::Steepness::default()
    };
    to.load_with_memory(steepness, Slip { force, distance });
    Ok(())
}

struct Slip {
    /// F, N or N·m.
    force: f64,
    /// D, m or rad.
    distance: f64,
}

impl Slip {
    /// Moves every element by `travel` and gives the force.
    fn moved(&self, travel: f64, memory: &mut [f64]) -> f64 {
        let mut sum = 0.0;
        for (deflection, reach) in memory.iter_mut().zip(REACHES) {
            // In units of the distance, so that the force needs one division.
            *deflection = (*deflection + travel / self.distance).clamp(-reach, reach);
            sum += *deflection / reach;
        }
        SHARE * self.force * sum
    }
}

impl MemoryLaw for Slip {
    fn size(&self) -> usize {
        REACHES.len()
    }

    fn settle(&self, start: &Start, memory: &mut [f64]) -> f64 {
        let slid = match start.speed {
            0.0 => start.friction.clamp(-1.0, 1.0),
            speed => speed.signum(),
        };
        for (deflection, reach) in memory.iter_mut().zip(REACHES) {
            *deflection = slid * reach;
        }
        self.moved(0.0, memory)
    }

    fn step(&self, step: &TableStep, memory: &mut [f64]) -> f64 {
        self.moved(step.travel, memory)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SLIP: Slip = Slip {
        force: 60.0,
        distance: 1e-4,
    };

    /// Force and work over a travel in small steps.
    fn along(travel: f64, memory: &mut [f64]) -> [f64; 2] {
        const STEPS: usize = 4000;
        let by = travel / STEPS as f64;
        let mut work = 0.0;
        let mut force = SLIP.moved(0.0, memory);
        for _ in 0..STEPS {
            let next = SLIP.moved(by, memory);
            work += 0.5 * (force + next) * by;
            force = next;
        }
        [force, work]
    }

    /// From one sliding to the other each element gives F/4 over the travel less the 2d in
    /// which it turns over: F (L − 2 · 1.875 D / 4).
    #[test]
    fn a_closed_loop_takes_what_its_area_says() {
        let mut memory = [0.0; 4];
        let [force, _] = along(1e-3, &mut memory);
        assert_eq!(force, 60.0);
        let [_, back] = along(-1e-3, &mut memory);
        let [_, there] = along(1e-3, &mut memory);
        let expected = 60.0 * (1e-3 - 0.9375e-4);
        // The corners lie on steps: rounding alone.
        assert!(
            (back - expected).abs() < 1e-9 * expected,
            "{back:e} {expected:e}"
        );
        assert!((there - expected).abs() < 1e-9 * expected);
    }

    /// A loop inside of another closes, and the outer one goes on as if it had not been.
    #[test]
    fn an_inner_loop_is_wiped_out() {
        let mut memory = [0.0; 4];
        along(0.6e-4, &mut memory);
        let before = (memory, SLIP.moved(0.0, &mut memory));
        along(-0.4e-4, &mut memory);
        let [force, _] = along(0.4e-4, &mut memory);
        assert!((force - before.1).abs() < 1e-9, "{force} {}", before.1);
        for (a, b) in memory.iter().zip(before.0) {
            assert!((a - b).abs() < 1e-12);
        }
    }

    #[test]
    fn any_closed_way_takes_energy() {
        let mut memory = [0.0; 4];
        for depth in [1e-6, 2e-5, 7e-5, 3e-4] {
            // Twice: the first may go on from another state.
            for counts in [false, true] {
                let [_, there] = along(depth, &mut memory);
                let [_, back] = along(-depth, &mut memory);
                assert!(!counts || there + back > -1e-18, "{depth}: {there} {back}");
            }
        }
    }
}
