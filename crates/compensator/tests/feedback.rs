//! The feedback around a plan, on its own linear model and on numbers of any kind.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]
#![cfg(feature = "design")]

use compensator::{
    Cascade, Compensator, DesignError, Drive, DriveModel, DriveSection, Feedback, FeedbackDesign,
    FeedbackSettings, Guard, GuardLimits, Guarded, Mode, Plan, PlanSettings, PlanWithFeedback,
    Planned, Reference, Sample, Status, StrokeSections, Target, Trip, Variation,
};
use lugre::{LuGre, Parameters};
use proptest::prelude::*;

const T: f64 = 1e-4;
const R: f64 = 0.01 / std::f64::consts::TAU;
/// Torque per command, greatest command, motor's and table's inertia, stiffness at the motor.
const K: f64 = 1.641;
const LIMIT: f64 = 15.0;
const MOTOR: f64 = 0.0065;
const TABLE: f64 = 515.0;
const STIFFNESS: f64 = 170.0;
/// Command per speed, and speed per position.
const CASCADE: [f64; 2] = [0.647, 29342.0];

/// A two-mass axis whose torque follows its command at once, without friction.
fn axis(position: f64) -> (DriveModel, Vec<Mode>) {
    let section = DriveSection {
        compliance: 1.0 / STIFFNESS,
        rotating: MOTOR,
        ..DriveSection::default()
    };
    let model = DriveModel {
        travel: R,
        load_inertia: TABLE,
        friction: LuGre::new(Parameters {
            coulomb: 0.5,
            stiction: 0.5,
            stribeck_speed: 1.0,
            stiffness: 0.5,
            damping: 0.0,
            viscous: 0.0,
        })
        .expect("a law"),
        lever: R,
        along: StrokeSections::new([0.0, 1.5], |_| section).expect("a stroke"),
        kinematics: compensator::Kinematics::default(),
        drive: Drive::Lag {
            gain: K,
            bandwidth: f64::INFINITY,
        },
        delay: 0.0,
        effort_limit: LIMIT,
        cascade: Cascade {
            position,
            velocity_feedforward: 1.0,
            acceleration_feedforward: 0.0,
            speed: CASCADE[0],
            speed_integral: 6.8,
            from_motor: false,
            signal_path: compensator::SignalPath::default(),
        },
        period: T,
    };
    let at_motor = TABLE * R * R;
    let total = MOTOR + at_motor;
    let frequency = (STIFFNESS * (1.0 / MOTOR + 1.0 / at_motor)).sqrt();
    let elastic = (at_motor / (MOTOR * total)).sqrt();
    let modes = vec![
        Mode {
            motor: 1.0 / total.sqrt(),
            load: R / total.sqrt(),
            ..Mode::default()
        },
        Mode {
            frequency,
            damping: 1e-5 * frequency * frequency,
            motor: elastic,
            load: -elastic * MOTOR / (R * TABLE),
        },
    ];
    (model, modes)
}

fn design() -> FeedbackDesign {
    let (model, modes) = axis(CASCADE[1]);
    FeedbackDesign::new(&model, &modes, &open()).expect("a design")
}

/// Margins that are not asked for.
fn open() -> FeedbackSettings {
    FeedbackSettings {
        sensitivity: f64::INFINITY,
        sensitivity_late: f64::INFINITY,
        ..FeedbackSettings::default()
    }
}

/// The two modes in small steps, with a force against the load.
#[derive(Default)]
struct Machine {
    state: [[f64; 2]; 2],
}

impl Machine {
    fn seen(&self, modes: &[Mode]) -> [f64; 2] {
        let of = |i: usize, shape: fn(&Mode) -> f64| -> f64 {
            modes
                .iter()
                .zip(&self.state)
                .map(|(m, s)| shape(m) * s[i])
                .sum()
        };
        [of(0, |m| m.load), of(1, |m| m.motor)]
    }

    fn cycle(&mut self, modes: &[Mode], command: f64, force: f64) {
        let steps = 50;
        let h = T / f64::from(steps);
        for _ in 0..steps {
            for (mode, [at, rate]) in modes.iter().zip(&mut self.state) {
                let push = mode.motor * K * command - mode.load * force;
                *rate += h * (push - mode.damping * *rate - mode.frequency * mode.frequency * *at);
                *at += h * *rate;
            }
        }
    }
}

