//! Residuals of the two balances along a record, and how they change with the parameters.
//!
//! ```text
//! e₁ = T − (J − J_w) θ̈ − J_w a/r − r load(x) − r (m a + T_f/lever + F₀)    N·m
//! e₂ = θ − x/r − c − b sat(T_t) − C T_t                                    rad
//! ```
//!
//! T_t = T − (J − J_w) θ̈ is the torque through the transmission.

use std::vec::Vec;

use libm::{exp, tanh};
use lugre::LuGre;
use nalgebra::{SMatrix, SVector};

use super::belief::Belief;
use super::parameter::{AdaptParameter, COUNT, Theta};
use super::record::Record;
use super::weight::weights;

/// Unknowns of a record that no model keeps: the force that its bristles begin with, the
/// angle between the two scales, and half the free travel at the motor.
pub(super) const NUISANCES: usize = 3;
/// The last of them.
pub(super) const GAP: usize = COUNT + 2;
/// Change of a parameter by which sensitivities are found.
const STEP: f64 = 0.01;
/// Share of the break-away level by which the force held at the start is uncertain.
const HELD: f64 = 0.1;

/// Deviation of half the free travel, in wind-ups by the Coulomb level.
const FREE: f64 = 0.2;
/// A residual below this share of the whole is not believed.
const FINEST: f64 = 1e-4;

/// Weight of each value of the two balances.
pub(super) type Weights = [Vec<f64>; 2];

/// Residuals and their rates of change.
#[derive(Clone)]
pub(super) struct Residuals {
    values: [Vec<f64>; 2],
    /// Of each channel, the coordinate and the change of the prediction with it.
    columns: [Vec<(usize, Vec<f64>)>; 2],
    scale: f64,
}

impl Residuals {
    /// At parameters and nuisances.
    pub fn at<const N: usize>(
        belief: &Belief,
        record: &Record,
        at: &SVector<f64, N>,
        free: &[usize],
    ) -> Self {
        let theta: Theta = std::array::from_fn(|i| at[i]);
        let [held, offset, gap] = [0, 1, 2].map(|i| at[COUNT + i]);
        let (model, points) = (&belief.model, &record.points);
        let travel = model.travel;
        let friction = |theta: &Theta, held: f64| {
            forces(
                &belief.friction(theta),
                record,
                belief.held(record, theta, held),
            )
        };
        let own = friction(&theta, held);
        let mass = model.load_inertia * exp(theta[AdaptParameter::LoadInertia.index()]);
        let standing = belief.standing_load(&theta);
        let torque =
            |i: usize| travel * (mass * points[i].acceleration + own[i] / model.lever + standing);
        let count = points.len();
        let balance = (0..count).map(|i| points[i].left - torque(i)).collect();
        let central = |more: Vec<f64>, less: Vec<f64>| -> Vec<f64> {
            let pairs = more.into_iter().zip(less);
            let by = travel / (2.0 * STEP * model.lever);
            pairs.map(|(more, less)| by * (more - less)).collect()
        };
        let off = |i: usize, by: f64| {
            let mut off = theta;
            off[i] += by;
            off
        };
        let mut columns = [Vec::new(), Vec::new()];
        for &i in free {
            let column = match AdaptParameter::ALL.get(i) {
                Some(AdaptParameter::Compliance) => continue,
                Some(AdaptParameter::LoadInertia) => {
                    let inertia = points.iter().map(|p| travel * mass * p.acceleration);
                    inertia.collect()
                }
                Some(AdaptParameter::StandingLoad) => {
                    let direct = travel * belief.value(AdaptParameter::StandingLoad);
                    let by_start = central(
                        friction(&off(i, STEP), held),
                        friction(&off(i, -STEP), held),
                    );
                    by_start.iter().map(|by| by + direct).collect()
                }
                Some(_) => central(
                    friction(&off(i, STEP), held),
                    friction(&off(i, -STEP), held),
                ),
                None if i == COUNT => {
                    central(friction(&theta, held + STEP), friction(&theta, held - STEP))
                }
                None => continue,
            };
            columns[0].push((i, column));
        }

        let mut lead = Vec::new();
        let mut scale = 0.0;
        if record.sees_load {
            let factor = exp(theta[AdaptParameter::Compliance.index()]);
            let level = travel * belief.value(AdaptParameter::StandingLoad);
            let side = |i: usize| tanh(10.0 * points[i].transmitted / level.max(1e-12));
            let wound = |i: usize| factor * points[i].compliance * points[i].transmitted;
            lead = (0..count)
                .map(|i| points[i].lead - offset - gap * side(i) - wound(i))
                .collect();
            columns[1] = vec![
                (
                    AdaptParameter::Compliance.index(),
                    (0..count).map(wound).collect(),
                ),
                (COUNT + 1, vec![1.0; count]),
                (GAP, (0..count).map(side).collect()),
            ];
            columns[1].retain(|(i, _)| free.contains(i));
            scale =
                (0..count).map(|i| wound(i).powi(2)).sum::<f64>().sqrt() / (count as f64).sqrt();
        }
        Self {
            values: [balance, lead],
            columns,
            scale,
        }
    }

