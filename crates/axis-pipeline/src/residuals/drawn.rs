//! Machines with cogging, local and asymmetric friction, drawn.

use std::f64::consts::TAU;

use axis_sim::Axis;
use axis_sim::effects::{ActiveEffect, Effect};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// How far a search may leave the numbers that it names: shares of sizes and widths, of the
/// width for places, rad for phases.
const NAMED_WITHIN: f64 = 0.2;

/// A machine with something in it that no parameter of the model holds.
#[derive(Clone, Debug)]
pub struct DrawnMachine {
    /// The machine.
    pub machine: Axis,
    /// What a search would have named: the same effects and orders, each other number off.
    pub named: Vec<ActiveEffect>,
}

/// Cogging of 3 to 12 % of the Coulomb level, 1 to 24 times a turn; dry friction that is 5 to
/// 15 % of it higher around a place within `room` (m or rad); and up to 8 % more or less of it
/// in either direction.
pub fn drawn_effects(axis: &Axis, room: [f64; 2], random: &mut ChaCha8Rng) -> Vec<ActiveEffect> {
    let travel = axis.travel_per_radian();
    let level = axis.friction.law.parameters().coulomb / axis.friction.lever(travel);
    let length = room[1] - room[0];
    let mut between = |least: f64, most: f64| random.random_range(least..most);
    let cogging = vec![
        travel * level * between(0.03, 0.12),
        between(1.0, 25.0).floor(),
        between(0.0, TAU),
    ];
    let local = vec![
        level * between(0.05, 0.15),
        between(room[0], room[1]),
        length * between(0.03, 0.15),
    ];
    let sides = vec![level * between(-0.08, 0.08), level * between(-0.08, 0.08)];
    let all = [
        ("cogging-torque", cogging),
        ("position-dependent-friction", local),
        ("asymmetric-friction", sides),
    ];
    let known = all.into_iter().filter_map(|(name, values)| {
        let effect = Effect::named(name)?;
        Some(ActiveEffect { effect, values })
    });
    known.collect()
}

/// `axis` with drawn effects, and what a search would name of them.
pub fn drawn_machine(axis: &Axis, room: [f64; 2], random: &mut ChaCha8Rng) -> DrawnMachine {
    let effects = drawn_effects(axis, room, random);
    let mut named = effects.clone();
    let mut off = || NAMED_WITHIN * random.random_range(-1.0..1.0);
    for active in &mut named {
        let v = &mut active.values;
        match active.effect.name {
            "cogging-torque" => {
                v[0] *= 1.0 + off();
                v[2] += off();
            }
            "position-dependent-friction" => {
                v[0] *= 1.0 + off();
                v[1] += v[2] * off();
                v[2] *= 1.0 + off();
            }
            _ => v.iter_mut().for_each(|size| *size *= 1.0 + off()),
        }
    }
    let mut machine = axis.clone();
    machine.effects.extend(effects);
    DrawnMachine { machine, named }
}
