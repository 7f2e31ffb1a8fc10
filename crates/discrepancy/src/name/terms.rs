//! Short laws outside the library: forces and displacements with one number, or with one and
//! a zero of their own.
//!
//! They say in a formula what a curve says in knots, and go on where a curve ends. They are
//! empirical: as an effect, one is only tried beside others, never named.

use axis_sim::effects::{
    ActiveEffect, Changes, Effect, EffectChannel, EffectParameter, EffectVariable, Measure, Nature,
    TableState,
};
use axis_sim::{Probe, SetupError};

use super::curves::{Course, Factor, Over, Place, STANDS, Variable, depends_on};

/// Of time (s), place (m), speed (m/s) and direction (−1 to 1).
type Value = fn(f64, f64, f64, f64) -> f64;

/// A term: its words and its course. `x` counts from the middle of the motion.
pub struct Term {
    /// On what it depends.
    pub over: Over,
    /// Its formula.
    pub words: &'static str,
    /// Unit of its number.
    pub unit: &'static str,
    value: Value,
    /// What it is taken with: a zero of its own, say.
    pub beside: Option<Beside>,
}

/// What a term is taken with.
pub struct Beside {
    /// Its formula; empty for a constant.
    pub words: &'static str,
    /// Unit of its number.
    pub unit: &'static str,
    value: Value,
}

const SPEED: Over = (Variable::Speed, Factor::One);
const POSITION: Over = (Variable::Position, Factor::One);
const POSITION_BY_SPEED: Over = (Variable::Position, Factor::Speed);
const POSITION_BY_DIRECTION: Over = (Variable::Position, Factor::Direction);
const TIME: Over = (Variable::Time, Factor::One);
const TIME_BY_DIRECTION: Over = (Variable::Time, Factor::Direction);

/// Forces on the load, against positive motion.
static FORCES: [Term; 12] = [
    term_of(SPEED, "√|v|·sign v", "N·(s/m)^½", |_, _, v, s| {
        v.abs().sqrt() * s
    }),
    term_of(SPEED, "|v|·v", "N·s²/m²", |_, _, v, _| v * v.abs()),
    term_of(SPEED, "v³", "N·s³/m³", |_, _, v, _| v.powi(3)),
    with(
        POSITION_BY_SPEED,
        "x·v",
        "N·s/m²",
        |_, x, v, _| x * v,
        ("v", "N·s/m", |_, _, v, _| v),
    ),
    with(
        POSITION_BY_DIRECTION,
        "x·sign v",
        "N/m",
        |_, x, _, s| x * s,
        ("sign v", "N", |_, _, _, s| s),
    ),
    with(
        POSITION,
        "x",
        "N/m",
        |_, x, _, _| x,
        ("", "N", |_, _, _, _| 1.0),
    ),
    with(
        POSITION,
        "x²",
        "N/m²",
        |_, x, _, _| x * x,
        ("", "N", |_, _, _, _| 1.0),
    ),
    term_of(
        TIME_BY_DIRECTION,
        "exp(−t / 1 s)·sign v",
        "N",
        |t, _, _, s| (-t).exp() * s,
    ),
    term_of(
        TIME_BY_DIRECTION,
        "exp(−t / 3 s)·sign v",
        "N",
        |t, _, _, s| (-t / 3.0).exp() * s,
    ),
    term_of(
        TIME_BY_DIRECTION,
        "exp(−t / 10 s)·sign v",
        "N",
        |t, _, _, s| (-t / 10.0).exp() * s,
    ),
    with(
        TIME_BY_DIRECTION,
        "t·sign v",
        "N/s",
        |t, _, _, s| t * s,
        ("sign v", "N", |_, _, _, s| s),
    ),
    with(
        TIME,
        "t",
        "N/s",
        |t, _, _, _| t,
        ("", "N", |_, _, _, _| 1.0),
    ),
];

/// Displacements of the load on its transmission.
static OFFSETS: [Term; 4] = [
    term_of(POSITION, "x²", "1/m", |_, x, _, _| x * x),
    term_of(POSITION, "x³", "1/m²", |_, x, _, _| x.powi(3)),
    term_of(TIME, "t·x", "1/s", |t, x, _, _| t * x),
    term_of(SPEED, "v", "s", |_, _, v, _| v),
];