/// Runs the feedback on the machine at rest; the last deviations.
fn run(feedback: &mut Feedback, force: f64, cycles: usize) -> (Machine, Vec<f64>) {
    let (_, modes) = axis(CASCADE[1]);
    let mut machine = Machine::default();
    let (mut command, mut commands) = (0.0, vec![]);
    for _ in 0..cycles {
        let [position, motor_speed] = machine.seen(&modes);
        let sample = Sample {
            position,
            motor_speed,
            last_command: command,
            ..Sample::default()
        };
        let correction = feedback.correct(&sample, &Planned::default());
        // What the drive's own loop gives: nothing.
        let speed = CASCADE[1] * (correction.position - position) - motor_speed;
        assert!(speed.abs() < 1e-9, "{speed}");
        command = correction.command;
        commands.push(command);
        machine.cycle(&modes, command, force);
    }
    (machine, commands)
}

/// A constant force is known, and the load stands where it should, though the transmission
/// winds up.
#[test]
fn a_constant_force_is_cancelled() {
    let mut feedback = design().feedback();
    let (machine, commands) = run(&mut feedback, 100.0, 120_000);
    let (_, modes) = axis(CASCADE[1]);
    let [load, _] = machine.seen(&modes);
    let found = feedback.deviations();
    assert!((found.force - 100.0).abs() < 1e-2, "{found:?}");
    assert!(
        load.abs() < 1e-10 && found.load.abs() < 1e-10,
        "{load} {found:?}"
    );
    let held = commands[commands.len() - 1];
    assert!((held - 100.0 * R / K).abs() < 1e-5, "{held}");
}

/// The watchdog sees what the observer does: noise as designed for is no surprise, a scale
/// that is suddenly 5 µm off is one, and so is a sample that is no number.
#[test]
fn a_guard_sees_the_surprise_of_plan_and_feedback() {
    let (model, modes) = axis(CASCADE[1]);
    for (off, tripped) in [(0.0, false), (5e-6, true), (f64::NAN, true)] {
        let plan = Plan::new(&model, &PlanSettings::default(), |_| Target::default());
        let inner = PlanWithFeedback::new(plan.expect("a plan"), design().feedback());
        let limits = GuardLimits {
            position: 1e-3,
            effort: LIMIT,
            surprise: 10.0,
            patience: 10,
            fade: 0,
        };
        let mut guarded = Guarded::new(inner, Guard::new(limits).expect("limits"));
        guarded.guard_mut().switch(true);
        let (mut machine, mut command, mut worst) = (Machine::default(), 0.0, 0.0_f64);
        for (k, (noisy, _)) in samples(2000).iter().enumerate() {
            let [position, motor_speed] = machine.seen(&modes);
            let broken = if k < 1000 { 0.0 } else { off * (k % 2) as f64 };
            let sample = Sample {
                position: position + noisy.position + broken,
                motor_speed: motor_speed + noisy.motor_speed - noisy.reference.velocity / R,
                iq: command,
                last_command: command,
                ..Sample::default()
            };
            command = guarded.correct(&sample).command;
            machine.cycle(&modes, command, 0.0);
            if k < 1000 {
                worst = worst.max(guarded.surprise());
            }
        }
        // Half the position's noise that it was designed for, as much of the speed's.
        assert!(worst > 0.1 && worst < 4.0, "{worst}");
        let status = guarded.guard().status();
        assert_eq!(status == Status::Tripped(Trip::Surprise), tripped, "{off}");
    }
}

/// Without a force nothing is found, and nothing is done.
#[test]
fn rest_stays_rest() {
    let mut feedback = design().feedback();
    let (machine, commands) = run(&mut feedback, 0.0, 100);
    assert!(machine.state == [[0.0; 2]; 2] && commands.iter().all(|c| *c == 0.0));
}

#[test]
fn riccati_equations_are_solved() {
    assert!(design().residual() < 1e-9, "{}", design().residual());
}

/// On the assumed axis the loop is stable with room; with another delay it says so.
#[test]
fn margins_say_what_the_loop_has() {
    let design = design();
    let m = design.margins(&Variation::default()).expect("margins");
    assert!(
        m.radius < 1.0 && m.sensitivity < 1.3 && m.sensitivity_late < 1.8,
        "{m:?}"
    );
    assert!(m.delay > 2.0 * T, "{m:?}");
    let heavy = Variation {
        mass: 1.4,
        ..Variation::default()
    };
    assert!(design.margins(&heavy).expect("margins").radius < 1.0);
}

