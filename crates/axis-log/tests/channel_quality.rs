//! What can be told of a channel alone, and of two together.

use std::f64::consts::{PI, TAU};

use axis_log::quality::{
    ChannelQuality, Colour, CrossCheckVerdict, Relation, RelationLaw, channel_quality, clock,
    cross_check,
};
use axis_log::{Channel, ColumnMap, Log, Mapping, read_log};
use proptest::prelude::*;

const PERIOD: f64 = 1e-3;

/// Of unit variance, nearly Gaussian, the same on every machine.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut uniform = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    move || (0..12).map(|_| uniform()).sum::<f64>() - 6.0
}

fn motion(t: f64) -> f64 {
    0.1 * (TAU * 0.4 * t).sin() + 0.02 * (TAU * 1.7 * t).cos()
}

fn speed(t: f64) -> f64 {
    TAU * (0.04 * (TAU * 0.4 * t).cos() - 0.034 * (TAU * 1.7 * t).sin())
}

fn times() -> Vec<f64> {
    (0..8000).map(|k| f64::from(k) * PERIOD).collect()
}

fn log(channels: &[(&str, Vec<f64>)]) -> Log {
    let channel =
        |(name, samples): &(&str, Vec<f64>)| Channel::new(*name, samples.clone()).unwrap();
    let time = Channel::new("t_s", times()).unwrap();
    Log::new(
        std::iter::once(time)
            .chain(channels.iter().map(channel))
            .collect(),
    )
    .unwrap()
}

fn of(f: impl FnMut(f64) -> f64) -> Vec<f64> {
    times().into_iter().map(f).collect()
}

fn judged(samples: Vec<f64>) -> ChannelQuality {
    channel_quality(&log(&[("x_m", samples)]), "x_m", None).unwrap()
}

#[test]
fn white_noise_has_its_level_and_no_corner() {
    let mut n = noise(1);
    let found = judged(of(|t| motion(t) + 3e-5 * n()));
    let level = found.noise.unwrap();
    assert!((level.level / 3e-5 - 1.0).abs() < 0.1, "{level:?}");
    assert_eq!(
        (level.colour, found.corner, found.quantum, found.hold),
        (Colour::White, None, None, None)
    );
    assert!(found.saturation.is_empty() && found.outliers == 0);
}

#[test]
fn a_low_pass_has_its_corner_and_differences_rise() {
    for corner in [60.0, 120.0, 200.0] {
        // Butterworth, second order, bilinear with its corner where it should be.
        let (mut n, mut x, mut y) = (noise(2), [0.0; 2], [0.0; 2]);
        let w = (PI * corner * PERIOD).tan();
        let a = 1.0 + 2f64.sqrt() * w + w * w;
        let (b1, b2) = (2.0 * (w * w - 1.0) / a, (1.0 - 2f64.sqrt() * w + w * w) / a);
        let filtered = of(|t| {
            let u = n();
            let v = w * w / a * (u + 2.0 * x[0] + x[1]) - b1 * y[0] - b2 * y[1];
            (x, y) = ([u, x[0]], [v, y[0]]);
            motion(t) + 1e-4 * v
        });
        let found = judged(filtered);
        let at = found.corner.expect("a corner");
        assert!((at / corner - 1.0).abs() < 0.25, "{at} for {corner}");
        assert_eq!(found.noise.unwrap().colour, Colour::Falling);
    }
    // The mean of 2 − 2 cos ω is 2.75 in the third quarter, and 3.80 in the fourth.
    let (mut n, mut last) = (noise(3), 0.0);
    let differences = of(|_| {
        let now = n();
        let d = now - last;
        last = now;
        d
    });
    let found = judged(differences);
    assert_eq!(
        (found.noise.unwrap().colour, found.corner),
        (Colour::Rising, None)
    );
}

