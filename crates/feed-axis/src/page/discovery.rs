//! The page of a discovery: verdict, effects, gap, pictures.

use axis_report::{Block, Cell, Figure, Notice, Page, Section, Series, Table, fixed, render};
use axis_sim::Axis;
use discrepancy::summary::SummaryFound;
use discrepancy::{
    Against, Discovered, Discovery, EffectFound, FrictionCurve, Gap, NextExperiment, Overlay,
    ReadUnit, Unknown, Verdict, said_evidence,
};
use miette::{IntoDiagnostic, Result};

use super::channel::{files, words};

/// The page as HTML.
pub fn page(discovered: &Discovered) -> Result<String> {
    let discovery = &discovered.discovery;
    let kind = match discovery.verdict {
        Verdict::Explained | Verdict::NothingMissing | Verdict::OtherForm => Notice::Good,
        Verdict::PartlyExplained | Verdict::Unknown => Notice::Warn,
    };
    let answers = discovery.first_screen().into_iter();
    let answers = answers.map(|a| (a.question.to_owned(), a.lines)).collect();
    let notes = match discovery.notes.as_slice() {
        [] => None,
        notes => Some(Block::Folded {
            summary: "Notes on the logs".to_owned(),
            blocks: vec![Block::List(notes.iter().map(|n| format!("{n}.")).collect())],
        }),
    };
    let further = [
        discovery.unknown.as_ref().map(unknown),
        discovery.next_experiment.as_ref().map(next),
    ];
    let page = Page::new(format!("What the model of {} lacks", discovery.axis))
        .lead(lead(discovery))
        .first(Block::Notice(kind, discovery.sentence.clone()))
        .first(Block::Answers(answers));
    let page = notes.into_iter().fold(page, Page::first);
    // What a reader looks for first: what was off, and what is now.
    let page = page
        .section(pictures(&discovered.overlays))
        .section(gaps(discovery))
        .section(effects(discovery));
    let friction = discovered.friction.as_ref().map(friction);
    let page = friction.into_iter().fold(page, Page::section);
    let against = Some(&discovered.against).filter(|all| !all.is_empty());
    let page = [against.map(|all| dependences(all))]
        .into_iter()
        .chain(further)
        .flatten()
        .chain([likenesses(discovery), known(discovery)])
        .fold(page, Page::section);
    render(&page).into_diagnostic()
}

/// How the logs were compared.
fn lead(discovery: &Discovery) -> &'static str {
    match discovery.answer.as_str() {
        "torque-balance" => {
            "The torque that the model needs for the logged motion, compared with the logged torque: the residual, and which effect explains it."
        }
        "thermal-network" => {
            "Growth and the friction's power in logs of hours, compared with a machine without heat and with the states of the axis' thermal network."
        }
        _ => {
            "Logs replayed through the simulated closed loop: the residual, and which effect explains it."
        }
    }
}

/// Values in a unit for people.
fn read(values: &[f64], unit: &ReadUnit) -> Vec<f64> {
    values.iter().map(|v| unit.factor * v).collect()
}

/// The unit for people in which the largest of these is read.
fn unit_of(values: &[f64], si: &str) -> ReadUnit {
    ReadUnit::of(si, values.iter().fold(0.0, |most, v| most.max(v.abs())))
}

/// Friction over speed, to both sides, and where it counts from low speed on.
fn friction(law: &FrictionCurve) -> Section {
    let both = friction_over(law, |_| true, "Friction over speed");
    let low = friction_over(law, |v| v > 0.0, "The same from low speed on").log_x();
    let figures = match law.at_low_speed {
        true => vec![both, low],
        false => vec![both],
    };
    let section = Section::new("Friction over speed").paragraph("Steady force on the load against its motion. Dots: friction as the check logs show it, which is the law with all named effects plus the mean residual in each range of speed.");
    match figures.len() {
        1 => figures.into_iter().fold(section, Section::figure),
        columns => section.figure_grid(figures, columns),
    }
}

