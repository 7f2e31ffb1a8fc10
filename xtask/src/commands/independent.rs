//! `independent`: what the search makes of logs from a simulator that shares no code with
//! the library.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use axis_sim::Axis;
use axis_sim::effects::Effect;
use clap::Args;
use discrepancy::{Discovery, EffectFound, Evidence, Settings, Verdict};
use independent_axis::cases::{CASES, Case, named};
use independent_axis::{Rough, TrueEffect, Truth, Wanted, write_case};
use miette::{IntoDiagnostic, Result};
use serde::{Deserialize, Serialize};

use feed_axis::commands::discover::read_all;
use feed_axis::output::{ready, say, write_whole};

/// Options of the command.
#[derive(Args)]
pub struct Options {
    /// Case (may be repeated) [default: all]
    #[arg(long, value_name = "NAME")]
    case: Vec<String>,
    /// Seed of noise and of parameter errors
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// By torque balance, as without a controller
    #[arg(long)]
    balance: bool,
    /// Folder for the logs, one result a case, independent.json and independent.md; cases
    /// that this program has a result of there are not run again [default:
    /// runs/independent/seed-N, with --balance seed-N-balance]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads, 0 for all cores; results do not depend on it
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
}

/// A parameter as it was found and as it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Size {
    name: String,
    unit: String,
    value: f64,
    ci95: [f64; 2],
    /// `None` if the effect is not the hidden one.
    truth: Option<f64>,
}

/// An effect that was named.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Name {
    name: String,
    indistinguishable_from: Vec<String>,
    sizes: Vec<Size>,
}

/// What came of a case.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Outcome {
    /// Hash of the program that made it.
    made_by: String,
    truth: Truth,
    /// `None` if the search failed.
    verdict: Option<Verdict>,
    effects: Vec<Name>,
    /// Variable and formula of what has no name.
    unknown: Option<[String; 2]>,
    /// What is not as it should be; empty if all is right.
    wrong: Vec<String>,
    sentence: String,
    seconds: f64,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let _ = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads)
        .build_global();
    let chosen = options.case.iter().map(|name| named(name));
    let mut cases: Vec<&Case> = chosen.collect::<Result<_, _>>().into_diagnostic()?;
    if cases.is_empty() {
        cases = CASES.iter().collect();
    }
    let by = if options.balance { "-balance" } else { "" };
    let default = || Path::new("runs/independent").join(format!("seed-{}{by}", options.seed));
    let out = options.out.clone().unwrap_or_else(default);
    ready(&out)?;
    let made_by = feed_axis::program::key();
    let mut outcomes = Vec::new();
    for case in cases {
        let file = out.join(case.name).join("outcome.json");
        let outcome = match kept(&file, &made_by, options.seed) {
            Some(outcome) => outcome,
            None => {
                let outcome = try_case(case, options, &out.join(case.name), &made_by)?;
                let json = serde_json::to_vec_pretty(&outcome).into_diagnostic()?;
                write_whole(&file, &json)?;
                outcome
            }
        };
        say(line(&outcome))?;
        outcomes.push(outcome);
    }
    let json = serde_json::to_vec_pretty(&outcomes).into_diagnostic()?;
    write_whole(&out.join("independent.json"), &json)?;
    let right = outcomes.iter().filter(|o| o.wrong.is_empty()).count();
    let summary = format!("{right} of {} right", outcomes.len());
    let page = page(&outcomes, options, &summary);
    write_whole(&out.join("independent.md"), page.as_bytes())?;
    say(format!(
        "{summary}\n{}",
        out.join("independent.md").display()
    ))
}

fn kept(file: &Path, made_by: &str, seed: u64) -> Option<Outcome> {
    let outcome: Outcome = serde_json::from_slice(&std::fs::read(file).ok()?).ok()?;
    (outcome.made_by == made_by && outcome.truth.seed == seed).then_some(outcome)
}

fn try_case(case: &Case, options: &Options, folder: &Path, made_by: &str) -> Result<Outcome> {
    let truth = write_case(case, options.seed, Rough::default(), folder).into_diagnostic()?;
    let start = Instant::now();
    let found = searched(folder, options.balance);
    let seconds = start.elapsed().as_secs_f64();
    let (effects, unknown) = match &found {
        Ok(d) => (
            d.effects.iter().map(|e| name(e, &truth)).collect(),
            d.unknown.as_ref().map(|u| {
                let formula = u.formula.clone().unwrap_or_default();
                [u.depends_on.clone(), formula]
            }),
        ),
        Err(_) => (Vec::new(), None),
    };
    let mut outcome = Outcome {
        made_by: made_by.to_owned(),
        verdict: found.as_ref().ok().map(|d| d.verdict),
        sentence: match &found {
            Ok(d) => d.sentence.clone(),
            Err(e) => format!("failed: {e}"),
        },
        truth,
        effects,
        unknown,
        wrong: Vec::new(),
        seconds,
    };
    outcome.wrong = judged(&outcome);
    Ok(outcome)
}

