//! Torque balance: a model balances what it simulated itself, and effects change it as
//! their laws say.

use axis_log::{Channel, Log};
use axis_sim::effects::{ActiveEffect, Effect};
use axis_sim::{
    Axis, Balance, BalanceError, ClosedLoop, Recorder, ReplayError, Sensors, Tolerances,
};
use compensator::NoCompensation;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use trajectories::{Limits, Motion, Program, Step};

use crate::{axis, text};

/// The first trajectory as it is simulated, sensors without noise.
fn simulated(axis: &Axis) -> Log {
    simulated_on(axis, &axis.plan(&axis.trajectories[0]).unwrap())
}

/// Any motion, likewise.
pub fn simulated_on(axis: &Axis, motion: &impl Motion) -> Log {
    let mut recorder = Recorder::new(axis);
    ClosedLoop::new(axis)
        .unwrap()
        .without_noise()
        .run(motion, &mut NoCompensation, |cycle| recorder.push(cycle))
        .completed()
        .unwrap();
    recorder.log().unwrap()
}

pub fn without(log: &Log, names: &[&str]) -> Log {
    let kept = log
        .channels()
        .iter()
        .filter(|c| !names.contains(&c.name.as_str()));
    Log::new(kept.cloned().collect()).unwrap()
}

pub fn rms(series: &[f64]) -> f64 {
    (series.iter().map(|v| v * v).sum::<f64>() / series.len() as f64).sqrt()
}

pub fn active(name: &str, values: &[f64]) -> ActiveEffect {
    ActiveEffect {
        effect: Effect::named(name).unwrap(),
        values: values.to_vec(),
    }
}

/// What is needed for a log, with effects.
fn needed(balance: &Balance, axis: &Axis, effects: &[ActiveEffect]) -> Vec<f64> {
    let trace = balance.run(axis, effects, None).unwrap();
    trace.channel(balance.channel()).unwrap().to_vec()
}

/// RMS of log minus model as a share of the log's, of the model that made the log.
pub fn unbalanced(axis: &Axis, log: &Log) -> f64 {
    let balance = Balance::new(log, axis.period, axis).unwrap();
    let measured = balance.compared().channel(balance.channel()).unwrap();
    let model = needed(&balance, axis, &[]);
    let rest: Vec<f64> = measured.iter().zip(&model).map(|(a, b)| a - b).collect();
    rms(&rest) / rms(measured)
}

/// A known model leaves next to nothing of its own log: with motor and load measured, with
/// one of them alone, by the current and by the command.
#[test]
fn a_model_balances_its_own_log() {
    let mut worst = 0.0_f64;
    for (name, left_out, most) in [
        ("linear-motor.toml", &[][..], 5e-5),
        // A current loop is more than the lag it is taken for.
        ("linear-motor.toml", &["iq_a"], 0.02),
        ("rack.toml", &[], 2e-6),
        // The end that is not measured is set apart by the wind-up.
        ("rack.toml", &["motor_angle_rad"], 5e-5),
        ("rack.toml", &["position_m"], 2e-4),
        ("rotary-table.toml", &[], 2e-5),
        ("liu2025.toml", &[], 1e-5),
        ("liu2025.toml", &["motor_angle_rad"], 1e-5),
        ("liu2025.toml", &["position_m"], 1e-5),
    ] {
        let mut axis = axis(name);
        // A scale's periodic error is an error of the motion that no filter takes out.
        axis.sensors = Sensors::default();
        // Slower, friction breaks away within less than a filter lets through.
        axis.balance.slowest = Some(0.05 * axis.trajectories[0].limits.velocity());
        let log = without(&simulated(&axis), left_out);
        let share = unbalanced(&axis, &log);
        println!("{name} without {left_out:?}: {share:.2e}");
        worst = worst.max(share / most);
    }
    assert!(worst < 1.0, "{worst}");
}

