//! Tuning: limits that hold, and what the simulated axis then does.

use axis_sim::control::CascadeGains;
use drive_loop::{LoopAnalysis, LoopSet, TuneSettings, Tuning};

use crate::support::example;

/// The linear motor, whose best figures of an independent search (without a limit of the ripple) are
/// peak errors of 3.8 µm, and 2.0 µm with the acceleration fed forward.
#[test]
fn a_linear_motor_is_tuned_within_its_limits() {
    let axis = example("linear-motor");
    let settings = TuneSettings::default();
    let found = Tuning::of(&axis, &settings).unwrap();
    let report = &found.report;
    // By the analysis of the tuned axis, made anew.
    let after = LoopAnalysis::of(&found.axis, &settings.set).unwrap();
    let [now, late] = [after.worst.sensitivity, after.worst.sensitivity_late].map(Option::unwrap);
    assert!(now <= 1.6 && late <= 2.0, "{now} {late}");
    assert!(now > 1.55 || late > 1.94, "room is left: {now} {late}");
    assert!(report.proven_stable && after.worst.unstable == 0);
    let peak = report.moves[0].tuned.peak_error.unwrap();
    assert!(peak < 2.1e-6, "{peak:e}");
    for check in &report.moves {
        assert!(check.tuned.peak_error.unwrap() < check.file.peak_error.unwrap());
        assert!(check.tuned.saturated_cycles <= check.file.saturated_cycles);
    }
    // The same bits again.
    let again = Tuning::of(&axis, &settings).unwrap();
    assert_eq!(report, &again.report);
}

/// The report's figures are those of the analysis of the tuned axis, peaks between the frequencies
/// of the search included: a limit of 2 was exceeded by 0.04.
#[test]
fn limits_hold_between_the_frequencies_of_the_search() {
    let template = "../../crates/feed-axis/templates/rigid-mass";
    for name in [template, "rack", "belt"] {
        let axis = example(name);
        let settings = TuneSettings {
            simulated: false,
            ..TuneSettings::default()
        };
        let found = Tuning::of(&axis, &settings).unwrap();
        let after = LoopAnalysis::of(&found.axis, &settings.set).unwrap().worst;
        let tuned = found.report.tuned;
        let pairs = [
            (after.sensitivity, tuned.sensitivity, 1.6),
            (after.sensitivity_late, tuned.sensitivity_late, 2.0),
        ];
        for (after, told, limit) in pairs {
            let (after, told) = (after.unwrap(), told.unwrap());
            assert!(after <= limit, "{name}: {after}");
            assert!((after - told).abs() < 1e-6, "{name}: {after} {told}");
        }
    }
}

/// A narrower limit gives a softer loop, with more room in the sweep of delays.
#[test]
fn a_narrower_limit_is_kept() {
    let axis = example("rotary-table");
    let settings = |sensitivity| TuneSettings {
        sensitivity,
        set: LoopSet {
            masses: vec![1.0, 1.4],
            ..LoopSet::default()
        },
        ..TuneSettings::default()
    };
    let [narrow, wide] = [1.3, 1.6].map(|ms| Tuning::of(&axis, &settings(ms)).unwrap().report);
    assert!(narrow.tuned.sensitivity.unwrap() <= 1.3);
    assert!(narrow.tuned.objective > wide.tuned.objective);
    assert!(narrow.tuned_gains.speed_proportional < wide.tuned_gains.speed_proportional);
}

