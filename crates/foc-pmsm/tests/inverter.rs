//! The two models of the inverter: volt-seconds, switching pattern, dead time.

use crate::axis::{DC_VOLTAGE, PERIOD, drawn_dc_voltage, drawn_period, motor};
use foc_pmsm::inverter::{Inverter, Rotor, SwitchingSegment};
use foc_pmsm::svpwm::{Duties, Overmodulation, Svpwm};
use foc_pmsm::{AlphaBeta, Dq, FocError, Phases};
use proptest::prelude::*;

fn inverter(dead_time: f64) -> Inverter {
    Inverter::new(DC_VOLTAGE, PERIOD, dead_time).unwrap()
}

fn distance(a: AlphaBeta, b: AlphaBeta) -> f64 {
    (a.alpha - b.alpha).hypot(a.beta - b.beta)
}

fn mean(segments: &[SwitchingSegment], period: f64) -> AlphaBeta {
    let sum = |f: fn(&SwitchingSegment) -> f64| {
        segments.iter().map(|s| s.duration * f(s)).sum::<f64>() / period
    };
    AlphaBeta {
        alpha: sum(|s| s.voltage.alpha),
        beta: sum(|s| s.voltage.beta),
    }
}

/// Duties in [0, 1], the ends themselves included.
fn duty() -> impl Strategy<Value = f64> {
    prop_oneof![8 => 0.0..1.0, 1 => Just(0.0), 1 => Just(1.0)]
}

/// Phase currents, zero included.
fn current() -> impl Strategy<Value = f64> {
    prop_oneof![8 => -15.0..15.0, 1 => Just(0.0)]
}

fn duties() -> impl Strategy<Value = Duties> {
    (duty(), duty(), duty()).prop_map(|(a, b, c)| Duties::new(a, b, c).unwrap())
}

fn currents() -> impl Strategy<Value = Phases> {
    (current(), current(), current()).prop_map(|(a, b, c)| Phases { a, b, c })
}

proptest! {
    /// The switched volt-seconds are the averaged ones, with any dead time,
    /// down to pulses that it swallows.
    #[test]
    fn volt_seconds_agree(
        voltage in drawn_dc_voltage(), period in drawn_period(), dead in 0.0..0.49,
        d in duties(), i in currents(),
    ) {
        let inverter = Inverter::new(voltage, period, dead * period).unwrap();
        let segments = inverter.switched(d, i);
        prop_assert!(segments.iter().all(|s| s.duration >= 0.0));
        let total: f64 = segments.iter().map(|s| s.duration).sum();
        prop_assert!((total / period - 1.0).abs() < 2e-15); // 2.2e-16 measured
        let error = distance(mean(&segments, period), inverter.averaged(d, i)) / voltage;
        prop_assert!(error < 3e-15, "{}", error); // 3.6e-16 measured
    }

    #[test]
    fn zero_dead_time_is_the_ideal_inverter_bit_for_bit(
        voltage in drawn_dc_voltage(), period in drawn_period(), d in duties(), i in currents(),
    ) {
        let ideal = Inverter::new(voltage, period, 0.0).unwrap();
        prop_assert_eq!(ideal.effective_duties(d, i), d);
        prop_assert_eq!(ideal.averaged(d, i), d.voltage(voltage));
        prop_assert_eq!(ideal.switched(d, i), ideal.switched(d, Phases::default()));
    }

    /// Eight vectors only, each phase once up and once down, and without
    /// dead time the same forwards and backwards.
    #[test]
    fn the_pattern_is_centre_aligned(
        voltage in drawn_dc_voltage(), period in drawn_period(), d in duties(), i in currents(),
    ) {
        let segments = Inverter::new(voltage, period, 0.0).unwrap().switched(d, i);
        for (s, mirror) in segments.iter().zip(segments.iter().rev()) {
            let length = s.voltage.alpha.hypot(s.voltage.beta) / voltage;
            // Measured: 2.2e-16 and 3.1e-16.
            prop_assert!(length < 2e-15 || (length - 2.0 / 3.0).abs() < 2e-15);
            prop_assert!((s.duration - mirror.duration).abs() < 2e-15 * period);
            // Stretches that only rounding made have no pattern to compare.
            prop_assert!(s.duration < 1e-15 * period || s.upper == mirror.upper);
        }
    }

    /// While all legs switch with pulses longer than the dead time, it costs
    /// each phase U t_d/T against its current.
    #[test]
    fn dead_time_costs_volt_seconds(
        voltage in drawn_dc_voltage(), period in drawn_period(),
        a in 0.1..0.9, b in 0.1..0.9, c in 0.1..0.9, i in currents(), dead in 0.0..0.09,
    ) {
        let inverter = Inverter::new(voltage, period, dead * period).unwrap();
        let d = Duties::new(a, b, c).unwrap();
        let got = inverter.averaged(d, i);
        let lost = |i: f64| if i == 0.0 { 0.0 } else { -i.signum() * dead * voltage };
        let lost = Phases { a: lost(i.a), b: lost(i.b), c: lost(i.c) }.clarke();
        let ideal = d.voltage(voltage);
        let expected = AlphaBeta { alpha: ideal.alpha + lost.alpha, beta: ideal.beta + lost.beta };
        // Measured: 2.1e-16 and 4.1e-17.
        prop_assert!(distance(got, expected) < 2e-15 * voltage);
        prop_assert!(distance(inverter.dead_time_voltage(i), lost) < 4e-16 * voltage);
    }
}

