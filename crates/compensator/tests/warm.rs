//! Friction that falls as an axis warms up, in the plan.

use compensator::{
    Cascade, Drive, DriveModel, DriveSection, Kinematics, PlanSettings, Planned, Planner,
    Reference, ResidualModel, SignalPath, Standstill, StrokeSections, Target,
};
use lugre::{LuGre, Parameters};

const T: f64 = 1e-4;

fn model() -> DriveModel {
    let section = DriveSection {
        rotating: 1e-4,
        ..DriveSection::default()
    };
    DriveModel {
        travel: 0.01,
        load_inertia: 2.0,
        friction: LuGre::new(Parameters {
            coulomb: 6.0,
            stiction: 7.0,
            stribeck_speed: 0.04,
            stiffness: 2e4,
            damping: 20.0,
            viscous: 8.0,
        })
        .unwrap(),
        lever: 1.0,
        along: StrokeSections::new([-2.0, 2.0], |_| section).unwrap(),
        kinematics: Kinematics::default(),
        drive: Drive::Lag {
            gain: 1.0,
            bandwidth: f64::INFINITY,
        },
        delay: 0.0,
        effort_limit: 10.0,
        cascade: Cascade {
            position: 600.0,
            velocity_feedforward: 1.0,
            acceleration_feedforward: 0.0,
            speed: 0.02,
            speed_integral: 0.4,
            from_motor: false,
            signal_path: SignalPath::default(),
        },
        period: T,
    }
}

/// Up to 0.5 rad/s in half a second, and on at that speed.
fn reference(k: usize) -> Reference {
    let t = k as f64 * T;
    let up = (t / 0.5).min(1.0);
    Reference {
        position: if t < 0.5 {
            0.5 * t * up
        } else {
            0.125 + 0.5 * (t - 0.5)
        },
        velocity: 0.5 * up,
        acceleration: if t < 0.5 { 1.0 } else { 0.0 },
    }
}

fn plan(model: &DriveModel, factors: impl Fn(f64) -> Option<[f64; 2]>) -> Vec<Planned> {
    let mut planner = Planner::new(model, &PlanSettings::default()).unwrap();
    planner.begin(0.0, &Standstill::default());
    let cycles = 0..20_000 + planner.look_ahead();
    let target = |k: usize| Target {
        friction: factors(k as f64 * T),
        ..Target::of(reference(k))
    };
    cycles.filter_map(|k| planner.push(target(k))).collect()
}

/// At 0.5 rad/s friction is 6 N dry and 8 N·s/rad viscous, each times its factor of then.
#[test]
fn friction_follows_the_factors_along_the_motion() {
    let schedule = |t: f64| match t {
        t if t < 0.8 => None,
        t if t < 1.4 => Some([0.9, 0.6]),
        _ => Some([0.8, 0.5]),
    };
    let planned = plan(&model(), schedule);
    for (t, [dry, viscous]) in [(0.7, [1.0, 1.0]), (1.3, [0.9, 0.6]), (1.9, [0.8, 0.5])] {
        let at = &planned[(t / T) as usize];
        let friction = dry * 6.0 + viscous * 8.0 * 0.5;
        assert!(
            (at.friction - friction).abs() < 1e-6,
            "{t}: {}",
            at.friction
        );
        assert!(
            (at.torque - 0.01 * friction).abs() < 1e-8,
            "{t}: {}",
            at.torque
        );
    }
    // Factors of the whole motion are the warm model's plan.
    let from_the_start = plan(&model(), |_| Some([0.8, 0.5]));
    let warm = plan(&model().warmed([0.8, 0.5]).unwrap(), |_| None);
    assert_eq!(from_the_start, warm);
    // What makes no law changes nothing.
    assert_eq!(
        plan(&model(), |_| Some([f64::NAN, -1.0])),
        plan(&model(), |_| None)
    );
    let error = model().warmed([1.0, -0.1]).unwrap_err().to_string();
    assert!(error.contains("viscous factor"), "{error}");
}

/// In KB, as the documentation of both and docs/theory/compensator.md say.
#[test]
fn a_planner_is_as_large_as_its_page_says() {
    let [whole, tables] = [size_of::<Planner>(), size_of::<ResidualModel>()];
    assert_eq!([whole / 1000, tables / 1000], [42, 3]);
}
