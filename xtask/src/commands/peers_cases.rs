//! `peers-cases`: cases of the second matrix as folders of files, for other programs to search.

use std::path::{Path, PathBuf};

use axis_log::write_csv;
use axis_sim::Axis;
use axis_sim::effects::{Effect, Scales};
use clap::Args;
use discover_matrix::matrix2::{Bench, Case, Channels, Given, Reach, peer_cases};
use miette::{IntoDiagnostic, Result, WrapErr};
use serde::{Deserialize, Serialize};
use toml_edit::{DocumentMut, Item, Table, value};

use super::matrix_options::MACHINES;
use feed_axis::context::read_text;
use feed_axis::output::{ready, say, write_whole};

/// Options of the command.
#[derive(Args)]
pub struct Options {
    /// Version of the matrix
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(2..=2))]
    version: u32,
    /// Axis files, taken in turn
    #[arg(long, value_name = "FILE", num_args = 1.., default_values = MACHINES)]
    machines: Vec<PathBuf>,
    /// Cases, rounded up to a multiple of four
    #[arg(long, value_name = "N", default_value_t = 40, value_parser = clap::value_parser!(u32).range(1..=400))]
    cases: u32,
    /// Seed of the cases, noise and known parameters
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Only the first N of them
    #[arg(long, value_name = "N")]
    first: Option<usize>,
    /// Folder for cases.json and a folder a case: fit.csv, check.csv, axis.toml and told.json
    /// for the search, truth.json for the score. A case that this program wrote is left as it
    /// is
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// What a searcher is told beside axis file and logs.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Told {
    machine: String,
    /// Share by which each known parameter may be off.
    tolerance: f64,
    /// Whether nothing of the controller is to be used: `discover --balance`.
    balance: bool,
    channels: Vec<String>,
    /// Time between samples, s.
    period_s: f64,
}

/// A number of what is hidden.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Number {
    name: String,
    value: f64,
    unit: String,
    /// Whether the effect vanishes with it.
    size: bool,
}

/// What is hidden.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct HiddenTruth {
    name: String,
    /// The law in words, of one outside the library.
    law: Option<String>,
    /// On what it depends.
    depends_on: String,
    numbers: Vec<Number>,
    /// Whether a search that knows all of it could see it.
    seen: bool,
    /// Effects of the library that these logs cannot tell from it.
    alike: Vec<String>,
}

/// The truth of a case.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct TruthFile {
    /// Hash of the program and the axis file that wrote it.
    made_by: String,
    /// Of logs, axis file and what is told.
    files: String,
    id: String,
    /// [`Reach::name`].
    reach: String,
    hidden: Vec<HiddenTruth>,
    /// How a law of the truth differs from the model's, and names that say so, which are
    /// neither right nor wrong.
    form: String,
    neither: Vec<String>,
    noise: String,
    /// Known parameters and the share by which each is off.
    known_off: Vec<(String, f64)>,
    case: Case,
}

/// What was written, in order.
#[derive(Serialize)]
struct Index<'a> {
    version: u32,
    seed: u64,
    chosen: &'static str,
    cases: Vec<&'a str>,
}

const CHOSEN: &str = "four of each plot: clean; two effects that are sums of terms; by turns an effect that is none, \
and a law outside the library. Of 16 single effects drawn a plot those taken least often before, first drawn first";

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let read = |file: &PathBuf| -> Result<(String, Axis)> {
        Ok((read_text(file)?, Axis::read(file).into_diagnostic()?))
    };
    let files: Vec<(String, Axis)> = options.machines.iter().map(read).collect::<Result<_>>()?;
    let machines: Vec<Axis> = files.iter().map(|(_, axis)| axis.clone()).collect();
    let mut cases =
        peer_cases(&machines, options.cases as usize, options.seed).into_diagnostic()?;
    cases.truncate(options.first.unwrap_or(cases.len()));
    ready(&options.out)?;
    let writers = cases.chunk_by(|a, b| a.plot == b.plot);
    for plot in writers {
        let of_plot = |(_, axis): &&(String, Axis)| axis.name == plot[0].setting.machine;
        if let Some((text, axis)) = files.iter().find(of_plot) {
            write_plot(&options.out, text, axis, plot)?;
        }
    }
    let index = Index {
        version: options.version,
        seed: options.seed,
        chosen: CHOSEN,
        cases: cases.iter().map(|c| c.id.as_str()).collect(),
    };
    let json = serde_json::to_vec_pretty(&index).into_diagnostic()?;
    write_whole(&options.out.join("cases.json"), &json)
}

