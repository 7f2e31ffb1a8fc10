//! Parameters that the axis file gives, and that may be off by its tolerance.

use axis_sim::effects::Machine;
use axis_sim::{Axis, RigidAxis};
use feed_dynamics::{DriveParameters, FeedDrive};
use foc_pmsm::{MotorParameters, Pmsm};
use lugre::{LuGre, Parameters};

/// A known parameter of a machine.
#[derive(Clone, Copy)]
pub struct Known {
    /// Its name in reports.
    pub name: &'static str,
    change: Change,
}

#[derive(Clone, Copy)]
enum Change {
    Drive(fn(&mut DriveParameters, f64)),
    Motor(fn(&mut MotorParameters, f64)),
    Friction(fn(&mut Parameters, f64)),
    Rigid(fn(&mut RigidAxis, f64)),
}

const BALL_SCREW: [Known; 13] = [
    drive("motor-inertia", |p, by| p.motor_inertia *= by),
    drive("motor-coupling", |p, by| p.motor_coupling_stiffness *= by),
    drive("screw-coupling", |p, by| p.screw_coupling_stiffness *= by),
    drive("nut-stiffness", |p, by| p.nut_stiffness *= by),
    drive("table-mass", |p, by| p.table_mass *= by),
    motor("torque-constant", |p, by| p.flux_linkage *= by),
    motor("resistance", |p, by| p.resistance *= by),
    motor("inductance", |p, by| {
        p.inductance_d *= by;
        p.inductance_q *= by;
    }),
    friction("coulomb-level", |p, by| {
        p.stiction += p.coulomb * (by - 1.0);
        p.coulomb *= by;
    }),
    friction("break-away", |p, by| {
        p.stiction = (p.stiction * by).max(p.coulomb)
    }),
    friction("stribeck-speed", |p, by| p.stribeck_speed *= by),
    friction("bristle-stiffness", |p, by| p.stiffness *= by),
    friction("viscous", |p, by| p.viscous *= by),
];

const RIGID: [Known; 2] = [
    Known {
        name: "mass",
        change: Change::Rigid(|axis, by| axis.mass *= by),
    },
    Known {
        name: "viscous",
        change: Change::Rigid(|axis, by| {
            let mut p = axis.friction.parameters();
            p.viscous *= by;
            axis.friction = LuGre::new(p).unwrap_or(axis.friction);
        }),
    },
];

const fn drive(name: &'static str, change: fn(&mut DriveParameters, f64)) -> Known {
    let change = Change::Drive(change);
    Known { name, change }
}

const fn motor(name: &'static str, change: fn(&mut MotorParameters, f64)) -> Known {
    let change = Change::Motor(change);
    Known { name, change }
}

const fn friction(name: &'static str, change: fn(&mut Parameters, f64)) -> Known {
    let change = Change::Friction(change);
    Known { name, change }
}

/// The known parameters of a kind of machine.
pub fn known_parameters(machine: &Machine) -> &'static [Known] {
    match machine {
        Machine::BallScrew(_) => &BALL_SCREW,
        Machine::Rigid(_) => &RIGID,
    }
}

/// How far a known parameter of this machine may be off, as a share.
pub fn tolerance(machine: &Machine) -> f64 {
    match machine {
        Machine::BallScrew(axis) => axis.tolerance,
        Machine::Rigid(axis) => axis.tolerance,
    }
}

/// Standard deviation of a known parameter's departure: that of a uniform
/// distribution over its tolerance.
pub fn known_deviation(machine: &Machine) -> f64 {
    tolerance(machine) / 3f64.sqrt()
}

/// Which known parameters are at the edge of their tolerance: they cannot move
/// on, whatever a linearised problem would like.
pub fn pinned(machine: &Machine, shares: &[f64]) -> Vec<bool> {
    let most = 0.999 * tolerance(machine);
    shares.iter().map(|s| s.abs() >= most).collect()
}

/// The machine with its known parameters off by `shares` of their values, in
/// the order of [`known_parameters`]. A share that would make no machine is
/// passed over.
pub fn with_known(machine: &Machine, shares: &[f64]) -> Machine {
    let mut machine = machine.clone();
    for (known, share) in known_parameters(&machine).iter().zip(shares) {
        if *share != 0.0 {
            match &mut machine {
                Machine::BallScrew(axis) => change(axis, known, 1.0 + share),
                Machine::Rigid(axis) => {
                    if let Change::Rigid(change) = known.change {
                        change(axis, 1.0 + share);
                    }
                }
            }
        }
    }
    machine
}

fn change(axis: &mut Axis, known: &Known, by: f64) {
    match known.change {
        Change::Drive(change) => {
            let mut p = axis.drive.parameters().clone();
            change(&mut p, by);
            if let Ok(drive) = FeedDrive::new(p) {
                axis.drive = drive;
            }
        }
        Change::Motor(change) => {
            let mut p = *axis.motor.parameters();
            change(&mut p, by);
            axis.motor = Pmsm::new(p).unwrap_or(axis.motor);
        }
        Change::Friction(change) => {
            let mut p = axis.friction.parameters();
            change(&mut p, by);
            axis.friction = LuGre::new(p).unwrap_or(axis.friction);
        }
        Change::Rigid(_) => {}
    }
}
