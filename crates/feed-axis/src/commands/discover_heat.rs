//! What logs of hours show, as a discovery.

use axis_sim::effects::Effect;
use axis_sim::{Axis, SixDigits};
use axis_thermal::{DriftOver, HeatEffect, HeatEstimate, HeatExplained, HeatGap, HeatResidual};
use discrepancy::{
    Assessment, ChannelGap, Confidence, Cost, Curve, Discovered, Discovery, EffectFound,
    FigureLogs, Gap, Gaps, Level, Likeness, Overlay, ParameterFound, Recalibrated, Remedy,
    RemedyFound, Shown, Unknown, Verdict,
};

/// Names of the logs.
pub(super) struct Logs {
    pub fit: Vec<String>,
    /// None: the last part of each log is held out.
    pub check: Vec<String>,
}

/// One of the two effects in words.
struct Said {
    effect: &'static str,
    gap: &'static str,
    /// Its size.
    parameter: &'static str,
    unit: &'static str,
    acts_in: &'static str,
}

const GROWTH: Said = Said {
    effect: "thermal-expansion",
    gap: "growth_m",
    parameter: "growth",
    unit: "m",
    acts_in: "growth of the screw",
};

const WARMING: Said = Said {
    effect: "warming-friction",
    gap: "friction_w",
    parameter: "share_lost",
    unit: "",
    acts_in: "power of the friction",
};

/// Two standard deviations of the friction's levels before a log.
const LEVEL_TOLERANCE: f64 = 0.4;

/// Share of the gap that is gone if it is explained.
const EXPLAINED: f64 = 0.9;

/// The discovery, with its pictures.
pub(super) fn discovered(machine: &Axis, found: &HeatExplained, logs: &Logs) -> Discovered {
    let both = seen(found);
    let verdict = verdict(&both);
    let mut effects: Vec<EffectFound> = both
        .iter()
        .filter(|(_, effect)| effect.named)
        .map(|(said, effect)| named(said, effect, found))
        .collect();
    effects.sort_by(|a, b| b.share_of_gap.total_cmp(&a.share_of_gap));
    let rivals = |(said, effect): &(&Said, &HeatEffect)| -> Vec<(String, f64)> {
        let unnamed = (!effect.named).then(|| (said.effect.to_owned(), effect.evidence[0]));
        unnamed.into_iter().collect()
    };
    let discovery = Discovery {
        schema: Discovery::SCHEMA,
        axis: machine.name.clone(),
        answer: "thermal-network".to_owned(),
        notes: notes(found, logs),
        verdict,
        sentence: sentence(verdict, &both, &effects),
        own_form: None,
        replaced: Vec::new(),
        refused: None,
        not_added: both.iter().flat_map(rivals).collect(),
        unknown: both.iter().find_map(|(said, e)| unknown(said, e, found)),
        gap: Gaps {
            fit: gap(&both, 0),
            check: gap(&both, 1),
        },
        figures: FigureLogs::default(),
        recalibrated: levels(found),
        assessment: assessment(verdict, &effects),
        likenesses: both.iter().map(|(said, e)| likeness(said, e)).collect(),
        next_experiment: None,
        effects,
    };
    Discovered {
        overlays: overlays(found, logs),
        against: Vec::new(),
        friction: None,
        proposal: None,
        discovery,
    }
}

/// What the logs show.
fn seen(found: &HeatExplained) -> Vec<(&'static Said, &HeatEffect)> {
    let growth = found.growth.as_ref().map(|effect| (&GROWTH, effect));
    let warming = found.warming.as_ref().map(|effect| (&WARMING, effect));
    growth.into_iter().chain(warming).collect()
}

fn verdict(both: &[(&Said, &HeatEffect)]) -> Verdict {
    let open = |effect: &HeatEffect| {
        let gap = &effect.gaps[1];
        gap.stands_out() && gap.reduction() < EXPLAINED
    };
    let any_named = both.iter().any(|(_, effect)| effect.named);
    match (any_named, both.iter().any(|(_, effect)| open(effect))) {
        (true, false) => Verdict::Explained,
        (true, true) => Verdict::PartlyExplained,
        (false, true) => Verdict::Unknown,
        (false, false) => Verdict::NothingMissing,
    }
}

fn parameter(name: &str, unit: &str, of: &HeatEstimate) -> ParameterFound {
    ParameterFound {
        name: name.to_owned(),
        value: of.value,
        unit: unit.to_owned(),
        ci95: of.interval,
        when_named: of.value,
        at_screw: None,
    }
}