fn friction_over(law: &FrictionCurve, kept: fn(f64) -> bool, title: &str) -> Figure {
    let [speed_unit, force_unit] = [
        unit_of(&law.speed, &law.speed_unit),
        unit_of(&law.with, &law.force_unit),
    ];
    let series = |name: &str, speeds: &[f64], forces: &[f64]| {
        let pairs = speeds.iter().zip(forces).filter(|(v, _)| kept(**v));
        let (x, y): (Vec<f64>, Vec<f64>) = pairs.unzip();
        Series::line(name, read(&x, &speed_unit), read(&y, &force_unit))
    };
    let [speeds, forces] = &law.measured;
    let dots = series("from the logs", speeds, forces);
    let dots = Series::dots(dots.name, dots.x, dots.y);
    let all = [
        series("model as in the axis file", &law.speed, &law.own).dashed(),
        series("with the named effects", &law.speed, &law.with),
        series("in the form found", &law.speed, &law.formed),
        dots,
    ];
    let figure = Figure::new(title, "speed", "friction").units(speed_unit.name, force_unit.name);
    let shown = all.into_iter().filter(|series| !series.x.is_empty());
    shown.fold(figure, Figure::series)
}

fn effects(discovery: &Discovery) -> Section {
    let mut table = Table::new(
        "Named effects, largest share of the gap first",
        [
            "Effect",
            "shows in",
            "depends on",
            "parameter",
            "value and 95 % interval",
            "share of gap",
            "look-alikes",
            "in SI",
        ],
    );
    for effect in &discovery.effects {
        for p in &effect.parameters {
            table = table.row([
                Cell::text(effect.name.clone()),
                Cell::text(effect.channel.clone()),
                Cell::text(effect.depends_on.clone()),
                Cell::text(p.name.clone()),
                Cell::text(
                    ReadUnit::of_parameter(&p.name, &p.unit, p.value).said_within(p.value, p.ci95),
                ),
                Cell::text(format!("{} %", fixed(100.0 * effect.share_of_gap, 1))),
                Cell::text(effect.indistinguishable_from.join(", ")),
                Cell::text(format!("{:.5e} {}", p.value, p.unit)),
            ]);
        }
    }
    let mut others = Table::new(
        "What else was tried, and what was left out",
        ["In place of", "effect", "evidence"],
    )
    .note("Evidence is the fall of −2 log L on the fit logs: twice the natural logarithm of how many times more likely they are with the effect than without, so that 25 is a factor of 270 000. The named effect reached the greatest, or about as much with fewer parameters.");
    for effect in &discovery.effects {
        for (name, gain) in &effect.runners_up {
            others = others.row([
                Cell::text(effect.name.clone()),
                Cell::text(name.clone()),
                Cell::text(said_evidence(*gain)),
            ]);
        }
    }
    for (name, gain) in &discovery.not_added {
        others = others.row([
            Cell::text("(not added)"),
            Cell::text(name.clone()),
            Cell::text(said_evidence(*gain)),
        ]);
    }
    let section = Section::new("Effects");
    let section = match discovery.effects.as_slice() {
        [] => section.paragraph("None is named."),
        _ => section.table(table),
    };
    let has_others = |e: &EffectFound| !e.runners_up.is_empty();
    let has_others = !discovery.not_added.is_empty() || discovery.effects.iter().any(has_others);
    let section = match has_others {
        true => section.table(others),
        false => section,
    };
    if discovery.replaced.is_empty() {
        return section;
    }
    let mut replaced = Table::new(
        "Named at first, then replaced",
        ["Effect", "parameter", "value then", "replaced by"],
    )
    .note("Beside the effects that were named later, the one in the last column explains the logs as well.");
    for effect in &discovery.replaced {
        for (name, value, unit) in &effect.when_named {
            replaced = replaced.row([
                Cell::text(effect.name.clone()),
                Cell::text(name.clone()),
                Cell::text(ReadUnit::of_parameter(name, unit, *value).said(*value)),
                Cell::text(effect.by.clone()),
            ]);
        }
    }
    section.table(replaced)
}

