//! What the residual is: noise, or something without a name; and the verdict that follows.

use axis_sim::{Axis, ReplayError};

use super::compared::Compared;
use super::named::NamedEffects;
use super::types::Verdict;
use super::unknown::{Unknown, in_frequency, lack};
use crate::answers::{LogSet, Rest};
use crate::estimate::fit::Fitter;
use crate::name::gap::{Gap, is_more_than_noise, sizes};
use crate::name::search::{LEAST_EVIDENCE_SHARE, Refused};
use crate::noise::{Excess, MotionAndRest, excess, log_noise, stays, steady_bands};

/// Share of the gap on check motion that named effects must take away to explain it.
const EXPLAINED: f64 = 0.9;

/// Share of the gap on check motion from which on a residual is reported only if it forms a curve: a fiftieth remains.
const NEARLY_ALL: f64 = 0.98;

/// What the residual is.
pub(super) struct Remainder<'a> {
    /// The gap, its residual at the floor where it is taken for noise.
    pub(super) gap: Gap,
    /// What the machine leaves with its known parameters fitted and no effect.
    pub(super) of_base: Rest,
    /// What has no name.
    pub(super) unknown: Option<Unknown>,
    /// Noise of a colour that the floor does not know.
    pub(super) coloured: Option<Excess>,
    /// Whether it is taken for noise that a controller made of that of its sensors.
    pub(super) is_slow_of_loop: bool,
    /// The fitted log in which there is more than noise though nothing was named, and how many times its floor.
    pub(super) more_than_noise: Option<(usize, f64)>,
    /// Whether nothing is named, and what remains is small beside what each channel shows.
    pub(super) is_immaterial: bool,
    /// What was refused and is not of noise.
    pub(super) refused: Option<&'a Refused>,
    /// Whether it is more than noise and than small change.
    is_significant: bool,
}

impl<'a> Remainder<'a> {
    /// Beside what was named.
    pub(super) fn of(compared: &Compared<'a>, named: &NamedEffects) -> Result<Self, ReplayError> {
        let (machine, found) = (compared.machine, compared.found);
        let (set, as_filed) = (compared.set, compared.as_filed.as_ref());
        let checker = Fitter {
            machine,
            set: as_filed,
        };
        let base = checker.at(found.base.state.clone())?;
        let of_base = as_filed.rest(&base.traces);
        let is_bare = named.effects.is_empty();
        let gap = compared.left.gap.clone();
        let largest = found.named.iter().map(|n| n.evidence).fold(0.0, f64::max);
        let is_nearly_none = gap.reduction >= NEARLY_ALL && !is_bare;
        let fitted = (&found.fit_logs, &compared.fit_gap);
        let mut logs = [(set, &compared.left.gap), fitted].into_iter();
        let is_immaterial = is_bare && logs.all(|(set, gap)| is_immaterial(machine, set, gap));
        // That nothing is missing has to hold of every log, of those that were fitted as well: there is no more noise
        // in them than the check logs show, but for what differs from log to log. Where there is, nothing is taken for noise.
        let more_than_noise = compared
            .fit_above
            .filter(|(_, times)| is_more_than_noise(*times, compared.above))
            .filter(|_| is_bare && named.own_form.is_none() && !is_immaterial);
        let lack = match is_immaterial {
            true => None,
            false => lack(machine, found, LEAST_EVIDENCE_SHARE * largest)?,
        };
        // Beside effects that leave next to nothing, a residual without a curve is small change.
        let excess = match lack.is_some() || is_nearly_none || is_immaterial {
            true => None,
            false => above_noise(compared)?,
        };
        let following = excess
            .as_ref()
            .and_then(|excess| following(compared, excess, is_bare));
        let coloured = excess.filter(|_| following.is_none() && more_than_noise.is_none());
        // Of a balance nobody knows what the controller makes of its sensors' noise: slow, it is above
        // the floor, and what curves take of it does not hold on other logs.
        let without = match is_bare {
            true => sizes(set, &compared.after),
            false => sizes(set, &of_base),
        };
        let as_noise = as_noise(&gap, &without, lack.is_some() || more_than_noise.is_some());
        let is_slow_of_loop = as_noise.is_some() && !gap.is_at_floor();
        let gap = as_noise.unwrap_or(gap);
        let unknown = lack.or_else(|| following.map(in_frequency));
        let as_coloured = compared.left.loop_noise.is_some() && unknown.is_none();
        let is_noise = gap.is_at_floor() || coloured.is_some() || is_slow_of_loop || as_coloured;
        let is_small = is_noise || is_nearly_none || is_immaterial;
        let is_significant = !is_small || unknown.is_some() || more_than_noise.is_some();
        // What takes away little of a residual that is noise was fitted to noise.
        let is_of_noise = |refused: &&Refused| {
            is_immaterial || as_coloured || is_slow_of_loop && refused.effects.is_empty()
        };
        let refused = found.refused.as_ref();
        let refused = refused.filter(|refused| !(is_bare && is_of_noise(refused)));
        Ok(Self {
            gap,
            of_base,
            unknown,
            coloured,
            is_slow_of_loop,
            more_than_noise,
            is_immaterial,
            refused,
            is_significant,
        })
    }