#[test]
fn a_hold_and_its_period_are_found() {
    for every in [2_usize, 5, 20] {
        let held =
            of(|t| motion(PERIOD * every as f64 * (t / PERIOD / every as f64 + 1e-9).floor()));
        let hold = judged(held).hold.expect("held");
        let exact = every as f64 * PERIOD;
        assert!((hold.period / exact - 1.0).abs() < 0.05, "{hold:?}");
        assert!(
            (hold.repeated - (1.0 - 1.0 / every as f64)).abs() < 0.05,
            "{hold:?}"
        );
    }
    // Quantisation repeats values too, where motion is slow: no hold.
    let coarse = of(|t| (motion(t) / 2e-4).round() * 2e-4);
    assert_eq!(judged(coarse).hold, None);
}

#[test]
fn a_limit_is_found_and_a_dwell_is_none() {
    let cut = judged(of(|t| motion(t).clamp(-1.0, 0.07)));
    assert_eq!(cut.saturation.len(), 1, "{cut}");
    assert_eq!(cut.saturation[0].value, 0.07);
    let ramp = |t: f64| {
        let s = ((t - 2.0) / 3.0).clamp(0.0, 1.0);
        s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
    };
    assert!(judged(of(ramp)).saturation.is_empty());
}

#[test]
fn a_clock_tells_jitter_and_missing_rows() {
    let mut time = times();
    time.drain(400..407);
    time[5000] += 0.1 * PERIOD;
    let found = clock(&Log::new(vec![Channel::new("t_s", time).unwrap()]).unwrap()).unwrap();
    assert_eq!(found.missing_rows, 7);
    assert!((found.period / PERIOD - 1.0).abs() < 1e-6, "{found:?}");
    assert!(
        (found.jitter - 0.1).abs() < 1e-3 && found.jitter_rms < 0.01,
        "{found:?}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn the_quantum_is_found_to_a_hundredth(step in 1e-7..2e-4f64, from in -1.0..1.0f64, loud in any::<bool>()) {
        let mut n = noise(7);
        let size = if loud { 2.0 * step } else { 0.0 };
        let found = judged(of(|t| from + ((motion(t) + size * n()) / step).round() * step));
        // A quantum much above the motion's speed changes too seldom to recur.
        let quantum = found.quantum.expect("a quantum");
        prop_assert!((quantum.step / step - 1.0).abs() < 0.01, "{quantum:?} for {step}");
        prop_assert!(quantum.on_grid > 0.99, "{quantum:?}");
    }

    #[test]
    fn the_delay_is_found_to_a_twentieth_of_a_sample(delay in -20.0..20.0f64) {
        let tones = [7.3, 19.1, 31.7, 60.3];
        let lively = |t: f64| tones.iter().map(|f| (TAU * f * t + f).sin()).sum::<f64>() / 2f64.sqrt();
        let (mut a, mut b) = (noise(11), noise(12));
        let pair = log(&[
            ("iq_ref_a", of(|t| lively(t) + 0.01 * a())),
            ("iq_a", of(|t| lively(t - delay * PERIOD) + 0.01 * b())),
        ]);
        let found = channel_quality(&pair, "iq_a", Some("iq_ref_a")).unwrap().delay.expect("a delay");
        prop_assert!((found.seconds / PERIOD - delay).abs() < 0.05, "{found:?} for {delay}");
    }
}

fn mapped() -> Mapping {
    let map = |source: &str, channel: &str| ColumnMap {
        source: source.into(),
        channel: channel.into(),
        scale: 1.0,
        is_scale_stated: false,
        offset: 0.0,
        delay: 0.0,
    };
    Mapping {
        columns: vec![map("Phi", "motor_angle_rad"), map("Pos", "position_m")],
        sample_rate_hz: None,
    }
}

const TRAVEL: f64 = 2e-3;

