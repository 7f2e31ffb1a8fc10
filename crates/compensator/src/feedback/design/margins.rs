//! Margins of a designed feedback, on the assumed axis or on another one.
//!
//! The loop is cut at the plant's input, the command: one signal, whatever is measured. With
//! L(z) = −(command that comes back)/(command that goes in), S = 1/(1 + L). What comes back has passed the
//! observer, the state feedback, and all that the drive has between a correction and the
//! command: its filters, and a position controller at a rate of its own.

use super::cut::Loop;
use super::linear::{DriveSituation, SampledDrive};
use super::{DesignError, FeedbackDesign, FeedbackSettings, STICKING};
use crate::model::Mode;

/// An axis that is not the assumed one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variation<'a> {
    /// Its modes: those of another position. As many as it has; none: those of the design.
    pub modes: &'a [Mode],
    /// Its load's inertia as a share of the assumed one; the modes are those without it.
    pub mass: f64,
    /// Its bristles' stiffness and damping and its viscous friction, as shares.
    pub friction: f64,
    /// Its χ (share of the bristles that stick) as a multiple of the design's, at most 1 in all.
    pub sticking: f64,
    /// Share of the least damping of slow sliding, which is negative; 1 where the load slides
    /// at about half the Stribeck speed and more, 0 if it slides fast.
    pub stribeck: f64,
}

impl Default for Variation<'_> {
    fn default() -> Self {
        Self {
            modes: &[],
            mass: 1.0,
            friction: 1.0,
            sticking: 1.0,
            stribeck: 0.0,
        }
    }
}

/// How far a loop is from instability; the worst over χ of each.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Margins {
    /// Greatest sensitivity at the plant's input; infinite if the loop is not stable.
    pub sensitivity: f64,
    /// χ where that is.
    pub sticking: f64,
    /// The same with one more cycle of delay.
    pub sensitivity_late: f64,
    /// χ where that is.
    pub sticking_late: f64,
    /// Delay that the loop takes before it is unstable, s; where the drive's position controller
    /// runs at a rate of its own, in whole control periods, up to 16 of them.
    pub delay: f64,
    /// Greatest eigenvalue of the closed loop, 1/cycle; below 1.
    pub radius: f64,
}

impl FeedbackDesign {
    /// Margins on the axis that `on` says.
    ///
    /// # Errors
    /// [`DesignError`] if that has more states than there is room for.
    pub fn margins(&self, on: &Variation<'_>) -> Result<Margins, DesignError> {
        self.worst(on, true, [f64::INFINITY; 2])
    }

    /// The margins; of a loop that repeats after several periods the delay takes long, and is
    /// left out if nobody asks for it. Where a sensitivity is above `enough`, that of the loop or
    /// that with one more cycle of delay, the rest is left out too.
    fn worst(
        &self,
        on: &Variation<'_>,
        with_delay: bool,
        enough: [f64; 2],
    ) -> Result<Margins, DesignError> {
        let mut all = Margins {
            sensitivity: 0.0,
            sticking: 0.0,
            sensitivity_late: 0.0,
            sticking_late: 0.0,
            delay: f64::INFINITY,
            radius: 0.0,
        };
        for (design, sticking) in self.designs.iter().zip(STICKING) {
            let plant = self.plant(on, sticking)?;
            let at = Loop::new(&plant, &self.model, design);
            if with_delay && at.repeats() > 1 {
                all.delay = all.delay.min(at.whole_delay(self.model.period));
            }
            for late in [0_usize, 1] {
                let radius = at.radius(late);
                let (mut sensitivity, delay) = at.frequencies(late, self.model.period);
                if radius.is_nan() || radius >= 1.0 {
                    sensitivity = f64::INFINITY;
                }
                let (worst, place) = if late > 0 {
                    (&mut all.sensitivity_late, &mut all.sticking_late)
                } else {
                    all.radius = all.radius.max(radius);
                    all.delay = all.delay.min(delay);
                    (&mut all.sensitivity, &mut all.sticking)
                };
                if sensitivity > *worst {
                    (*worst, *place) = (sensitivity, sticking);
                }
                if sensitivity > enough[late] {
                    return Ok(all);
                }
            }
        }
        Ok(all)
    }