    /// What can be said.
    pub(super) fn verdict(&self, named: &NamedEffects) -> Verdict {
        let (gap, is_refused) = (&self.gap, self.refused.is_some());
        match (named.effects.is_empty(), self.is_significant) {
            (true, _) if is_refused => Verdict::Unknown,
            (true, false) if named.own_form.is_some() && gap.stands_out() => Verdict::OtherForm,
            (true, false) => Verdict::NothingMissing,
            (true, true) => Verdict::Unknown,
            // What was refused beside what is named is a residual that has no name.
            _ if is_refused => Verdict::PartlyExplained,
            // No share of a gap can be asked for where none stood out.
            (false, false) if gap.reduction >= EXPLAINED || !gap.stands_out() => Verdict::Explained,
            (false, _) => Verdict::PartlyExplained,
        }
    }
}

/// Whether the residual of logs is small beside what each of their channels shows.
fn is_immaterial(machine: &Axis, set: &LogSet, gap: &Gap) -> bool {
    let sizes: Vec<f64> = gap.channels.iter().map(|channel| channel.after).collect();
    set.is_immaterial(machine, &sizes)
}

/// The gap, were its residual taken for noise although that is above its floor: not where something else is known of
/// it (`is_more`), a law that it follows or a log in which there is more than in others. One residual is not both.
fn as_noise(gap: &Gap, without: &[f64], is_more: bool) -> Option<Gap> {
    gap.taken_for_noise(without).filter(|_| !is_more)
}

/// The bands in which the residual is more than the noise, if that is known.
fn above_noise(compared: &Compared<'_>) -> Result<Option<Excess>, ReplayError> {
    let (machine, set, traces) = (compared.machine, compared.set, &compared.traces);
    let of_loop = compared.left.loop_noise.clone();
    let noise = of_loop.or_else(|| log_noise(machine, set, compared.state(), traces));
    match noise {
        Some(noise) => excess(
            machine,
            set,
            compared.state(),
            traces,
            &noise,
            &compared.slow,
        ),
        None => Ok(None),
    }
}

/// The bands of them that are no noise. A residual that is neither a curve over the motion nor follows it is noise, whatever
/// its colour; but it may be what an imitation leaves of a gap, be that a form of friction.
fn following(compared: &Compared<'_>, excess: &Excess, is_bare: bool) -> Option<Excess> {
    let gap = &compared.left.gap;
    let imitates = !is_bare && gap.stands_out();
    let is_small = match compared.found.named.is_empty() {
        true => gap.may_be_noise_apart_from_motion(),
        false => gap.may_be_coloured(),
    };
    if compared.set.is_balanced() || !is_small || imitates {
        return Some(excess.clone());
    }
    let (fitted, checked) = (compared.fitted(), compared.checked());
    let rest = MotionAndRest::new(fitted, checked);
    // A larger one must be there while the axis stands, too.
    let is_large = !gap.may_be_coloured();
    let is_steady = is_large.then(|| steady_bands(compared.machine, compared.state(), checked));
    let comes_with_motion = |band| is_steady.as_ref().is_some_and(|steady| !steady(band));
    let stays = stays([fitted, checked]);
    excess.only(|band| rest.follows(band) || comes_with_motion(band) || stays && band[0] == 0.0)
}

#[cfg(test)]
mod tests {
    use super::as_noise;
    use crate::name::gap::{ChannelGap, Gap};

    /// A clean axis of which one fitted log was 3.4 times above its noise: it was said in one report that this
    /// rules out "nothing is missing", and that the residual is noise.
    #[test]
    fn a_residual_that_is_more_than_noise_in_one_log_is_not_taken_for_noise() {
        let gap = Gap {
            channels: vec![ChannelGap {
                channel: "force_ref_n".to_owned(),
                before: 1.3,
                after: 1.3,
                floor: 1.0,
                floor_most: 1.0,
                floor_is_least: true,
            }],
            reduction: 0.0,
        };
        assert!(as_noise(&gap, &[1.3], false).is_some());
        assert!(as_noise(&gap, &[1.3], true).is_none());
    }
}
