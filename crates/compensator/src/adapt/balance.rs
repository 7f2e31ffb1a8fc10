//! The two balances along a record, and how they change with the parameters.
//!
//! ```text
//! e₁ = T − (J − J_w) θ̈ − J_w a/r − e'(θ) F − r load(x) − r (m a + T_f/lever + F₀)    N·m
//! e₂ = θ − x/r − c − b sat(T_t) − C T_t                                    rad
//! ```
//!
//! F is the force of the transmission, e the error of its kinematics, F₀ a constant load, T_t = T − (J − J_w) θ̈ the torque through the transmission, c the
//! angle between the two scales, b half the free travel.

use std::vec::Vec;

use libm::exp;
use lugre::LuGre;
use nalgebra::SVector;

use super::assumed::AssumedModel;
use super::coordinates::{GAP, HELD, OFFSET};
use super::parameter::{AdaptParameter, COUNT, Theta};
use super::record::Record;
use crate::Kinematics;

/// Change of a parameter by which sensitivities are found.
const STEP: f64 = 0.01;

/// Residuals of one balance, and for each coordinate in it the change of what is predicted.
#[derive(Clone, Debug, Default)]
pub(super) struct Balance {
    pub values: Vec<f64>,
    pub columns: Vec<(usize, Vec<f64>)>,
    /// RMS of what is balanced.
    pub scale: f64,
}

/// The first: torques.
pub(super) fn torque<const N: usize>(
    assumed: &AssumedModel,
    record: &Record,
    at: &SVector<f64, N>,
    free: &[usize],
) -> Balance {
    let theta: Theta = std::array::from_fn(|i| at[i]);
    let (model, points) = (&assumed.model, &record.points);
    let travel = model.travel;
    let friction = |theta: &Theta, share: f64| {
        let held = held(assumed, record, theta, share);
        forces(&assumed.friction(theta), record, held)
    };
    let own = friction(&theta, at[HELD]);
    let mass = model.load_inertia * exp(theta[AdaptParameter::LoadInertia.index()]);
    let standing = assumed.standing_load(&theta);
    let pairs = points.iter().zip(&own);
    let values = pairs.map(|(p, friction)| {
        p.left - travel * (mass * p.acceleration + friction / model.lever + standing)
    });
    let central = |more: Vec<f64>, less: Vec<f64>| -> Vec<f64> {
        let by = travel / (2.0 * STEP * model.lever);
        let pairs = more.into_iter().zip(less);
        pairs.map(|(more, less)| by * (more - less)).collect()
    };
    let by_parameter = |i: usize| {
        let off = |by: f64| {
            let mut off = theta;
            off[i] += by;
            friction(&off, at[HELD])
        };
        central(off(STEP), off(-STEP))
    };
    let column = |i: usize| match AdaptParameter::ALL.get(i) {
        Some(AdaptParameter::Compliance) => None,
        Some(AdaptParameter::LoadInertia) => {
            let inertia = points.iter().map(|p| travel * mass * p.acceleration);
            Some(inertia.collect())
        }
        Some(AdaptParameter::StandingLoad) => {
            // It acts, and changes what friction holds at the start.
            let direct = travel * assumed.value(AdaptParameter::StandingLoad);
            let by_start = by_parameter(i);
            Some(by_start.iter().map(|by| by + direct).collect())
        }
        Some(_) => Some(by_parameter(i)),
        None if i == HELD => Some(central(
            friction(&theta, at[HELD] + STEP),
            friction(&theta, at[HELD] - STEP),
        )),
        None => None,
    };
    Balance {
        values: values.collect(),
        columns: free.iter().filter_map(|&i| Some((i, column(i)?))).collect(),
        scale: record.torque,
    }
}

/// The second: wind-up, where the load is seen.
pub(super) fn wind_up<const N: usize>(
    assumed: &AssumedModel,
    record: &Record,
    at: &SVector<f64, N>,
    free: &[usize],
) -> Balance {
    if !record.sees_load {
        return Balance::default();
    }
    let compliance = AdaptParameter::Compliance.index();
    let factor = exp(at[compliance]);
    let level = assumed.model.travel * assumed.value(AdaptParameter::StandingLoad);
    let points = record.points.iter();
    // Side of a free travel of 2: 1 is half of it.
    let two = Kinematics {
        free_travel: 2.0,
        ..Kinematics::default()
    };
    let side = points
        .clone()
        .map(|p| two.side(p.transmitted / level.max(1e-12)));
    let wound = points
        .clone()
        .map(|p| factor * p.compliance * p.transmitted);
    let values = points.zip(side.clone().zip(wound.clone()));
    let values = values.map(|(p, (side, wound))| p.lead - at[OFFSET] - at[GAP] * side - wound);
    let squares: f64 = wound.clone().map(|w| w * w).sum();
    let mut columns = Vec::from([
        (compliance, wound.collect()),
        (OFFSET, std::vec![1.0; record.points.len()]),
        (GAP, side.collect()),
    ]);
    columns.retain(|(i, _)| free.contains(i));
    Balance {
        values: values.collect(),
        columns,
        scale: (squares / record.points.len() as f64).sqrt(),
    }
}

/// The bristles' force at the start: what the torque there leaves to friction, and `share`
/// of the break-away level more.
fn held(assumed: &AssumedModel, record: &Record, theta: &Theta, share: f64) -> f64 {
    let most = assumed.model.friction.parameters().stiction;
    let left = record.held - assumed.model.lever * assumed.standing_load(theta);
    left.clamp(-most, most) + share * most
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
    let points = record.points.iter();
    points
        .map(|p| record.kernel.of(0, &padded, p.sample))
        .collect()
}

// `COUNT` parameters come first, then the nuisances.
const _: () = assert!(HELD == COUNT && OFFSET == COUNT + 1 && GAP == COUNT + 2);
