//! What an effect may change: parameters of a machine, and hooks in its loop.

use std::fmt;
use std::sync::Arc;

use feed_dynamics::{DriveError, DriveParameters, FeedDrive};
use foc_pmsm::{MotorParameters, Pmsm, Servo, ServoGains};

use crate::{Axis, Measured, RigidAxis};

/// Either kind of machine.
#[derive(Clone, Debug)]
pub enum Machine {
    /// Ball screw, permanent-magnet motor, field-oriented control.
    BallScrew(Box<Axis>),
    /// A rigid mass with a force gain.
    Rigid(Box<RigidAxis>),
}

/// The table as a load sees it.
#[derive(Clone, Copy, Debug, Default)]
pub struct TableState {
    /// Since the motion began, s.
    pub time: f64,
    /// m, absolute.
    pub position: f64,
    /// m/s.
    pub speed: f64,
    /// Unit bristle, −1 to 1: the direction of sliding, without a jump.
    pub bristle: f64,
    /// Share of a standing load that acts: it comes up over 20 ms, so that a
    /// log may start with the machine at rest under it.
    pub pressed: f64,
}

/// The screw at the nut as an error of its kinematics sees it.
#[derive(Clone, Copy, Debug, Default)]
pub struct ScrewState {
    /// Since the motion began, s.
    pub time: f64,
    /// Motor angle since then, rad.
    pub angle: f64,
    /// Motor speed, rad/s.
    pub rate: f64,
    /// Table position, m.
    pub position: f64,
    /// Table speed, m/s.
    pub speed: f64,
}

/// What the sensors get wrong.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sensors {
    /// Added to the q current, A.
    pub current_offset: f64,
    /// Amplitude and phase of each of the motor encoder's errors, rad.
    pub eccentricities: Vec<[f64; 2]>,
}

impl Sensors {
    /// What these sensors make of what perfect ones would show.
    pub(crate) fn show(&self, mut m: Measured) -> Measured {
        m.current.q += self.current_offset;
        let true_angle = m.motor_angle;
        let mut speed_ratio = 1.0;
        for [amplitude, phase] in &self.eccentricities {
            let at = true_angle + phase;
            m.motor_angle += amplitude * (at.sin() - phase.sin());
            speed_ratio += amplitude * at.cos();
        }
        m.motor_speed *= speed_ratio;
        m
    }
}

type Load = Arc<dyn Fn(&TableState) -> f64 + Send + Sync>;
type Torque = Arc<dyn Fn(f64, f64) -> f64 + Send + Sync>;
type Offset = Arc<dyn Fn(&ScrewState) -> [f64; 2] + Send + Sync>;

/// Where the loop calls effects. The default has none, and costs nothing.
#[derive(Clone, Default)]
pub(crate) struct Hooks {
    loads: Vec<Load>,
    torques: Vec<Torque>,
    offsets: Vec<Offset>,
    pub(crate) gap: f64,
    pub(crate) sensors: Sensors,
    pub(crate) dead_time_voltage: f64,
    pub(crate) delay: f64,
    pub(crate) clock_offset: f64,
}

impl fmt::Debug for Hooks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Hooks")
            .field("loads", &self.loads.len())
            .field("torques", &self.torques.len())
            .field("offsets", &self.offsets.len())
            .finish_non_exhaustive()
    }
}

impl Hooks {
    /// Adds a load on the table, N, positive against positive motion.
    pub fn load(&mut self, load: impl Fn(&TableState) -> f64 + Send + Sync + 'static) {
        self.loads.push(Arc::new(load));
    }

    /// Adds a motor torque, N·m, from motor angle (rad) and air-gap torque (N·m).
    pub fn torque(&mut self, torque: impl Fn(f64, f64) -> f64 + Send + Sync + 'static) {
        self.torques.push(Arc::new(torque));
    }

    /// Adds a displacement of the nut, and its rate: m, m/s.
    pub fn offset(&mut self, offset: impl Fn(&ScrewState) -> [f64; 2] + Send + Sync + 'static) {
        self.offsets.push(Arc::new(offset));
    }

    pub(crate) fn has_loads(&self) -> bool {
        !self.loads.is_empty()
    }

    pub(crate) fn loads_at(&self, table: &TableState) -> f64 {
        self.loads.iter().map(|load| load(table)).sum()
    }

    pub(crate) fn torque_at(&self, angle: f64, torque: f64) -> f64 {
        let added = |sum, hook: &Torque| sum + hook(angle, torque);
        self.torques.iter().fold(torque, added)
    }

    pub(crate) fn offset_at(&self, screw: &ScrewState) -> [f64; 2] {
        self.offsets.iter().fold([0.0; 2], |sum, hook| {
            let [by, rate] = hook(screw);
            [sum[0] + by, sum[1] + rate]
        })
    }
}

