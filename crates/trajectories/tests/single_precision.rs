//! Motions in `f32` are those in `f64`, to a stated multiple of what `f32` rounds, and keep their limits as strictly.
//!
//! Both take the same numbers: limits, ends and instants are `f32`, and `f64` takes them exactly.
#![cfg(feature = "alloc")]

use proptest::prelude::*;
use trajectories::{
    Chirp, Limits, Motion, Oscillation, Program, SCurve, Setpoint, Sine, Step, Sweep,
};

/// Table 12 of Liu et al. 2025: mm/s, mm/s², mm/s³ over 300 mm.
const TABLE_12: [[f64; 3]; 6] = [
    [100.0, 225.0, 1200.0],
    [100.0, 225.0, 1400.0],
    [100.0, 120.0, 1000.0],
    [100.0, 140.0, 1000.0],
    [110.0, 160.0, 1000.0],
    [120.0, 160.0, 1000.0],
];

/// Greatest deviations of position, velocity and acceleration at `count` instants, in
/// `f32::EPSILON` of the sizes given.
fn deviation(
    single: &impl Motion<f32>,
    double: &impl Motion,
    count: u32,
    sizes: [f64; 3],
) -> [f64; 3] {
    let duration = double.duration() as f32;
    (0..=count).fold([0.0; 3], |worst: [f64; 3], i| {
        let t = duration * (i as f32 / count as f32);
        let (a, b) = (single.at(t), double.at(f64::from(t)));
        let off = [
            f64::from(a.position) - b.position,
            f64::from(a.velocity) - b.velocity,
            f64::from(a.acceleration) - b.acceleration,
        ];
        let unit = f64::from(f32::EPSILON);
        std::array::from_fn(|k| worst[k].max(off[k].abs() / (unit * sizes[k])))
    })
}

/// Sizes: what is added up, and what a rounding of the time moves on the way.
#[test]
fn the_six_trajectories() {
    let mut worst = [0.0_f64; 3];
    for row in TABLE_12 {
        let limits = Limits::<f64>::new(row[0] / 1e3, row[1] / 1e3, row[2] / 1e3).unwrap();
        let single = SCurve::plan(0.6, 0.9, &limits.cast::<f32>().unwrap()).unwrap();
        let limits = limits.cast::<f32>().unwrap().cast::<f64>().unwrap();
        let ends = [single.from(), single.to()].map(f64::from);
        let double = SCurve::plan(ends[0], ends[1], &limits).unwrap();
        let (v, a, j) = (limits.velocity(), limits.acceleration(), limits.jerk());
        let time = double.duration();
        let sizes = [0.9 + v * time, v + a * time, a + j * time];
        let here = deviation(&single, &double, 100_000, sizes);
        worst = std::array::from_fn(|k| worst[k].max(here[k]));
    }
    assert!(worst.iter().all(|&x| x < 2.0), "{worst:?}"); // 0.50, 0.48, 0.51 measured
}

/// Sines and chirps: the phase, of n cycles, is rounded to n ε, and each derivative with it.
#[test]
fn oscillations() {
    let sine = Sine::<f32> {
        amplitude: 1e-3,
        frequency: 5.0,
        cycles: 10,
    };
    let chirp = |sweep| {
        Step::Chirp(Chirp::<f32> {
            amplitude: 1e-3,
            from_frequency: 1.0,
            to_frequency: 20.0,
            duration: 5.0,
            ramp: 0.5,
            sweep,
        })
    };
    for (name, step, cycles) in [
        ("sine", Step::Sine(sine), 12.0),
        ("linear chirp", chirp(Sweep::Linear), 52.5),
        ("logarithmic chirp", chirp(Sweep::Logarithmic), 31.7),
    ] {
        let single = Program::new(0.6_f32, vec![step]).unwrap();
        let double = single.cast::<f64>().unwrap();
        let e = double.extremes();
        let phase = std::f64::consts::TAU * cycles;
        let sizes = [
            1.0 + 1e-3 * phase,
            e.velocity * phase,
            e.acceleration * phase,
        ];
        let worst = deviation(&single, &double, 100_000, sizes);
        // 0.26 to 0.47, 0.38 to 1.71, 0.40 to 1.74 measured.
        assert!(worst.iter().all(|&x| x < 4.0), "{name}: {worst:?}");
    }
}

/// A number between `10^low` and `10^high`, all magnitudes alike.
fn magnitude(low: f32, high: f32) -> impl Strategy<Value = f32> {
    (low..high).prop_map(|x| 10f32.powf(x))
}