    /// Whether a record has this nuisance.
    pub fn has_nuisance(belief: &Belief, record: &Record, nuisance: usize) -> bool {
        let friction = belief.model.friction.parameters().coulomb > 0.0;
        match nuisance {
            0 => friction,
            1 => record.sees_load,
            _ => record.sees_load && friction,
        }
    }

    /// Deviation of a nuisance, in its unit.
    pub fn nuisance_deviation(belief: &Belief, record: &Record, nuisance: usize) -> f64 {
        let level = belief.model.travel * belief.value(AdaptParameter::StandingLoad);
        let wound = belief.value(AdaptParameter::Compliance) * level;
        match nuisance {
            0 => HELD,
            // The two scales begin anywhere.
            1 => {
                1e3 * record
                    .points
                    .iter()
                    .fold(wound.max(1e-9), |a, p| a.max(p.lead.abs()))
            }
            _ => FREE * wound.max(1e-12),
        }
    }

    /// Σ w e² over both.
    pub fn square(&self, weights: &Weights) -> f64 {
        let of = |channel: usize| {
            let pairs = self.values[channel].iter().zip(&weights[channel]);
            pairs.map(|(e, w)| w * e * e).sum::<f64>()
        };
        of(0) + of(1)
    }

    /// RMS of the torque balance, N·m.
    pub fn rms(&self) -> f64 {
        self.weighed(&vec![1.0; self.values[0].len()])
    }

    /// The same by weights.
    pub fn weighed(&self, weights: &[f64]) -> f64 {
        let pairs = self.values[0].iter().zip(weights);
        let square: f64 = pairs.map(|(e, w)| w * e * e).sum();
        (square / weights.iter().sum::<f64>()).sqrt()
    }

    /// Weight of each value, `free` coordinates being fitted; see [`weights`].
    pub fn weights(&self, record: &Record, free: usize, even: bool) -> Weights {
        let floor = [record.torque, self.scale].map(|scale| FINEST * scale);
        [0, 1].map(|channel| weights(&self.values[channel], floor[channel], free, even))
    }

    /// Adds gradient and curvature of ½ Σ w e².
    pub fn add_to<const N: usize>(
        &self,
        weights: &Weights,
        gradient: &mut SVector<f64, N>,
        curvature: &mut SMatrix<f64, N, N>,
    ) {
        for channel in 0..2 {
            let (columns, values) = (&self.columns[channel], &self.values[channel]);
            for (i, a) in columns {
                let weighed: Vec<f64> = a
                    .iter()
                    .zip(&weights[channel])
                    .map(|(a, w)| a * w)
                    .collect();
                let dot = |b: &[f64]| weighed.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
                gradient[*i] -= dot(values);
                for (j, b) in columns {
                    curvature[(*i, *j)] += dot(b);
                }
            }
        }
    }
}

impl Belief {
    /// The bristles' force at the start: what the torque there leaves to friction, and
    /// `share` of the break-away level more.
    fn held(&self, record: &Record, theta: &Theta, share: f64) -> f64 {
        let most = self.model.friction.parameters().stiction;
        let left = record.held - self.model.lever * self.standing_load(theta);
        left.clamp(-most, most) + share * most
    }
}

/// Friction smoothed at each point, in its own coordinate, the bristles beginning with the
/// force `held`.
fn forces(law: &LuGre, record: &Record, held: f64) -> Vec<f64> {
    let limit = law.bristle_limit();
    let stiffness = law.parameters().stiffness;
    let mut z = match stiffness > 0.0 {
        true => (held / stiffness).clamp(-limit, limit),
        false => 0.0,
    };
    let mut before = record.speeds.first().copied().unwrap_or(0.0);
    let each = record.speeds.iter().map(|&speed| {
        let (next, force) = law.step_torque(z, before, speed, record.period);
        (z, before) = (next, speed);
        force
    });
    let series: Vec<f64> = each.collect();
    let padded = record.kernel.pad(&series, record.rest);
    let smooth = record
        .points
        .iter()
        .map(|p| record.kernel.of(0, &padded, p.sample));
    smooth.collect()
}
