//! A compensator as a real controller drives it: in single precision, set points one by one,
//! a bounded look ahead, noisy sensors, a guard around everything; no simulator.
//!
//! `cargo run --release -p compensator --example streaming`
//!
//! The controller holds its own set points back by the planner's look-ahead (8 ms here). The
//! axis is a few lines at the end: a carriage on a screw, its friction 15 % below what is
//! assumed, behind the P-PI drive whose offsets are corrected.
#![allow(clippy::disallowed_methods, reason = "truth needs no promised bits")]

use compensator::{
    Cascade, Correction, Drive, DriveModel, DriveSection, FeedbackDesign, FeedbackSettings, Guard,
    GuardLimits, Mode, PlanSettings, Planner, Reference, Sample, Standstill, Status,
    StrokeSections, Target,
};
use lugre::{LuGre, Parameters};
use trajectories::{Limits, Motion, SCurve};

/// Control period, s.
const T: f64 = 1e-4;
/// Travel per radian, m/rad; torque per current, N·m/A.
const R: f64 = 0.01 / std::f64::consts::TAU;
const KT: f64 = 1.641;
/// What turns with the motor, kg·m²; the carriage, kg.
const J: f64 = 0.008;
const M: f64 = 515.0;
/// Position gain, (rad/s)/m; speed gains, A/(rad/s) and A/rad.
const P: f64 = 29_342.0;
const SPEED: [f64; 2] = [0.647, 6.8];
const LIMIT: f64 = 15.0;

/// The model of the axis.
fn assumed_model() -> Result<DriveModel, Box<dyn std::error::Error>> {
    let section = DriveSection {
        rotating: J,
        ..DriveSection::default()
    };
    Ok(DriveModel {
        travel: R,
        load_inertia: M,
        friction: LuGre::new(Parameters::LIU_2025)?,
        lever: R,
        along: StrokeSections::new([0.0, 1.5], |_| section)?,
        kinematics: compensator::Kinematics::default(),
        drive: Drive::Lag {
            gain: KT,
            bandwidth: 4000.0,
        },
        delay: 0.0,
        effort_limit: LIMIT,
        cascade: Cascade {
            position: P,
            velocity_feedforward: 1.0,
            acceleration_feedforward: 0.0,
            speed: SPEED[0],
            speed_integral: SPEED[1],
            from_motor: false,
            signal_path: compensator::SignalPath::default(),
        },
        period: T,
    })
}

