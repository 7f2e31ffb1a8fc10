//! Friction over speed: the model's own law, the law with what was named, and the logs.

use axis_sim::effects::{ActiveEffect, FrictionForm, Measure};
use axis_sim::{Axis, Trace};

use super::cost::effort;
use crate::answers::Rest;
use crate::answers::{LogSet, State};

/// Steady friction of an axis over the speed of its load.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionCurve {
    /// SI unit of the speeds.
    pub speed_unit: String,
    /// SI unit of the forces, on the load and against its motion.
    pub force_unit: String,
    /// Speeds, rising, as far as the check motion goes to either side.
    pub speed: Vec<f64>,
    /// The model's own friction, known parameters as fitted.
    pub own: Vec<f64>,
    /// The same with the friction effects that were named.
    pub with: Vec<f64>,
    /// That in the form that was found; empty if none was.
    pub formed: Vec<f64>,
    /// Mean speeds of the check motion in bins, and the mean of what the drive gave against
    /// friction there: the law with all that was named, and the residual of the effort
    /// channel as a force. Empty if no channel shows what the drive gives.
    pub measured: [Vec<f64>; 2],
    /// Whether the law was found to differ at low speed, where a linear axis hides it.
    pub at_low_speed: bool,
}

/// Speeds of a curve to either side, and bins of the logs.
const SIDE: usize = 80;
const BINS: usize = 28;
/// Lowest speed shown over the highest.
const LOWEST: f64 = 1e-3;
/// Fewest samples of which a mean is shown.
const LEAST: usize = 20;

/// Steady force of an effect against motion at a speed of the load; `None` of one that is
/// no friction over the speed alone.
///
/// Levels follow the sign of the speed, as bristles do that slide; Stribeck's part is
/// F e^(−(v/v_s)²) (Armstrong-Hélouvry, Dupont and Canudas de Wit, Automatica 30 (1994)
/// 1083–1138, doi:10.1016/0005-1098(94)90209-7).
pub(super) fn steady(active: &ActiveEffect, speed: f64) -> Option<f64> {
    let sign = match speed {
        0.0 => 0.0,
        speed => speed.signum(),
    };
    let of_direction = |both: [f64; 2]| if speed > 0.0 { both[0] } else { both[1] };
    match (active.effect.name, active.values.as_slice()) {
        ("viscous-friction", &[coefficient]) => Some(coefficient * speed),
        ("coulomb-friction", &[force]) => Some(force * sign),
        ("asymmetric-friction", &[ahead, back]) => Some(of_direction([ahead, back]) * sign),
        ("asymmetric-viscous-friction", &[ahead, back]) => {
            Some(of_direction([ahead, back]) * speed)
        }
        ("stribeck-friction", &[force, velocity]) => {
            Some(force * (-(speed / velocity).powi(2)).exp() * sign)
        }
        _ => None,
    }
}

/// By how much a form changes the steady force of its friction.
fn formed(active: &ActiveEffect, speed: f64) -> Option<f64> {
    let form = FrictionForm::of(active)?;
    Some(steady(&form.base()?, speed)? * (form.at(speed.abs()) - 1.0))
}

/// Friction of the axis at a speed: own law with effects of the file, with effects of the
/// state, and in their forms.
fn at(machine: &Axis, state: &State, speed: f64) -> [f64; 3] {
    let lever = machine.friction.lever(machine.travel_per_radian());
    let own = machine.friction.law.steady_state(speed / lever) / lever;
    let of = |all: &[ActiveEffect], part: fn(&ActiveEffect, f64) -> Option<f64>| -> f64 {
        all.iter().filter_map(|active| part(active, speed)).sum()
    };
    let own = own + of(&machine.effects, steady);
    let with = own + of(&state.effects, steady);
    [own, with, with + of(&state.effects, formed)]
}