/// What a mechanism's parameter changes in the machine it changes in a balance, whichever end
/// was measured.
#[test]
fn every_parameter_of_a_mechanism_is_in_a_balance() {
    for name in [
        "liu2025.toml",
        "screw-datasheet.toml",
        "rack.toml",
        "belt.toml",
        "joint.toml",
    ] {
        let mut axis = axis(name);
        axis.sensors = Sensors::default();
        // Above the least that a load swings with.
        crate::change(&mut axis.mechanism, &[("stiffness_damping", 5e-4)]);
        // At about 1 kHz, as drives log.
        let every = (1e-3 / axis.period).round() as usize;
        let log = simulated_on(&axis, &back_and_forth(&axis));
        let log = log.decimate(every).unwrap();
        let period = every as f64 * axis.period;
        for left_out in ["position_", "motor_angle_rad"] {
            let all = log.channels().iter().map(|c| c.name.as_str());
            let names: Vec<&str> = all.filter(|name| name.starts_with(left_out)).collect();
            let balance = Balance::new(&without(&log, &names), period, &axis).unwrap();
            let before = needed(&balance, &axis, &[]);
            for key in axis.mechanism.kind().keys {
                let key = key.name();
                // Backlash, which is 0 in all of them, shows between motor and load.
                let value = axis.mechanism.values().or(key, 0.0);
                if value == 0.0 {
                    continue;
                }
                // Of the load's motion alone a kinematic error tells nothing; an error of the
                // transmission shows between motor and load.
                if key.starts_with("kinematic_error") && left_out == "motor_angle_rad" {
                    continue;
                }
                let mut other = axis.clone();
                crate::change(&mut other.mechanism, &[(key, 1.1 * value)]);
                let after = needed(&balance, &other, &[]);
                let change: Vec<f64> = before.iter().zip(&after).map(|(a, b)| a - b).collect();
                let share = rms(&change) / rms(&before);
                println!("{name} without {left_out}: {key} {share:.1e}");
                assert!(share > 1e-12, "{name} without {left_out}: {key}");
            }
        }
    }
}

/// A screw's damping holds its table back by k τ ẇ. On a chirp nearly without friction, the log of
/// a machine with damping has the share of the torque that a balance by the load alone gives it, and
/// that of a machine without has it not. (What is in both, such as a cycle between current and
/// motion, is in the difference no more.)
#[test]
fn a_screws_damping_is_in_a_balance() {
    let damped = |seconds: f64| {
        let damping = format!("stiffness_damping_s = {seconds}");
        let mut axis = crate::changed(
            "liu2025.toml",
            &[
                ("stiffness_damping_s = 1e-5", &damping),
                ("coulomb_n_m = 0.6757", "coulomb_n_m = 1e-6"),
                ("stiction_n_m = 0.7653", "stiction_n_m = 1.1e-6"),
            ],
        );
        axis.sensors = Sensors::default();
        axis
    };
    let chirp = trajectories::Chirp {
        amplitude: 5e-4,
        from_frequency: 2.0,
        to_frequency: 15.0,
        duration: 4.0,
        ramp: 0.5,
        sweep: trajectories::Sweep::Linear,
    };
    let motion = Program::new(0.6, vec![Step::Chirp(chirp)]).unwrap();
    let share = |seconds: f64| {
        let machine = damped(seconds);
        let log = without(&simulated_on(&machine, &motion), &["motor_angle_rad"]);
        let balance = Balance::new(&log, machine.period, &machine).unwrap();
        let measured = balance.compared().channel(balance.channel()).unwrap();
        let [with, none] = [1e-3, 0.0].map(|s| needed(&balance, &damped(s), &[]));
        let triples = with.iter().zip(&none).zip(measured);
        let [top, below] = triples.fold([0.0, 0.0], |[top, below], ((with, none), y)| {
            let by = with - none;
            [top + by * (y - none), below + by * by]
        });
        top / below
    };
    let found = share(1e-3) - share(0.0);
    println!("{found:.3} of the damping");
    // Measured 1.24: two inertias on one spring stand for the chain.
    assert!((found - 1.0).abs() < 0.35, "{found}");
}

/// The joint, its gear without an error.
pub fn exact_joint() -> Axis {
    crate::changed(
        "joint.toml",
        &[("kinematic_error_arcmin = 0.5", "kinematic_error_arcmin = 0")],
    )
}

