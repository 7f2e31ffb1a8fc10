//! What is uncertain of every machine and no answer to the question: the form of its own friction,
//! and small laws over effort and acceleration.
//!
//! A family is one way in which the axis' own dry friction may differ from the model's. Its
//! numbers are integrated out of every hypothesis.

use axis_sim::Axis;
use axis_sim::effects::{ActiveEffect, Effect, Formed, FrictionForm, Scales};
use rayon::prelude::*;

use crate::estimate::columns::is_free;
use crate::estimate::fit::{Fit, Fitter};
use crate::name::library::responses;
use crate::name::search::is_form;
use crate::spectrum::Amplitudes;

/// A column of a nuisance, with the deviation of its number.
pub type Weighed = (Amplitudes, f64);

/// A way in which the axis' own friction may differ.
pub struct Family {
    pub columns: Vec<Weighed>,
    /// The effect that it is the same as: with that, it says nothing.
    pub instead_of: &'static str,
}

/// Share of the axis' own dry friction by which laws over effort and over acceleration may be off
/// everywhere (Kennedy and O'Hagan, J. R. Statist. Soc. B 63 (2001) 425–464,
/// doi:10.1111/1467-9868.00294). Without, a curve over effort wins on clean screws.
pub const DISCREPANCY: f64 = 0.015;

/// Length of these laws, as a share of the range of their variable.
pub const LENGTH: f64 = 0.2;

/// Deviation of the fall from break-away, as a share of the level.
const FALL: f64 = 0.04;

/// Speeds over those of the knots at which an onset in speed is complete.
const ONSETS: [f64; 6] = [1.0, 4.0, 16.0, 64.0, 200.0, 800.0];

/// Deviation of the share of the friction that has another onset.
const SHARE: f64 = 0.7;

/// Distances of a Maxwell slip, over the typical one.
const SLIPS: [f64; 4] = [0.1, 0.2, 0.4, 0.75];

/// Greatest share by which a stiffness hardens over its typical range.
const HARDENING: f64 = 0.2;

/// Pre-sliding over its typical share.
const PRESLIDING: f64 = 5.0;

/// The onset of a friction, as in the model, with priors of its numbers.
pub fn onset_of(friction: &ActiveEffect, fastest: f64) -> Option<ActiveEffect> {
    let formed = Formed {
        friction: friction.clone(),
        fall: None,
        fastest,
    };
    let form = FrictionForm::all(&formed).into_iter().next();
    form.map(FrictionForm::with_prior)
}

type Make<'b> = fn(&At<'b>) -> Option<Vec<Weighed>>;

/// The effect that it is the same as, and how it is made.
type Line<'b> = (&'static str, Make<'b>);

/// What families are made at.
pub struct At<'a> {
    pub fitter: &'a Fitter<'a>,
    pub fit: &'a Fit,
    pub own: Option<&'a ActiveEffect>,
}

impl<'b> At<'b> {
    fn machine(&self) -> &Axis {
        self.fitter.machine
    }

    fn fastest(&self) -> f64 {
        let speeds = self.fit.traces.iter().flat_map(|t| &t.speed);
        speeds.fold(0.0_f64, |most, v| most.max(v.abs()))
    }