/// A PID controller is tuned to the same limits, and its keys are set.
#[test]
fn a_pid_controller_is_tuned() {
    let axis = example("linear-stage");
    let settings = TuneSettings::default();
    let found = Tuning::of(&axis, &settings).unwrap();
    let after = LoopAnalysis::of(&found.axis, &settings.set).unwrap();
    let [now, late] = [after.worst.sensitivity, after.worst.sensitivity_late].map(Option::unwrap);
    assert!(now <= 1.6 && late <= 2.0, "{now} {late}");
    assert!(now > 1.5 || late > 1.9, "room is left: {now} {late}");
    assert!(found.report.proven_stable);
    for check in &found.report.moves {
        let [before, after] = [check.file, check.tuned].map(|m| m.peak_error.unwrap());
        assert!(after < before, "{after:e} {before:e}");
    }
    let keys: Vec<String> = found.keys(&axis).into_iter().map(|key| key.key).collect();
    assert_eq!(
        keys,
        [
            "proportional_n_per_m",
            "integral_n_per_m_s",
            "derivative_n_s_per_m"
        ]
    );
    // At low frequencies the integral action alone resists a force: y/F = 2πf/K_I.
    let curves = &after.curves[0];
    let at = curves.frequency_hz.iter().position(|f| *f > 0.2).unwrap();
    let [re, im] = curves.compliance[at];
    let integral = found.axis.control.values().number("integral").unwrap();
    let expected = std::f64::consts::TAU * curves.frequency_hz[at] / integral;
    assert!((re.hypot(im) / expected - 1.0).abs() < 0.01);
    assert!(curves.speed_followed.is_empty());
}

/// Gains that are unstable at the beginning are found stable ones.
#[test]
fn an_unstable_start_is_no_obstacle() {
    let mut axis = example("linear-motor");
    let own = axis.control.cascade(1.0, axis.period).unwrap();
    let wild = CascadeGains {
        position: own.position,
        speed: 50.0 * own.speed,
        speed_integral: 50.0 * own.speed_integral,
        acceleration_feedforward: None,
        notch: None,
    };
    let values = axis
        .control
        .retuned(axis.control.values(), &wild, 1.0)
        .unwrap();
    axis.control.change(|own| *own = values).unwrap();
    let before = LoopAnalysis::of(&axis, &LoopSet::default()).unwrap();
    assert!(before.worst.unstable > 0 && before.worst.sensitivity.is_none());
    let found = Tuning::of(&axis, &TuneSettings::default()).unwrap();
    assert!(found.report.file.sensitivity.is_none());
    assert!(found.report.tuned.sensitivity.unwrap() <= 1.6);
    let note = "do not keep these limits (sensitivity not stable,";
    assert!(found.report.notes.iter().any(|said| said.contains(note)));
    // Gains 50 times too high held the load more firmly, as far as they held it at all.
    assert!(is_said_softer(&found.report));
}

fn is_said_softer(found: &Tuning) -> bool {
    let mut notes = found.notes.iter();
    notes.any(|said| said.contains("less firmly"))
}

/// That the load is held less firmly is said where a compliance rose, and nowhere else.
#[test]
fn a_softer_loop_is_said_where_it_is_one() {
    let mut axis = example("linear-motor");
    let own = axis.control.cascade(1.0, axis.period).unwrap();
    // A position loop too fast for its slow speed loop: the limits are not kept, and the load is held softly.
    let slack = CascadeGains {
        position: 8.0 * own.position,
        speed: 0.3 * own.speed,
        speed_integral: 0.1 * own.speed_integral,
        acceleration_feedforward: None,
        notch: None,
    };
    let values = axis
        .control
        .retuned(axis.control.values(), &slack, 1.0)
        .unwrap();
    axis.control.change(|own| *own = values).unwrap();
    let report = Tuning::of(&axis, &TuneSettings::default()).unwrap().report;
    assert!(
        report.notes.iter().any(|said| said.contains("do not keep")),
        "{:?}",
        report.notes
    );
    assert!(report.tuned.compliance_rms < report.file.compliance_rms);
    assert!(report.tuned.compliance_slope < report.file.compliance_slope);
    assert!(!is_said_softer(&report), "{:?}", report.notes);
}

#[test]
fn what_is_wrong_is_said() {
    let axis = example("linear-motor");
    let said = |settings: TuneSettings| Tuning::of(&axis, &settings).unwrap_err().to_string();
    let low = TuneSettings {
        sensitivity: 1.0,
        ..TuneSettings::default()
    };
    assert!(said(low).contains("is 1; valid: from 1.1 to 10"));
    let crossed = TuneSettings {
        sensitivity_late: 1.2,
        ..TuneSettings::default()
    };
    assert!(said(crossed).contains("at least the limit without"));
}