/// The joint's position controller runs at 1 kHz and its speed controller at 4 kHz. A log in
/// step with the first shows each torque of a period's begin, k_p a (T - T_s) / 2 above the
/// mean: a share of the inertia that `sampled_inertia` takes, and of which a log at 4 kHz knows
/// nothing. Its gear has no error here: driven through the gear's resonance, that takes torque of its own, of
/// which motion behind a low-pass knows nothing.
#[test]
fn a_command_in_step_with_the_position_controller_shows_more_inertia() {
    let mut joint = exact_joint();
    joint.sensors = Sensors::default();
    let from = joint.stroke.start;
    let limits = Limits::new(0.8, 2.0, 10.0).unwrap();
    let to = |to: f64| Step::Move { to, limits };
    let rest = Step::Dwell { duration: 0.2 };
    let steps = vec![rest, to(from + 1.0), rest, to(from), rest];
    let log = simulated_on(&joint, &Program::new(from, steps).unwrap());
    let log = without(&log, &["motor_angle_rad"]);
    let mut unknown = joint.clone().without_control().unwrap();
    unknown.tolerances = Tolerances::all(0.01);
    let known = unknown.known();
    let place = |name| known.iter().position(|n| *n == name).unwrap();
    let (sampled, hold) = (place("sampled_inertia"), place("command_hold"));
    let more = |every: usize| -> f64 {
        let log = log.decimate(every).unwrap();
        let balance = Balance::new(&log, every as f64 * joint.period, &unknown).unwrap();
        let measured = balance.compared().channel(balance.channel()).unwrap();
        let with = |share: f64| {
            let mut shares = vec![0.0; known.len()];
            shares[sampled] = share;
            // A sample stands for its whole period: for its mean, but for that share.
            shares[hold] = 1.0;
            needed(&balance, &unknown.with_known(&shares), &[])
        };
        let (none, all) = (with(0.0), with(1.0));
        let pairs = none.iter().zip(&all).zip(measured);
        let [top, below] = pairs.fold([0.0, 0.0], |[top, below], ((none, all), y)| {
            let by = all - none;
            [top + by * (y - none), below + by * by]
        });
        top / below
    };
    // k_p at the load, by (T - T_s) / 2 and the whole inertia there.
    let foretold = 0.02 * 100.0 * 100.0 * 0.375e-3 / 3.0;
    let [slow, fast] = [4, 1].map(more);
    println!("{slow:.4} at 1 kHz, {fast:.4} at 4 kHz, {foretold:.4} foretold");
    assert!((slow - fast - foretold).abs() < 0.1 * foretold);
    assert!(fast.abs() < 0.1 * foretold);
    // Where the load's inertia may be off by as much, it takes this too.
    unknown.tolerances = Tolerances::all(0.2);
    assert!(!unknown.known().contains(&"sampled_inertia"));
}

/// The first trajectory there and back, at full, a third and two thirds of its speed.
pub fn back_and_forth(axis: &Axis) -> Program {
    let (start, spec) = (axis.stroke.start, &axis.trajectories[0]);
    let rest = Step::Dwell { duration: 0.2 };
    let mut steps = vec![rest];
    for share in [1.0, 0.3, 0.6] {
        let limits = &spec.limits;
        let limits = Limits::new(
            share * limits.velocity(),
            share * limits.acceleration(),
            limits.jerk(),
        );
        let limits = limits.unwrap();
        for to in [start + spec.displacement, start] {
            steps.extend([Step::Move { to, limits }, rest]);
        }
    }
    Program::new(start, steps).unwrap()
}

/// A motion of several frequencies, sampled at 1 kHz: position, and its acceleration.
pub fn motion(n: usize) -> [Vec<f64>; 2] {
    let parts = [(0.5, 0.4, 0.1), (0.1, 1.7, 0.5), (0.02, 4.1, 1.1)];
    let sum = |power: i32, sign: f64| -> Vec<f64> {
        let at = |k: usize| {
            let part = |(a, f, phase): &(f64, f64, f64)| {
                let w = std::f64::consts::TAU * f;
                sign * a * w.powi(power) * (w * k as f64 * 1e-3 + phase).sin()
            };
            parts.iter().map(part).sum()
        };
        (0..n).map(at).collect()
    };
    [sum(0, 1.0), sum(2, -1.0)]
}

