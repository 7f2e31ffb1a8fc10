//! The compliance at the load from measured responses, against forces on the table of a second simulator
//! (`independent_axis`), which shares no code with what is tested: another mesh, another integration, a drive of its own.

use std::f64::consts::TAU;

use axis_log::{Channel, Log};
use axis_sim::Axis;
use drive_loop::{MeasureSettings, MeasuredDrive};
use independent_axis::{Hidden, LoopNoise, Motion, Parameters, Push, Random, Sample, run_pushed};

use crate::support::example;

/// Frequencies of the force, Hz: whole ones, apart from one another over a second.
const FORCED: [f64; 13] = [
    4.0, 7.0, 11.0, 16.0, 23.0, 33.0, 45.0, 58.0, 75.0, 100.0, 130.0, 160.0, 220.0,
];
/// N each.
const FORCE: f64 = 15.0;

fn slide() -> Motion {
    Motion::from(0.6).rest(0.2).by(0.16, 0.02, 0.1)
}

fn samples(p: &Parameters, noise: &LoopNoise, push: impl Fn(f64) -> Push) -> Vec<Sample> {
    let mut all = Vec::new();
    let mut random = Random::new(3, 0);
    let hidden = Hidden::default();
    run_pushed(p, &hidden, &slide(), (noise, &mut random), push, |sample| {
        all.push(*sample);
    })
    .unwrap();
    all
}

/// Its log under a random binary signal of 2 A that repeats itself each second, from 0.6 s on.
fn log(p: &Parameters) -> Log {
    let mut random = Random::new(5, 1);
    let signs: Vec<f64> = (0..5000)
        .map(|_| if random.uniform() < 0.5 { -2.0 } else { 2.0 })
        .collect();
    let added = |t: f64| {
        let k = ((t - 0.6) / p.period).round();
        match (0.0..7.0).contains(&(t - 0.6)) {
            true => signs[(k as usize / 2) % signs.len()],
            false => 0.0,
        }
    };
    let all = samples(p, &LoopNoise::GOOD, |t| Push {
        current: added(t),
        force: 0.0,
    });
    let channel = |name: &str, of: &dyn Fn(&Sample) -> f64| {
        Channel::new(name, all.iter().map(of).collect()).unwrap()
    };
    Log::new(vec![
        channel("t_s", &|s| s.time),
        channel("position_ref_m", &|s| s.wanted.position),
        channel("position_m", &|s| s.seen.position),
        channel("motor_angle_rad", &|s| s.seen.angle),
        channel("motor_speed_rad_s", &|s| s.seen.speed),
        channel("iq_ref_a", &|s| s.command.current),
        channel("iq_a", &|s| s.seen.current[1]),
        channel("excitation_a", &|s| added(s.time)),
    ])
    .unwrap()
}

/// Motion of the table per force, as complex amplitudes over 2 s: with the force less without it.
fn truth(p: &Parameters) -> Vec<[f64; 2]> {
    let force = |t: f64| -> f64 {
        // Phases apart, or all crests come together.
        let of = |(i, f): (usize, &f64)| FORCE * (TAU * f * t + 2.0 * (i * i) as f64).cos();
        FORCED.iter().enumerate().map(of).sum()
    };
    let quiet = LoopNoise::default();
    let pushed = samples(p, &quiet, |t| Push {
        current: 0.0,
        force: if t > 1.0 { force(t) } else { 0.0 },
    });
    let free = samples(p, &quiet, |_| Push::default());
    let (from, count) = (40_000, 20_000);
    let amplitude = |f: f64, of: &dyn Fn(usize) -> f64| {
        let (mut re, mut im) = (0.0, 0.0);
        for (k, sample) in pushed.iter().enumerate().skip(from).take(count) {
            let angle = TAU * f * sample.time;
            re += of(k) * angle.cos();
            im -= of(k) * angle.sin();
        }
        [re, im]
    };
    let one = |f: &f64| {
        let [a, b] = amplitude(*f, &|k| pushed[k].seen.position - free[k].seen.position);
        let [c, d] = amplitude(*f, &|k| force(pushed[k].time));
        let square = c * c + d * d;
        [(a * c + b * d) / square, (b * c - a * d) / square]
    };
    FORCED.iter().map(one).collect()
}