/// Cases of one plot, which share what is made beforehand.
fn write_plot(out: &Path, text: &str, axis: &Axis, plot: &[Case]) -> Result<()> {
    let mut bench = None;
    for case in plot {
        let folder = out.join(&case.id);
        if is_whole(&folder, axis, case) {
            continue;
        }
        let bench = match &mut bench {
            Some(bench) => bench,
            none => none.insert(Bench::new(axis, &case.setting).into_diagnostic()?),
        };
        let given = bench.given(case).into_diagnostic().wrap_err_with(|| {
            format!(
                "case {} cannot be simulated; leave it out with another seed",
                case.id
            )
        })?;
        write_case(&folder, text, axis, &given)?;
        say(folder.display().to_string())?;
    }
    Ok(())
}

fn made_by(axis: &Axis) -> String {
    let inputs = feed_axis::program::inputs();
    inputs.with("axis", axis.fingerprint.as_str()).key()
}

/// Whether a folder holds this case, written by this program and not changed since.
fn is_whole(folder: &Path, axis: &Axis, case: &Case) -> bool {
    let text = std::fs::read(folder.join(TRUTH)).unwrap_or_default();
    let truth: Option<TruthFile> = serde_json::from_slice(&text).ok();
    truth.is_some_and(|t| {
        t.made_by == made_by(axis) && t.case.is_same(case) && hash(folder).ok() == Some(t.files)
    })
}

const TRUTH: &str = "truth.json";
const SHOWN: [&str; 4] = ["fit.csv", "check.csv", "axis.toml", "told.json"];

/// BLAKE3 of what a searcher is given.
fn hash(folder: &Path) -> std::io::Result<String> {
    let mut hasher = blake3::Hasher::new();
    for name in SHOWN {
        hasher.update(&std::fs::read(folder.join(name))?);
    }
    Ok(hasher.finalize().to_hex().to_string())
}

/// The truth last: a folder without it is not whole.
fn write_case(folder: &Path, text: &str, axis: &Axis, given: &Given) -> Result<()> {
    ready(folder)?;
    for (name, log) in SHOWN.iter().zip(&given.logs) {
        write_csv(folder.join(name), log).into_diagnostic()?;
    }
    let setting = &given.case.setting;
    let told_axis = told_axis(text, setting.tolerance)?;
    write_whole(&folder.join("axis.toml"), told_axis.as_bytes())?;
    let told = Told {
        machine: axis.name.clone(),
        tolerance: setting.tolerance,
        balance: setting.channels == Channels::Balance,
        channels: given.logs[0]
            .channels()
            .iter()
            .map(|c| c.name.clone())
            .collect(),
        period_s: given.period,
    };
    let json = serde_json::to_vec_pretty(&told).into_diagnostic()?;
    write_whole(&folder.join("told.json"), &json)?;
    let truth = TruthFile {
        files: hash(folder).into_diagnostic()?,
        ..truth(axis, given)
    };
    let json = serde_json::to_vec_pretty(&truth).into_diagnostic()?;
    write_whole(&folder.join(TRUTH), &json)
}

/// The axis file with the case's tolerance; it names no file beside it. Where a motion starts
/// is in its log, and the file's own trajectories may not fit on the stroke from there.
fn told_axis(text: &str, tolerance: f64) -> Result<String> {
    let mut document: DocumentMut = text.parse().into_diagnostic()?;
    document.remove("experiment");
    let mut tolerances = Table::new();
    tolerances.insert("known_parameters_percent", value(100.0 * tolerance));
    document.insert("tolerances", Item::Table(tolerances));
    Ok(document.to_string())
}