/// 2 µs of dead time and current into the motor: the leg rises 2 µs late and
/// falls in time; with the current reversed it falls late.
#[test]
fn dead_time_moves_one_edge() {
    let d = Duties::new(0.5, 0.0, 0.0).unwrap();
    let edges = |current: f64| {
        let i = Phases {
            a: current,
            b: 0.0,
            c: 0.0,
        };
        let segments = inverter(2e-6).switched(d, i);
        let start: f64 = segments
            .iter()
            .take_while(|s| !s.upper[0])
            .map(|s| s.duration)
            .sum();
        let on: f64 = segments
            .iter()
            .filter(|s| s.upper[0])
            .map(|s| s.duration)
            .sum();
        (start, start + on)
    };
    for (current, on, off) in [
        (0.0, 25e-6, 75e-6),
        (5.0, 27e-6, 75e-6),
        (-5.0, 25e-6, 77e-6),
    ] {
        let (start, end) = edges(current);
        assert!(
            (start - on).abs() < 1e-19 && (end - off).abs() < 1e-19,
            "{current} A: {start} {end}"
        );
    }
}

/// From zero current with a whole-period active vector both models are the
/// same RL circuit.
#[test]
fn saturated_legs_make_the_models_identical() {
    let d = Duties::new(1.0, 0.0, 0.0).unwrap();
    let rotor = Rotor {
        electrical_angle: 0.4,
        speed: 60.0,
    };
    let start = Dq { d: 0.5, q: 2.0 };
    let averaged = inverter(2e-6).averaged_step(&motor(), start, rotor, d);
    let switched = inverter(2e-6).switched_step(&motor(), start, rotor, d);
    assert_eq!(averaged, switched);
}

/// Pieces of a sixteenth of a period: against the exact solution with the
/// period cut 1000 times more finely.
#[test]
fn the_integration_inside_a_period_is_fine_enough() {
    let (motor, inverter) = (motor(), inverter(0.0));
    let rotor = Rotor {
        electrical_angle: 1.0,
        speed: 200.0,
    };
    let modulator = Svpwm::new(DC_VOLTAGE, Overmodulation::default()).unwrap();
    let duties = modulator.duties(AlphaBeta {
        alpha: 100.0,
        beta: 200.0,
    });
    let start = Dq { d: 0.5, q: 8.0 };
    let (mut i, mut t) = (start, 0.0);
    for s in inverter.switched(duties, Phases::default()) {
        let h = s.duration / 2000.0;
        for k in 0..2000 {
            let u = s
                .voltage
                .park(rotor.angle_after(&motor, t + (f64::from(k) + 0.5) * h));
            i = motor.step_exact(i, u, rotor.speed, h);
        }
        t += s.duration;
    }
    let coarse = inverter.switched_step(&motor, start, rotor, duties);
    let error = (coarse - i).dot(coarse - i).sqrt();
    // Local error of a piece: (ω_e h)² (L_q/L_d)/12 ≈ 7e-6 of its change of
    // current, of which a period has at most 2/3 U_dc T/L_d = 9 A; 1.5e-5 A measured.
    assert!(error < 6e-5, "{error}");
}

#[test]
fn validation_names_the_field_and_nan_is_seen() {
    let field = |r: Result<Inverter, FocError>| match r {
        Err(FocError::OutOfRange { field, .. }) => field,
        other => panic!("{other:?}"),
    };
    assert_eq!(field(Inverter::new(-1.0, PERIOD, 0.0)), "dc_voltage");
    assert_eq!(field(Inverter::new(540.0, 0.0, 0.0)), "period");
    for bad in [-1e-9, 0.5 * PERIOD, f64::NAN] {
        assert_eq!(field(Inverter::new(540.0, PERIOD, bad)), "dead_time");
    }
    let nothing = AlphaBeta {
        alpha: f64::NAN,
        beta: 0.0,
    };
    let d = Svpwm::new(DC_VOLTAGE, Overmodulation::default())
        .unwrap()
        .duties(nothing);
    let i = inverter(0.0).switched_step(&motor(), Dq::ZERO, Rotor::default(), d);
    assert!(i.d.is_nan() || i.q.is_nan());
}