#[test]
fn what_cannot_be_is_refused() {
    let (model, modes) = axis(0.0);
    let refused = |model: &DriveModel, modes: &[Mode], settings: &FeedbackSettings| {
        FeedbackDesign::new(model, modes, settings).expect_err("refused")
    };
    assert!(matches!(
        refused(&model, &modes, &open()),
        DesignError::Control(_)
    ));
    let (model, modes) = axis(CASCADE[1]);
    assert!(matches!(
        refused(&model, &[], &open()),
        DesignError::Modes(_)
    ));
    assert!(matches!(
        refused(&model, &modes[1..], &open()),
        DesignError::Modes(_)
    ));
    let strict = FeedbackSettings {
        sensitivity: 1.001,
        ..FeedbackSettings::default()
    };
    let error = refused(&model, &modes, &strict);
    assert!(matches!(error, DesignError::Margin { .. }), "{error}");
    let late = DriveModel {
        delay: 12.0 * T,
        ..model
    };
    assert!(matches!(
        refused(&late, &modes, &open()),
        DesignError::Size { .. }
    ));
    let bad = FeedbackSettings {
        damping: f64::NAN,
        ..open()
    };
    assert!(matches!(
        refused(&model, &modes, &bad),
        DesignError::Setting(_)
    ));
}

/// Noise as it always is, 10 nm and 0.01 rad/s.
fn samples(count: usize) -> Vec<(Sample, Planned)> {
    let mut seed = 7_u64;
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    (0..count)
        .map(|k| {
            let velocity = 0.05 * (k as f64 * 0.01).sin();
            let reference = Reference {
                velocity,
                ..Reference::default()
            };
            let sample = Sample {
                reference,
                position: 1e-8 * next(),
                motor_speed: velocity / R + 0.01 * next(),
                ..Sample::default()
            };
            let planned = Planned {
                reference,
                motor_speed: velocity / R,
                sticking: next().max(0.0),
                ..Planned::default()
            };
            (sample, planned)
        })
        .collect()
}

#[test]
fn the_same_bits_twice() {
    let mut a = design().feedback();
    let mut b = design().feedback();
    let rows = samples(2000);
    let first: Vec<_> = rows.iter().map(|(s, p)| a.correct(s, p)).collect();
    b.correct(&rows[5].0, &rows[5].1);
    b.reset();
    let again: Vec<_> = rows.iter().map(|(s, p)| b.correct(s, p)).collect();
    assert_eq!(first, again);
}

/// In `f32` the command is that of `f64` to a thousandth of what the feedback gives.
#[test]
fn single_precision_follows() {
    let mut double = design().feedback();
    let mut single = double.cast::<f32>();
    let (mut most, mut off) = (0.0f64, 0.0f64);
    for (s, p) in &samples(2000) {
        // Both see the same numbers: those of f32.
        let (s, v) = (s.cast::<f32>(), p.motor_speed as f32);
        let p32 = Planned::<f32> {
            reference: s.reference,
            motor_speed: v,
            sticking: p.sticking as f32,
            ..Planned::default()
        };
        let p64 = Planned {
            reference: s.cast().reference,
            motor_speed: f64::from(v),
            sticking: f64::from(p32.sticking),
            ..Planned::default()
        };
        let a = double.correct(&s.cast(), &p64).command;
        let b = f64::from(single.correct(&s, &p32).command);
        most = most.max(a.abs());
        off = off.max((a - b).abs());
    }
    assert!(off < 1e-3 * most && most > 0.0, "{off} of {most}");
}

fn any_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>(),
        -1.0..1.0f64,
        Just(f64::NAN),
        Just(f64::INFINITY),
        Just(1e300),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// After whatever it was shown it is finite again with the next good samples.
    #[test]
    fn nothing_bad_stays(bad in prop::collection::vec(prop::array::uniform8(any_number()), 1..20)) {
        let mut feedback = design_once().clone();
        for v in &bad {
            let sample = Sample {
                position: v[0],
                motor_speed: v[1],
                iq: v[2],
                last_command: v[3],
                ..Sample::default()
            };
            let planned = Planned {
                position: v[4],
                motor_speed: v[5],
                sticking: v[6],
                effort: v[7],
                ..Planned::default()
            };
            let correction = feedback.correct(&sample, &planned);
            prop_assert!(correction.command.is_finite() && correction.position.is_finite());
            prop_assert!(feedback.states().iter().all(|x| x.is_finite()));
        }
        for _ in 0..20_000 {
            let correction = feedback.correct(&Sample::default(), &Planned::default());
            prop_assert!(correction.command.is_finite() && correction.command.abs() <= 3.0 * LIMIT);
        }
    }
}

fn design_once() -> &'static Feedback {
    static FEEDBACK: std::sync::OnceLock<Feedback> = std::sync::OnceLock::new();
    FEEDBACK.get_or_init(|| design().feedback())
}

/// As the documentation says.
#[test]
fn memory() {
    let sizes = [size_of::<Feedback<f64>>(), size_of::<Feedback<f32>>()];
    assert!(sizes[0] <= 13 * 1024 && sizes[1] <= 13 * 512, "{sizes:?}");
}
