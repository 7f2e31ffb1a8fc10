//! The machine between two samples: motor, drive and friction under a held voltage.

use feed_dynamics::{DriveError, NutErrors, Observation, Settled, TimeStepper};
use foc_pmsm::{Dq, Pmsm};
use lugre::LuGre;

use crate::Axis;
use crate::effects::{Hooks, ScrewState, TableState};
use crate::work::{MOST_SUBSTEPS, substeps_of};

/// The machine, for control cycles of one length.
#[derive(Clone, Debug)]
pub struct Plant<S> {
    stepper: S,
    motor: Pmsm,
    friction: LuGre,
    /// Unit element that friction effects act through.
    unit_friction: LuGre,
    hooks: Hooks,
    travel_per_radian: f64,
    substeps: u32,
}

/// The machine's inner state, which no controller sees.
#[derive(Clone, Debug)]
pub struct PlantState<D> {
    drive: D,
    /// Since the motion began, s.
    time: f64,
    /// Table position there, m.
    origin: f64,
    /// Bristle deflection z at the screw, rad.
    bristle: f64,
    /// Bristle deflection of the unit element, rad.
    unit_bristle: f64,
    /// Currents, A.
    pub(crate) current: Dq,
    /// What the drive shows.
    pub(crate) seen: Observation,
    /// Motor acceleration over the last step, rad/s².
    motor_acceleration: f64,
}

impl<D> PlantState<D> {
    /// Table position, m from the driven end.
    pub(crate) fn position(&self) -> f64 {
        self.origin + self.seen.displacement
    }

    /// Since the motion began, s.
    pub(crate) fn time(&self) -> f64 {
        self.time
    }
}

/// Number of equal steps, none longer than asked, that make up a control period.
pub(crate) fn substeps(axis: &Axis) -> u32 {
    let steps = substeps_of(axis.period, axis.simulation.step);
    steps.min(f64::from(MOST_SUBSTEPS)) as u32
}

impl<S: TimeStepper> Plant<S> {
    /// The plant of `axis` on a stepper whose step is the control period
    /// divided by [`substeps`].
    pub(crate) fn new(axis: &Axis, hooks: Hooks, stepper: S) -> Self {
        Self {
            unit_friction: unit_friction(&axis.friction),
            hooks,
            stepper,
            motor: axis.motor,
            friction: axis.friction,
            travel_per_radian: axis.travel_per_radian(),
            substeps: substeps(axis),
        }
    }

    pub(crate) fn hooks(&mut self) -> &mut Hooks {
        &mut self.hooks
    }

    /// Everything at rest and relaxed, the table at `x` (m).
    ///
    /// # Errors
    /// [`DriveError::OffScrew`].
    pub(crate) fn at_rest(&self, x: f64) -> Result<PlantState<S::State>, DriveError> {
        let drive = self.stepper.settled(x, &Settled::default())?;
        Ok(PlantState {
            seen: self.stepper.observe(&drive),
            drive,
            time: 0.0,
            origin: x,
            bristle: 0.0,
            unit_bristle: 0.0,
            current: Dq::ZERO,
            motor_acceleration: 0.0,
        })
    }

    /// Uniformly accelerated motion at the table speed `speed` (m/s) and
    /// `acceleration` (m/s²): deflections settled, bristles at their steady
    /// deflection, current as the torque balance asks.
    ///
    /// # Errors
    /// [`DriveError::OffScrew`]; [`DriveError::Parameter`] for a motion that is
    /// not finite.
    pub(crate) fn in_motion(
        &self,
        x: f64,
        speed: f64,
        acceleration: f64,
        torque: impl FnOnce(&Settled) -> f64,
    ) -> Result<PlantState<S::State>, DriveError> {
        let r = self.travel_per_radian;
        let bristle = self.friction.steady_bristle(speed / r);
        let own = self.friction.torque(bristle, speed / r) / r;
        let load = own
            + self.hooks.loads_at(&TableState {
                time: SETTLED,
                position: x,
                speed,
                bristle: if speed == 0.0 { 0.0 } else { speed.signum() },
                pressed: 1.0,
            });
        let motion = Settled {
            speed,
            acceleration,
            load,
        };
        let drive = self.stepper.settled(x, &motion)?;
        Ok(PlantState {
            seen: self.stepper.observe(&drive),
            drive,
            time: SETTLED,
            origin: x,
            bristle,
            unit_bristle: self.unit_friction.steady_bristle(speed / r),
            current: Dq {
                d: 0.0,
                q: self.motor.q_current(torque(&motion)),
            },
            motor_acceleration: acceleration / r,
        })
    }

