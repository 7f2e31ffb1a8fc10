//! Results on disk: one folder a stage, with a manifest written last.
//!
//! The manifest holds the key of the stage's inputs and the hash of each
//! file. A stage is up to date when the manifest is, byte for byte, the one that
//! its inputs and its files make; a file that does not match it is refused.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::context::Context;
use crate::output::{ready, remove, sweep, write_whole};
use crate::{program, shell};

/// Layout of manifests and of the JSON files beside them.
const SCHEMA: u32 = 1;
const MANIFEST: &str = "manifest.json";

/// What a stage was made from, and what it made.
#[derive(Clone, Serialize, Deserialize)]
pub struct Manifest {
    schema: u32,
    stage: String,
    /// Hash of everything that the results depend on.
    key: String,
    axis: String,
    axis_fingerprint: String,
    seed: u64,
    quick: bool,
    version: String,
    /// blake3 of each file.
    files: BTreeMap<String, String>,
}

/// One stage of one run folder.
pub struct Stage<'a> {
    context: &'a Context,
    name: &'static str,
    files: &'static [&'static str],
    scratch: &'static [&'static str],
    key: String,
    /// The stages that it builds on, in their order.
    before: Vec<&'static str>,
}

impl<'a> Stage<'a> {
    /// The stage `name` with the results `files`, which depend on the axis, the seed,
    /// the program's version, `settings` and the files of the stages `after`.
    pub fn new(
        context: &'a Context,
        name: &'static str,
        files: &'static [&'static str],
        settings: &str,
        after: &[&Stage<'_>],
    ) -> Self {
        let mut hasher = blake3::Hasher::new();
        let mut put = |text: &str| {
            hasher.update(&(text.len() as u64).to_le_bytes());
            hasher.update(text.as_bytes());
        };
        put(name);
        put(env!("CARGO_PKG_VERSION"));
        put(&context.axis.fingerprint);
        put(&context.seed.to_string());
        put(settings);
        for stage in after {
            put(&stage.key);
        }
        let key = hasher.finalize().to_hex().to_string();
        let mut before: Vec<&'static str> = Vec::new();
        for name in after.iter().flat_map(|s| s.before.iter().chain([&s.name])) {
            if !before.contains(name) {
                before.push(name);
            }
        }
        Self {
            context,
            name,
            files,
            scratch: &[],
            key,
            before,
        }
    }