fn gaps(discovery: &Discovery) -> Section {
    let table = |title: &str, gap: &Gap| {
        let mut table = Table::new(title, ["Channel", "before", "after", "noise"]);
        for c in &gap.channels {
            let unit = ReadUnit::of_channel(&c.channel, c.before);
            table = table.row([
                Cell::text(c.channel.clone()),
                Cell::text(unit.said(c.before)),
                Cell::text(unit.said(c.after)),
                Cell::text(unit.said(c.floor)),
            ]);
        }
        table.note(match gap.stands_out() {
            true => format!(
                "{} % of the gap above the noise is gone.",
                fixed(100.0 * gap.reduction, 1)
            ),
            false => "No channel exceeded its noise by more than a fifth.".to_owned(),
        })
    };
    Section::new("Gap, RMS")
        .table(table("Motion not used in the fit", &discovery.gap.check))
        .table(table("Fit motion", &discovery.gap.fit))
}

fn pictures(overlays: &[Overlay]) -> Section {
    let figure = |o: &Overlay| {
        let most = o.before.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let unit = ReadUnit::of_channel(&o.channel, most);
        // No line over samples that are left out of a torque balance.
        let is_whole = is_whole(&o.time);
        let series = |name, gap: &[f64]| {
            let (time, gap) = (o.time.clone(), read(gap, &unit));
            match is_whole {
                true => Series::line(name, time, gap),
                false => Series::dots(name, time, gap),
            }
        };
        let log = o.title.trim_end_matches(&o.channel);
        let name = words(&o.channel);
        Figure::new(
            format!(
                "{}: {name} ({})",
                files(log.trim_end_matches(": ")),
                o.channel
            ),
            "time",
            // The title has the quantity; a phone has no room for it beside the axis.
            "log − model",
        )
        .units("s", &unit.name)
        .linked(log)
        .series(series("before", &o.before))
        .series(series("after", &o.after))
    };
    Section::new("The gap before and after, on motion not used in the fit")
        .paragraph("Before: known parameters moved within their tolerances, no effect added. After: with the named effects.")
        .figure_grid(overlays.iter().map(figure).collect(), 2)
}

/// Whether no sample is left out between others.
fn is_whole(time: &[f64]) -> bool {
    let steps = || time.windows(2).map(|pair| pair[1] - pair[0]);
    let shortest = steps().fold(f64::INFINITY, f64::min);
    steps().all(|step| step < 1.5 * shortest)
}

fn dependences(all: &[Against]) -> Section {
    let figure = |a: &Against| {
        let over = unit_of(&a.at, &a.variable_unit);
        let unit = unit_of(&a.without, &a.unit);
        let series =
            |name, means: &[f64]| Series::line(name, read(&a.at, &over), read(means, &unit));
        Figure::new(
            format!("{}: {} ({})", a.effect, words(&a.channel), a.channel),
            a.variable.clone(),
            "log − model",
        )
        .units(&over.name, &unit.name)
        .series(series("without it", &a.without))
        .series(series("with it", &a.with))
    };
    Section::new("The residual, against what each effect depends on")
        .paragraph("Check motion, means over ranges of that variable, a torque as the force on the load; all other named effects are in the model both times.")
        .figure_grid(all.iter().map(figure).collect(), 2)
}

fn likenesses(discovery: &Discovery) -> Section {
    let mut table = Table::new(
        "Every effect of the library on the fit motion",
        ["Effect", "detection limit, about", "its response is reproduced by"],
    )
    .note("Detection limit: the size that the search would name despite noise and uncertain known parameters, if the response is linear; a dash if an effect has several sizes, or if ten times its typical size would not show. While the residual is within 0.2 % of what each channel shows (of a position: of the tracking error), nothing is named, whatever the limits. In brackets the sine of the largest angle between the two responses; below 0.15 they form one class.");
    for l in &discovery.likenesses {
        let shown = l.shown_from.as_ref().map_or("–".to_owned(), |s| {
            ReadUnit::of_parameter(&s.parameter, &s.unit, s.value).said(s.value)
        });
        let alike = l
            .alike
            .iter()
            .map(|(name, sine)| format!("{name} ({sine:.2})"));
        table = table.row([
            Cell::text(l.name.clone()),
            Cell::text(shown),
            Cell::text(alike.collect::<Vec<_>>().join(", ")),
        ]);
    }
    Section::new("What these logs can show").table(table)
}

