//! Logs: CSV, Parquet and MAT.

use std::fmt::Write as _;
use std::path::Path;

use axis_log::quality::MIN_SAMPLES;
use axis_log::{ColumnMap, Mapping, read_log};
use axis_sim::Axis;
use discrepancy::logs::{check_log, from_rest};
use miette::IntoDiagnostic;

use super::axis::small_screw;
use super::{Input, Kind, Verdict, fault, refused};
use crate::commands::torture::mutate;
use crate::commands::torture::random::Source;

const PARQUET: &[u8] = include_bytes!("../../../../../crates/axis-log/tests/fixtures/log.parquet");
const PLAIN_MAT: &[u8] = include_bytes!("../../../../../crates/axis-log/tests/fixtures/plain.mat");
const COMPRESSED_MAT: &[u8] =
    include_bytes!("../../../../../crates/axis-log/tests/fixtures/compressed.mat");

struct LogFile {
    name: &'static str,
    file: &'static str,
    bases: Vec<Vec<u8>>,
    machine: Option<Axis>,
    mapping: Mapping,
}

/// The three formats.
pub fn kinds() -> Vec<Box<dyn Kind>> {
    let machine = || Axis::parse("base", &small_screw()).ok();
    let kind = |name, file, bases| -> Box<dyn Kind> {
        Box::new(LogFile {
            name,
            file,
            bases,
            machine: machine(),
            mapping: mapping(),
        })
    };
    vec![
        kind("log, CSV", "log.csv", vec![csv().into_bytes()]),
        kind("log, Parquet", "log.parquet", vec![PARQUET.to_vec()]),
        kind(
            "log, MAT",
            "log.mat",
            vec![PLAIN_MAT.to_vec(), COMPRESSED_MAT.to_vec()],
        ),
    ]
}

/// The names of the MAT files; the other logs have those of the channels.
fn mapping() -> Mapping {
    let map = |(source, channel): (&str, &str)| ColumnMap {
        source: source.to_owned(),
        channel: channel.to_owned(),
        scale: 1.0,
        is_scale_stated: false,
        offset: 0.0,
        delay: 0.0,
    };
    let names = [("t", "t_s"), ("qg", "position_ref_m"), ("qm", "position_m")];
    Mapping {
        columns: names.into_iter().map(map).collect(),
        sample_rate_hz: None,
    }
}

/// A move there and back, long enough to be judged.
fn csv() -> String {
    let mut text = "t_s,position_ref_m,position_m,iq_a,state\n".to_owned();
    for k in 0..110 {
        let t = f64::from(k) * 1e-3;
        // At rest for a tenth of the time, then there and back.
        let turn = f64::from((k - 11).max(0)) * std::f64::consts::TAU / 98.0;
        let place = 0.6 + 0.01 * (1.0 - turn.cos());
        let current = 0.1 * f64::from(k % 7);
        // A formatted write to a text does not fail.
        let _ = writeln!(
            text,
            "{t:.3},{place:.6},{:.6},{current:.2},RUN",
            place + 1e-5
        );
    }
    text
}

impl Kind for LogFile {
    fn name(&self) -> &'static str {
        self.name
    }

    fn share(&self) -> usize {
        4
    }

    fn input(&self, random: &mut Source) -> Input {
        let base = random.pick(&self.bases);
        let bytes = match std::str::from_utf8(base) {
            Ok(text) => mutate::text(text, random),
            Err(_) => mutate::bytes(base, random),
        };
        Input {
            file: self.file.to_owned(),
            bytes,
            damaged: false,
        }
    }

    fn judge(&self, input: &Input, desk: &Path) -> Verdict {
        let path = desk.join(&input.file);
        let name = path.display().to_string();
        let required = ["position_ref_m", "position_m"];
        let log = match read_log(&path, &self.mapping, &required).into_diagnostic() {
            Ok(log) => log,
            // A damaged binary file need not have a place.
            Err(e) => return refused(e, input, self.file == "log.csv"),
        };
        let increasing = log.time().windows(2).all(|w| w[0] < w[1]);
        let finite = log
            .channels()
            .iter()
            .flat_map(|c| &c.samples)
            .all(|x| x.is_finite());
        if !(increasing && finite) {
            return fault("what is read is no log");
        }
        if log.len() < MIN_SAMPLES {
            return Verdict::Accepted;
        }
        let Some(machine) = &self.machine else {
            return fault("the base axis is refused");
        };
        let period = match check_log(&name, &log, machine).into_diagnostic() {
            Ok(period) => period,
            Err(e) => return refused(e, input, true),
        };
        match from_rest(&name, log, period, machine).into_diagnostic() {
            Ok(_) => Verdict::Accepted,
            Err(e) => refused(e, input, true),
        }
    }
}
