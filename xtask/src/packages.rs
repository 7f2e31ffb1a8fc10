//! The crates of the folder `crates`, as cargo describes them, lower ones first.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::Deserialize;

/// One crate.
#[derive(Deserialize)]
pub struct Package {
    pub name: String,
    pub version: String,
    manifest_path: PathBuf,
    pub description: Option<String>,
    pub license: Option<String>,
    pub readme: Option<PathBuf>,
    pub repository: Option<String>,
    pub rust_version: Option<String>,
    pub keywords: Vec<String>,
    pub categories: Vec<String>,
    /// Registries that it may go to; none if `publish = false`.
    pub publish: Option<Vec<String>>,
    pub features: BTreeMap<String, Vec<String>>,
    pub dependencies: Vec<Dependency>,
    pub metadata: Metadata,
}

/// What a crate depends on, of any kind.
#[derive(Deserialize)]
pub struct Dependency {
    pub name: String,
    /// The requirement on the version; `*` where none is written.
    pub req: String,
    /// Where it lies, of a crate of this workspace.
    pub path: Option<PathBuf>,
}

/// What the manifest says to this project alone.
#[derive(Deserialize)]
pub struct Metadata {
    pub layer: Layer,
}

/// A crate may depend on lower layers only.
#[derive(Deserialize)]
pub struct Layer {
    pub level: u32,
}

/// What cargo says of the project.
#[derive(Deserialize)]
pub struct Workspace {
    pub packages: Vec<Package>,
    /// Where cargo builds.
    pub target_directory: PathBuf,
}

impl Package {
    /// The crate's folder.
    pub fn folder(&self) -> &Path {
        self.manifest_path.parent().unwrap_or(Path::new("."))
    }
}

/// The project's folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// `cargo` with these arguments, in the project's folder.
pub fn cargo(arguments: &[&str]) -> Command {
    let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(program);
    command.args(arguments).current_dir(root());
    command
}

/// What cargo writes on standard output.
pub fn cargo_says(arguments: &[&str]) -> Result<Vec<u8>> {
    let called = cargo(arguments).output().into_diagnostic();
    let output = called.wrap_err("cannot run cargo")?;
    if output.status.success() {
        return Ok(output.stdout);
    }
    let said = String::from_utf8_lossy(&output.stderr);
    Err(miette!("`cargo {}` failed:\n{said}", arguments.join(" ")))
}

/// The crates in an order in which each comes after all that it depends on: by layer, then by name.
pub fn workspace() -> Result<Workspace> {
    let metadata = cargo_says(&["metadata", "--no-deps", "--format-version", "1", "--locked"])?;
    let mut workspace: Workspace = serde_json::from_slice(&metadata).into_diagnostic()?;
    let folder = root().join("crates").canonicalize().into_diagnostic()?;
    let packages = &mut workspace.packages;
    packages.retain(|package| package.manifest_path.starts_with(&folder));
    packages.sort_by_cached_key(|package| (package.metadata.layer.level, package.name.clone()));
    Ok(workspace)
}
