//! `new`: a commented axis file to begin with.

mod commented;
mod programs;

use std::path::PathBuf;

use axis_sim::Axis;
use axis_sim::mechanism::MECHANISMS;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::Serialize;

use crate::exit::wrong_use;
use crate::out_file::spare;
use crate::output::{Worded, print, write_whole};
use crate::{program, shell};

/// An example of each kind of mechanism.
const EXAMPLES: [&str; 8] = [
    include_str!("../../../templates/ball-screw.toml"),
    include_str!("../../../templates/screw-datasheet.toml"),
    include_str!("../../../templates/rack.toml"),
    include_str!("../../../templates/belt.toml"),
    include_str!("../../../templates/joint.toml"),
    include_str!("../../../templates/linear-motor.toml"),
    include_str!("../../../templates/rotary-table.toml"),
    include_str!("../../../templates/rigid-mass.toml"),
];

/// Options of `new`.
#[derive(Args)]
pub struct Options {
    /// Name of the axis; the file is NAME.toml
    name: String,
    /// Mechanism, with an actuator, a controller, friction and sensors that suit it
    #[arg(long, value_parser = kinds())]
    kind: String,
    /// Folder for the file [default: the one in which the command runs]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write two motion programs besides, NAME-fit.toml and NAME-check.toml: there and back, to
    /// record logs for `discover`
    #[arg(long)]
    programs: bool,
    /// Overwrite existing files
    #[arg(long)]
    force: bool,
}

/// The kinds of mechanism, with what each is.
fn kinds() -> PossibleValuesParser {
    let value = |name: &'static str, summary: &'static str| PossibleValue::new(name).help(summary);
    PossibleValuesParser::new(MECHANISMS.iter().map(|kind| value(kind.name, kind.summary)))
}

/// What was written.
#[derive(Serialize)]
struct Written<'a> {
    file: PathBuf,
    kind: &'a str,
    trajectories: usize,
    /// Motion programs that were asked for.
    programs: Vec<PathBuf>,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let name = &options.name;
    let is_name = !name.is_empty() && !name.contains(['/', '\\', '\0', '\n']) && name != "..";
    if !is_name {
        return Err(wrong_use(format!(
            "\"{name}\" is not a name for an axis: give one without / and \\, and the folder with --out"
        )));
    }
    let file = PathBuf::from(format!("{name}.toml"));
    let file = match &options.out {
        Some(folder) => folder.join(file),
        None => file,
    };
    spare(&file, options.force)?;
    let (text, axis) = text(name, &options.kind)?;
    let mut motions = Vec::new();
    for (kind, purpose, shares) in programs::PROGRAMS {
        let path = file.with_file_name(format!("{name}-{kind}.toml"));
        if let Some(text) = programs::program(&axis, purpose, shares).filter(|_| options.programs) {
            spare(&path, options.force)?;
            motions.push((path, text));
        }
    }
    write_whole(&file, text.as_bytes())?;
    for (path, text) in &motions {
        write_whole(path, text.as_bytes())?;
    }
    let words = format!(
        "{}: {}, {} trajectories; next: {} simulate --axis {} --trajectory 1",
        file.display(),
        options.kind,
        axis.trajectories.len(),
        program::name(),
        shell::word(&file.display().to_string())
    );
    let value = Written {
        file,
        kind: &options.kind,
        trajectories: axis.trajectories.len(),
        programs: motions.into_iter().map(|(path, _)| path).collect(),
    };
    print("new", &Worded { text: words, value })
}

/// The text of an axis file, which is read back.
fn text(name: &str, kind: &str) -> Result<(String, Axis)> {
    let example = example(kind)?;
    let made_by = format!(
        "{} new {} --kind {kind}",
        program::name(),
        shell::word(name)
    );
    let text = commented::file(example, name, &made_by)?;
    let axis = Axis::parse(name, &text)
        .into_diagnostic()
        .wrap_err("the example of this kind is damaged")?;
    Ok((text, axis))
}

/// The example of a kind.
fn example(kind: &str) -> Result<&'static str> {
    for example in EXAMPLES {
        let axis = Axis::parse("example", example)?;
        if axis.mechanism.kind().name == kind {
            return Ok(example);
        }
    }
    Err(miette!("there is no example of the mechanism {kind}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The comments change no value, and no key of the kind is left untold.
    #[test]
    fn every_kind_has_a_file_that_means_what_its_example_means() {
        for kind in MECHANISMS {
            let (text, axis) = text("mine", kind.name).unwrap();
            let example = Axis::parse("example", example(kind.name).unwrap()).unwrap();
            assert_eq!(axis.fingerprint, example.fingerprint, "{text}");
            assert_eq!(axis.name, "mine");
            for key in kind.keys {
                let told = |line: &str| {
                    let line = line.trim_start_matches("# ");
                    let name = line.split(" =").next().unwrap();
                    key.spellings().iter().any(|spelling| spelling == name) && line.contains("  #")
                };
                assert!(text.lines().any(told), "{} in\n{text}", key.name());
            }
        }
    }

    /// What is commented out may stay so, and the unit in a comment is that of the key.
    #[test]
    fn a_limit_is_told_in_the_unit_of_its_key() {
        let (text, _) = text("mine", "belt").unwrap();
        let line = |start: &str| text.lines().find(|line| line.starts_with(start)).unwrap();
        let pulley = line("pulley_diameter_mm = ");
        assert!(pulley.contains("from 1 to 10000, in mm"), "{pulley}");
        let backlash = line("# backlash_mm = 0 ");
        assert!(backlash.contains("0 if left out"), "{backlash}");
    }
}
