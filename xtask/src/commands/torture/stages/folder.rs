//! What stands in a run's folder, and whether two of them hold the same.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::SystemTime;

use miette::{IntoDiagnostic, Result};
use serde_json::Value;

/// The stages in the order in which they run.
const STAGES: [&str; 6] = [
    "sample",
    "train",
    "identify",
    "validate",
    "compensate",
    "study",
];

/// All files of a folder by their path in it, times taken out.
#[derive(Default)]
pub struct Snapshot(BTreeMap<String, Vec<u8>>);

impl Snapshot {
    pub fn of(folder: &Path) -> Result<Self> {
        let mut files = BTreeMap::new();
        collect(folder, "", &mut files)?;
        Ok(Self(timeless(files)))
    }

    /// The first difference, in words.
    pub fn same_as(&self, other: &Self) -> std::result::Result<(), String> {
        if let Some(name) = self.0.keys().find(|name| !other.0.contains_key(*name)) {
            return Err(format!("{name} is left over"));
        }
        for (name, bytes) in &other.0 {
            match self.0.get(name) {
                None => return Err(format!("{name} is missing")),
                Some(found) if found != bytes => return Err(format!("{name} is another")),
                Some(_) => {}
            }
        }
        Ok(())
    }
}

fn collect(folder: &Path, prefix: &str, into: &mut BTreeMap<String, Vec<u8>>) -> Result<()> {
    for entry in std::fs::read_dir(folder).into_diagnostic()? {
        let entry = entry.into_diagnostic()?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.file_type().into_diagnostic()?.is_dir() {
            collect(&entry.path(), &format!("{name}/"), into)?;
        } else {
            into.insert(name, std::fs::read(entry.path()).into_diagnostic()?);
        }
    }
    Ok(())
}

/// How long a training took is the one result that is a time: it stands in its record,
/// in the summary and the report, and in the record's hash.
fn timeless(mut files: BTreeMap<String, Vec<u8>>) -> BTreeMap<String, Vec<u8>> {
    let json = |bytes: &[u8]| serde_json::from_slice::<Value>(bytes).unwrap_or_default();
    let of = |files: &BTreeMap<String, Vec<u8>>, name: &str| files.get(name).map(|b| json(b));
    let record = of(&files, "train/training.json");
    let seconds = record.as_ref().and_then(|r| r["seconds"].as_f64());
    let without = [
        ("train/training.json", "/seconds"),
        ("summary.json", "/network/train_seconds"),
        ("train/manifest.json", "/files/training.json"),
    ];
    for (name, path) in without {
        if let Some(mut value) = of(&files, name) {
            if let Some(time) = value.pointer_mut(path) {
                *time = Value::Null;
            }
            files.insert(name.to_owned(), value.to_string().into_bytes());
        }
    }
    if let (Some(seconds), Some(html)) = (seconds, files.get_mut("report.html")) {
        let text = String::from_utf8_lossy(html);
        let text = text.replace(&format!("Trained in {seconds:.1} s"), "Trained");
        *html = text.into_bytes();
    }
    files
}

/// Times of the last change of a folder's files.
pub type Changed = BTreeMap<String, SystemTime>;

/// When the files of a folder changed last.
pub fn files(folder: &Path) -> Result<Changed> {
    let mut changed = Changed::new();
    for entry in std::fs::read_dir(folder).into_diagnostic()? {
        let entry = entry.into_diagnostic()?;
        let name = entry.file_name().to_string_lossy().into_owned();
        // What a killed run left aside is to go.
        if !name.starts_with('.') && name != "checkpoint.cfnn" {
            let time = entry.metadata().and_then(|m| m.modified());
            changed.insert(name, time.into_diagnostic()?);
        }
    }
    Ok(changed)
}

/// The finished stages of a run, and when their files changed.
pub fn finished(run: &Path) -> Result<Vec<(String, Changed)>> {
    let mut found = Vec::new();
    for stage in STAGES {
        if run.join(stage).join("manifest.json").exists() {
            found.push((stage.to_owned(), files(&run.join(stage))?));
        }
    }
    Ok(found)
}

/// How long each stage of a run took, s, by the times of their manifests.
pub fn times(run: &Path) -> Result<Vec<(String, f64)>> {
    let modified = |path: &Path| path.metadata().and_then(|m| m.modified()).into_diagnostic();
    let mut last = modified(&run.join("run.lock"))?;
    let mut found = Vec::new();
    for stage in STAGES {
        let end = modified(&run.join(stage).join("manifest.json"))?;
        let took = end.duration_since(last).unwrap_or_default();
        found.push((stage.to_owned(), took.as_secs_f64()));
        last = end;
    }
    Ok(found)
}

/// Copies a folder with all that is in it.
pub fn copy(from: &Path, to: &Path) -> Result<()> {
    std::fs::create_dir_all(to).into_diagnostic()?;
    for entry in std::fs::read_dir(from).into_diagnostic()? {
        let entry = entry.into_diagnostic()?;
        let target = to.join(entry.file_name());
        if entry.file_type().into_diagnostic()?.is_dir() {
            copy(&entry.path(), &target)?;
        } else {
            std::fs::copy(entry.path(), &target).into_diagnostic()?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn snapshot(files: &[(&str, &str)]) -> Snapshot {
        let bytes = |&(name, text): &(&str, &str)| (name.to_owned(), text.as_bytes().to_vec());
        Snapshot(timeless(files.iter().map(bytes).collect()))
    }

    #[test]
    fn folders_differ_in_anything_but_times() {
        let run = |seconds: &str, rms: &str| {
            let record = format!("{{\"seconds\": {seconds}, \"rms_um\": [{rms}]}}");
            let page = format!("<p>Trained in {seconds} s. RMS {rms}</p>");
            snapshot(&[("train/training.json", &record), ("report.html", &page)])
        };
        assert_eq!(run("1.5", "2.0").same_as(&run("3.5", "2.0")), Ok(()));
        assert!(run("1.5", "2.0").same_as(&run("1.5", "2.5")).is_err());
        let more = snapshot(&[("a", "1"), (".a.x1y2z3", "")]);
        let less = snapshot(&[("a", "1")]);
        assert_eq!(
            more.same_as(&less),
            Err(".a.x1y2z3 is left over".to_owned())
        );
        assert_eq!(less.same_as(&more), Err(".a.x1y2z3 is missing".to_owned()));
    }
}