fn named(said: &Said, effect: &HeatEffect, found: &HeatExplained) -> EffectFound {
    let mut parameters = vec![parameter(said.parameter, said.unit, &effect.size)];
    if let Some([viscous, dry, _]) = found
        .falls
        .as_ref()
        .filter(|_| said.effect == WARMING.effect)
    {
        parameters.push(parameter("viscous_fall", "1/K", viscous));
        parameters.push(parameter("dry_fall", "1/K", dry));
    }
    let [time, place] = effect.at;
    let minutes = SixDigits((time / 60.0).round());
    let summary = match said.effect == GROWTH.effect {
        true => format!(
            "growth of the screw with its temperatures, at {} mm after {minutes} min",
            SixDigits((1e3 * place).round())
        ),
        false => format!("friction that falls with warmth, after {minutes} min"),
    };
    EffectFound {
        name: said.effect.to_owned(),
        summary,
        indistinguishable_from: Vec::new(),
        parameters,
        channel: said.acts_in.to_owned(),
        depends_on: "temperatures of the thermal network".to_owned(),
        share_of_gap: effect.gaps[1].reduction(),
        evidence: effect.evidence,
        size_on_check: None,
        runners_up: effect
            .rivals
            .iter()
            .map(|(rival, evidence)| (drift(rival.over), evidence[0]))
            .collect(),
        form: None,
    }
}

fn drift(over: DriftOver) -> String {
    format!("a drift with {}", over.name())
}

fn channel(said: &Said, gap: &HeatGap) -> ChannelGap {
    ChannelGap {
        channel: said.gap.to_owned(),
        before: gap.before,
        after: gap.after,
        floor: gap.noise,
        floor_most: gap.noise,
        floor_is_least: false,
    }
}

fn gap(both: &[(&Said, &HeatEffect)], part: usize) -> Gap {
    let of = |(said, effect): &(&Said, &HeatEffect)| channel(said, &effect.gaps[part]);
    let out: Vec<&HeatGap> = both
        .iter()
        .map(|(_, effect)| &effect.gaps[part])
        .filter(|gap| gap.stands_out())
        .collect();
    let gone: f64 = out.iter().map(|gap| gap.reduction()).sum();
    Gap {
        channels: both.iter().map(of).collect(),
        reduction: gone / out.len().max(1) as f64,
    }
}

fn notes(found: &HeatExplained, logs: &Logs) -> Vec<String> {
    let judged = match logs.check.is_empty() {
        true => format!("the last 25 % of {}", logs.fit.join(", ")),
        false => logs.check.join(", "),
    };
    let mut notes = vec![format!(
        "the figures are from {judged}, which is not fitted and also decides what is named"
    )];
    if found.growth.is_none() {
        notes.push("the logs have too few readings of growth (6 to fit, 3 to judge by): whether the screw grows is not answered; valid: place_mm and growth_um of a probe, or position_mm and motor_angle_rad".to_owned());
    }
    if found.warming.is_none() {
        notes.push("the logs have too few readings of the friction (6 to fit, 3 to judge by): whether it falls with warmth is not answered; valid: friction_w, or torque_n_m or iq_a beside a reference".to_owned());
    }
    notes
}

fn sentence(verdict: Verdict, both: &[(&Said, &HeatEffect)], effects: &[EffectFound]) -> String {
    let names: Vec<&str> = effects.iter().map(|effect| effect.name.as_str()).collect();
    let names = names.join(" and ");
    let drifts = both.iter().filter(|(_, effect)| effect.is_a_drift);
    let drifts: Vec<&str> = drifts.map(|(said, _)| said.acts_in).collect();
    let drifts = match drifts.is_empty() {
        true => String::new(),
        false => format!(
            " In the {} a drift with time or distance travelled does better than any temperature of the network.",
            drifts.join(" and the ")
        ),
    };
    match verdict {
        Verdict::Explained => {
            let they = if effects.len() > 1 { "they explain" } else { "it explains" };
            format!("The model lacks {names}: as states of the axis' thermal network, {they} the logs.")
        }
        Verdict::PartlyExplained => format!(
            "The model lacks {names}, as states of the axis' thermal network; a part of the gap is left.{drifts}"
        ),
        Verdict::Unknown => format!(
            "The logs differ from a machine without heat by more than noise, and neither growth nor friction that falls with warmth explains it as states of the axis' thermal network.{drifts}"
        ),
        _ => "Nothing is missing: neither growth nor friction that falls with warmth shows in these logs.".to_owned(),
    }
}