/// A machine that effects are being put into.
pub struct Changes<'a> {
    pub(crate) machine: MachineMut<'a>,
    pub(crate) hooks: &'a mut Hooks,
}

pub(crate) enum MachineMut<'a> {
    BallScrew(&'a mut Axis),
    Rigid(&'a mut RigidAxis),
}

impl MachineMut<'_> {
    /// Control period, s.
    pub(crate) fn period(&self) -> f64 {
        match self {
            Self::BallScrew(axis) => axis.period,
            Self::Rigid(axis) => axis.period,
        }
    }
}

/// The values of an effect with K parameters; missing ones are 0.
pub(super) fn array<const K: usize>(values: &[f64]) -> [f64; K] {
    std::array::from_fn(|i| values.get(i).copied().unwrap_or(0.0))
}

pub(super) fn out_of_range(name: &'static str, value: f64) -> DriveError {
    DriveError::Parameter {
        name,
        value,
        valid: "such that the machine's own value stays in its range",
    }
}

impl Changes<'_> {
    /// Adds a load on the table, N, positive against positive motion.
    pub fn load(&mut self, load: impl Fn(&TableState) -> f64 + Send + Sync + 'static) {
        self.hooks.load(load);
    }

    /// Adds a motor torque, N·m, from motor angle (rad) and air-gap torque (N·m).
    pub fn torque(&mut self, torque: impl Fn(f64, f64) -> f64 + Send + Sync + 'static) {
        self.hooks.torque(torque);
    }

    /// Adds a displacement of the nut on the screw, and its rate: m, m/s.
    pub fn offset(&mut self, offset: impl Fn(&ScrewState) -> [f64; 2] + Send + Sync + 'static) {
        self.hooks.offset(offset);
    }

    /// The ball-screw axis. Effects that ask for it are never installed on
    /// another machine ([`super::Effect::on_rigid`]).
    pub(super) fn ball_screw(&mut self) -> Result<&mut Axis, DriveError> {
        match &mut self.machine {
            MachineMut::BallScrew(axis) => Ok(axis),
            MachineMut::Rigid(_) => Err(out_of_range("ball screw", 0.0)),
        }
    }

    pub(super) fn drive(
        &mut self,
        change: impl Fn(&mut DriveParameters),
    ) -> Result<(), DriveError> {
        let axis = self.ball_screw()?;
        let mut parameters = axis.drive.parameters().clone();
        change(&mut parameters);
        axis.drive = FeedDrive::new(parameters)?;
        Ok(())
    }

    pub(super) fn motor(
        &mut self,
        change: impl Fn(&mut MotorParameters),
    ) -> Result<(), DriveError> {
        let axis = self.ball_screw()?;
        let mut parameters = *axis.motor.parameters();
        change(&mut parameters);
        axis.motor = Pmsm::new(parameters).map_err(|_| out_of_range("motor", 0.0))?;
        Ok(())
    }

    fn gains(&mut self, change: impl Fn(&mut ServoGains)) -> Result<(), DriveError> {
        let axis = self.ball_screw()?;
        let mut gains = *axis.servo.gains();
        change(&mut gains);
        axis.servo = Servo::new(gains, *axis.servo.limits(), axis.period)
            .map_err(|_| out_of_range("gain", 0.0))?;
        Ok(())
    }

    pub(super) fn mass(&mut self, added: f64) -> Result<(), DriveError> {
        match &mut self.machine {
            MachineMut::BallScrew(_) => self.drive(|p| p.table_mass += added),
            MachineMut::Rigid(axis) => {
                axis.mass += added;
                if axis.mass > 0.0 {
                    Ok(())
                } else {
                    Err(out_of_range("mass", added))
                }
            }
        }
    }

    pub(super) fn torque_constant(&mut self, relative: f64) -> Result<(), DriveError> {
        match &mut self.machine {
            MachineMut::BallScrew(_) => self.motor(|p| p.flux_linkage *= 1.0 + relative),
            MachineMut::Rigid(axis) => {
                axis.force_gain *= 1.0 + relative;
                Ok(())
            }
        }
    }

    pub(super) fn position_gain(&mut self, relative: f64) -> Result<(), DriveError> {
        match &mut self.machine {
            MachineMut::BallScrew(_) => self.gains(|g| g.position *= 1.0 + relative),
            MachineMut::Rigid(axis) => {
                axis.position_gain *= 1.0 + relative;
                Ok(())
            }
        }
    }

    /// Proportional and integral gain alike.
    pub(super) fn speed_gain(&mut self, relative: f64) -> Result<(), DriveError> {
        match &mut self.machine {
            MachineMut::BallScrew(_) => self.gains(|g| {
                g.speed_p *= 1.0 + relative;
                g.speed_i *= 1.0 + relative;
            }),
            MachineMut::Rigid(axis) => {
                axis.speed_gain *= 1.0 + relative;
                Ok(())
            }
        }
    }
}