    /// One control cycle with the voltage held. Where it carries the table over
    /// the screw's end, the nut stays at that end: a cycle is too short for more
    /// than some 10 µm, and the loop looks at the next sample where the table is.
    ///
    /// # Errors
    /// [`DriveError::LoadNotFound`] where no friction goes with the table's motion
    /// at the end of a step; [`DriveError::Parameter`] where an effect shifts the
    /// nut by no number. Time and what is seen are then those at its start.
    pub(crate) fn advance(
        &self,
        state: &mut PlantState<S::State>,
        voltage: Dq,
    ) -> Result<(), DriveError> {
        let h = self.stepper.step_length();
        let r = self.travel_per_radian;
        for _ in 0..self.substeps {
            // Currents, over the mean motor speed of the step.
            let start = state.seen;
            let mean_speed = start.motor_speed + 0.5 * h * state.motor_acceleration;
            let voltage = voltage + self.lost_voltage(state);
            state.current = self.motor.step(state.current, voltage, mean_speed, h);
            let time = state.time + h;
            let angle = start.motor_angle + h * mean_speed;
            let torque = self
                .hooks
                .torque_at(angle, self.motor.torque(state.current));

            // Mechanics; the friction follows the table's speed at the end of the step.
            let errors = self.nut_errors(state, time, angle)?;
            let (z0, w0) = (state.bristle, start.speed / r);
            let (u0, origin) = (state.unit_bristle, state.origin);
            let (mut z1, mut u1) = (z0, u0);
            let moving = &mut state.drive;
            let report = self.stepper.step_through(moving, torque, &errors, |table| {
                let w1 = table.speed / r;
                let (z, friction) = self.friction.step_torque(z0, w0, w1, h);
                z1 = z;
                let mut load = friction / r;
                if self.hooks.has_loads() {
                    u1 = self.unit_friction.step(u0, w0, w1, h);
                    load += self.hooks.loads_at(&TableState {
                        time,
                        position: origin + table.displacement,
                        speed: table.speed,
                        bristle: self.unit_friction.torque(u1, w1),
                        pressed: (time / STANDING_LOAD_RISE).min(1.0),
                    });
                }
                load
            });
            if !report.load.converged {
                return Err(DriveError::LoadNotFound {
                    rounds: report.load.rounds,
                    residual: report.load.residual,
                });
            }
            state.time = time;
            state.bristle = z1;
            state.unit_bristle = u1;
            state.seen = self.stepper.observe(&state.drive);
            state.motor_acceleration = (state.seen.motor_speed - start.motor_speed) / h;
        }
        Ok(())
    }

    /// Errors of the nut's kinematics at the end of a step.
    fn nut_errors(
        &self,
        state: &PlantState<S::State>,
        time: f64,
        angle: f64,
    ) -> Result<NutErrors, DriveError> {
        let [offset, offset_rate] = self.hooks.offset_at(&ScrewState {
            time,
            angle,
            rate: state.seen.motor_speed,
            position: state.position(),
            speed: state.seen.speed,
        });
        NutErrors::new(offset, offset_rate, self.hooks.gap)
    }

    /// What dead time takes from the voltage, in the rotor's frame: in each
    /// phase against its current, softened below [`DEAD_TIME_CURRENT`], where
    /// the current's ripple makes it cross zero in every period.
    fn lost_voltage(&self, state: &PlantState<S::State>) -> Dq {
        let lost = self.hooks.dead_time_voltage;
        if lost == 0.0 {
            return Dq::ZERO;
        }
        let at = self.motor.electrical_speed(state.seen.motor_angle);
        let phases = state.current.inverse_park(at).inverse_clarke();
        let soft = |i: f64| -lost * (i / DEAD_TIME_CURRENT).tanh();
        foc_pmsm::Phases {
            a: soft(phases.a),
            b: soft(phases.b),
            c: soft(phases.c),
        }
        .clarke()
        .park(at)
    }
}

/// Time over which a standing load comes up, s.
const STANDING_LOAD_RISE: f64 = 0.02;

/// A time at which everything that comes up has come up, s.
const SETTLED: f64 = 1.0;

/// Half the current ripple below which dead time counts less, A.
const DEAD_TIME_CURRENT: f64 = 0.05;

/// The law with its Coulomb level scaled to 1 N·m, without break-away,
/// bristle damping and viscous part: the same pre-sliding distance.
fn unit_friction(law: &LuGre) -> LuGre {
    let p = law.parameters();
    let unit = lugre::Parameters {
        coulomb: 1.0,
        stiction: 1.0,
        stribeck_speed: p.stribeck_speed,
        stiffness: if p.coulomb > 0.0 {
            p.stiffness / p.coulomb
        } else {
            p.stiffness
        },
        damping: 0.0,
        viscous: 0.0,
    };
    LuGre::new(unit).unwrap_or(*law)
}
