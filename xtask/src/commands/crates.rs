//! `crates`: what each crate is and needs, as a table for docs/crates.md and a line for its README.
//!
//! Dependencies are the other crates that a user's build has to compile for it, this project's and
//! others', procedural macros and build scripts' among them, on x86-64 Linux with Cargo.lock's
//! versions: what `cargo tree --edges normal,build` lists, each once.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use clap::Args;
use feed_axis::context::read_text;
use feed_axis::output::{say, write_whole};
use miette::{Result, miette};

use crate::packages::{Package, cargo_says, root, workspace};

/// Options of `crates`.
#[derive(Args)]
pub struct Options {
    /// Write the table and the lines; without it they are compared
    #[arg(long)]
    write: bool,
}

const HEAD: &str = "| layer | crate | job | features | `no_std` | Rust | dependencies |\n\
                    |---|---|---|---|---|---|---|\n";
const BEGIN: &str = "<!-- crates: written by `cargo xtask crates --write` -->\n";
const END: &str = "<!-- end -->";

/// Runs the command.
pub fn command(options: &Options) -> Result<()> {
    let workspace = workspace()?;
    let mut table = HEAD.to_owned();
    let mut texts = Vec::new();
    for package in &workspace.packages {
        let counts = Counts::of(package)?;
        table += &row(package, &counts)?;
        texts.push(between(
            &package.folder().join("README.md"),
            &counts.sentence(package),
        )?);
    }
    texts.push(between(&root().join("docs/crates.md"), &table)?);
    texts.retain(|(_, before, after)| before != after);
    if options.write {
        for (file, _, text) in &texts {
            write_whole(file, text.as_bytes())?;
        }
    } else if !texts.is_empty() {
        let files: Vec<String> = texts
            .iter()
            .map(|text| text.0.display().to_string())
            .collect();
        return Err(miette!(
            "not as the crates are now (`cargo xtask crates --write` corrects it):\n{}",
            files.join("\n")
        ));
    }
    say(format!("crates: {} described", workspace.packages.len()))
}

/// A file, its text, and its text with another one between the marks.
fn between(file: &Path, new: &str) -> Result<(PathBuf, String, String)> {
    let text = read_text(file)?;
    let parts = text.split_once(BEGIN).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(END)?;
        Some(format!("{before}{BEGIN}{new}{END}{after}"))
    });
    match parts {
        Some(made) => Ok((file.to_owned(), text, made)),
        None => Err(miette!(
            "{}: no place for what is written here, between the lines\n{BEGIN}{END}",
            file.display()
        )),
    }
}

/// How many other crates a crate needs.
struct Counts {
    /// Without features, with those that are on by default, with all; if there are none the
    /// same.
    bare: usize,
    default: usize,
    all: usize,
}

impl Counts {
    fn of(package: &Package) -> Result<Self> {
        let default = dependencies(&package.name, None)?;
        if package.features.is_empty() {
            return Ok(Self {
                bare: default,
                default,
                all: default,
            });
        }
        Ok(Self {
            bare: dependencies(&package.name, Some("--no-default-features"))?,
            default,
            all: dependencies(&package.name, Some("--all-features"))?,
        })
    }

    fn sentence(&self, package: &Package) -> String {
        let Self { bare, default, all } = self;
        let counts = if bare == all {
            all.to_string()
        } else {
            format!(
                "{bare} without features, {default} with those that are on by default, {all} with all"
            )
        };
        let rust = package.rust_version.as_deref().unwrap_or_default();
        format!("Rust {rust} or later. Crates that it needs, itself not counted: {counts}.\n")
    }

    fn cell(&self) -> String {
        let Self { bare, default, all } = self;
        if bare == all {
            return all.to_string();
        }
        format!("{bare} / {default} / {all}")
    }
}

fn dependencies(name: &str, features: Option<&str>) -> Result<usize> {
    let mut arguments = vec!["tree", "--locked", "-p", name, "--edges", "normal,build"];
    arguments.extend(["--target", "x86_64-unknown-linux-gnu", "--prefix", "none"]);
    arguments.extend(["--format", "{p}"]);
    arguments.extend(features);
    let tree = cargo_says(&arguments)?;
    let tree = String::from_utf8_lossy(&tree);
    // `(*)` stands where a crate was listed before, `(proc-macro)` behind some.
    let words = |line: &str| line.split(' ').take(2).collect::<Vec<_>>().join(" ");
    let crates: BTreeSet<String> = tree.lines().filter(|l| !l.is_empty()).map(words).collect();
    Ok(crates.len().saturating_sub(1))
}

fn row(package: &Package, counts: &Counts) -> Result<String> {
    let features = package.features.keys().filter(|name| *name != "default");
    let features: Vec<String> = features.map(|name| format!("`{name}`")).collect();
    let library = read_text(&package.folder().join("src/lib.rs"))?;
    let bare = library
        .lines()
        .any(|line| line.starts_with("#![") && line.contains("no_std"));
    Ok(format!(
        "| {} | `{name}` | {} | {} | {} | {} | {} |\n",
        package.metadata.layer.level,
        package.description.as_deref().unwrap_or_default(),
        if features.is_empty() {
            "–".to_owned()
        } else {
            features.join(", ")
        },
        if bare { "yes" } else { "–" },
        package.rust_version.as_deref().unwrap_or_default(),
        counts.cell(),
        name = package.name,
    ))
}