fn any_curve() -> impl Strategy<Value = (f32, f32, Limits<f32>, SCurve<f32>)> {
    let limits = (
        magnitude(-4.0, 2.0),
        magnitude(-3.0, 3.0),
        magnitude(-2.0, 6.0),
    );
    (-10.0_f32..10.0, magnitude(-9.0, 1.0), any::<bool>(), limits).prop_filter_map(
        "no move, or too long",
        |(from, distance, back, (v, a, j))| {
            let to = from + if back { -distance } else { distance };
            let limits = Limits::new(v, a, j).unwrap();
            let curve = SCurve::plan(from, to, &limits).ok()?;
            (to != from).then_some((from, to, limits, curve))
        },
    )
}

fn any_oscillation() -> impl Strategy<Value = Oscillation<f32>> {
    let frequency = || magnitude(-1.0, 2.0);
    let sine =
        (-1e-2_f32..1e-2, frequency(), 1u32..20).prop_map(|(amplitude, frequency, cycles)| {
            let sine = Sine {
                amplitude,
                frequency,
                cycles,
            };
            Oscillation::sine(0.3, &sine).unwrap()
        });
    let chirp = (
        -1e-2_f32..1e-2,
        [frequency(), frequency()],
        magnitude(-1.0, 1.0),
        0.02_f32..0.5,
        any::<bool>(),
    );
    let chirp = chirp.prop_map(|(amplitude, [from, to], duration, ramp, linear)| {
        let chirp = Chirp {
            amplitude,
            from_frequency: from,
            to_frequency: to,
            duration,
            ramp: ramp * duration,
            sweep: if linear {
                Sweep::Linear
            } else {
                Sweep::Logarithmic
            },
        };
        Oscillation::chirp(0.3, &chirp).unwrap()
    });
    prop_oneof![sine, chirp]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5000))]

    /// Without any tolerance, as in `f64`.
    #[test]
    fn no_limit_is_ever_passed((from, to, limits, curve) in any_curve()) {
        let duration = curve.duration();
        let spread = (-3..=203).map(|i| duration * i as f32 / 200.0);
        let switches = curve.segments().into_iter().map(|s| s.start);
        let beside = switches.flat_map(|s| [s.next_down(), s, s.next_up()]);
        for t in spread.chain(beside) {
            let s = curve.at(t);
            prop_assert!(s.velocity.abs() <= limits.velocity(), "{s:?} at {t}");
            prop_assert!(s.acceleration.abs() <= limits.acceleration(), "{s:?} at {t}");
            prop_assert!(s.jerk.abs() <= limits.jerk(), "{s:?} at {t}");
            prop_assert!(s.position >= from.min(to) && s.position <= from.max(to), "{s:?} at {t}");
        }
        prop_assert!(curve.segments().iter().all(|s| s.duration >= 0.0));
        prop_assert_eq!(curve.at(-1.0), Setpoint::at_rest(from));
        prop_assert_eq!(curve.at(f32::NAN), Setpoint::at_rest(from));
        prop_assert_eq!(curve.at(-f32::NAN), Setpoint::at_rest(from));
        prop_assert_eq!(curve.at(-0.0), curve.at(0.0));
        prop_assert_eq!(curve.at(duration), Setpoint::at_rest(to));
        prop_assert_eq!(curve.at(f32::INFINITY), Setpoint::at_rest(to));
    }

    #[test]
    fn bounds_of_oscillations_are_never_passed(oscillation in any_oscillation()) {
        let e = oscillation.extremes();
        for i in -1..=3000 {
            let s = oscillation.at(oscillation.duration() * i as f32 / 2999.0);
            prop_assert!(s.position >= e.position_min && s.position <= e.position_max, "{s:?} {e:?}");
            prop_assert!(s.velocity.abs() <= e.velocity, "{s:?} {e:?}");
            prop_assert!(s.acceleration.abs() <= e.acceleration, "{s:?} {e:?}");
            prop_assert!(s.jerk.abs() <= e.jerk, "{s:?} {e:?}");
        }
    }
}

#[test]
fn what_single_precision_cannot_hold_is_refused() {
    let tiny = Limits::<f64>::new(1e-50, 1.0, 1.0).unwrap();
    assert!(
        tiny.cast::<f32>()
            .unwrap_err()
            .to_string()
            .contains("velocity is 0 m/s")
    );
    let stiff = Limits::new(1.0_f32, 1.0, 1e15).unwrap();
    let error = SCurve::plan(0.0, 1e-45, &stiff).unwrap_err().to_string();
    assert!(error.contains("32-bit float"), "{error}");
    let long = Sine {
        amplitude: 1e-3_f32,
        frequency: 1.0,
        cycles: 20_000,
    };
    let error = Oscillation::sine(0.0, &long).unwrap_err().to_string();
    assert_eq!(error, "total cycles is 20002 , but must be at most 1e4");
}
