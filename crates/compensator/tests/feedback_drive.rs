//! The margins of a feedback count what its drive has besides: against the feedback itself on a
//! drive and a machine that are simulated in small steps.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]
#![cfg(feature = "design")]

use compensator::{
    Cascade, DesignError, Drive, DriveFilter, DriveModel, DriveSection, FeedbackDesign,
    FeedbackSettings, Mode, Planned, Reference, Sample, SignalPath, StrokeSections, Variation,
};
use foc_pmsm::{MotorParameters, Pmsm};
use lugre::{LuGre, Parameters};
use std::collections::VecDeque;
use std::f64::consts::TAU;

const T: f64 = 1e-4;
const R: f64 = 0.01 / TAU;
const K: f64 = 1.641;
const LIMIT: f64 = 15.0;
/// Inertia at the motor, of a rigid axis.
const INERTIA: f64 = 0.0078;
const MASS: f64 = 515.0;
const RESISTANCE: f64 = 0.75;
const INDUCTANCE: f64 = 0.0132;
/// Bandwidth of the current loop 4000 1/s, its integral a fifth of that.
const CURRENT: [f64; 2] = [53.0, 42_000.0];
const SPEED: [f64; 2] = [0.647, 6.8];
const POSITION: f64 = 29_342.0;

/// A rigid axis that is hardly held by any friction, under that drive.
fn axis(drive: Drive, signal_path: SignalPath) -> (DriveModel, [Mode; 1]) {
    let section = DriveSection {
        compliance: 0.0,
        rotating: INERTIA - MASS * R * R,
        ..DriveSection::default()
    };
    let model = DriveModel {
        travel: R,
        load_inertia: MASS,
        friction: LuGre::new(Parameters {
            coulomb: 1e-6,
            stiction: 1e-6,
            stribeck_speed: 1.0,
            stiffness: 1e-6,
            damping: 0.0,
            viscous: 0.0,
        })
        .expect("a law"),
        lever: R,
        along: StrokeSections::new([0.0, 1.5], |_| section).expect("a stroke"),
        kinematics: compensator::Kinematics::default(),
        drive,
        delay: 0.0,
        effort_limit: LIMIT,
        cascade: Cascade {
            position: POSITION,
            velocity_feedforward: 1.0,
            acceleration_feedforward: 0.0,
            speed: SPEED[0],
            speed_integral: SPEED[1],
            from_motor: false,
            signal_path,
        },
        period: T,
    };
    let rigid = Mode {
        motor: 1.0 / INERTIA.sqrt(),
        load: R / INERTIA.sqrt(),
        ..Mode::default()
    };
    (model, [rigid])
}

fn at_once() -> Drive {
    Drive::Lag {
        gain: K,
        bandwidth: f64::INFINITY,
    }
}

fn with_currents(late: f64) -> Drive {
    let parameters = MotorParameters {
        pole_pairs: 4,
        resistance: RESISTANCE,
        inductance_d: INDUCTANCE,
        inductance_q: INDUCTANCE,
        flux_linkage: K / 6.0,
    };
    Drive::FieldOriented {
        motor: Pmsm::new(parameters).expect("a motor"),
        gear: 1.0,
        d: CURRENT,
        q: CURRENT,
        voltage: 1e6,
        late,
    }
}

/// Without a look at what is asked for.
fn design(model: &DriveModel, modes: &[Mode]) -> FeedbackDesign {
    let settings = FeedbackSettings {
        sensitivity: f64::INFINITY,
        sensitivity_late: f64::INFINITY,
        ..FeedbackSettings::default()
    };
    FeedbackDesign::new(model, modes, &settings).expect("a design")
}

fn low_pass(frequency: f64) -> DriveFilter {
    let pole = (-TAU * frequency * T).exp();
    DriveFilter {
        b: [1.0 - pole, 0.0, 0.0],
        a: [-pole, 0.0],
    }
}

/// (s² + 2 d ζ ω s + ω²)/(s² + 2 ζ ω s + ω²), bilinear about its middle.
fn notch(frequency: f64, damping: f64, depth: f64) -> DriveFilter {
    let k = (0.5 * TAU * frequency * T).tan();
    let side = |by: f64| {
        [
            1.0 + by * k + k * k,
            2.0 * (k * k - 1.0),
            1.0 - by * k + k * k,
        ]
    };
    let (top, bottom) = (side(2.0 * depth * damping), side(2.0 * damping));
    DriveFilter {
        b: top.map(|b| b / bottom[0]),
        a: [bottom[1] / bottom[0], bottom[2] / bottom[0]],
    }
}