fn findings(position: f64, angle: f64, zero: f64) -> Vec<axis_log::quality::Finding> {
    let mut n = noise(31);
    let log = log(&[
        ("position_ref_m", of(motion)),
        (
            "position_m",
            of(|t| position * (motion(t - 5e-3) + 1e-6 * n()) + zero),
        ),
        (
            "motor_angle_rad",
            of(|t| angle * motion(t - 5e-3) / TRAVEL + 77.0),
        ),
        ("motor_speed_rad_s", of(|t| speed(t - 5e-3) / TRAVEL)),
    ]);
    let relations = [
        Relation::new("position_m", "position_ref_m", RelationLaw::Same),
        Relation::new(
            "position_m",
            "motor_angle_rad",
            RelationLaw::Scaled { factor: TRAVEL },
        ),
        Relation::new(
            "motor_angle_rad",
            "motor_speed_rad_s",
            RelationLaw::Integral { factor: 1.0 },
        ),
        Relation::new("position_m", "not_there_m", RelationLaw::Same),
    ];
    cross_check(&log, &mapped(), &relations)
}

#[test]
fn channels_that_agree_are_let_be() {
    let found = findings(1.0, 1.0, 0.0);
    assert_eq!(found.len(), 3);
    for f in found {
        assert_eq!(f.verdict, CrossCheckVerdict::Agrees, "{f}");
        assert_eq!(f.repair, None);
    }
}

#[test]
fn degrees_counts_turns_millimetres_and_signs_are_recognised() {
    let cases: [(f64, f64, f64, &str, &str, f64); 7] = [
        (1e3, 1.0, 0.0, "position_m", "mm", 1e-3),
        (-1.0, 1.0, 0.0, "position_m", "sign", -1.0),
        (1.0, 180.0 / PI, 0.0, "motor_angle_rad", "deg", PI / 180.0),
        (
            1.0,
            -180.0 / PI,
            0.0,
            "motor_angle_rad",
            "sign reversed",
            -PI / 180.0,
        ),
        (1.0, 1.0 / TAU, 0.0, "motor_angle_rad", "rev", TAU),
        (
            1.0,
            10_000.0 / TAU,
            0.0,
            "motor_angle_rad",
            "counts, 10000 a turn",
            TAU / 10_000.0,
        ),
        (
            1.0,
            65_536.0 / TAU,
            0.0,
            "motor_angle_rad",
            "counts, 65536 a turn",
            TAU / 65_536.0,
        ),
    ];
    for (position, angle, zero, channel, words, scale) in cases {
        let found = findings(position, angle, zero);
        let wrong = found
            .iter()
            .filter(|f| f.verdict == CrossCheckVerdict::Contradicts);
        let told = wrong.filter(|f| f.looks_like.contains(words));
        let repairs: Vec<_> = told.filter_map(|f| f.repair.as_ref()).collect();
        let right = repairs
            .iter()
            .any(|r| r.channel == channel && (r.scale / scale - 1.0).abs() < 1e-12);
        assert!(right, "{words}: {found:#?}");
    }
}

#[test]
fn another_zero_is_told_with_the_offset_that_mends_it() {
    let found = findings(1.0, 1.0, 0.4);
    let wrong: Vec<_> = found
        .iter()
        .filter(|f| f.verdict == CrossCheckVerdict::Contradicts)
        .collect();
    assert_eq!(wrong.len(), 1, "{found:#?}");
    let repair = wrong[0].repair.as_ref().unwrap();
    assert!((repair.offset + 0.4).abs() < 1e-3, "{repair:?}");
    let lines = wrong[0].lines().unwrap();
    assert!(
        lines.contains("source = \"Pos\"") && lines.contains("offset = -0.39996"),
        "{lines}"
    );
}

#[test]
fn a_factor_that_no_unit_explains_is_unclear_and_proposes_nothing() {
    let found = findings(1.0, 1.37, 0.0);
    let odd: Vec<_> = found
        .iter()
        .filter(|f| f.verdict == CrossCheckVerdict::Unclear)
        .collect();
    assert_eq!(odd.len(), 2, "{found:#?}");
    assert!(odd.iter().all(|f| f.repair.is_none()), "{odd:#?}");
    assert!(
        found
            .iter()
            .all(|f| f.verdict != CrossCheckVerdict::Contradicts)
    );
}