/// All but the hash of what is shown.
fn truth(axis: &Axis, given: &Given) -> TruthFile {
    let case = &given.case;
    let scales = Scales::of(axis);
    let hidden = case
        .hidden
        .iter()
        .zip(&given.predicted)
        .map(|(hidden, predicted)| {
            let effect = Effect::named(&hidden.name);
            let parameters = effect.map_or(&[][..], |e| e.parameters);
            let numbers = parameters
                .iter()
                .zip(&hidden.values)
                .map(|(p, &value)| Number {
                    name: p.name.to_owned(),
                    value,
                    unit: p.unit(&scales).to_owned(),
                    size: p.is_size(),
                });
            let of_law = case.law.iter().flat_map(|law| law.variables());
            let of_law: Vec<&str> = of_law.map(|v| v.words()).collect();
            HiddenTruth {
                name: hidden.name.clone(),
                law: case.law.as_ref().map(|law| law.name()),
                depends_on: effect.map_or(of_law.join(", "), |e| e.depends_on.to_owned()),
                numbers: numbers.collect(),
                seen: predicted.as_ref().is_some_and(|f| f.detectable),
                alike: predicted.as_ref().map_or(Vec::new(), |f| f.class.clone()),
            }
        });
    TruthFile {
        made_by: made_by(axis),
        files: String::new(),
        id: case.id.clone(),
        reach: Reach::of(case).name().to_owned(),
        hidden: hidden.collect(),
        form: case.form.name().to_owned(),
        neither: case.form.said_by().iter().map(|&n| n.to_owned()).collect(),
        noise: format!("{} × {:.1}", case.noise.name(), case.noise.level),
        known_off: axis
            .known()
            .into_iter()
            .map(str::to_owned)
            .zip(given.shares.iter().copied())
            .collect(),
        case: case.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use axis_log::read_csv;
    use discover_matrix::hidden::Rough;

    fn file() -> PathBuf {
        PathBuf::from(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../data/axes/linear-motor.toml"
        ))
    }

    /// A torque balance of the slide, which takes no prediction in a loop.
    fn written(out: &Path) -> (Axis, Case, Given) {
        let (text, axis) = (read_text(&file()).unwrap(), Axis::read(&file()).unwrap());
        let all = peer_cases(std::slice::from_ref(&axis), 4, 3).unwrap();
        let mut case = all
            .into_iter()
            .find(|c| Reach::of(c) == Reach::InTerms)
            .unwrap();
        case.setting.channels = Channels::Balance;
        case.noise = Rough::white(1.0);
        write_plot(out, &text, &axis, std::slice::from_ref(&case)).unwrap();
        let given = Bench::new(&axis, &case.setting)
            .unwrap()
            .given(&case)
            .unwrap();
        (axis, case, given)
    }

    #[test]
    fn a_case_comes_back_from_its_folder() {
        let out = tempfile::tempdir().unwrap();
        let (axis, case, given) = written(out.path());
        let folder = out.path().join(&case.id);
        // Logs, bit for bit, and no channel more than the case shows.
        for (name, log) in SHOWN.iter().zip(&given.logs) {
            let back = read_csv(folder.join(name), &[]).unwrap();
            assert_eq!(back.channels().len(), 3);
            for channel in log.channels() {
                assert_eq!(back.channel(&channel.name).unwrap(), channel.samples);
            }
        }
        // The axis as the bench tells it to the search.
        let told = Axis::read(&folder.join("axis.toml")).unwrap();
        assert_eq!(
            told.tolerances,
            axis_sim::Tolerances::all(case.setting.tolerance)
        );
        assert_eq!(told.known(), axis.known());
        // The truth is that of the logs.
        let truth: TruthFile =
            serde_json::from_slice(&std::fs::read(folder.join(TRUTH)).unwrap()).unwrap();
        assert_eq!(truth.case, given.case);
        assert_eq!(truth.hidden[0].name, case.hidden[0].name);
        let sizes: Vec<f64> = truth.hidden[0].numbers.iter().map(|n| n.value).collect();
        assert_eq!(sizes, given.case.hidden[0].values);
        assert!(
            truth
                .known_off
                .iter()
                .all(|(_, off)| off.abs() <= case.setting.tolerance)
        );
    }

    #[test]
    fn a_changed_case_is_written_again() {
        let out = tempfile::tempdir().unwrap();
        let (axis, case, _) = written(out.path());
        let folder = out.path().join(&case.id);
        assert!(is_whole(&folder, &axis, &case));
        std::fs::write(folder.join("check.csv"), "t_s\n").unwrap();
        assert!(!is_whole(&folder, &axis, &case));
    }
}
