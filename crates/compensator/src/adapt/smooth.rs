//! Signals of a log through the Gaussian.

use std::vec::Vec;

use super::kernel::Kernel;
use crate::DriveModel;

/// The balance at one instant. Torques at the motor, N·m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// Sample that it is at.
    pub sample: usize,
    /// Torque that is left for inertia of the load, friction and constant load.
    pub left: f64,
    /// Acceleration of the load.
    pub acceleration: f64,
    /// Motor angle against that of the load, rad.
    pub lead: f64,
    /// Torque through the transmission.
    pub transmitted: f64,
    /// Torque that something besides the model took, in `left` no more.
    pub besides: f64,
    /// Compliance of the model there, rad/(N·m).
    pub compliance: f64,
}

/// Signals of a log, to be smoothed where they are asked for.
pub(super) struct Smooth<'a> {
    pub model: &'a DriveModel,
    pub balance: &'a Kernel,
    pub torques: Vec<f64>,
    /// What something besides the model took, at the motor and on the load; empty if there
    /// is no such thing.
    pub besides: [Vec<f64>; 2],
    pub angles: Vec<f64>,
}

impl Smooth<'_> {
    /// Position of a load that has no sensor: the motor's, with the known kinematic error, less
    /// the wind-up that the torque tells.
    pub fn load(&self, measured: &[f64], angle: &[f64]) -> Vec<f64> {
        let m = self.model;
        let wound = |k: usize| {
            let section = m.along.at(measured[k]);
            let of_motor = self.balance.of(2, &self.angles, k);
            let inertia = section.rotating - section.lagging;
            let torque = self.balance.of(0, &self.torques, k) - self.taken(0, k);
            section.compliance * (torque - inertia * of_motor)
        };
        let ahead = |k: usize| m.kinematics.ahead(angle[k]);
        let start = measured[0] - m.travel * (angle[0] - wound(0)) - ahead(0);
        let load = |k: usize| start + m.travel * (angle[k] - wound(k)) + ahead(k);
        (0..measured.len()).map(load).collect()
    }

    /// Torques less what the force of the transmission asks of the motor by an error of the kinematics, e'(θ) F, at the
    /// measured positions and angles. F changes less over the motor's turn than e' does: it is the smoothed one.
    pub fn without_reaction(&self, torques: &[f64], measured: &[f64], angle: &[f64]) -> Vec<f64> {
        let m = self.model;
        let left = |k: usize| {
            let section = m.along.at(measured[k]);
            let inertia = section.rotating - section.lagging;
            let transmitted = self.balance.of(0, &self.torques, k)
                - self.taken(0, k)
                - inertia * self.balance.of(2, &self.angles, k);
            torques[k] - m.kinematics.growth(angle[k]) * transmitted / m.travel
        };
        (0..torques.len()).map(left).collect()
    }

    /// The balance at a sample.
    pub fn point(&self, sample: usize, positions: &[f64], elastic: bool) -> Point {
        let (m, of) = (self.model, |which, of: &[f64]| {
            self.balance.of(which, of, sample)
        });
        let (x, acceleration) = (of(0, positions), of(2, positions));
        let section = m.along.at(x);
        let of_motor = match elastic {
            true => of(2, &self.angles),
            false => acceleration / m.travel,
        };
        let inertia = section.rotating - section.lagging;
        let besides = [0, 1].map(|at| self.taken(at, sample));
        let transmitted = of(0, &self.torques) - besides[0] - inertia * of_motor;
        let of_rotation = section.lagging * acceleration / m.travel;
        Point {
            sample,
            left: transmitted - besides[1] - of_rotation - m.travel * section.load,
            acceleration,
            lead: of(0, &self.angles) - x / m.travel,
            transmitted,
            compliance: section.compliance,
            besides: besides[0] + besides[1],
        }
    }

    /// Torque taken besides the model at a sample: at the motor (0) or on the load (1).
    fn taken(&self, at: usize, sample: usize) -> f64 {
        match self.besides[at].is_empty() {
            true => 0.0,
            false => self.balance.of(0, &self.besides[at], sample),
        }
    }
}