/// A table on a torque motor without control: inertia alone.
pub fn bench(inertia: f64, more: &str) -> Axis {
    let text = format!(
        "schema = 2\nname = \"bench\"\n[mechanism]\nkind = \"torque-motor\"\ntable_inertia_kg_m2 = {inertia}\n[actuator]\nkind = \"torque-source\"\ntorque_limit_n_m = 100\nbandwidth_hz = 1e6\n[friction]\nkind = \"coulomb-rotary\"\nviscous_n_m_s_per_rad = 0\ncoulomb_n_m = 0\npresliding_rad = 1e-4\n[stroke]\nminimum_rad = -100\nmaximum_rad = 100\nstart_rad = 0\n{more}"
    );
    Axis::parse("bench.toml", &text).unwrap()
}

pub fn log_of(channels: &[(&str, Vec<f64>)]) -> Log {
    let time = (0..channels[0].1.len()).map(|k| k as f64 * 1e-3).collect();
    let all = std::iter::once(Channel::new("t_s", time).unwrap());
    let others = channels
        .iter()
        .map(|(n, s)| Channel::new(*n, s.clone()).unwrap());
    Log::new(all.chain(others).collect()).unwrap()
}

/// A log of a bench with the torque of its inertia.
fn bench_log(inertia: f64) -> Log {
    let [position, acceleration] = motion(20_000);
    let torque = acceleration.iter().map(|a| inertia * a).collect();
    log_of(&[("position_rad", position), ("torque_n_m", torque)])
}

/// Where friction hangs on what the motion does not tell, nothing is compared: where an axis breaks
/// away and where it comes to rest, and there alone.
#[test]
fn what_friction_does_beneath_a_sensors_noise_is_left_out() {
    let mut axis = axis("liu2025.toml");
    axis.sensors = Sensors::default();
    let log = without(&simulated(&axis), &["motor_angle_rad"]);
    // As good sensors have it: 10 nm and 5 mA.
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut noisy = |name: &str, deviation: f64| {
        let noise = |x: &f64| {
            let n: f64 = StandardNormal.sample(&mut random);
            x + deviation * n
        };
        let samples = log.channel(name).unwrap().iter().map(noise);
        Channel::new(name, samples.collect()).unwrap()
    };
    let channels = [
        noisy("t_s", 0.0),
        noisy("position_m", 1e-8),
        noisy("iq_a", 5e-3),
    ];
    let log = Log::new(channels.into()).unwrap();
    let balance = Balance::new(&log, axis.period, &axis).unwrap();
    let quality = balance.quality();
    let share = unbalanced(&axis, &log);
    println!(
        "{} left out of {:?}: {share:.2e}",
        quality.unresolved, quality.samples
    );
    assert!(quality.unresolved > 0);
    // They lie where the axis starts and stops, and nowhere between.
    let (time, period) = (balance.compared().time(), balance.compared_period());
    let even = |t: &[f64]| t[1] - t[0] < 1.5 * period;
    assert!(time.windows(2).all(even));
    let [compared, _] = quality.samples;
    assert!(8 * quality.unresolved < compared);
    // With these samples, 1.65e-3 of the current is left.
    assert!(share < 6e-4, "{share}");
}

#[test]
fn effects_add_what_their_laws_say() {
    let axis = bench(0.3, "");
    let balance = Balance::new(&bench_log(0.3), 1e-3, &axis).unwrap();
    let bare = needed(&balance, &axis, &[]);
    let measured = balance.compared().channel("torque_n_m").unwrap();
    let off: Vec<f64> = bare.iter().zip(measured).map(|(a, b)| a - b).collect();
    assert!(
        rms(&off) < 1e-3 * rms(measured),
        "{}",
        rms(&off) / rms(measured)
    );

    // Twice the inertia: twice the torque.
    let doubled = needed(&balance, &axis, &[active("payload-mass", &[0.3])]);
    let off = doubled.iter().zip(&bare).map(|(d, b)| (d - 2.0 * b).abs());
    assert!(off.fold(0.0, f64::max) < 1e-12 * rms(&bare).max(1.0));

    let trace = balance.run(&axis, &[], None).unwrap();
    let difference = |effect: ActiveEffect| -> Vec<f64> {
        let with = needed(&balance, &axis, &[effect]);
        with.iter().zip(&bare).map(|(a, b)| a - b).collect()
    };
    let near = |found: &[f64], law: &dyn Fn(usize) -> f64| {
        let off: Vec<f64> = (0..found.len()).map(|k| found[k] - law(k)).collect();
        rms(&off) / rms(found)
    };
    let viscous = difference(active("viscous-friction", &[0.7]));
    assert!(near(&viscous, &|k| 0.7 * trace.speed[k]) < 1e-3);
    let load = difference(active("constant-load", &[2.0]));
    assert!(near(&load, &|_| 2.0) < 1e-9);
    // What cogging gives the motor need not.
    let cogging = difference(active("cogging-torque", &[0.5, 2.0, 0.3]));
    let angle = trace.position();
    let law = |k: usize| -0.5 * (2.0 * angle[k] + 0.3).sin();
    assert!(near(&cogging, &law) < 1e-2, "{}", near(&cogging, &law));
    // A torque constant has no say in a measured torque; an offset of nothing none at all.
    assert_eq!(rms(&difference(active("torque-constant", &[0.1]))), 0.0);
}