    /// Names files that a run leaves only where it is killed.
    pub fn with_scratch(self, scratch: &'static [&'static str]) -> Self {
        Self { scratch, ..self }
    }

    /// Hash of all inputs.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Path of one of the stage's files.
    pub fn path(&self, file: &str) -> PathBuf {
        self.context.out.join(self.name).join(file)
    }

    /// Whether the results are there, whole, and made from these inputs.
    pub fn is_current(&self) -> bool {
        let found = std::fs::read(self.path(MANIFEST));
        found.is_ok_and(|found| self.expected().is_ok_and(|whole| whole == found))
    }

    /// Makes the stage's folder, and removes what killed runs left aside in it.
    pub fn begin(&self) -> Result<()> {
        ready(&self.path(""))?;
        let names = [self.files, self.scratch, &[MANIFEST]].concat();
        sweep(&self.path(""), &names)?;
        // Results without manifest are unfinished; the old one must not vouch for them.
        remove(&self.path(MANIFEST))
    }

    /// Writes a result as JSON.
    pub fn write_json(&self, file: &str, value: &impl Serialize) -> Result<()> {
        let bytes = crate::json::pretty(value).into_diagnostic()?;
        write_whole(&self.path(file), &bytes)
    }

    /// Declares the stage done. What only helped to make it goes before: nothing in the folder of a finished
    /// stage is ever changed but to make the stage anew.
    pub fn finish(&self) -> Result<()> {
        let manifest = self.expected()?;
        for file in self.scratch {
            let path = self.path(file);
            remove(&path)?;
            // The folder of its own that it may have; where something else is in it, it stays.
            if let Some(folder) = path.parent().filter(|folder| *folder != self.path("")) {
                let _ = std::fs::remove_dir(folder);
            }
        }
        write_whole(&self.path(MANIFEST), &manifest)
    }

    /// The manifest that the inputs and the files make.
    fn expected(&self) -> Result<Vec<u8>> {
        let hash = |file: &&str| -> Result<(String, String)> {
            Ok(((*file).to_owned(), hash_of(&read(&self.path(file))?)))
        };
        self.manifest_of(self.files.iter().map(hash).collect::<Result<_>>()?)
    }

    fn manifest_of(&self, files: BTreeMap<String, String>) -> Result<Vec<u8>> {
        let manifest = Manifest {
            schema: SCHEMA,
            stage: self.name.to_owned(),
            key: self.key.clone(),
            axis: self.context.axis.name.clone(),
            axis_fingerprint: self.context.axis.fingerprint.clone(),
            seed: self.context.seed,
            quick: self.context.quick,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            files,
        };
        crate::json::pretty(&manifest).into_diagnostic()
    }

    /// A result of this stage, for a later one: checked against the manifest.
    pub fn read(&self, file: &str) -> Result<Vec<u8>> {
        let (manifest, found) = self.manifest()?;
        let path = self.path(file);
        let again = || format!("run `{}` again", self.context.line(self.name));
        if manifest.axis_fingerprint != self.context.axis.fingerprint {
            return Err(miette!(
                "{} was made from another axis file ({}); {}",
                path.display(),
                manifest.axis,
                again()
            ));
        }
        if manifest.key != self.key {
            return Err(miette!(
                "{} was made with other settings (seed, --quick, machine, version) or from other results; {}",
                path.display(),
                again()
            ));
        }
        if self.manifest_of(manifest.files.clone())? != found {
            return Err(miette!(
                "{} is damaged (truncated or changed); {}",
                self.path(MANIFEST).display(),
                again()
            ));
        }
        let bytes = read(&path)?;
        if manifest.files.get(file) != Some(&hash_of(&bytes)) {
            return Err(miette!(
                "{} does not match its manifest (truncated or changed); {}",
                path.display(),
                again()
            ));
        }
        Ok(bytes)
    }

    /// A JSON result of this stage.
    pub fn read_json<T: DeserializeOwned>(&self, file: &str) -> Result<T> {
        serde_json::from_slice(&self.read(file)?)
            .into_diagnostic()
            .wrap_err_with(|| {
                format!(
                    "{} is not what this version writes",
                    self.path(file).display()
                )
            })
    }

    /// The commands that make this stage: those of the stages before it that have no results
    /// yet, and its own, each with the options that these results are found by.
    fn missing(&self) -> String {
        let there = |name: &str| self.context.out.join(name).join(MANIFEST).exists();
        let before = self.before.iter().filter(|name| !there(name));
        let commands = before.chain([&self.name]);
        let commands = commands.map(|name| format!("`{}`", self.context.line(name)));
        commands.collect::<Vec<_>>().join(", then ")
    }

    /// The manifest as it stands, and its bytes.
    fn manifest(&self) -> Result<(Manifest, Vec<u8>)> {
        let path = self.path(MANIFEST);
        let bytes = std::fs::read(&path).map_err(|e| {
            miette!(
                "no finished results in {} ({e}); first run {}",
                self.path("").display(),
                self.missing()
            )
        })?;
        let manifest: Manifest = serde_json::from_slice(&bytes).map_err(|e| {
            miette!(
                "{} is not a manifest ({e}); run `{}` again",
                path.display(),
                self.context.line(self.name)
            )
        })?;
        if manifest.schema != SCHEMA {
            return Err(miette!(
                "{} has schema {}, this program reads {SCHEMA}; run `{}` again",
                path.display(),
                manifest.schema,
                self.context.line(self.name)
            ));
        }
        Ok((manifest, bytes))
    }
}

/// A JSON result of a finished stage in a run's folder, whatever axis and settings it is of:
/// checked against the stage's manifest.
pub fn read_finished<T: DeserializeOwned>(run: &Path, stage: &str, file: &str) -> Result<T> {
    let folder = run.join(stage);
    let manifest = folder.join(MANIFEST);
    let again = format!(
        "make it with `{} pipeline --axis FILE --out {}`",
        program::name(),
        shell::word(&run.display().to_string())
    );
    let found: Manifest = serde_json::from_slice(&read(&manifest)?)
        .into_diagnostic()
        .wrap_err_with(|| format!("{} is not a manifest; {again}", manifest.display()))?;
    let path = folder.join(file);
    let bytes = read(&path)?;
    if found.files.get(file) != Some(&hash_of(&bytes)) {
        return Err(miette!(
            "{} does not match its manifest (truncated or changed); {again}",
            path.display()
        ));
    }
    serde_json::from_slice(&bytes)
        .into_diagnostic()
        .wrap_err_with(|| {
            format!(
                "{} is not what this version writes; {again}",
                path.display()
            )
        })
}

