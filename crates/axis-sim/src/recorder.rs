//! Cycles to a log with named channels.

use axis_log::{Channel, Log, LogError};

use crate::Cycle;

/// Collects the cycles of a run.
#[derive(Clone, Debug, Default)]
pub struct Recorder {
    cycles: Vec<Cycle>,
}

type Column = (&'static str, &'static str, fn(&Cycle) -> f64);

/// Name, unit and meaning of each channel. Names end in their unit.
const COLUMNS: [Column; 15] = [
    ("t_s", "s", |c| c.time),
    ("position_ref_m", "m", |c| c.reference.position),
    ("velocity_ref_m_s", "m/s", |c| c.reference.velocity),
    ("acceleration_ref_m_s2", "m/s²", |c| {
        c.reference.acceleration
    }),
    ("position_m", "m", |c| c.measured.position),
    ("motor_angle_rad", "rad", |c| c.measured.motor_angle),
    ("motor_speed_rad_s", "rad/s", |c| c.measured.motor_speed),
    ("speed_ref_rad_s", "rad/s", |c| c.command.speed_ref),
    ("iq_ref_a", "A", |c| c.command.iq_ref),
    ("iq_a", "A", |c| c.measured.current.q),
    ("id_a", "A", |c| c.measured.current.d),
    ("ud_v", "V", |c| c.command.voltage.d),
    ("uq_v", "V", |c| c.command.voltage.q),
    ("correction_m", "m", |c| c.correction.position),
    ("iq_feedforward_a", "A", |c| c.correction.iq),
];

impl Recorder {
    /// Adds a cycle; pass this to [`crate::ClosedLoop::run`].
    pub fn push(&mut self, cycle: &Cycle) {
        self.cycles.push(*cycle);
    }

    /// The cycles so far.
    pub fn cycles(&self) -> &[Cycle] {
        &self.cycles
    }

    /// The log: one channel a signal, one sample a cycle.
    ///
    /// # Errors
    /// [`LogError`] where there is no cycle, or one that is not finite.
    pub fn log(&self) -> Result<Log, LogError> {
        let channel = |(name, unit, value): &Column| Channel {
            name: (*name).to_owned(),
            unit: (*unit).to_owned(),
            samples: self.cycles.iter().map(value).collect(),
        };
        Log::new(COLUMNS.iter().map(channel).collect())
    }
}