/// A drive that shows its current as RMS and takes its command as an amplitude, or the other way round.
#[test]
fn rms_values_beside_amplitudes_are_recognised_and_nothing_is_proposed() {
    for factor in [2.0f64.sqrt(), 0.5f64.sqrt()] {
        let mut n = noise(41);
        let pair = log(&[
            ("iq_ref_a", of(motion)),
            ("iq_a", of(|t| factor * motion(t) + 1e-4 * n())),
        ]);
        let follows = [Relation::new("iq_a", "iq_ref_a", RelationLaw::Follows)];
        let found = cross_check(&pair, &mapped(), &follows);
        assert_eq!(found[0].verdict, CrossCheckVerdict::Unclear, "{found:?}");
        assert!(found[0].looks_like.contains("RMS"), "{found:?}");
        assert_eq!(found[0].repair, None);
    }
}

fn measured(file: &str) -> Option<Log> {
    let path = crate::needs::shared(&format!("data/{file}"))?;
    let map = |source: &str, channel: &str| ColumnMap {
        source: source.into(),
        channel: channel.into(),
        scale: 1.0,
        is_scale_stated: false,
        offset: 0.0,
        delay: 0.0,
    };
    let columns = vec![
        map("q_ref_m", "position_ref_m"),
        map("q_meas_m", "position_m"),
        map("u_V", "drive_command_v"),
    ];
    Some(
        read_log(
            path,
            &Mapping {
                columns,
                sample_rate_hz: None,
            },
            &[],
        )
        .unwrap(),
    )
}

fn tell(log: &Log) {
    println!("{:?}", clock(log));
    for channel in &log.channels()[1..] {
        println!("{}", channel_quality(log, &channel.name, None).unwrap());
    }
}

#[test]
fn the_emps_stage_has_the_grid_and_the_filter_that_it_is_known_for() {
    let Some(fit) = measured("emps/emps.csv") else {
        return;
    };
    tell(&fit);
    let found = channel_quality(&fit, "position_m", Some("position_ref_m")).unwrap();
    println!("{found}");
    let step = found.quantum.expect("a quantum").step;
    assert!((step / 5e-8 - 1.0).abs() < 0.01, "{step}");
    assert_eq!(found.outliers, 0);
    let Some(check) = measured("emps/emps_pulses.csv") else {
        return;
    };
    tell(&check);
    let same = [Relation::new(
        "position_m",
        "position_ref_m",
        RelationLaw::Same,
    )];
    for log in [fit, check] {
        for finding in cross_check(&log, &Mapping::default(), &same) {
            assert_eq!(finding.verdict, CrossCheckVerdict::Agrees, "{finding}");
        }
    }
}

#[test]
fn the_bench_motor_has_its_encoder_and_its_integral() {
    let Some(log) = measured("lugre-bench/J_1.csv") else {
        return;
    };
    tell(&log);
    let found = channel_quality(&log, "position_rad", None).unwrap();
    let step = found.quantum.expect("a quantum").step;
    assert!((step / (TAU / 10_000.0) - 1.0).abs() < 0.01, "{step}");
    let integral = [Relation::new(
        "position_rad",
        "velocity_rad_s",
        RelationLaw::Integral { factor: 1.0 },
    )];
    for finding in cross_check(&log, &Mapping::default(), &integral) {
        println!("{finding}");
        assert_eq!(finding.verdict, CrossCheckVerdict::Agrees, "{finding}");
    }
}

#[test]
fn the_rig_of_two_motors_has_its_torque_constant() {
    let Some(log) = measured("hsm150/pos_0.06_1.csv") else {
        return;
    };
    tell(&log);
    let relations = [
        Relation::new(
            "position_rad",
            "velocity_rad_s",
            RelationLaw::Integral { factor: 1.0 },
        ),
        Relation::new(
            "torque_measured_n_m",
            "current_a",
            RelationLaw::About {
                factor: 0.0458,
                within: 2.0,
            },
        ),
    ];
    for finding in cross_check(&log, &Mapping::default(), &relations) {
        println!("{finding}");
        assert_ne!(finding.verdict, CrossCheckVerdict::Contradicts, "{finding}");
    }
}