/// A filter in direct form I.
#[derive(Default)]
struct Filtered {
    given: [f64; 2],
    made: [f64; 2],
}

impl Filtered {
    fn pass(&mut self, f: Option<DriveFilter>, u: f64) -> f64 {
        let Some(f) = f else { return u };
        let y = f.b[0] * u + f.b[1] * self.given[0] + f.b[2] * self.given[1]
            - f.a[0] * self.made[0]
            - f.a[1] * self.made[1];
        (self.given, self.made) = ([u, self.given[0]], [y, self.made[0]]);
        y
    }
}

/// By how much the deviations change a cycle in the end, the machine beginning a little off: over
/// `cycles`, or until the command comes near its limit, where the loop is no longer linear.
fn growth(model: &DriveModel, modes: &[Mode], cycles: usize) -> f64 {
    let mut feedback = design(model, modes).feedback();
    let signal_path = model.cascade.signal_path;
    let steps = 100;
    let h = T / f64::from(steps);
    let (mut angle, mut speed, mut current) = (1e-12_f64, 0.0_f64, 0.0_f64);
    let (mut sum, mut voltages, mut set_point, mut command) = (0.0, 0.0, 0.0, 0.0);
    let mut under_way = match model.drive {
        Drive::FieldOriented { late, .. } => {
            VecDeque::from(vec![0.0; (late * f64::from(steps)).round() as usize])
        }
        Drive::Lag { .. } => VecDeque::new(),
    };
    let mut positions = [R * angle; 2];
    let mut filters: [Filtered; 3] = Default::default();
    let mut sizes = Vec::new();
    for k in 0..cycles {
        let position = R * angle;
        let sample = Sample {
            position,
            motor_angle: angle,
            motor_speed: speed,
            iq: current,
            last_command: command,
            reference: Reference::default(),
            ..Sample::default()
        };
        let correction = feedback.correct(&sample, &Planned::default());
        // The drive.
        if k % signal_path.position_every as usize == 0 {
            set_point = POSITION * (correction.position - position);
        }
        let mut seen = speed;
        if signal_path.speed_of_position {
            seen = (position - positions[1]) / (2.0 * T * R);
            positions = [position, positions[0]];
        }
        let error = set_point - filters[0].pass(signal_path.speed, seen);
        sum += SPEED[1] * T * error;
        command = SPEED[0] * error + sum + correction.command;
        command = filters[1].pass(signal_path.command[0], command);
        command = filters[2].pass(signal_path.command[1], command);
        // The machine.
        let error = command - current;
        voltages += CURRENT[1] * T * error;
        let asked = CURRENT[0] * error + voltages;
        for _ in 0..steps {
            match model.drive {
                Drive::Lag { .. } => current = command,
                Drive::FieldOriented { .. } => {
                    under_way.push_back(asked);
                    let voltage = under_way.pop_front().expect("one was pushed");
                    let induced = 4.0 * speed * K / 6.0;
                    current += h * (voltage - RESISTANCE * current - induced) / INDUCTANCE;
                }
            }
            angle += h * (speed + 0.5 * h * K * current / INERTIA);
            speed += h * K * current / INERTIA;
        }
        sizes.push((R * angle).abs().max(R * speed.abs() * T * 30.0));
        if command.abs() > 0.1 * LIMIT {
            break;
        }
    }
    let cycles = sizes.len();
    let most = |from: usize, to: usize| sizes[from..to].iter().copied().fold(0.0, f64::max);
    let (first, second) = (
        most(cycles / 2, cycles * 5 / 8),
        most(cycles * 7 / 8, cycles),
    );
    (second / first).powf(8.0 / (3.0 * cycles as f64))
}

/// What margins say of it, against that.
fn compare(name: &str, drive: Drive, signal_path: SignalPath, cycles: usize) -> (f64, f64) {
    let (model, modes) = axis(drive, signal_path);
    let margins = design(&model, &modes)
        .margins(&Variation::default())
        .expect("margins");
    let growth = growth(&model, &modes, cycles);
    println!(
        "{name}: {:.5} by eigenvalues, {growth:.5} simulated; S {:.2}, delay {:.2} T",
        margins.radius,
        margins.sensitivity,
        margins.delay / T
    );
    (margins.radius, growth)
}