const fn term_of(over: Over, words: &'static str, unit: &'static str, value: Value) -> Term {
    Term {
        over,
        words,
        unit,
        value,
        beside: None,
    }
}

const fn with(
    over: Over,
    words: &'static str,
    unit: &'static str,
    law: Value,
    (beside, beside_unit, value): (&'static str, &'static str, Value),
) -> Term {
    Term {
        beside: Some(Beside {
            words: beside,
            unit: beside_unit,
            value,
        }),
        ..term_of(over, words, unit, law)
    }
}

/// The terms of a place.
pub fn terms(place: Place) -> &'static [Term] {
    match place {
        Place::Force => &FORCES,
        Place::Offset => &OFFSETS,
    }
}

/// The middle of the way that these motions cover, from which a term's `x` counts.
pub fn middle(courses: &[Course]) -> f64 {
    let positions = courses.iter().flat_map(|c| &c.position);
    let (low, high) = positions.fold((f64::MAX, f64::MIN), |(a, b), &x| (a.min(x), b.max(x)));
    f64::midpoint(low, high)
}

impl Term {
    /// On what it depends, in words.
    pub fn depends_on(&self) -> String {
        depends_on(self.over)
    }

    /// Its law and that of what it is taken with.
    fn values(&self) -> impl Iterator<Item = Value> + use<> {
        let beside = self.beside.as_ref().map(|beside| beside.value);
        [Some(self.value), beside].into_iter().flatten()
    }

    /// Its course on these motions, and that of what it is taken with: one series a log, each.
    pub fn series(&self, courses: &[Course], middle: f64) -> Vec<Vec<Vec<f64>>> {
        let one = |value: Value| {
            let of = |c: &Course| {
                let at = |k: usize| at(value, c.time[k], c.position[k] - middle, c.speed[k]);
                (0..c.time.len()).map(at).collect()
            };
            courses.iter().map(of).collect()
        };
        self.values().map(one).collect()
    }

    /// Disturbances of these motions by it with these factors, of the term and of what it is
    /// taken with.
    pub fn probes(
        &self,
        place: Place,
        factors: &[f64],
        courses: &[Course],
        middle: f64,
    ) -> Vec<Probe> {
        let all = self.series(courses, middle);
        let of_log = |l: usize| {
            let mut sum = vec![0.0; courses[l].time.len()];
            for (series, by) in all.iter().zip(factors) {
                sum.iter_mut()
                    .zip(&series[l])
                    .for_each(|(s, v)| *s += by * v);
            }
            place.probe(sum)
        };
        (0..courses.len()).map(of_log).collect()
    }
}

fn at(value: Value, time: f64, x: f64, speed: f64) -> f64 {
    value(time, x, speed, (speed / STANDS).tanh())
}

const HELD: EffectParameter = EffectParameter {
    name: "given",
    measure: Measure::Ratio,
    nature: Nature::Held,
    typical: 0.0,
    bounds: [f64::MIN, f64::MAX],
};

/// The most of a term on the fitted motions.
const FORCE: EffectParameter = EffectParameter {
    name: "force",
    measure: Measure::Force,
    nature: Nature::Size { either_sign: true },
    typical: 60.0,
    bounds: [-1e5, 1e5],
};

/// A force of [`FORCES`]: its place there and the middle of the motion; of the law the most on
/// the fitted motions, and the force that it is then.
static ALONE: Effect = Effect {
    name: "short-term",
    summary: "a force by a short law that is not in the library",
    channel: EffectChannel::Torque,
    depends_on: "one variable of the motion",
    shown_over: EffectVariable::Time,
    parameters: &[HELD, HELD, HELD, FORCE],
    needs: &[],
    install,
};

/// The same, and what it is taken with.
static BESIDE: Effect = Effect {
    parameters: &[HELD, HELD, HELD, FORCE, HELD, FORCE],
    ..ALONE
};

/// Values before those of the law, and of each law.
const FIRST: usize = 2;
const EACH: usize = 2;

impl Term {
    /// It as an effect, of no size, that a fit may move; `None` of a displacement, and of what
    /// these motions do not show.
    pub fn as_effect(&self, courses: &[Course]) -> Option<ActiveEffect> {
        let place = FORCES.iter().position(|term| std::ptr::eq(term, self))?;
        let middle = middle(courses);
        let mut values = vec![place as f64, middle];
        for series in self.series(courses, middle) {
            let all = series.iter().flatten();
            let most = all.fold(0.0_f64, |most, v| most.max(v.abs()));
            if most == 0.0 {
                return None;
            }
            values.extend([most, 0.0]);
        }
        let effect = if self.beside.is_some() {
            &BESIDE
        } else {
            &ALONE
        };
        Some(ActiveEffect { effect, values })
    }