/// The search over the logs of a folder, as `discover` does it.
fn searched(folder: &Path, by_balance: bool) -> Result<Discovery> {
    let mut machine = Axis::read(&folder.join("axis.toml"))?;
    if by_balance {
        machine = machine.without_control().into_diagnostic()?;
    }
    let mut notes = Vec::new();
    let mut logs = |names: [&str; 2]| {
        let paths = names.map(|name| folder.join(name));
        read_all(&paths, &machine, &mut notes)
    };
    let fit = logs(["fit-1.csv", "fit-2.csv"])?;
    let check = logs(["check-1.csv", "check-2.csv"])?;
    let evidence = Evidence::new(&machine, fit, check, Vec::new()).into_diagnostic()?;
    let say = |what: &str| tracing::debug!("{what}");
    let searched = evidence.discover(&machine, &Settings::default(), say);
    let (_, discovered) = searched.into_diagnostic()?;
    Ok(discovered.discovery)
}

/// The hidden effect of that name, or one that is as right.
fn hidden<'a>(truth: &'a Truth, name: &str) -> Option<&'a TrueEffect> {
    let mut all = truth.effects.iter().chain(&truth.also_right);
    all.find(|e| e.name == name)
}

fn name(found: &EffectFound, truth: &Truth) -> Name {
    let hidden = hidden(truth, &found.name);
    let of = |name: &str| hidden.and_then(|e| e.parameters.get(name).copied());
    let has_phase = found.parameters.iter().any(|p| p.name == "phase");
    // An amplitude below zero is one above, half a turn on.
    let flipped = has_phase
        && found
            .parameters
            .iter()
            .any(|p| p.name == "amplitude" && p.value < 0.0);
    let size = |p: &discrepancy::ParameterFound| {
        let mut size = Size {
            name: p.name.clone(),
            unit: p.unit.clone(),
            value: p.value,
            ci95: p.ci95,
            truth: of(&p.name),
        };
        if flipped && p.name == "amplitude" {
            size.value = -p.value;
            size.ci95 = [-p.ci95[1], -p.ci95[0]];
        }
        if p.name == "phase" {
            let half = if flipped { std::f64::consts::PI } else { 0.0 };
            let turns = (p.value + half - size.truth.unwrap_or(0.0)) / std::f64::consts::TAU;
            let by = half - turns.round() * std::f64::consts::TAU;
            size.value += by;
            size.ci95 = size.ci95.map(|end| end + by);
        }
        size
    };
    Name {
        name: found.name.clone(),
        indistinguishable_from: found.indistinguishable_from.clone(),
        sizes: found.parameters.iter().map(size).collect(),
    }
}

/// What is not as it should be.
fn judged(outcome: &Outcome) -> Vec<String> {
    let truth = &outcome.truth;
    let mut wrong = Vec::new();
    let wanted = match truth.verdict {
        Wanted::NothingMissing => Verdict::NothingMissing,
        Wanted::Explained => Verdict::Explained,
        Wanted::Unknown => Verdict::Unknown,
    };
    match outcome.verdict {
        Some(verdict) if verdict == wanted => {}
        Some(verdict) => wrong.push(format!("{}, not {}", verdict.name(), wanted.name())),
        None => wrong.push("the search failed".to_owned()),
    }
    let mut names = outcome.effects.iter();
    if !truth.effects.is_empty() {
        match names.next() {
            Some(first) if hidden(truth, &first.name).is_some() => wrong.extend(missed(first)),
            Some(first) => wrong.push(format!(
                "{} first, not {}",
                first.name, truth.effects[0].name
            )),
            None => wrong.push(format!("{} not named", truth.effects[0].name)),
        }
    }
    wrong.extend(names.map(|other| format!("{} named", other.name)));
    if truth.variable.is_some() {
        let product = |[variable, formula]: &[String; 2]| {
            variable.contains("position") && variable.contains("speed") || formula.contains("x·v")
        };
        if !outcome.unknown.as_ref().is_some_and(product) {
            wrong.push("the variable not found".to_owned());
        }
    }
    wrong
}

/// Sizes whose interval does not hold the truth; what shapes an effect is not judged.
fn missed(name: &Name) -> Vec<String> {
    let effect = Effect::named(&name.name);
    let is_size = |size: &&Size| {
        let own = effect.and_then(|e| e.parameters.iter().find(|p| p.name == size.name));
        own.is_none_or(|p| p.is_size())
    };
    let sizes = name.sizes.iter().filter(is_size);
    sizes
        .filter_map(|s| {
            let truth = s.truth?;
            let outside = !(s.ci95[0]..=s.ci95[1]).contains(&truth);
            outside.then(|| format!("{} of {truth:.4e} outside its interval", s.name))
        })
        .collect()
}

