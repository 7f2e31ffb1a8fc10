//! What `discover` says: for people, and as JSON.

use std::fmt;
use std::path::{Path, PathBuf};

use axis_sim::Axis;
use axis_sim::friction::FrictionPlace;
use discrepancy::summary::SummaryFound;
use discrepancy::{Discovery, Verdict};
use serde::Serialize;

use super::discover_files::{AXIS, DISCOVERY, NEXT, REPORT};

/// What a search found, and where it is written.
#[derive(Serialize)]
pub struct Found<'a> {
    /// discovery.json.
    #[serde(flatten)]
    pub discovery: &'a Discovery,
    /// What was added to the axis file, for people.
    #[serde(skip)]
    pub added: String,
    /// Files that were written.
    pub files: Files,
}

/// Files of a search.
#[derive(Serialize)]
pub struct Files {
    discovery: PathBuf,
    axis: PathBuf,
    report: PathBuf,
    next_experiment: Option<PathBuf>,
}

impl Files {
    /// The files in a folder.
    pub fn of(out: &Path, has_next: bool) -> Self {
        Self {
            discovery: out.join(DISCOVERY),
            axis: out.join(AXIS),
            report: out.join(REPORT),
            next_experiment: has_next.then(|| out.join(NEXT)),
        }
    }
}

/// What a table of errors ranks, and its page.
#[derive(Serialize)]
pub struct FoundInSummary<'a> {
    /// summary.json.
    #[serde(flatten)]
    pub found: &'a SummaryFound,
    /// The page.
    pub report: PathBuf,
}

impl fmt::Display for Found<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let discovery = self.discovery;
        writeln!(f, "\n{}", discovery.sentence)?;
        for answered in discovery.first_screen() {
            writeln!(f, "\n{}", answered.question)?;
            for line in &answered.lines {
                writeln!(f, "  {line}")?;
            }
        }
        self.numbers(f)?;
        self.gaps(f)?;
        if !self.added.is_empty() {
            writeln!(f, "\nadded to the axis file (which has all digits):")?;
            for line in self.added.trim_start().lines() {
                writeln!(f, "+ {line}")?;
            }
        }
        self.next(f)?;
        write!(f, "\n{}", self.files.report.display())
    }
}

impl Found<'_> {
    /// The sizes of what was named, and what was named on the way.
    fn numbers(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "\nThe numbers in SI")?;
        for effect in &self.discovery.effects {
            writeln!(f, "{} ({})", effect.name, effect.channel)?;
            for p in &effect.parameters {
                let [low, high] = p.ci95;
                write!(
                    f,
                    "  {} = {:.5e} {}   95 %: {low:.5e} to {high:.5e}",
                    p.name, p.value, p.unit
                )?;
                match &p.at_screw {
                    Some(s) => writeln!(f, "   at the motor {:.4e} {}", s.value, s.unit)?,
                    None => writeln!(f)?,
                }
            }
        }
        for effect in &self.discovery.replaced {
            let values = effect.when_named.iter();
            let values: Vec<String> = values
                .map(|(name, value, unit)| format!("{name} = {value:.4e} {unit}"))
                .collect();
            writeln!(
                f,
                "{} ({}) was named at first, then replaced: beside the other effects, {} explains the logs as well",
                effect.name,
                values.join(", "),
                effect.by
            )?;
        }
        Ok(())
    }

    /// The gap on motion that was not fitted.
    fn gaps(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "\nRMS gap, motion not in the fit    before        after        noise"
        )?;
        for c in &self.discovery.gap.check.channels {
            writeln!(
                f,
                "  {:<24} {:>12.4e} {:>12.4e} {:>12.4e}",
                c.channel, c.before, c.after, c.floor
            )?;
        }
        Ok(())
    }

    /// What to do next.
    fn next(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let discovery = self.discovery;
        if let (Some(next), Some(file)) = (&discovery.next_experiment, &self.files.next_experiment)
        {
            writeln!(
                f,
                "\nNext experiment: {}. It separates {} from {}. {}:\n  {}",
                next.what,
                next.separates[0],
                next.separates[1],
                next.said(),
                file.display()
            )?;
        }
        if matches!(
            discovery.verdict,
            Verdict::PartlyExplained | Verdict::Unknown
        ) {
            writeln!(
                f,
                "\nSearch again: --reject NAME leaves an effect out, --accept NAME has one in the model from the start."
            )?;
        }
        Ok(())
    }
}

/// A ranking by a table of errors, as people read it.
pub fn summary_words(axis: &Axis, found: &SummaryFound, trajectories: usize) -> String {
    let mut lines = Vec::new();
    lines.push(format!(
        "RMS gap over {} figures, model as its file says: {:.2} %\n",
        2 * trajectories,
        100.0 * found.before
    ));
    let r = axis.travel_per_radian();
    for (place, closing) in found.ranked.iter().take(8).enumerate() {
        let values: Vec<String> = closing
            .parameters
            .iter()
            .map(|(n, v, u)| format!("{n} {v:.4e} {u}"))
            .collect();
        lines.push(format!(
            "{}. {:<28} leaves {:>6.2} %   {}",
            place + 1,
            closing.name,
            100.0 * closing.gap,
            values.join(", ")
        ));
        if closing.name == "viscous-friction" && axis.friction.at == FrictionPlace::Motor {
            let total = axis.friction.law.parameters().viscous + closing.parameters[0].1 * r * r;
            let rpm = std::f64::consts::TAU / 60.0;
            lines.push(format!(
                "   with the file's own: σ2 = {:.5} N·m/rpm at the motor",
                total * rpm
            ));
        }
    }
    lines.push("\nA table of errors has no noise floor and cannot tell apart effects that close the gap alike; logs can (--fit, --check).".to_owned());
    lines.join("\n") + "\n"
}
