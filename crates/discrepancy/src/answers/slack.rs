//! Gaps between motor and load, of which nobody knows at a log's start how they are taken up.

use axis_log::Log;
use axis_sim::effects::{ActiveEffect, EFFECTS, Effect, EffectNeed, Scales};
use axis_sim::part::Role;
use axis_sim::{Axis, reference_in};

use super::set::{LogSet, Prepared};

impl LogSet {
    /// Of these effects: a gap that is larger than what is taken up before a log counts,
    /// and that log.
    pub(crate) fn slack_left(&self, effects: &[ActiveEffect]) -> Option<(f64, &Prepared)> {
        let gaps = effects.iter().filter(|a| is_gap(a.effect));
        let gap: f64 = gaps.map(|a| a.values[0]).sum();
        let least = |a: &&Prepared, b: &&Prepared| a.taken_up.total_cmp(&b.taken_up);
        // A balance begins with the measured motion, wherever the motor stood before.
        let replayed = self.logs.iter().filter(|log| log.answer.replay().is_some());
        let least = replayed.min_by(least)?;
        (gap > least.taken_up).then_some((gap, least))
    }
}

/// Whether an effect is a gap between motor and load.
fn is_gap(effect: &Effect) -> bool {
    effect.needs.contains(&EffectNeed::Role(Role::Backlash))
}

/// Largest gap that is taken up before a log counts, m: the largest that an axis file may
/// have; of a motion that never goes so far, half of its farthest.
pub(super) fn taken_up(log: &Log, machine: &Axis) -> f64 {
    let scales = Scales::of(machine);
    let gaps = EFFECTS.iter().filter(|effect| is_gap(effect));
    let largest = gaps.map(|e| e.parameters[0].bounds(&scales)[1]);
    let largest = largest.fold(0.0, f64::max);
    let reference = reference_in(log).unwrap_or_default();
    let moved = |x: &f64| (x - reference[0]).abs();
    largest.min(0.5 * reference.iter().map(moved).fold(0.0, f64::max))
}

/// When the reference has first moved so far that slack is taken up, s: before
/// that nobody knows where a screw lies in its gap, and noise shakes it about.
pub(super) fn first_move(log: &Prepared) -> f64 {
    let reference = reference_in(&log.log).unwrap_or_default();
    let moved = |x: &f64| (x - reference[0]).abs() >= log.taken_up;
    let first = reference.iter().position(moved).unwrap_or(0);
    first as f64 * log.period
}