fn hash_of(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}

fn read(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use axis_sim::Axis;

    fn context(out: &Path) -> Context {
        let text = include_str!("../../../data/axes/liu2025.toml");
        let axis = Axis::parse("liu2025.toml", text).unwrap();
        Context {
            machine: axis.clone(),
            axis,
            axis_file: "liu2025.toml".into(),
            axis_text: text.to_owned(),
            has_machine: false,
            out: out.to_owned(),
            seed: 1,
            threads: 1,
            quick: true,
            options: Vec::new(),
        }
    }

    fn finished(context: &Context) -> Stage<'_> {
        let stage = Stage::new(context, "some", &["a.json", "b.json"], "settings", &[]);
        let stage = stage.with_scratch(&["checkpoint"]);
        stage.begin().unwrap();
        stage.write_json("a.json", &[1, 2]).unwrap();
        stage.write_json("b.json", &[3]).unwrap();
        stage.finish().unwrap();
        stage
    }

    fn names(stage: &Stage<'_>) -> Vec<String> {
        let entries = std::fs::read_dir(stage.path("")).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn what_killed_runs_left_goes_with_the_next() {
        let folder = tempfile::tempdir().unwrap();
        let context = context(folder.path());
        let stage = finished(&context);
        let left = [".a.json.x1Y2z3", ".manifest.json.123456", "checkpoint"];
        let leave = || {
            for name in left {
                std::fs::write(stage.path(name), "half").unwrap();
            }
        };
        leave();
        stage.begin().unwrap();
        // The results, without the manifest, and the checkpoint to go on from.
        assert_eq!(names(&stage), ["a.json", "b.json", "checkpoint"]);
        assert!(!stage.is_current());
        stage.finish().unwrap();
        assert_eq!(names(&stage), ["a.json", "b.json", "manifest.json"]);
        assert!(stage.is_current());
    }

    /// A process that is killed once the manifest is there leaves nothing that the next run would have to remove
    /// from a finished stage: what only helped is gone before.
    #[test]
    fn what_only_helped_goes_before_a_stage_is_finished() {
        let folder = tempfile::tempdir().unwrap();
        let context = context(folder.path());
        let stage = finished(&context).with_scratch(&["checkpoint", "shards/a.part"]);
        stage.begin().unwrap();
        std::fs::create_dir(stage.path("shards")).unwrap();
        for file in stage.scratch {
            std::fs::write(stage.path(file), "half").unwrap();
        }
        // The manifest cannot be put in place: as far as a killed process came.
        std::fs::create_dir(stage.path(MANIFEST)).unwrap();
        stage.finish().unwrap_err();
        let left = names(&stage);
        let left: Vec<&String> = left.iter().filter(|name| !name.starts_with('.')).collect();
        assert_eq!(left, ["a.json", "b.json", "manifest.json"]);
    }

    #[test]
    fn a_manifest_vouches_for_nothing_but_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let context = context(folder.path());
        let stage = finished(&context);
        let whole = std::fs::read_to_string(stage.path(MANIFEST)).unwrap();
        let shorter: Vec<&str> = whole.lines().filter(|l| !l.contains("a.json")).collect();
        for changed in [
            whole.replace("\"seed\": 1", "\"seed\": 2"),
            whole.replace("\"quick\": true", "\"quick\": false"),
            whole.replace(": ", ":"),
            whole.clone() + "\n",
            shorter.join("\n"),
        ] {
            assert_ne!(changed, whole);
            std::fs::write(stage.path(MANIFEST), &changed).unwrap();
            assert!(!stage.is_current(), "{changed}");
            let read = stage.read_json::<Vec<i32>>("a.json");
            let message = format!("{:?}", read.unwrap_err());
            assert!(message.contains("run `feed-axis some`"), "{message}");
        }
        std::fs::write(stage.path(MANIFEST), &whole).unwrap();
        assert!(stage.is_current());
        assert_eq!(stage.read_json::<Vec<i32>>("a.json").unwrap(), [1, 2]);
    }
}
