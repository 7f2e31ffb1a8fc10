//! The log's promises and the error metrics' laws.

use axis_log::metrics::{ErrorSummary, MetricError, max_abs, mean_abs, rms};
use axis_log::{Channel, Log, LogError};
use proptest::prelude::*;

fn channel(name: &str, samples: &[f64]) -> Channel {
    Channel::new(name, samples.to_vec()).unwrap()
}

fn log() -> Log {
    Log::new(vec![
        channel("t_s", &[0.0, 1.0, 2.0, 3.0]),
        channel("x_m", &[1.0, 2.0, 3.0, 4.0]),
    ])
    .unwrap()
}

#[test]
fn construction_refuses_what_a_log_may_not_hold() {
    let t = || channel("t_s", &[0.0, 1.0]);
    let named = |e: LogError| e.to_string();
    assert_eq!(Log::new(vec![]), Err(LogError::Empty));
    assert_eq!(Log::new(vec![channel("t_s", &[])]), Err(LogError::Empty));
    assert!(matches!(
        Log::new(vec![channel("x_m", &[0.0])]),
        Err(LogError::TimeNotFirst { .. })
    ));
    assert!(matches!(
        Log::new(vec![channel("t_s", &[0.0, 0.0])]),
        Err(LogError::TimeNotIncreasing { index: 1, .. })
    ));
    assert!(matches!(
        Log::new(vec![channel("t_s", &[0.0, f64::NAN])]),
        Err(LogError::NotFinite { index: 1, .. })
    ));
    let short = Log::new(vec![t(), channel("x_m", &[0.0])]).unwrap_err();
    assert_eq!(
        named(short),
        "channel \"x_m\" has 1 samples: it must have 2, as \"t_s\" has"
    );
    let infinite = Log::new(vec![t(), channel("x_m", &[0.0, f64::INFINITY])]).unwrap_err();
    assert_eq!(
        named(infinite),
        "channel \"x_m\", sample 1: inf is not a finite number"
    );
    assert!(matches!(
        Log::new(vec![t(), t()]),
        Err(LogError::Duplicate { .. })
    ));
}

#[test]
fn a_unit_that_contradicts_its_suffix_is_refused() {
    let mut wrong = channel("x_m", &[0.0; 4]);
    wrong.unit = "mm".into();
    wrong.name = "y_m".into();
    let mut log = log();
    let before = log.clone();
    assert!(matches!(
        log.push_channel(wrong),
        Err(LogError::UnitMismatch { expected: "m", .. })
    ));
    assert_eq!(log, before);
    assert!(matches!(
        Channel::new("speed", vec![]),
        Err(LogError::UnitSuffix { .. })
    ));
}

#[test]
fn a_missing_channel_lists_those_that_exist() {
    let text = log().channel("y_m").unwrap_err().to_string();
    assert_eq!(text, "no channel \"y_m\": the log has \"t_s\", \"x_m\"");
}

#[test]
fn decimation_keeps_every_nth_sample_of_every_channel() {
    let thin = log().decimate(2).unwrap();
    assert_eq!(thin.time(), [0.0, 2.0]);
    assert_eq!(thin.channel("x_m").unwrap(), [1.0, 3.0]);
    assert_eq!(log().decimate(1).unwrap(), log());
    assert_eq!(log().decimate(9).unwrap().len(), 1);
    assert_eq!(log().decimate(0), Err(LogError::Decimation { every: 0 }));
}

#[test]
fn metrics_of_known_sequences() {
    let summary = ErrorSummary::of(&[3.0, -4.0, 0.0, 0.0]).unwrap();
    assert_eq!((summary.max, summary.mean), (4.0, 1.75));
    // sqrt(25/4): the relative sum (9/16 + 1)/4 is exact in f64.
    assert_eq!(summary.rms, 2.5);
    // A sine over whole periods: max 1, mean 2/π, rms 1/√2. The mean of |sin|
    // over 10⁴ samples a period differs from 2/π by π/(6·N²) of it, 5e-9.
    let sine: Vec<f64> = (0..10_000)
        .map(|k| (std::f64::consts::TAU * f64::from(k) / 1e4).sin())
        .collect();
    let s = ErrorSummary::of(&sine).unwrap();
    assert!((s.mean - 2.0 / std::f64::consts::PI).abs() < 1e-7);
    assert!((s.rms - 0.5f64.sqrt()).abs() < 1e-12);
}

#[test]
fn metrics_refuse_nothing_and_nan() {
    assert_eq!(max_abs(&[]), Err(MetricError::Empty));
    assert!(matches!(
        rms(&[0.0, f64::NAN]),
        Err(MetricError::NotFinite { index: 1, .. })
    ));
    assert!(matches!(
        ErrorSummary::between(&[0.0], &[]),
        Err(MetricError::Length { .. })
    ));
    assert!(matches!(
        ErrorSummary::between(&[f64::MAX], &[f64::MIN]),
        Err(MetricError::NotFinite { index: 0, .. })
    ));
}

#[test]
fn metrics_survive_the_ends_of_the_number_range() {
    for scale in [f64::MAX, 1e-300, 0.0] {
        let s = ErrorSummary::of(&[scale, -scale]).unwrap();
        assert_eq!((s.max, s.mean, s.rms), (scale, scale, scale));
    }
}

proptest! {
    #[test]
    fn mean_rms_max_are_ordered(errors in prop::collection::vec(-1e3..1e3f64, 1..200)) {
        let (max, mean, rms) = (
            max_abs(&errors).unwrap(),
            mean_abs(&errors).unwrap(),
            rms(&errors).unwrap(),
        );
        // Jensen: mean <= rms <= max; 1e-12 for the rounding of 200 terms.
        prop_assert!(mean <= rms * (1.0 + 1e-12));
        prop_assert!(rms <= max);
    }

    #[test]
    fn metrics_scale_with_the_unit(
        errors in prop::collection::vec(-1.0..1.0f64, 1..50), exponent in -40..40i32,
    ) {
        // A power of two, so that scaling is exact.
        let factor = 2f64.powi(exponent);
        let scaled: Vec<f64> = errors.iter().map(|e| e * factor).collect();
        let (a, b) = (ErrorSummary::of(&errors).unwrap(), ErrorSummary::of(&scaled).unwrap());
        prop_assert_eq!(a.max * factor, b.max);
        prop_assert_eq!(a.mean * factor, b.mean);
        prop_assert_eq!(a.rms * factor, b.rms);
    }
}
