//! Networks and checkpoints as bytes that refuse to be read when damaged.
//!
//! A payload (bincode 2.0.1, fixed-width integers, little-endian) lies in a
//! frame with magic, kind, schema number, length and the BLAKE3 hash of all
//! that; length and hash are checked before anything is decoded, and decoding
//! must use every byte. What is decoded is validated like any other input.
//!
//! Every artifact carries a *provenance*: a string of the caller's, for
//! instance the hash of the parameter file that the samples came from. This
//! module stores it and gives it back; the caller compares.
//!
//! A network or checkpoint is written in the oldest schema that can hold it, so
//! that older versions of this crate read what they can evaluate:
//!
//! | schema | holds |
//! |---|---|
//! | 1 | the cascade of tansig layers; training without Bayesian regularisation in threads of its own |
//! | 2 | other links and transfer functions, dropped inputs; all settings |
//!
//! bincode is unmaintained (RUSTSEC-2025-0141) and pinned; the plain data
//! structs that it sees are listed in this module, one for each schema number.

#[cfg(feature = "train")]
mod checkpoint;
mod frame;

use std::string::String;
use std::vec::Vec;

use bincode::config::{Configuration, Fixint, Limit, LittleEndian};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use thiserror::Error as ThisError;

#[cfg(feature = "train")]
pub use checkpoint::{checkpoint_from_bytes, checkpoint_to_bytes};
use frame::Format;

use crate::{Activation, Architecture, Error, Links, Network, Scaling, Shape};

/// Why an artifact was refused or could not be written.
#[derive(Debug, Clone, PartialEq, ThisError)]
#[non_exhaustive]
pub enum ArtifactError {
    /// The first bytes are not those of an artifact of this crate.
    #[error("not a cfnn artifact: the first bytes differ")]
    NotAnArtifact,
    /// Bytes are missing at the end.
    #[error("artifact truncated: {found} bytes, must be {expected}")]
    Truncated {
        /// Bytes there.
        found: u64,
        /// Bytes that the header announces.
        expected: u64,
    },
    /// Bytes follow the end.
    #[error("artifact has {found} bytes, more than the {expected} that it announces")]
    TrailingBytes {
        /// Bytes there.
        found: u64,
        /// Bytes that the header announces.
        expected: u64,
    },
    /// The hash does not match the content.
    #[error("artifact damaged: its hash does not match its content")]
    Damaged,
    /// An artifact of another kind.
    #[error("artifact is of kind {found:?}, must be {expected:?}")]
    WrongKind {
        /// Kind found.
        found: String,
        /// Kind asked for.
        expected: String,
    },
    /// An artifact in another version of the format.
    #[error("artifact has schema {found}, this version reads 1 to {expected}")]
    OtherSchema {
        /// Schema number found.
        found: u32,
        /// The newest schema that can be read.
        expected: u32,
    },
    /// The payload does not decode although its hash is right.
    #[error("artifact payload does not decode: {reason}")]
    Payload {
        /// What the decoder said.
        reason: String,
    },
    /// The payload decodes into something that is no network.
    #[error("artifact content: {0}")]
    Content(#[from] Error),
}

const NETWORK: Format = Format {
    kind: *b"NETW",
    schema: 2,
};

/// At most 1 GB of decoded data. Memory is bounded by the bytes given: every
/// string is borrowed from them, and a list reserves at most 1 MiB (serde's
/// bound) before its elements are read.
type Config = Configuration<LittleEndian, Fixint, Limit<{ 1 << 30 }>>;

fn config() -> Config {
    bincode::config::standard()
        .with_fixed_int_encoding()
        .with_limit::<{ 1 << 30 }>()
}

/// Schema 1 of a network. Field order is the format.
#[derive(Debug, Serialize, Deserialize)]
struct NetworkV1 {
    inputs: u64,
    hidden: Vec<u64>,
    outputs: u64,
    input_ranges: Vec<(f64, f64)>,
    output_ranges: Vec<(f64, f64)>,
    weights: Vec<f64>,
}

/// What schema 2 adds to the cascade of schema 1.
#[derive(Debug, Serialize, Deserialize)]
struct ArchitectureV2 {
    links: u8,
    transfers: Vec<u8>,
    dropped_inputs: Vec<u64>,
}

/// Schema 2 of a network.
#[derive(Debug, Serialize, Deserialize)]
struct NetworkV2 {
    architecture: ArchitectureV2,
    cascade: NetworkV1,
}

#[derive(Debug, Serialize, Deserialize)]
struct WithProvenance<'a, T> {
    provenance: &'a str,
    content: T,
}

impl From<&Network> for NetworkV1 {
    fn from(network: &Network) -> Self {
        let shape = network.shape();
        let ends = |ranges: &[crate::ScalingRange<f64>]| {
            ranges.iter().map(|r| (r.minimum(), r.maximum())).collect()
        };
        Self {
            inputs: shape.inputs as u64,
            hidden: shape.hidden.iter().map(|&n| n as u64).collect(),
            outputs: shape.outputs as u64,
            input_ranges: ends(network.scaling().input()),
            output_ranges: ends(network.scaling().output()),
            weights: network.weights().to_vec(),
        }
    }
}

impl TryFrom<NetworkV1> for Network {
    type Error = Error;

    fn try_from(stored: NetworkV1) -> Result<Self, Error> {
        let shape = Shape {
            inputs: size(stored.inputs),
            hidden: stored.hidden.into_iter().map(size).collect(),
            outputs: size(stored.outputs),
        };
        let scaling = Scaling::from_ranges(&stored.input_ranges, &stored.output_ranges)?;
        Network::new(shape, scaling, stored.weights)
    }
}