/// A gap that no state of the network explains, over time.
fn unknown(said: &Said, effect: &HeatEffect, found: &HeatExplained) -> Option<Unknown> {
    let gap = &effect.gaps[1];
    if !gap.stands_out() || gap.reduction() >= EXPLAINED {
        return None;
    }
    let of_growth = said.effect == GROWTH.effect;
    let residuals = found.residuals.iter().flatten();
    let longest = residuals
        .filter(|residual| residual.place.is_some() == of_growth)
        .max_by_key(|residual| residual.time.len())?;
    let best = effect
        .rivals
        .iter()
        .max_by(|a, b| a.1[1].total_cmp(&b.1[1]));
    let best = best.filter(|_| effect.is_a_drift);
    Some(Unknown {
        channel: said.acts_in.to_owned(),
        depends_on: best
            .map_or("time", |(rival, _)| rival.over.name())
            .to_owned(),
        formula: None,
        curve: Curve {
            variable: "time, s".to_owned(),
            unit: if of_growth { "m" } else { "W" }.to_owned(),
            at: longest.time.clone(),
            value: longest.after.clone(),
            within: vec![2.0 * gap.noise; longest.time.len()],
        },
        evidence: best.map_or([0.0; 2], |(_, evidence)| *evidence),
    })
}

fn levels(found: &HeatExplained) -> Vec<Recalibrated> {
    let one = |(name, level): (&str, f64)| Recalibrated {
        name: name.to_owned(),
        share: level - 1.0,
        tolerance: LEVEL_TOLERANCE,
        is_angle: false,
        by_logs: None,
    };
    let names = ["dry friction, cold", "viscous friction, cold"];
    let levels = names.into_iter().zip(found.levels);
    match found.warming {
        Some(_) => levels.map(one).collect(),
        None => Vec::new(),
    }
}

fn assessment(verdict: Verdict, effects: &[EffectFound]) -> Assessment {
    let is_wide = |p: &&ParameterFound| p.ci95[1] - p.ci95[0] > 0.5 * p.value.abs();
    let wide = effects.iter().flat_map(|effect| {
        // The falls share the size between them, and are poorly determined alone.
        let first = effect.parameters.iter().take(1).filter(is_wide);
        first.map(|p| [effect.name.clone(), p.name.clone()])
    });
    let wide: Vec<[String; 2]> = wide.collect();
    let level = match verdict {
        Verdict::Explained | Verdict::NothingMissing if wide.is_empty() => Level::High,
        Verdict::Unknown => Level::Low,
        _ => Level::Medium,
    };
    let remedy = |effect: &EffectFound| {
        let remedy = Remedy::of(&effect.name)?;
        let parameter = match effect.name == GROWTH.effect {
            true => {
                "growth predicted by the thermal network from the reference (heat --fit, heat --predict, compensate --after)"
            }
            false => "a plan with the friction of the predicted temperature (compensate --after)",
        };
        Some(RemedyFound {
            effect: effect.name.clone(),
            function: remedy.function,
            parameter: parameter.to_owned(),
        })
    };
    Assessment {
        cost: Cost::default(),
        each: Vec::new(),
        confidence: Confidence {
            level,
            at_edge: Vec::new(),
            wide,
            ambiguous: Vec::new(),
        },
        remedies: effects.iter().filter_map(remedy).collect(),
        controller: None,
    }
}

fn likeness(said: &Said, effect: &HeatEffect) -> Likeness {
    debug_assert!(Effect::named(said.effect).is_some());
    Likeness {
        name: said.effect.to_owned(),
        shown_from: Some(Shown {
            parameter: said.parameter.to_owned(),
            value: effect.limit,
            unit: said.unit.to_owned(),
        }),
        alike: Vec::new(),
    }
}

/// Residuals on what was not fitted.
fn overlays(found: &HeatExplained, logs: &Logs) -> Vec<Overlay> {
    let names = logs.fit.iter().chain(&logs.check);
    let one = |(name, residual): (&String, &HeatResidual)| {
        let channel = match residual.place {
            Some(place) => format!("growth_at_{}_mm_m", SixDigits((1e3 * place).round())),
            None => "friction_w".to_owned(),
        };
        Overlay {
            title: format!("{name}: {channel}"),
            channel,
            time: residual.time.clone(),
            before: residual.before.clone(),
            after: residual.after.clone(),
        }
    };
    let all = names.zip(&found.residuals);
    let all = all.flat_map(|(name, residuals)| residuals.iter().map(move |r| (name, r)));
    all.map(one).collect()
}