fn unknown(unknown: &Unknown) -> Section {
    let curve = &unknown.curve;
    let unit = unit_of(&curve.value, &curve.unit);
    let (variable, si) = curve
        .variable
        .rsplit_once(", ")
        .unwrap_or((curve.variable.as_str(), ""));
    let over = unit_of(&curve.at, si);
    let at = || read(&curve.at, &over);
    let edge = |sign: f64| -> Vec<f64> {
        let pairs = curve.value.iter().zip(&curve.within);
        pairs.map(|(v, w)| unit.factor * (v + sign * w)).collect()
    };
    let figure = Figure::new(
        format!("Against {}", unknown.depends_on),
        variable,
        "missing",
    )
    .units(&over.name, &unit.name)
    .series(Series::line("estimate", at(), edge(0.0)));
    let figure = if curve.within.iter().any(|w| *w > 0.0) {
        figure
            .series(Series::line("95 % from", at(), edge(-1.0)).dashed())
            .series(Series::line("to", at(), edge(1.0)).dashed())
    } else {
        figure
    };
    let fall = match unknown.evidence {
        [0.0, check] => format!("{} on the check logs", said_evidence(check)),
        [fit, check] => format!(
            "{} on the fit logs, {} on the check logs",
            said_evidence(fit),
            said_evidence(check)
        ),
    };
    Section::new("What no effect of the library explains")
        .paragraph(format!(
            "It acts in the {} and depends on {}. {}",
            unknown.channel,
            unknown.depends_on,
            unknown.formula.clone().unwrap_or_else(|| {
                "No short formula describes it as well as the curve.".to_owned()
            })
        ))
        .paragraph(format!(
            "Evidence (fall of −2 log L): {fall}. Chance alone reaches some tens."
        ))
        .figure(figure)
}

fn next(next: &NextExperiment) -> Section {
    Section::new("Next experiment").paragraph(format!(
        "{}: it separates {} from {}. {}. The motion is in next-experiment.toml, for the command simulate (--program) and for the machine.",
        capital(&next.what), next.separates[0], next.separates[1], next.said()
    ))
}

fn capital(text: &str) -> String {
    let mut chars = text.chars();
    let first = chars.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + chars.as_str()
}

fn known(discovery: &Discovery) -> Section {
    let mut table = Table::new(
        "Known parameters, moved within their tolerances",
        ["Parameter", "moved by", "tolerance, ±"],
    );
    for k in &discovery.recalibrated {
        table = table.row([
            Cell::text(k.name.clone()),
            Cell::text(k.moved()),
            Cell::text(k.within()),
        ]);
    }
    Section::new("Known parameters").table(table)
}

/// The page of a table of errors.
pub fn summary_page(axis: &Axis, found: &SummaryFound) -> Result<String> {
    let mut table = Table::new(
        "Effects by how far each alone closes the gap",
        ["Effect", "RMS gap left", "parameters"],
    )
    .note(format!("Without any: {:.2} %.", 100.0 * found.before));
    for c in &found.ranked {
        let values: Vec<String> = c
            .parameters
            .iter()
            .map(|(n, v, u)| format!("{n} {}", ReadUnit::of_parameter(n, u, *v).said(*v)))
            .collect();
        table = table.row([
            Cell::text(c.name.clone()),
            Cell::text(format!("{:.2} %", 100.0 * c.gap)),
            Cell::text(values.join(", ")),
        ]);
    }
    let page = Page::new(format!("What the model of {} lacks", axis.name))
        .lead("From a table of maximum and mean errors: one effect at a time, all relative gaps alike.")
        .section(Section::new("Ranking").table(table));
    render(&page).into_diagnostic()
}