    /// The same with these factors, of the term and of what it is taken with.
    pub fn sized(mut active: ActiveEffect, factors: &[f64]) -> ActiveEffect {
        let laws = active.values[FIRST..].chunks_exact_mut(EACH);
        laws.zip(factors)
            .for_each(|(of, factor)| of[1] = factor * of[0]);
        active
    }

    /// Its own factor of such an effect, and by how much that changes with the size.
    pub fn factor(active: &ActiveEffect) -> [f64; 2] {
        let [most, size] = [active.values[FIRST], active.values[FIRST + 1]];
        [size / most, 1.0 / most]
    }

    /// The factor of what it is taken with; `None` if it is taken alone.
    pub fn factor_beside(active: &ActiveEffect) -> Option<f64> {
        let beside = active.values.get(FIRST + EACH..)?;
        Some(beside.get(1)? / beside[0])
    }
}

fn install(values: &[f64], to: &mut Changes<'_>) -> Result<(), SetupError> {
    let &[place, middle, ref each @ ..] = values else {
        return Ok(());
    };
    let term = FORCES.get(place as usize);
    let laws = term.into_iter().flat_map(Term::values);
    let sizes = each.chunks_exact(EACH).map(|of| of[1] / of[0]);
    let parts: Vec<(Value, f64)> = laws.zip(sizes).collect();
    // What has a direction comes on through the bristle, as the library's dry friction does.
    to.load(move |t: &TableState| {
        let of =
            |(law, by): &(Value, f64)| by * law(t.time, t.position - middle, t.speed, t.bristle);
        t.loaded * parts.iter().map(of).sum::<f64>()
    });
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{Course, OFFSETS, Place, Term, terms};

    fn course() -> Course {
        let time: Vec<f64> = (0..100).map(f64::from).collect();
        Course {
            position: time.clone(),
            speed: time.iter().map(|t| 0.1 * (0.3 * t).sin()).collect(),
            angle: Vec::new(),
            acceleration: Vec::new(),
            effort: Vec::new(),
            time,
        }
    }

    /// The factor that goes in is the one that comes out; a displacement of the same formula is no
    /// force.
    #[test]
    fn forces_are_effects_in_their_own_unit_and_displacements_are_none() {
        let motions = [course()];
        for term in terms(Place::Force) {
            let active = term.as_effect(&motions).unwrap();
            let sized = Term::sized(active, &[2.5, 1.5]);
            let [factor, per_newton] = Term::factor(&sized);
            assert!((factor - 2.5).abs() < 1e-12, "{}", term.words);
            let beside = Term::factor_beside(&sized);
            assert_eq!(beside.is_some(), term.beside.is_some(), "{}", term.words);
            assert!(beside.is_none_or(|beside| (beside - 1.5).abs() < 1e-12));
            let series = term.series(&motions, super::middle(&motions));
            let most = series[0][0].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
            assert!((per_newton * most - 1.0).abs() < 1e-12, "{}", term.words);
        }
        assert!(
            OFFSETS
                .iter()
                .all(|term| term.as_effect(&motions).is_none())
        );
    }

    /// A jump at rest, or an onset of another length than the bristle's, would be a second law beside
    /// the one that is said.
    #[test]
    fn what_has_a_direction_comes_on_with_the_bristle() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
        let axis = axis_sim::Axis::read(file.as_ref()).unwrap();
        let root = &terms(Place::Force)[0];
        let active = Term::sized(root.as_effect(&[course()]).unwrap(), &[200.0]);
        let forces = axis.effect_forces(&[active]).unwrap();
        let travel = axis.travel_per_radian();
        for (speed, share) in [(1e-5, 0.1), (0.04, 1.0), (-0.04, -1.0), (-1e-5, 0.0)] {
            let [_, force] = forces.at(0.0, speed / travel, 0.7, share);
            let expected = 200.0 * f64::abs(speed).sqrt() * share;
            assert!((force - expected).abs() < 1e-9, "{speed}: {force}");
        }
    }
}