    fn effect(&self, name: &str) -> Option<&'static Effect> {
        Effect::named(name).filter(|e| e.applies_to(self.machine()).is_ok())
    }

    /// What these effects do together.
    fn together(&self, effects: Vec<ActiveEffect>) -> Amplitudes {
        let mut state = self.fit.state.clone();
        state.effects.extend(effects);
        self.fitter.column(self.fit, &state, 1.0)
    }

    /// What an effect of typical shape does per typical size.
    fn typical(&self, name: &str) -> Option<(Vec<Amplitudes>, f64)> {
        let effect = self.effect(name)?;
        let scales = Scales::of(self.machine());
        let values = effect.typical(&scales);
        let size = effect.parameters.iter().find(|p| p.is_size())?;
        let columns = responses(self.fitter, self.fit, effect, &values);
        Some((columns, size.typical(&scales)))
    }

    /// Steady friction over speed, near standstill first.
    fn steady(&self) -> Option<Vec<Weighed>> {
        let active = onset_of(self.own?, self.fastest())?;
        let columns = responses(self.fitter, self.fit, active.effect, &active.values);
        let form = FrictionForm::of(&active)?;
        let scales = Scales::of(self.machine());
        let parameters = active.effect.parameters.iter().enumerate();
        // Columns are of typical sizes.
        let deviations = parameters.filter(|(_, p)| is_free(p)).filter_map(|(i, p)| {
            let deviation = form.deviation(i)?;
            Some(deviation / p.typical(&scales))
        });
        Some(columns.into_iter().zip(deviations).collect())
    }

    fn form(&self) -> Option<Vec<Weighed>> {
        let mut all = self.steady()?;
        if let Some((fall, typical)) = self.typical("stribeck-friction") {
            let deviation = FALL * self.own?.values[0] / typical;
            all.extend(fall.into_iter().map(|c| (c, deviation)));
        }
        Some(all)
    }

    fn onset(&self) -> Option<Vec<Weighed>> {
        let one = |by: f64| {
            let mut form = onset_of(self.own?, self.fastest() * by)?;
            let share = form.effect.parameters.iter().position(is_free)?;
            form.values[share] = 1.0;
            Some((self.together(vec![form]), SHARE))
        };
        let mut all: Vec<Weighed> = ONSETS.iter().filter_map(|by| one(*by)).collect();
        let near_rest = self.steady()?.into_iter().take(4).skip(1);
        all.extend(near_rest.map(|(c, deviation)| (c, 0.5 * deviation)));
        Some(all)
    }

    fn slip(&self) -> Option<Vec<Weighed>> {
        let (slip, dry) = (
            self.effect("maxwell-slip-hysteresis")?,
            self.effect("coulomb-friction")?,
        );
        let level = self.own?.values[0];
        let typical = slip.parameters[1].typical(&Scales::of(self.machine()));
        let one = |by: f64| {
            let instead = vec![
                ActiveEffect {
                    effect: slip,
                    values: vec![level, by * typical],
                },
                ActiveEffect {
                    effect: dry,
                    values: vec![-level],
                },
            ];
            (self.together(instead), SHARE)
        };
        let mut all: Vec<Weighed> = SLIPS.iter().map(|by| one(*by)).collect();
        all.extend(self.steady()?.into_iter().take(4));
        if let Some((presliding, _)) = self.typical("presliding") {
            all.extend(presliding.into_iter().map(|c| (c, PRESLIDING)));
        }
        Some(all)
    }

    fn hardening(&self) -> Option<Vec<Weighed>> {
        let (columns, typical) = self.typical("hardening-stiffness")?;
        let deviation = HARDENING / typical;
        Some(columns.into_iter().map(|c| (c, deviation)).collect())
    }

    /// All families that this machine can have, beside a form that is there already.
    pub fn families(&self) -> Vec<Family> {
        let is_there = self.fit.state.effects.iter().any(is_form);
        let all: [(Line<'b>, bool); 4] = [
            (("", At::onset), is_there),
            (("", At::form), is_there),
            (("presliding", At::slip), false),
            (("hardening-stiffness", At::hardening), false),
        ];
        let all = all.into_iter().filter(|(_, is_there)| !is_there);
        let all: Vec<Line<'b>> = all.map(|(line, _)| line).collect();
        let one = |(instead_of, make): Line<'b>| {
            let columns = make(self)?;
            let mut all = columns.iter().flat_map(|(c, _)| c.iter().flatten());
            all.any(|v| v.norm_sqr() > 0.0).then_some(Family {
                columns,
                instead_of,
            })
        };
        all.into_par_iter().filter_map(one).collect()
    }
}
