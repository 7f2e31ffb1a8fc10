//! The drive without its controllers, and what its sensors show, at one place and state.

use axis_sim::{Axis, LoadSensor};
use compensator::{
    Cascade, DriveModel, DriveSituation, Mode, SampledDrive, SampledResponse, SignalPath,
};
use nalgebra::{Complex, DMatrix, DVector, RowDVector};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::LoopError;

pub(crate) type Number = Complex<f64>;

/// Most natural modes that count; those above have no part in a loop that a drive can close.
const MODES: usize = 16;

/// Where the load is, and what is other than the file says: one member of the set over which
/// margins must hold.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Corner {
    /// Position of the load, m or rad.
    pub position: f64,
    /// Its mass or inertia, as a share of the file's.
    pub mass: f64,
    /// Friction (stiffness and damping of its bristles, viscous part), as a share of the file's.
    pub friction: f64,
    /// Whether the load sticks: its friction is a spring and a damper. It slides otherwise.
    pub stuck: bool,
}

/// What an axis is to its loops, wherever the load is.
#[derive(Clone, Debug)]
pub(crate) struct LoopModel {
    pub model: DriveModel,
    pub sensing: Sensing,
    integrates: bool,
    /// Whether it is a PID controller of the position: its integral sees the position error alone, and
    /// there is one loop.
    pub is_pid: bool,
}

/// How the drive gets to see motor and load.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sensing {
    /// Time by which each sensor is late, in cycles.
    pub load_delay: f64,
    pub motor_delay: f64,
    /// Whether the motor's angle is what the load's sensor shows.
    pub motor_from_load: bool,
    /// Whether the load's position is what the motor's sensor shows.
    pub load_from_motor: bool,
    /// Whether the speed is the difference of angles.
    pub by_differences: bool,
    /// Step of the angle that the speed is derived from, rad; 0 for none.
    pub step: f64,
}

impl Sensing {
    /// Of responses that hold what sensors do already.
    pub const AS_SHOWN: Self = Self {
        load_delay: 0.0,
        motor_delay: 0.0,
        motor_from_load: false,
        load_from_motor: false,
        by_differences: false,
        step: 0.0,
    };

    fn of(axis: &Axis) -> Self {
        let cycles = |seconds: f64| seconds / axis.period;
        let load = match &axis.sensors.load {
            LoadSensor::Fitted(sensor) => Some(sensor),
            _ => None,
        };
        let motor = axis.sensors.motor.as_ref();
        let motor_from_load =
            motor.is_none() && load.is_some() && !axis.mechanism.has_motor_encoder();
        let step = match (motor, load) {
            (Some(sensor), _) => sensor.resolution(),
            (None, Some(sensor)) if motor_from_load => {
                sensor.resolution() / axis.travel_per_radian()
            }
            _ => 0.0,
        };
        Self {
            load_delay: load.map_or(0.0, |sensor| cycles(sensor.delay())),
            motor_delay: motor.map_or(0.0, |sensor| cycles(sensor.delay())),
            motor_from_load,
            load_from_motor: matches!(axis.sensors.load, LoadSensor::Missing),
            by_differences: axis.derives_speed(),
            step,
        }
    }
}

impl Sensing {
    /// Of a controller that derives the speed from the position that it controls.
    fn derive_speed_from_position(&mut self, axis: &Axis) {
        self.by_differences = true;
        self.motor_from_load = !self.load_from_motor;
        if let LoadSensor::Fitted(sensor) = &axis.sensors.load {
            self.step = sensor.resolution() / axis.travel_per_radian();
        }
    }
}

impl LoopModel {
    pub fn new(axis: &Axis) -> Result<Self, LoopError> {
        let mut model = axis.drive_model()?;
        let mut sensing = Sensing::of(axis);
        let pid = axis.control.pid(model.travel, axis.period);
        let is_pid = pid.is_some();
        if let Some(pid) = pid {
            model.cascade = pid;
            sensing.derive_speed_from_position(axis);
        }
        if model.cascade.position <= 0.0 || model.cascade.speed <= 0.0 {
            return Err(LoopError::Control {
                kind: axis.control.kind().name,
            });
        }
        Ok(Self {
            integrates: model.cascade.speed_integral > 0.0,
            model,
            sensing,
            is_pid,
        })
    }

    /// Whether the speed controller has an integral.
    pub fn integrates(&self) -> bool {
        self.integrates
    }

    pub fn cascade(&self) -> &Cascade {
        &self.model.cascade
    }

    pub fn signal_path(&self) -> &SignalPath {
        &self.model.cascade.signal_path
    }

    pub fn period(&self) -> f64 {
        self.model.period
    }

    /// Its drive in one corner; `modes` are those with the load there.
    pub fn drive(&self, modes: &[Mode], at: &Corner) -> SampledDrive {
        let situation = DriveSituation {
            sticking: if at.stuck { 1.0 } else { 0.0 },
            mass: at.mass,
            friction: at.friction,
            bristles: 1.0,
            sliding: 0.0,
        };
        let used = &modes[..modes.len().min(MODES)];
        SampledDrive::new(&self.model, used, false, &situation)
    }
}

/// Natural modes with the load at a position.
pub(crate) fn modes_at(axis: &Axis, position: f64) -> Result<Vec<Mode>, LoopError> {
    let mechanism = axis.planned_mechanism()?;
    mechanism
        .participation(position)
        .map_err(|error| LoopError::Position { position, error })
}

/// Responses of the drive at one frequency, SI: to the command, and to a force against the load.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PlantAt {
    /// Angular frequency, rad/s.
    pub frequency: f64,
    /// Motor's angle (rad), its speed, and the load's position to a unit of the command.
    pub command: [Number; 3],
    /// The same to a unit of force.
    pub force: [Number; 3],
}

/// The drive's frequency response.
pub(crate) struct PlantResponse {
    response: SampledResponse,
    period: f64,
    travel: f64,
}

impl PlantResponse {
    pub fn new(drive: &SampledDrive, model: &DriveModel) -> Self {
        let (limit, period) = (model.effort_limit, model.period);
        let n = drive.size() - 1;
        let a = drive.a.view((0, 0), (n, n)).into_owned();
        // The force's column is in units of its own.
        let force = drive.a.view((0, n), (n, 1)) / drive.units[n];
        let mut b = DMatrix::zeros(n, 2);
        b.set_column(0, &(drive.b.rows(0, n) / limit));
        b.set_column(1, &DVector::from_iterator(n, force.iter().copied()));
        let row = |row: &RowDVector<f64>| row.columns(0, n).into_owned();
        let c = DMatrix::from_rows(&[row(&drive.motor), row(&drive.motor_speed), row(&drive.load)]);
        Self {
            response: SampledResponse::new(a, &b, &c, DMatrix::zeros(3, 2)),
            period,
            travel: model.travel,
        }
    }

    /// Travel of the load per radian of the motor.
    pub fn travel(&self) -> f64 {
        self.travel
    }

    /// At an angular frequency, rad/s; none at a pole.
    pub fn at(&self, frequency: f64) -> Option<PlantAt> {
        let angle = frequency * self.period;
        let z = Number::from_polar(1.0, angle);
        let all = self.response.at(z)?;
        // A sine of force is not held over a period; the model's is.
        let j = Number::new(0.0, 1.0);
        let held = (Number::new(1.0, 0.0) - z.inv()) / (j * angle);
        let column = |j: usize| [all[(0, j)], all[(1, j)], all[(2, j)]];
        Some(PlantAt {
            frequency,
            command: column(0),
            force: column(1).map(|value| value / held),
        })
    }
}
