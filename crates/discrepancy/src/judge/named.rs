//! What each named effect does on the logs that a discovery is judged by.

use axis_sim::ReplayError;

use super::against::{Against, against};
use super::compared::Compared;
use super::cost::{Cost, cost};
use super::form::FormFound;
use super::found::{OnCheck, effect_found, form_of_own};
use super::law::steady;
use super::types::EffectFound;
use crate::name::gap::gap;
use crate::name::search::is_form;
use crate::name::transfer::Transfer;

/// What was named, in figures.
#[derive(Default)]
pub(super) struct NamedEffects {
    /// Those that take away most of the gap first.
    pub(super) effects: Vec<EffectFound>,
    /// The residual against what each depends on.
    pub(super) pictured: Vec<Against>,
    /// What each costs, by name.
    pub(super) each: Vec<(String, Cost)>,
    /// The form of the axis' own friction.
    pub(super) own_form: Option<FormFound>,
}

impl NamedEffects {
    /// Each effect is taken out by itself.
    pub(super) fn of(compared: &Compared<'_>) -> Result<Self, ReplayError> {
        let Compared {
            machine,
            found,
            set,
            before,
            after,
            left,
            ..
        } = compared;
        let full = compared.state();
        let mut named = Self::default();
        for (index, one) in found.named.iter().enumerate() {
            if is_form(&full.effects[index]) {
                named.own_form = named
                    .own_form
                    .or_else(|| form_of_own(machine, found, index));
                continue;
            }
            let mut other = full.clone();
            let taken = full.effects[index].effect;
            other.remove(index);
            let without = set.rest(&set.simulate(machine, &other)?);
            let lost = gap(set, before, &without, &left.floors);
            let costs = cost(machine, set, &without, after);
            named.each.push((taken.name.to_owned(), costs));
            // A friction over speed is shown as its law.
            if steady(&full.effects[index], 1.0).is_none() {
                let rests = [&without, after];
                let floors = &left.floors;
                let picture = against(machine, set, &compared.traces, taken, rests, floors);
                named.pictured.extend(picture);
            }
            let share = (left.gap.reduction - lost.reduction).clamp(0.0, 1.0);
            let on_check = OnCheck {
                share_of_gap: share,
                transfer: Transfer::new(set, &without, after),
            };
            let effect = effect_found(machine, found, index, one, &on_check);
            named.effects.push(effect);
        }
        (named.effects).sort_by(|a, b| b.share_of_gap.total_cmp(&a.share_of_gap));
        Ok(named)
    }
}
