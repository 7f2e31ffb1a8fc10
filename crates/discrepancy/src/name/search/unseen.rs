//! Effects that end where nothing of them is to be seen but what a simpler one does.
//!
//! A shape that ends at such a limit, or beyond all that logs show, is no second explanation beside
//! the simpler effect, and no name: a body that swings faster than any motion is a mass.

use axis_sim::effects::{ActiveEffect, Effect, EffectParameter, Nature, Scales};

use super::form::WITH_MEMORY;
use super::state::Search;
use super::swing::is_frequency;
use crate::answers::Prepared;

/// Share of the way on which the axis' own friction comes on that slip with a memory must take.
const OF_OWN_WAY: f64 = 0.1;

impl Search<'_> {
    /// Whether an effect is no other than a simpler one, with the values that it has.
    pub(super) fn is_unseen(&self, active: &ActiveEffect) -> bool {
        let scales = Scales::of(self.machine);
        let highest = (self.fit_logs.logs.iter()).map(Prepared::highest_shown);
        let friction = &self.machine.friction;
        let lever = friction.lever(self.machine.travel_per_radian());
        let own_way = lever / friction.unit.parameters().stiffness;
        hardly_falls(active, &scales)
            || hardly_remembers(active, own_way)
            || swings_as_fast(active, &scales, highest.fold(0.0, f64::max))
    }
}

/// Whether an effect may come to be no other than a simpler one.
pub(super) fn may_end_unseen(effect: &Effect) -> bool {
    let falls = |p: &EffectParameter| matches!(p.nature, Nature::Speed(..));
    effect.name == WITH_MEMORY
        || effect.place_of(is_frequency).is_some()
        || effect.parameters.iter().any(falls)
}

/// Whether it is a friction that falls with a speed that is as high as it may be: over all of the
/// motion it is dry friction that is a little less where motion is fast.
fn hardly_falls(active: &ActiveEffect, scales: &Scales) -> bool {
    let mut values = active.effect.parameters.iter().zip(&active.values);
    values.any(|(p, value)| matches!(p.nature, Nature::Speed(..)) && *value >= p.bounds(scales)[1])
}

/// Whether it is slip with a memory that takes up next to nothing of the way of the axis' `own`
/// bristles: dry friction that comes on sooner than the file says.
fn hardly_remembers(active: &ActiveEffect, own: f64) -> bool {
    active.effect.name == WITH_MEMORY && active.values[1] < OF_OWN_WAY * own
}

/// Whether it is a body that swings with so many hertz or more, or as fast as one may: it is a mass.
fn swings_as_fast(active: &ActiveEffect, scales: &Scales, highest: f64) -> bool {
    let at = active.effect.place_of(is_frequency);
    at.is_some_and(|at| {
        let [_, most] = active.effect.parameters[at].bounds(scales);
        active.values[at] >= highest.min(most)
    })
}

#[cfg(test)]
mod tests {
    use axis_sim::effects::{ActiveEffect, Effect, Scales};

    use super::{WITH_MEMORY, hardly_falls, hardly_remembers, swings_as_fast};

    fn active(name: &str, values: &[f64]) -> ActiveEffect {
        ActiveEffect {
            effect: Effect::named(name).unwrap(),
            values: values.to_vec(),
        }
    }

    fn scales() -> Scales {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
        Scales::of(&axis_sim::Axis::read(file.as_ref()).unwrap())
    }

    #[test]
    fn a_body_swings_faster_than_half_the_rate_or_not() {
        let as_fast = |body: &ActiveEffect, most: f64| swings_as_fast(body, &scales(), most);
        let body = active("structural-resonance", &[900.0, 600.0, 0.03]);
        assert!(as_fast(&body, 500.0) && !as_fast(&body, 700.0));
        assert!(!as_fast(&active("payload-mass", &[900.0]), 500.0));
        // A log at 10 kHz shows more than the library has, whose bodies swing at 1 kHz at most.
        let fastest = active("structural-resonance", &[900.0, 1000.0, 0.03]);
        assert!(as_fast(&fastest, 5000.0) && !as_fast(&body, 5000.0));
    }

    /// What balances low-pass at 40 Hz shows no body that swings faster, though its samples would.
    #[test]
    fn a_balance_shows_no_body_that_swings_above_its_low_pass() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/rack.toml");
        let text = std::fs::read_to_string(file).unwrap() + "\n[balance]\ncutoff_hz = 40\n";
        let axis = axis_sim::Axis::parse("rack.toml", &text).unwrap();
        let motion = axis.plan(&axis.trajectories[0]).unwrap();
        let mut recorder = axis_sim::Recorder::new(&axis);
        axis_sim::ClosedLoop::new(&axis)
            .unwrap()
            .run(&motion, &mut compensator::NoCompensation, |c| {
                recorder.push(c)
            })
            .completed()
            .unwrap();
        let logs = vec![("log".to_owned(), recorder.log().unwrap(), axis.period)];
        let machine = axis.without_control().unwrap();
        let set = crate::answers::LogSet::new(logs, &machine).unwrap();
        let log = &set.logs[0];
        assert!(0.5 / log.period > 41.0, "{}", log.period);
        assert!((log.highest_shown() - 40.0).abs() < 1e-9);
    }

    #[test]
    fn a_fall_at_its_highest_speed_and_a_memory_of_no_way_are_dry_friction() {
        let fall =
            |speed: f64| hardly_falls(&active("stribeck-friction", &[60.0, speed]), &scales());
        // A tenth of the speed of 0.12 m/s.
        assert!(fall(0.012) && !fall(0.0114));
        let memory = |way: f64| hardly_remembers(&active(WITH_MEMORY, &[30.0, way]), 1e-5);
        assert!(memory(0.9e-6) && !memory(1.1e-6));
        assert!(!hardly_remembers(
            &active("coulomb-friction", &[30.0]),
            1e-5
        ));
    }
}