/// The model in single precision: made in double precision, once.
fn single(model: &DriveModel) -> Result<DriveModel<f32>, Box<dyn std::error::Error>> {
    let section = DriveSection {
        rotating: J as f32,
        ..DriveSection::default()
    };
    let c = &model.cascade;
    Ok(DriveModel {
        travel: R as f32,
        load_inertia: M as f32,
        friction: LuGre::new(model.friction.parameters().cast())?,
        lever: R as f32,
        along: StrokeSections::new([0.0, 1.5], |_| section)?,
        kinematics: compensator::Kinematics::default(),
        drive: Drive::Lag {
            gain: KT as f32,
            bandwidth: 4000.0,
        },
        delay: 0.0,
        effort_limit: LIMIT as f32,
        cascade: Cascade {
            position: c.position as f32,
            velocity_feedforward: 1.0,
            acceleration_feedforward: 0.0,
            speed: c.speed as f32,
            speed_integral: c.speed_integral as f32,
            from_motor: false,
            signal_path: compensator::SignalPath::default(),
        },
        period: T as f32,
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Once, where there is time: the design, in double precision.
    let model = assumed_model()?;
    let whole = (J + M * R * R).sqrt();
    let rigid = Mode {
        motor: 1.0 / whole,
        load: R / whole,
        ..Mode::default()
    };
    let design =
        FeedbackDesign::within_margins(&model, &[rigid], &[], &FeedbackSettings::default())?;
    let margins = design.margins(&compensator::Variation::default())?;
    println!("margins of the feedback: {margins:?}");

    // The program, as another part of the controller hands it out: one set point a cycle.
    let program = SCurve::plan(0.0, 0.1, &Limits::new(0.1, 0.5, 10.0)?)?;
    let cycles = (program.duration() / T) as usize + 500;
    let set_point = |k: usize| {
        let at = program.at(k as f64 * T);
        Reference {
            position: at.position,
            velocity: at.velocity,
            acceleration: at.acceleration,
        }
        .cast::<f32>()
    };

    for compensated in [false, true] {
        let mut planner = Planner::new(&single(&model)?, &PlanSettings::default())?;
        let mut feedback = design.feedback().cast::<f32>();
        let mut guard = Guard::new(GuardLimits {
            position: 2e-4_f32,
            effort: 8.0,
            surprise: 10.0,
            patience: 50,
            fade: 100,
        })?;
        guard.switch(compensated);
        let mut axis = Axis::at(0.0)?;
        planner.begin(0.0, &Standstill::default());
        let (mut peak, mut held) = (0.0_f64, 0.0_f32);
        for k in 0..cycles {
            // The newest set point goes in; the plan is of one that is look-ahead old.
            let Some(planned) = planner.push(Target::of(set_point(k))) else {
                continue;
            };
            let sample = axis.sense(planned.reference, held);
            let asked = feedback.correct(&sample, &planned);
            let correction = guard.pass(&asked, feedback.deviations().surprise);
            peak = peak.max((f64::from(planned.reference.position) - axis.position).abs());
            held = axis.cycle(&sample, &correction);
        }
        assert!(
            !matches!(guard.status(), Status::Tripped(_)),
            "{:?}",
            guard.status()
        );
        println!(
            "compensated: {compensated:5}   peak error {:.3} µm",
            1e6 * peak
        );
    }
    Ok(())
}

/// The axis: friction on a rigid carriage, a current that lags, the drive's own P-PI.
struct Axis {
    friction: LuGre,
    position: f64,
    speed: f64,
    bristle: f64,
    current: f64,
    integral: f64,
    noise: u64,
}

impl Axis {
    fn at(position: f64) -> Result<Self, lugre::LugreError> {
        let p = Parameters::LIU_2025;
        Ok(Self {
            friction: LuGre::new(Parameters {
                coulomb: 0.85 * p.coulomb,
                stiction: 0.85 * p.stiction,
                ..p
            })?,
            position,
            speed: 0.0,
            bristle: 0.0,
            current: 0.0,
            integral: 0.0,
            noise: 1,
        })
    }

    /// Nearly normal, of deviation 1.
    fn random(&mut self) -> f64 {
        let mut sum = -6.0;
        for _ in 0..12 {
            self.noise = self
                .noise
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            sum += (self.noise >> 11) as f64 / (1_u64 << 53) as f64;
        }
        sum
    }

    /// What the sensors show: 10 nm, 0.01 rad/s and 5 mA of noise. Positions count from the
    /// start of the motion: in single precision 0.6 m has steps of 60 nm.
    fn sense(&mut self, reference: Reference<f32>, held: f32) -> Sample<f32> {
        let noise = [1e-8, 1e-2, 5e-3].map(|deviation| deviation * self.random());
        Sample {
            reference,
            position: (self.position + noise[0]) as f32,
            motor_angle: (self.position / R) as f32,
            motor_speed: (self.speed / R + noise[1]) as f32,
            iq: (self.current + noise[2]) as f32,
            last_command: held,
            ..Sample::default()
        }
    }

    /// The drive, and the carriage until the next sample; the current that was commanded.
    fn cycle(&mut self, sample: &Sample<f32>, correction: &Correction<f32>) -> f32 {
        let error = f64::from(sample.reference.position - sample.position + correction.position);
        let asked = P * error + f64::from(sample.reference.velocity) / R;
        let speed_error = asked - f64::from(sample.motor_speed);
        self.integral += SPEED[1] * speed_error * T;
        let command = SPEED[0] * speed_error + self.integral + f64::from(correction.command);
        let command = command.clamp(-LIMIT, LIMIT);
        let steps = 10;
        for _ in 0..steps {
            let h = T / f64::from(steps);
            self.current += (command - self.current) * (1.0 - (-4000.0 * h).exp());
            let w = self.speed / R;
            let (bristle, drag) = self.friction.step_torque(self.bristle, w, w, h);
            self.bristle = bristle;
            let rate = (KT * self.current - drag) / (J + M * R * R);
            self.position += h * (self.speed + 0.5 * h * rate * R);
            self.speed += h * rate * R;
        }
        command as f32
    }
}
