//! Sample files.

use std::path::Path;

use axis_pipeline::sample_file;
use axis_pipeline::sampling::{SamplePlan, Sampler, SpeedDensity};
use axis_sim::Axis;
use miette::{IntoDiagnostic, Result};

use super::axis::small_screw;
use super::{Input, Kind, Verdict, fault, refused};
use crate::commands::torture::mutate;
use crate::commands::torture::random::Source;

/// Bytes of the hash at the end.
const HASH: usize = 32;

struct SampleFile {
    base: Vec<u8>,
    fingerprint: String,
}

/// A file of ten samples.
pub fn kind(desk: &Path) -> Result<Box<dyn Kind>> {
    let axis = Axis::parse("base", &small_screw())?;
    let plan = SamplePlan {
        count: 10,
        seed: 1,
        density: SpeedDensity::Uniform,
    };
    let sampler = Sampler::new(&axis, &plan).into_diagnostic()?;
    let path = desk.join("base.samples");
    sample_file::write(&path, &sampler, &axis.fingerprint, |_| {}).into_diagnostic()?;
    Ok(Box::new(SampleFile {
        base: std::fs::read(&path).into_diagnostic()?,
        fingerprint: axis.fingerprint,
    }))
}

impl Kind for SampleFile {
    fn name(&self) -> &'static str {
        "sample file"
    }

    fn share(&self) -> usize {
        3
    }

    /// Every fourth has a hash that fits what is left.
    fn input(&self, random: &mut Source) -> Input {
        let rehashed = random.chance(0.25);
        let mut bytes = self.base.clone();
        while bytes == self.base {
            bytes = mutate::bytes(&self.base, random);
            if rehashed {
                bytes.truncate(bytes.len().saturating_sub(HASH));
                let hash = blake3::hash(&bytes);
                bytes.extend_from_slice(hash.as_bytes());
            }
        }
        Input {
            file: "some.samples".to_owned(),
            bytes,
            damaged: !rehashed,
        }
    }

    fn judge(&self, input: &Input, desk: &Path) -> Verdict {
        let path = desk.join(&input.file);
        match sample_file::read(&path, &self.fingerprint).into_diagnostic() {
            Err(e) => refused(e, input, false),
            Ok(_) if input.damaged => fault("a damaged file is read"),
            Ok(set) if set.inputs.len() == set.increments.len() => Verdict::Accepted,
            Ok(_) => fault("inputs without increments"),
        }
    }
}
