//! Friction feed-forward, none, and sums.

use compensator::{
    Combined, Compensator, CompensatorError, Correction, FeedforwardDrive, FrictionFeedforward,
    NoCompensation, Reference, Sample,
};
use lugre::{LuGre, Parameters};
use proptest::prelude::*;

const R: f64 = 0.01 / std::f64::consts::TAU;
const KT: f64 = 1.641;

fn law() -> LuGre {
    LuGre::new(Parameters {
        viscous: 0.0298,
        ..Parameters::LIU_2025
    })
    .unwrap()
}

fn friction() -> FrictionFeedforward {
    FrictionFeedforward::new(
        law(),
        FeedforwardDrive {
            travel_per_radian: R,
            torque_constant: KT,
            period: 1e-4,
        },
    )
    .unwrap()
}

fn moving(velocity: f64) -> Sample {
    let reference = Reference {
        velocity,
        ..Reference::default()
    };
    Sample {
        reference,
        next_reference: reference,
        ..Sample::default()
    }
}

/// A strategy that answers with what it was given.
struct Fixed(Correction);

impl Compensator for Fixed {
    fn reset(&mut self) {}
    fn correct(&mut self, _: &Sample) -> Correction {
        self.0
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Friction is odd, whatever the history.
    #[test]
    fn odd(velocities in prop::collection::vec(-0.2..0.2f64, 1..200)) {
        let (mut there, mut back) = (friction(), friction());
        for v in velocities {
            prop_assert_eq!(there.correct(&moving(v)).command, -back.correct(&moving(-v)).command);
        }
    }

    /// At steady speed the current drives along the motion and is the
    /// steady-state curve's over K_t.
    #[test]
    fn steady_speed(speed in 5e-3..0.2f64, backwards: bool) {
        let v = if backwards { -speed } else { speed };
        let mut feedforward = friction();
        let mut iq = 0.0;
        for _ in 0..20_000 {
            iq = feedforward.correct(&moving(v)).command;
        }
        prop_assert!(iq * v > 0.0);
        // 2 s settle the bristles (σ0 ω/G ≥ 60 /s) to e⁻¹²⁰; rounding is left, 3.6e-14
        // measured.
        prop_assert!((iq - law().steady_state(v / R) / KT).abs() < 3e-13);
    }

    #[test]
    fn combined_adds(p in prop::array::uniform2(-1e-4..1e-4f64), q in prop::array::uniform2(-5.0..5.0f64)) {
        let [first, second] = [0, 1].map(|i| Fixed(Correction { position: p[i], command: q[i] }));
        let sum = Combined::new(first, second).correct(&Sample::default());
        prop_assert_eq!(sum, Correction { position: p[0] + p[1], command: q[0] + q[1] });
    }
}

#[test]
fn combined_resets_both() {
    let mut both = Combined::new(friction(), Combined::new(NoCompensation, friction()));
    let first = both.correct(&moving(0.1));
    both.correct(&moving(0.1));
    both.reset();
    assert_eq!(both.correct(&moving(0.1)), first);
    assert_eq!(
        first.command,
        2.0 * friction().correct(&moving(0.1)).command
    );
}

#[test]
fn invalid_settings_are_refused() {
    let refused = |r, kt, period| match FrictionFeedforward::new(
        law(),
        FeedforwardDrive {
            travel_per_radian: r,
            torque_constant: kt,
            period,
        },
    ) {
        Err(CompensatorError::Setting { name, .. }) => name,
        other => panic!("{other:?}"),
    };
    assert_eq!(refused(0.0, KT, 1e-4), "travel_per_radian");
    assert_eq!(refused(R, f64::NAN, 1e-4), "torque_constant");
    assert_eq!(refused(R, KT, -1e-4), "period");
}
