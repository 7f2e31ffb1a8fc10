//! The axis' friction and what effects add to it, as one law.

use std::f64::consts::E;

use lugre::{LuGre, LugreError, Parameters};

use crate::axis::Axis;
use crate::effects::{Hooks, Measure, Scales, TableState};
use crate::plant::Start;

/// Places along the stroke over which friction is averaged.
const PLACES: u32 = 32;

/// Eighty times the greatest velocity of `stribeck-friction` on the reference machine, m/s: from there on
/// friction is a straight line over speed, to the last bit.
const FAST: f64 = 1.0;

/// Share of a friction below which its dry part is rounding.
const ROUNDING: f64 = 1e-12;

/// Halvings after which a speed is known to the last bit.
const HALVINGS: u32 = 64;

/// What the effects of an axis add to the friction of its load: the mean of both directions and
/// of the whole stroke, as at the start of a motion.
struct Added<'a> {
    hooks: &'a Hooks,
    stroke: [f64; 2],
}

impl Added<'_> {
    /// Force at a speed of the load ≥ 0 with the bristles deflected that way, N or N·m.
    fn at(&self, speed: f64) -> f64 {
        let [least, most] = self.stroke;
        let place = |i: u32| least + (most - least) * (f64::from(i) + 0.5) / f64::from(PLACES);
        let way = |position: f64, direction: f64| {
            let speed = direction * speed;
            let table = TableState {
                position,
                speed,
                bristle: direction,
                loaded: 1.0,
                ..TableState::default()
            };
            let start = Start {
                speed,
                friction: direction,
                ..Start::at(position)
            };
            let memories = self.hooks.memories();
            self.hooks.loads_at(&table) + memories.settled(&start).1
        };
        let both = |position: f64| 0.5 * (way(position, 1.0) - way(position, -1.0));
        (0..PLACES).map(|i| both(place(i))).sum::<f64>() / f64::from(PLACES)
    }
}

/// The friction of an axis whose effects are `hooks`: with what is dry, viscous or falls with speed
/// of what they add. The dry part has the axis' own pre-sliding distance, as in most effects (one
/// with a memory counts by its level). A fall with speed and the axis' own become one, which is at
/// 1/e of the whole at the speed at which both together are.
///
/// # Errors
/// [`LugreError`] if less than no friction is left.
pub(super) fn with_effects(axis: &Axis, hooks: &Hooks) -> Result<LuGre, LugreError> {
    let own = axis.friction.law;
    let added = Added {
        hooks,
        stroke: [axis.stroke.minimum, axis.stroke.maximum],
    };
    let fast = FAST * Scales::of(axis).ratio(Measure::Speed);
    let [at_fast, at_twice] = [added.at(fast), added.at(2.0 * fast)];
    let viscous = (at_twice - at_fast) / fast;
    let dry = match at_fast - viscous * fast {
        rest if rest.abs() <= ROUNDING * at_fast.abs() => 0.0,
        rest => rest,
    };
    let breakaway = added.at(0.0);
    if [viscous, dry, breakaway] == [0.0; 3] {
        return Ok(own);
    }
    // A force at the load, and its speed, in the law's coordinate.
    let lever = axis.friction.lever(axis.travel_per_radian());
    let p = own.parameters();
    let own_rise = p.stiction - p.coulomb;
    let added_rise = (breakaway - dry) * lever;
    let coulomb = p.coulomb + dry * lever;
    let rise = (own_rise + added_rise).max(0.0);
    let stribeck_speed = if added_rise == 0.0 || rise == 0.0 {
        p.stribeck_speed
    } else {
        let risen = |speed: f64| {
            let ratio = speed / p.stribeck_speed;
            let load = speed * lever;
            own_rise * (-ratio * ratio).exp() + lever * (added.at(load) - viscous * load - dry)
        };
        falls_to(rise / E, fast / lever, risen)
    };
    LuGre::new(Parameters {
        coulomb,
        stiction: coulomb + rise,
        stribeck_speed,
        stiffness: if dry == 0.0 {
            p.stiffness
        } else {
            coulomb * axis.friction.unit.parameters().stiffness
        },
        damping: p.damping,
        viscous: p.viscous + viscous * lever * lever,
    })
}

/// The speed up to `most` at which something that falls with speed has fallen to `level`.
fn falls_to(level: f64, most: f64, of: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, most);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if of(middle) > level {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}