fn measured(axis: &Axis, log: &Log) -> MeasuredDrive {
    MeasuredDrive::of(axis, log, &MeasureSettings::default()).unwrap()
}

/// Relative errors of the measured compliance and of the model's.
fn errors(found: &MeasuredDrive, truth: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let compliance = found.compliance.as_ref().unwrap();
    let one = |(f, [re, im]): (&f64, &[f64; 2])| {
        let line = compliance
            .lines
            .iter()
            .min_by(|a, b| {
                let of = |hz: f64| (hz - f).abs();
                of(a.frequency_hz).total_cmp(&of(b.frequency_hz))
            })
            .unwrap();
        assert!(
            (line.frequency_hz - f).abs() < 1e-3,
            "{f} {}",
            line.frequency_hz
        );
        let off = |v: [f64; 2]| (v[0] - re).hypot(v[1] - im) / re.hypot(*im);
        println!(
            "{f:>6} Hz true {:.3e} measured {:.1} % off (deviation {:.1} %), model {:.1} %",
            re.hypot(*im),
            100.0 * off(line.value),
            100.0 * line.deviation / re.hypot(*im),
            100.0 * off(line.model)
        );
        [off(line.value), off(line.model)]
    };
    FORCED.iter().zip(truth).map(one).collect()
}

fn median(mut of: Vec<f64>) -> f64 {
    of.sort_by(f64::total_cmp);
    of[of.len() / 2]
}

/// The machine of the file, and one with 40 % more table and half the stiffness of the nut, of which the file
/// knows nothing.
#[test]
fn responses_show_the_compliance_of_forces_on_the_table() {
    let axis = example("liu2025");
    let own = Parameters::paper();
    let other = Parameters {
        table_mass: 1.4 * own.table_mass,
        nut_stiffness: 0.5 * own.nut_stiffness,
        ..own
    };
    for (p, is_known) in [(own, true), (other, false)] {
        let found = measured(&axis, &log(&p));
        assert!(found.is_usable(), "{:?}", found.traps);
        let c = found.compliance.as_ref().unwrap();
        let all = errors(&found, &truth(&p));
        for ([measured, _], f) in all.iter().zip(FORCED) {
            // Found: 2.7 % at most, below 10 Hz; below 1 % from 58 Hz on.
            let most = if f < 50.0 { 0.04 } else { 0.012 };
            assert!(*measured < most, "{f} Hz: {measured}");
        }
        let model = median(all.iter().map(|e| e[1]).collect());
        // Of the file the model is right (0.1 % found), of the other machine 60 % off.
        assert!(if is_known { model < 0.01 } else { model > 0.3 }, "{model}");
        // By hand: motor, sensor and solid screw turn, the table moves along.
        let screw =
            p.density * std::f64::consts::PI * p.screw_diameter.powi(4) * p.screw_length / 32.0;
        let inertia =
            p.motor_inertia + p.sensor_inertia + screw + p.table_mass * p.travel().powi(2);
        assert!(
            (c.inertia.value / inertia - 1.0).abs() < 0.04,
            "{:?}",
            c.inertia
        );
        assert!(
            (c.travel.value / p.travel() - 1.0).abs() < 2e-3,
            "{:?}",
            c.travel
        );
        assert_eq!(c.modes.len(), 2);
        // The first mode has the table against the motor.
        assert!(c.modes[0].load_per_motor.value < 0.0);
    }
}

/// What is missing is said.
#[test]
fn a_log_without_the_current_shows_no_compliance() {
    let axis = example("liu2025");
    let whole = log(&Parameters::paper());
    let without = |name: &str| {
        let channels = whole.channels().iter().filter(|c| c.name != name);
        let log = Log::new(channels.cloned().collect()).unwrap();
        let found = MeasuredDrive::of(&axis, &log, &MeasureSettings::default()).unwrap();
        assert!(found.is_usable() && found.compliance.is_none());
        found.compliance_missing.unwrap()
    };
    let said = without("iq_a");
    assert!(
        said.contains("both the command and the actual current"),
        "{said}"
    );
    let mut still = axis.clone();
    still.sensors.load = axis_sim::LoadSensor::Missing;
    let found = MeasuredDrive::of(&still, &whole, &MeasureSettings::default()).unwrap();
    let said = found.compliance_missing.unwrap();
    assert!(said.contains("no sensor at the load"), "{said}");
}