/// The law as found; `None` if no friction over speed was named.
pub(super) fn friction_law(
    machine: &Axis,
    set: &LogSet,
    state: &State,
    traces: &[Trace],
    rest: &Rest,
) -> Option<FrictionCurve> {
    let is_form = |active: &ActiveEffect| FrictionForm::of(active).is_some();
    let has_form = state.effects.iter().any(is_form);
    if !has_form && state.effects.iter().all(|a| steady(a, 1.0).is_none()) {
        return None;
    }
    let fitted = machine.with_known(&state.shares);
    let speeds = || traces.iter().flat_map(|trace| &trace.speed);
    let most = speeds().fold(0.0_f64, |most, v| most.max(v.abs()));
    if most == 0.0 {
        return None;
    }
    let speed = grid(most);
    let column = |part: usize| -> Vec<f64> {
        let one = |&v: &f64| at(&fitted, state, v)[part];
        speed.iter().map(one).collect()
    };
    let freedom = machine.freedom();
    let low = |a: &ActiveEffect| is_form(a) || a.effect.name == "stribeck-friction";
    Some(FrictionCurve {
        speed_unit: Measure::Speed.unit(freedom).to_owned(),
        force_unit: Measure::Force.unit(freedom).to_owned(),
        own: column(0),
        with: column(1),
        formed: if has_form { column(2) } else { Vec::new() },
        measured: measured(&fitted, set, state, traces, rest, most),
        at_low_speed: state.effects.iter().any(low),
        speed,
    })
}

/// Speeds to either side, in equal ratios.
fn grid(most: f64) -> Vec<f64> {
    let one = |k: usize| most * LOWEST.powf(1.0 - k as f64 / (SIDE - 1) as f64);
    let ahead = (0..SIDE).map(one);
    ahead.clone().rev().map(|v| -v).chain(ahead).collect()
}

/// Means over bins of speed, those of either side in equal ratios.
fn measured(
    machine: &Axis,
    set: &LogSet,
    state: &State,
    traces: &[Trace],
    rest: &Rest,
    most: f64,
) -> [Vec<f64>; 2] {
    let Some((channel, force)) = effort(machine, set) else {
        return Default::default();
    };
    let mut sums = [(0usize, 0.0, 0.0); 2 * BINS];
    for (trace, series) in traces.iter().zip(rest) {
        for (&v, left) in trace.speed.iter().zip(&series[channel]) {
            let share = 1.0 - (v.abs() / most).ln() / LOWEST.ln();
            if !(0.0..=1.0).contains(&share) {
                continue;
            }
            let bin = ((share * BINS as f64) as usize).min(BINS - 1);
            let place = if v < 0.0 { BINS - 1 - bin } else { BINS + bin };
            let (count, speeds, forces) = &mut sums[place];
            *count += 1;
            *speeds += v;
            *forces += at(machine, state, v)[2] + force * left;
        }
    }
    let kept = sums.iter().filter(|(count, ..)| *count >= LEAST);
    kept.map(|&(count, v, f)| (v / count as f64, f / count as f64))
        .unzip::<_, _, Vec<f64>, Vec<f64>>()
        .into()
}

#[cfg(test)]
mod tests {
    use axis_sim::effects::{ActiveEffect, Effect};

    use super::{LOWEST, SIDE, grid, steady};

    fn active(name: &str, values: &[f64]) -> ActiveEffect {
        ActiveEffect {
            effect: Effect::named(name).expect(name),
            values: values.to_vec(),
        }
    }

    #[test]
    fn friction_opposes_motion_and_stribecks_part_fades() {
        let at = |name: &str, values: &[f64], v: f64| steady(&active(name, values), v);
        assert_eq!(at("viscous-friction", &[4000.0], -0.1), Some(-400.0));
        assert_eq!(at("coulomb-friction", &[60.0], -0.1), Some(-60.0));
        assert_eq!(at("asymmetric-friction", &[60.0, 20.0], -0.1), Some(-20.0));
        assert_eq!(at("coulomb-friction", &[60.0], 0.0), Some(0.0));
        let stribeck = |v: f64| at("stribeck-friction", &[60.0, 0.02], v).expect("a friction");
        assert!((stribeck(1e-6) - 60.0).abs() < 1e-3);
        assert!((stribeck(0.02) - 60.0 / std::f64::consts::E).abs() < 1e-9);
        assert!(stribeck(0.2) < 1e-9);
        assert_eq!(at("backlash", &[4e-6], 0.1), None);
    }

    #[test]
    fn speeds_rise_and_are_the_same_to_either_side() {
        let all = grid(0.2);
        assert_eq!(all.len(), 2 * SIDE);
        assert!(all.windows(2).all(|w| w[0] < w[1]));
        assert!((all[SIDE] / (0.2 * LOWEST) - 1.0).abs() < 1e-12);
        assert!(all.iter().zip(all.iter().rev()).all(|(a, b)| a == &-b));
    }
}