fn filtered(speed: Option<DriveFilter>, command: [Option<DriveFilter>; 2]) -> SignalPath {
    SignalPath {
        speed,
        command,
        ..SignalPath::default()
    }
}

/// Stable loops and unstable ones: what is left of a deviation, or becomes of it.
#[test]
fn the_loop_decays_and_grows_as_its_eigenvalues_say() {
    let every = |position_every| SignalPath {
        position_every,
        ..SignalPath::default()
    };
    let differences = SignalPath {
        speed_of_position: true,
        ..SignalPath::default()
    };
    let cases = [
        ("nothing besides", at_once(), SignalPath::default()),
        (
            "speed low-passed at 400 Hz",
            at_once(),
            filtered(Some(low_pass(400.0)), [None; 2]),
        ),
        (
            "at 30 Hz",
            at_once(),
            filtered(Some(low_pass(30.0)), [None; 2]),
        ),
        (
            "command at 500 Hz",
            at_once(),
            filtered(None, [Some(low_pass(500.0)), None]),
        ),
        (
            "at 40 Hz",
            at_once(),
            filtered(None, [Some(low_pass(40.0)), None]),
        ),
        (
            "notch of 300 Hz",
            at_once(),
            filtered(None, [None, Some(notch(300.0, 0.5, 0.1))]),
        ),
        (
            "wide one of 60 Hz",
            at_once(),
            filtered(None, [None, Some(notch(60.0, 1.0, 0.02))]),
        ),
        ("position every 2", at_once(), every(2)),
        ("every 8", at_once(), every(8)),
        ("every 32", at_once(), every(32)),
        ("speed of the position", at_once(), differences),
        ("current loop", with_currents(0.0), SignalPath::default()),
        (
            "current loop, 1 late",
            with_currents(1.0),
            SignalPath::default(),
        ),
        (
            "current loop, 0.4 late",
            with_currents(0.4),
            SignalPath::default(),
        ),
        ("and every 4", with_currents(1.0), every(4)),
    ];
    let mut unstable = 0;
    for (name, drive, signal_path) in cases {
        let (radius, growth) = compare(name, drive, signal_path, 1600);
        assert_eq!(radius < 1.0, growth < 1.0, "{name}");
        unstable += u32::from(growth > 1.0);
        // One pair of poles alone, in the end.
        let off = (growth - radius).abs();
        assert!(off < 5e-5 + 0.05 * (radius - 1.0).abs(), "{name}: {off:e}");
    }
    assert!(unstable >= 3, "{unstable}");
}

/// What no margins are computed of is refused, with the key that is in the way.
#[test]
fn loops_that_are_not_counted_are_refused() {
    let none = SignalPath::default();
    let cases = [
        (
            SignalPath {
                speed_every: 2,
                ..none
            },
            "speed_rate",
        ),
        (
            SignalPath {
                position_every: 33,
                ..none
            },
            "position_rate",
        ),
        (
            SignalPath {
                other_position: true,
                ..none
            },
            "blend",
        ),
    ];
    for (signal_path, key) in cases {
        let (model, modes) = axis(at_once(), signal_path);
        let error = FeedbackDesign::new(&model, &modes, &FeedbackSettings::default());
        let error = error.expect_err("refused");
        assert!(matches!(error, DesignError::Control(_)), "{error}");
        assert!(error.to_string().contains(key), "{error}");
    }
}

/// The sensitivity of a loop that repeats after one period is the same as of one that is said to
/// repeat after several and does not.
#[test]
fn a_filter_that_passes_all_changes_no_margin() {
    let all = DriveFilter {
        b: [1.0, 0.0, 0.0],
        a: [0.0; 2],
    };
    let margins = |signal_path| {
        let (model, modes) = axis(with_currents(1.0), signal_path);
        design(&model, &modes)
            .margins(&Variation::default())
            .expect("margins")
    };
    let plain = margins(SignalPath::default());
    let passed = margins(filtered(Some(all), [Some(all), Some(all)]));
    assert!(
        (plain.sensitivity / passed.sensitivity - 1.0).abs() < 1e-6,
        "{plain:?} {passed:?}"
    );
    assert!(
        (plain.delay / passed.delay - 1.0).abs() < 1e-6,
        "{plain:?} {passed:?}"
    );
}
