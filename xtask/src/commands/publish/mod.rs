//! `publish --dry-run`: what publishing all crates would do, in its order, without doing it.
//!
//! It asks of each crate what crates.io does ([`demands`]), then lets cargo make and build all
//! packages of a copy ([`copy`]): cargo 1.90 or later takes those that are not published yet from
//! each other. It never publishes; a person does.

mod copy;
mod demands;

use std::collections::BTreeMap;
use std::path::Path;

use clap::Args;
use miette::{IntoDiagnostic, Result, WrapErr, miette};

use feed_axis::exit::wrong_use;
use feed_axis::output::say;

use crate::packages::{Package, cargo, workspace};

/// Options of `publish`.
#[derive(Args)]
pub struct Options {
    /// Check and package everything, publish nothing; required, as a person publishes
    #[arg(long)]
    dry_run: bool,
    /// Package without building what was packaged: quick, but a file outside of its crate is not
    /// noticed
    #[arg(long)]
    no_verify: bool,
}

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    if !options.dry_run {
        return Err(wrong_use(
            "`publish` is done by a person: only `publish --dry-run` is possible here. \
             docs/crates.md says what comes before, and in which order",
        ));
    }
    let workspace = workspace()?;
    let packages = &workspace.packages;
    meet_demands(packages)?;
    let work = workspace.target_directory.join("publish");
    package(packages, &work, options)?;
    let made = work.join("target/package");
    for (number, package) in packages.iter().enumerate() {
        say(line(number + 1, package, &made)?)?;
    }
    for missing in for_a_person(packages) {
        say(format!("left for a person: {missing}"))?;
    }
    Ok(())
}

/// Refuses crates that crates.io would refuse.
fn meet_demands(packages: &[Package]) -> Result<()> {
    let mut versions = BTreeMap::new();
    let mut lacks = Vec::new();
    for package in packages {
        let of_it = demands::lacking(package, &versions);
        lacks.extend(of_it.iter().map(|what| format!("{}: {what}", package.name)));
        versions.insert(package.name.as_str(), package.version.as_str());
    }
    if lacks.is_empty() {
        return Ok(());
    }
    Err(miette!(
        "crates that cannot be published:\n{}",
        lacks.join("\n")
    ))
}

/// Makes all packages in `work`, each built from its own files where that is asked.
fn package(packages: &[Package], work: &Path, options: &Options) -> Result<()> {
    let project = work.join("project");
    copy::make(&project)?;
    let mut command = cargo(&["package", "--locked", "--no-metadata", "--allow-dirty"]);
    command
        .current_dir(&project)
        .arg("--target-dir")
        .arg(work.join("target"));
    for package in packages {
        command.args(["-p", &package.name]);
    }
    if options.no_verify {
        command.arg("--no-verify");
    }
    let status = command
        .status()
        .into_diagnostic()
        .wrap_err("cannot run cargo")?;
    if status.success() {
        return Ok(());
    }
    Err(miette!(
        "`cargo package` refused a crate: see its message above"
    ))
}

/// Place in the order, name, version and size of a package.
fn line(number: usize, package: &Package, made: &Path) -> Result<String> {
    let Package { name, version, .. } = package;
    let file = made.join(format!("{name}-{version}.crate"));
    let about = || format!("no package {}", file.display());
    let size = std::fs::metadata(&file)
        .into_diagnostic()
        .wrap_err_with(about)?;
    let kilobytes = size.len() as f64 / 1e3;
    Ok(format!(
        "{number:>2} {name:<18} {version} {kilobytes:>7.1} kB"
    ))
}

/// Whether it may go to no registry.
fn closed(package: &Package) -> bool {
    package.publish.as_ref().is_some_and(Vec::is_empty)
}

/// What no command decides.
fn for_a_person(packages: &[Package]) -> Vec<String> {
    let mut missing = Vec::new();
    if packages.iter().any(|package| package.repository.is_none()) {
        missing.push("`repository` in [workspace.package]: the project's address".to_owned());
    }
    if packages.iter().any(closed) {
        missing.push("`publish = false` in [workspace.package]: take it out".to_owned());
    }
    missing.push("whether the names are free on crates.io, and `cargo login`".to_owned());
    missing
}