/// A drive that reads 5 % too great a current, in closed loop: measured current and command are
/// both 5 % above what the torque needs. Measured, by current and by command: shares left of 5.5e-6
/// and 0.011 with it, 0.048 and 0.057 without.
#[test]
fn a_current_sensors_gain_is_in_the_current_and_in_its_command() {
    for (left_out, most) in [(&[][..], 1e-4), (&["iq_a"], 0.02)] {
        let mut machine = axis("linear-motor.toml");
        machine.sensors = Sensors::default();
        machine.balance.slowest = Some(0.05 * machine.trajectories[0].limits.velocity());
        let honest = machine.clone();
        machine.effects = vec![active("current-sensor-gain", &[0.05])];
        let log = without(&simulated(&machine), left_out);
        let shares = [&machine, &honest].map(|model| unbalanced(model, &log));
        println!("without {left_out:?}: {shares:?}");
        assert!(shares[0] < most && (0.04..0.06).contains(&shares[1]));
    }
}

#[test]
fn an_effect_of_nothing_changes_no_bit() {
    let axis = bench(0.3, "");
    let balance = Balance::new(&bench_log(0.3), 1e-3, &axis).unwrap();
    let bare = needed(&balance, &axis, &[]);
    for name in [
        "payload-mass",
        "viscous-friction",
        "coulomb-friction",
        "constant-load",
    ] {
        let null = active(name, &[0.0, 0.0]);
        assert_eq!(needed(&balance, &axis, &[null]), bare, "{name}");
    }
}

#[test]
fn an_axis_without_control_is_balanced_and_not_looped() {
    let axis = bench(0.3, "");
    assert!(!axis.has_control());
    let error = ClosedLoop::new(&axis).unwrap_err().to_string();
    assert!(
        error.contains("no [control]") && error.contains("discover"),
        "{error}"
    );
    // A table that is misspelt is not one that is left out.
    let misspelt = text("rack.toml").replace("[control]", "[contrl]");
    let error = Axis::parse("rack.toml", &misspelt).unwrap_err().to_string();
    assert!(error.contains("did you mean `[control]`?"), "{error}");
    assert!(
        !crate::axis("rack.toml")
            .without_control()
            .unwrap()
            .has_control()
    );
}

#[test]
fn what_a_log_lacks_is_named() {
    let axis = bench(0.3, "");
    let [position, _] = motion(5000);
    let refusal = |channels: &[(&str, Vec<f64>)]| -> BalanceError {
        match Balance::new(&log_of(channels), 1e-3, &axis) {
            Err(ReplayError::Balance(error)) => error,
            other => panic!("{other:?}"),
        }
    };
    let error = refusal(&[("position_rad", position.clone())]);
    assert!(matches!(error, BalanceError::NoTorque { .. }));
    assert!(error.to_string().contains("torque_ref_n_m"), "{error}");
    let error = refusal(&[
        ("torque_n_m", position.clone()),
        ("position_m", position.clone()),
    ]);
    assert!(matches!(error, BalanceError::NoMotion { .. }));
    assert!(error.to_string().contains("velocity_rad_s"), "{error}");
    let still = vec![0.1; position.len()];
    let error = refusal(&[("torque_n_m", position), ("position_rad", still)]);
    assert!(matches!(error, BalanceError::Standstill { .. }), "{error}");
}