/// Counts beyond this machine's words saturate; a size is then refused as too
/// large.
fn size(n: u64) -> usize {
    usize::try_from(n).unwrap_or(usize::MAX)
}

/// Whether schema 1 can hold the network.
fn plain(network: &Network) -> bool {
    *network.architecture() == Architecture::from(network.shape().clone())
}

impl From<&Architecture> for ArchitectureV2 {
    fn from(architecture: &Architecture) -> Self {
        let code = |layer| match architecture.transfer(layer) {
            Activation::Tansig => 0,
            Activation::Logsig => 1,
            Activation::Purelin => 2,
            Activation::Poslin => 3,
        };
        let layers = 0..architecture.shape().hidden.len();
        let dropped = architecture.dropped_inputs().iter();
        Self {
            links: match architecture.links() {
                Links::Cascade => 0,
                Links::FeedForward => 1,
            },
            transfers: layers.map(code).collect(),
            dropped_inputs: dropped.map(|&i| i as u64).collect(),
        }
    }
}

impl ArchitectureV2 {
    /// The network with the links and transfer functions stored here.
    fn applied_to(self, cascade: &Network) -> Result<Network, Error> {
        let unknown = |name, value: u8, valid| Error::Setting {
            name,
            value: f64::from(value),
            valid,
        };
        let links = match self.links {
            0 => Links::Cascade,
            1 => Links::FeedForward,
            other => return Err(unknown("links", other, "0 or 1")),
        };
        let transfer = |&code: &u8| match code {
            0 => Ok(Activation::Tansig),
            1 => Ok(Activation::Logsig),
            2 => Ok(Activation::Purelin),
            3 => Ok(Activation::Poslin),
            other => Err(unknown("transfer", other, "0, 1, 2 or 3")),
        };
        let transfers = (self.transfers.iter().map(transfer)).collect::<Result<Vec<_>, _>>()?;
        let dropped: Vec<usize> = self.dropped_inputs.into_iter().map(size).collect();
        let architecture = Architecture::from(cascade.shape().clone())
            .with_links(links)
            .with_transfers(&transfers)?
            .without_inputs(&dropped)?;
        let (scaling, weights) = (cascade.scaling().clone(), cascade.weights().to_vec());
        Network::new(architecture, scaling, weights)
    }
}

impl TryFrom<NetworkV2> for Network {
    type Error = Error;

    fn try_from(stored: NetworkV2) -> Result<Self, Error> {
        stored.architecture.applied_to(&stored.cascade.try_into()?)
    }
}

/// The bytes of a network.
///
/// ```
/// use cfnn::{Network, Scaling, Shape, artifact};
/// let shape = Shape { inputs: 1, hidden: vec![], outputs: 1 };
/// let scaling = Scaling::from_ranges(&[(0.0, 1.0)], &[(0.0, 2.0)])?;
/// let network = Network::new(shape, scaling, vec![0.0, 1.0])?;
/// let bytes = artifact::network_to_bytes(&network, "axis 1f3a")?;
/// let (again, provenance) = artifact::network_from_bytes(&bytes)?;
/// assert_eq!((again, provenance.as_str()), (network, "axis 1f3a"));
/// assert!(artifact::network_from_bytes(&bytes[..40]).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ArtifactError::Payload`] when encoding fails, which memory alone can
/// cause.
pub fn network_to_bytes(network: &Network, provenance: &str) -> Result<Vec<u8>, ArtifactError> {
    if plain(network) {
        encode(NETWORK.older(1), NetworkV1::from(network), provenance)
    } else {
        let stored = NetworkV2 {
            architecture: network.architecture().into(),
            cascade: network.into(),
        };
        encode(NETWORK, stored, provenance)
    }
}

/// A network and its provenance from bytes.
///
/// # Errors
/// Any [`ArtifactError`]: every truncation and every flipped bit is refused.
pub fn network_from_bytes(bytes: &[u8]) -> Result<(Network, String), ArtifactError> {
    match frame::unwrap(NETWORK, bytes)? {
        (1, payload) => content::<NetworkV1, _>(payload),
        (_, payload) => content::<NetworkV2, _>(payload),
    }
}

fn encode<T: Serialize>(
    format: Format,
    content: T,
    provenance: &str,
) -> Result<Vec<u8>, ArtifactError> {
    let whole = WithProvenance {
        provenance,
        content,
    };
    let payload =
        bincode::serde::encode_to_vec(&whole, config()).map_err(|e| ArtifactError::Payload {
            reason: std::format!("it cannot be written: {e}"),
        })?;
    Ok(frame::wrap(format, &payload))
}

/// What a payload of the stored form `S` holds, with its provenance.
fn content<S, T>(payload: &[u8]) -> Result<(T, String), ArtifactError>
where
    S: DeserializeOwned,
    T: TryFrom<S, Error = Error>,
{
    let (whole, used): (WithProvenance<'_, S>, usize) =
        bincode::serde::borrow_decode_from_slice(payload, config()).map_err(payload_error)?;
    if used != payload.len() {
        return Err(ArtifactError::Payload {
            reason: std::format!("{used} of {} bytes used", payload.len()),
        });
    }
    Ok((whole.content.try_into()?, whole.provenance.into()))
}

/// bincode's own words are those of its types.
fn payload_error(error: bincode::error::DecodeError) -> ArtifactError {
    use bincode::error::DecodeError;
    let reason = match error {
        DecodeError::UnexpectedEnd { .. } => "it ends too early".into(),
        DecodeError::LimitExceeded => "it claims more than 1 GiB".into(),
        DecodeError::Utf8 { inner } => std::format!("a text in it is not UTF-8: {inner}"),
        DecodeError::OtherString(reason) => reason,
        _ => "a value in it is none of its kind".into(),
    };
    ArtifactError::Payload { reason }
}
