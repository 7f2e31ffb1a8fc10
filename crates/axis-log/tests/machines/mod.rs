//! Logs as real machines and programs write them: read as they stand, and told of.

mod binary;
mod motion;
mod text;

use std::path::PathBuf;

use axis_log::intake::{Options, PreparedLog, prepare};
use axis_log::{ColumnMap, ColumnUnit, Mapping, MappingProposal, propose};

/// A file of these bytes, in a folder that goes with it.
struct Given {
    path: PathBuf,
    _folder: tempfile::TempDir,
}

fn given(name: &str, bytes: impl AsRef<[u8]>) -> Given {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    Given {
        path,
        _folder: folder,
    }
}

impl Given {
    fn proposal(&self) -> MappingProposal {
        propose(&self.path).unwrap().unwrap()
    }

    /// Read with what is proposed, as a user would take it over.
    fn accepted(&self) -> PreparedLog {
        let column = |column: &axis_log::ProposedColumn| {
            let unit = ColumnUnit {
                unit: Some(column.unit),
                factor: column.factor,
                ..Default::default()
            };
            ColumnMap::in_unit(&column.source, column.channel, unit).unwrap()
        };
        let columns = self.proposal().columns.iter().map(column).collect();
        self.mapped(&Mapping {
            columns,
            sample_rate_hz: None,
        })
    }

    fn mapped(&self, mapping: &Mapping) -> PreparedLog {
        prepare(&[&self.path], mapping, &[], Options::default()).unwrap()
    }

    fn plain(&self) -> PreparedLog {
        self.mapped(&Mapping::default())
    }
}

/// What was done, in words.
fn told(prepared: &PreparedLog) -> String {
    let done = prepared.done.iter().map(ToString::to_string);
    done.collect::<Vec<_>>().join("\n")
}

fn rate(prepared: &PreparedLog) -> f64 {
    1.0 / axis_log::quality::clock(&prepared.log).unwrap().period
}

/// Whether values are these, to within `off`.
fn assert_near(found: &[f64], expected: impl Fn(usize) -> f64, off: f64) {
    for (k, value) in found.iter().enumerate() {
        let right = expected(k);
        assert!((value - right).abs() <= off, "{k}: {value} for {right}");
    }
}