    fn plant(&self, on: &Variation<'_>, sticking: f64) -> Result<SampledDrive, DesignError> {
        let modes = match on.modes {
            [] => &self.modes,
            modes => &self.settings.used(modes)?,
        };
        let situation = DriveSituation {
            sticking: (sticking * on.sticking).clamp(0.0, 1.0),
            mass: on.mass,
            friction: on.friction,
            bristles: 1.0,
            sliding: on.stribeck * self.stribeck,
        };
        SampledDrive::new(
            &self.model,
            modes,
            self.settings.speed_by_differences,
            &situation,
        )
        .fits()
    }

    /// Refuses a design whose margins are not those that its settings ask for, with the load
    /// where it was designed for and `elsewhere`. `search` remembers where a design failed.
    pub(super) fn require_margins(
        &self,
        elsewhere: &[&[Mode]],
        search: &mut MarginSearch,
    ) -> Result<(), DesignError> {
        let s = &self.settings;
        if s.sensitivity.is_infinite() && s.sensitivity_late.is_infinite() {
            return Ok(());
        }
        let here: &[Mode] = &self.modes;
        let mut all = Vec::new();
        // Everything in one place first: most of what fails does so there.
        for modes in core::iter::once(&here).chain(elsewhere) {
            for stribeck in [0.0, 1.0] {
                for mass in [1.0, s.mass[0], s.mass[1]] {
                    for friction in [1.0, s.friction[0], s.friction[1]] {
                        all.push(Variation {
                            modes,
                            mass,
                            friction,
                            stribeck,
                            ..Variation::default()
                        });
                    }
                }
            }
        }
        // Where the last design failed the next one likely does.
        let first = search.failed.min(all.len() - 1);
        let order = core::iter::once(first).chain((0..all.len()).filter(|i| *i != first));
        for i in order {
            let asked = asked(s, &all[i]).map(|most| most * search.nearest);
            let found = self.worst(&all[i], false, asked)?;
            if let Err(error) = found.within(s, &all[i]) {
                search.failed = i;
                search.nearest = search.nearest.min(error.excess());
                return Err(error);
            }
        }
        Ok(())
    }
}

/// What is known of the designs that were tried before.
#[derive(Clone, Copy, Debug)]
pub(super) struct MarginSearch {
    /// The variation in which the last one failed.
    failed: usize,
    /// How far the nearest is from what was asked for: what is farther need not be known better.
    nearest: f64,
}

impl Default for MarginSearch {
    fn default() -> Self {
        Self {
            failed: 0,
            nearest: f64::INFINITY,
        }
    }
}

/// Greatest sensitivities in a variation: of the loop, and with one more cycle of delay.
fn asked(s: &FeedbackSettings, on: &Variation<'_>) -> [f64; 2] {
    // Slow sliding is unstable by itself: a loop around it cannot have the same margins.
    [s.sensitivity, s.sensitivity_late].map(|most| match on.stribeck > 0.0 {
        true => most.max(s.sensitivity_slow),
        false => most,
    })
}

impl Margins {
    fn within(&self, s: &FeedbackSettings, on: &Variation<'_>) -> Result<(), DesignError> {
        let [most, most_late] = asked(s, on);
        let late = "the sensitivity with one more cycle of delay";
        let all = [
            ("the sensitivity", self.sensitivity, most, self.sticking),
            (late, self.sensitivity_late, most_late, self.sticking_late),
        ];
        for (what, value, most, sticking) in all {
            if value > most {
                return Err(DesignError::Margin {
                    what,
                    value,
                    most,
                    mass: on.mass,
                    friction: on.friction,
                    sticking,
                    stribeck: on.stribeck,
                    frequency: on.modes.get(1).map_or(0.0, |mode| mode.frequency),
                });
            }
        }
        Ok(())
    }
}
