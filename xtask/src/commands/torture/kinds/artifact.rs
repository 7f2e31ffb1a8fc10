//! Networks and checkpoints: damaged, and damaged with a hash that fits again.

use std::path::Path;

use cfnn::artifact::{checkpoint_from_bytes, checkpoint_to_bytes, network_to_bytes};
use cfnn::train::{Dataset, Settings, Trainer};
use cfnn::{Network, Shape};
use miette::{IntoDiagnostic, Result, WrapErr};

use super::{Input, Kind, Verdict, fault, refused};
use crate::commands::torture::mutate;
use crate::commands::torture::random::Source;
use feed_axis::commands::train;

/// Bytes of the frame before the payload, and of the hash behind it.
const HEADER: usize = 24;
const HASH: usize = 32;

struct Artifact {
    name: &'static str,
    base: Vec<u8>,
    read: fn(&[u8], &Path) -> Result<Option<Network>>,
    rehashed: bool,
}

/// Networks and checkpoints.
pub fn kinds() -> Result<Vec<Box<dyn Kind>>> {
    let trainer = trainer().into_diagnostic()?;
    let network = network_to_bytes(&trainer.network(), "torture").into_diagnostic()?;
    let checkpoint = checkpoint_to_bytes(&trainer.checkpoint(), "torture").into_diagnostic()?;
    let kind = |name, base: &[u8], read, rehashed| -> Box<dyn Kind> {
        Box::new(Artifact {
            name,
            base: base.to_vec(),
            read,
            rehashed,
        })
    };
    Ok(vec![
        kind("network", &network, from_network, false),
        kind("network, hashed again", &network, from_network, true),
        kind("checkpoint", &checkpoint, from_checkpoint, false),
        kind(
            "checkpoint, hashed again",
            &checkpoint,
            from_checkpoint,
            true,
        ),
    ])
}

/// A training of three epochs.
fn trainer() -> std::result::Result<Trainer, cfnn::Error> {
    let inputs: Vec<f64> = (0..40).map(|k| f64::from((k * 7) % 11)).collect();
    let outputs: Vec<f64> = (0..10).map(|k| f64::from(k * k)).collect();
    let data = Dataset::new(4, 1, inputs, outputs)?;
    let shape = Shape {
        inputs: 4,
        hidden: vec![2, 2],
        outputs: 1,
    };
    let settings = Settings {
        epochs: 3,
        threads: 1,
        ..Settings::default()
    };
    let mut trainer = Trainer::new(shape, data.scaling()?, &data, settings)?;
    trainer.run(|_| {});
    Ok(trainer)
}

/// The network of any finished training, small, for other kinds to store.
pub fn some_network() -> Result<Network> {
    Ok(trainer().into_diagnostic()?.network())
}

fn from_network(bytes: &[u8], path: &Path) -> Result<Option<Network>> {
    Ok(Some(train::network(bytes, path)?.0))
}

/// A checkpoint shows its network to a training alone. A training ignores one that is
/// refused, so it is this function's words that name the file.
fn from_checkpoint(bytes: &[u8], path: &Path) -> Result<Option<Network>> {
    let read = checkpoint_from_bytes(bytes).into_diagnostic();
    let named = read.wrap_err_with(|| format!("{} is not valid", path.display()));
    named.map(|_| None)
}

impl Kind for Artifact {
    fn name(&self) -> &'static str {
        self.name
    }

    fn share(&self) -> usize {
        2
    }

    fn input(&self, random: &mut Source) -> Input {
        let mut bytes = self.base.clone();
        while bytes == self.base {
            bytes = if self.rehashed {
                let payload = &self.base[HEADER..self.base.len() - HASH];
                framed(&self.base, &mutate::bytes(payload, random))
            } else {
                mutate::bytes(&self.base, random)
            };
        }
        Input {
            file: "some.cfnn".to_owned(),
            bytes,
            damaged: !self.rehashed,
        }
    }

    fn judge(&self, input: &Input, desk: &Path) -> Verdict {
        let path = desk.join(&input.file);
        let Ok(bytes) = std::fs::read(&path) else {
            return fault("the file is gone");
        };
        let network = match (self.read)(&bytes, &path) {
            Err(e) => return refused(e, input, false),
            Ok(_) if input.damaged => return fault("a damaged file is read"),
            Ok(None) => return Verdict::Accepted,
            Ok(Some(network)) => network,
        };
        let shape = network.shape();
        let (mut inputs, mut outputs) = (vec![0.1; shape.inputs], vec![0.0; shape.outputs]);
        inputs
            .iter_mut()
            .enumerate()
            .for_each(|(k, x)| *x *= k as f64);
        let mut scratch = network.scratch();
        match network.evaluate(&inputs, &mut scratch, &mut outputs) {
            Ok(()) => Verdict::Accepted,
            Err(e) => fault(format!("accepted, then not evaluated: {e}")),
        }
    }
}

/// The frame of `whole` around another payload, with its length and hash.
fn framed(whole: &[u8], payload: &[u8]) -> Vec<u8> {
    let mut bytes = whole[..HEADER - 8].to_vec();
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    bytes.extend_from_slice(payload);
    let hash = blake3::hash(&bytes);
    bytes.extend_from_slice(hash.as_bytes());
    bytes
}