/// Named effects with their sizes and half intervals.
fn told(outcome: &Outcome) -> String {
    let one = |name: &Name| {
        let mut text = name.name.clone();
        for s in &name.sizes {
            let half = 0.5 * (s.ci95[1] - s.ci95[0]);
            let _ = write!(text, " {} = {:.4e} ± {half:.1e}", s.name, s.value);
        }
        if !name.indistinguishable_from.is_empty() {
            let _ = write!(text, " (or {})", name.indistinguishable_from.join(", "));
        }
        text
    };
    let mut all: Vec<String> = outcome.effects.iter().map(one).collect();
    if let Some([variable, formula]) = &outcome.unknown {
        all.push(format!("unknown over {variable} {formula}"));
    }
    all.join("; ")
}

fn verdict(outcome: &Outcome) -> &'static str {
    outcome.verdict.map_or("failed", Verdict::name)
}

fn line(outcome: &Outcome) -> String {
    let right = match outcome.wrong.as_slice() {
        [] => "right".to_owned(),
        wrong => format!("WRONG: {}", wrong.join("; ")),
    };
    format!(
        "{:<18} {:<16} {:>5.0} s  {right}\n{:>19}{}",
        outcome.truth.case,
        verdict(outcome),
        outcome.seconds,
        "",
        told(outcome)
    )
}

fn page(outcomes: &[Outcome], options: &Options, summary: &str) -> String {
    let seed = options.seed;
    let by = if options.balance { " --balance" } else { "" };
    let mut page = format!(
        "# Logs of an independent simulator\n\n`cargo xtask independent --seed {seed}{by}`: {summary}.\n\n\
         | case | hidden | verdict | named | right | s |\n|---|---|---|---|---|---|\n"
    );
    for o in outcomes {
        let words = named(&o.truth.case).map_or("", |c| c.words);
        let right = match o.wrong.as_slice() {
            [] => "yes".to_owned(),
            wrong => format!("no: {}", wrong.join("; ")),
        };
        let told = told(o).replace('|', "\\|");
        let _ = writeln!(
            page,
            "| {} | {words} | {} | {told} | {right} | {:.0} |",
            o.truth.case,
            verdict(o),
            o.seconds
        );
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(truth: Truth, verdict: Verdict, effects: Vec<Name>) -> Outcome {
        Outcome {
            made_by: String::new(),
            truth,
            verdict: Some(verdict),
            effects,
            unknown: None,
            wrong: Vec::new(),
            sentence: String::new(),
            seconds: 0.0,
        }
    }

    fn truth(verdict: Wanted, effects: Vec<TrueEffect>) -> Truth {
        Truth {
            case: "loop-viscous".to_owned(),
            seed: 1,
            verdict,
            effects,
            also_right: Vec::new(),
            variable: None,
            law: None,
            put_off: Default::default(),
            told_percent: 1.0,
        }
    }

    fn viscous(value: f64, half: f64) -> Name {
        Name {
            name: "viscous-friction".to_owned(),
            indistinguishable_from: Vec::new(),
            sizes: vec![Size {
                name: "coefficient".to_owned(),
                unit: "N*s/m".to_owned(),
                value,
                ci95: [value - half, value + half],
                truth: Some(5000.0),
            }],
        }
    }

    #[test]
    fn only_the_hidden_effect_alone_with_its_size_is_right() {
        let effect = TrueEffect::new("viscous-friction", &[("coefficient", 5000.0)]);
        let secret = || truth(Wanted::Explained, vec![effect.clone()]);
        let judge = |verdict, effects| judged(&outcome(secret(), verdict, effects)).len();
        assert_eq!(judge(Verdict::Explained, vec![viscous(4990.0, 20.0)]), 0);
        assert_eq!(judge(Verdict::Explained, vec![viscous(4900.0, 20.0)]), 1);
        let two = || vec![viscous(4990.0, 20.0), viscous(1.0, 1.0)];
        assert_eq!(judge(Verdict::Explained, two()), 1);
        assert_eq!(judge(Verdict::Unknown, Vec::new()), 2);
    }

    #[test]
    fn where_nothing_is_hidden_any_name_is_wrong() {
        let secret = || truth(Wanted::NothingMissing, Vec::new());
        let judge = |verdict, effects| judged(&outcome(secret(), verdict, effects));
        assert!(judge(Verdict::NothingMissing, Vec::new()).is_empty());
        assert!(!judge(Verdict::Unknown, Vec::new()).is_empty());
        assert!(!judge(Verdict::NothingMissing, vec![viscous(1.0, 1.0)]).is_empty());
    }
}
