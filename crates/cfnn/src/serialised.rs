//! Networks and settings in any format that serde has; what is read is checked
//! as by the constructors.

use alloc::vec::Vec;

use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::{Activation, Architecture, Links, Network, Scaling, ScalingRange, Shape};

impl Serialize for Shape {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        // The derived one, which `remote` makes an associated function.
        Self::serialize(self, serializer)
    }
}

impl<'de> Deserialize<'de> for Shape {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let shape = Self::deserialize(deserializer)?;
        shape.validate().map_err(D::Error::custom)?;
        Ok(shape)
    }
}

#[cfg(feature = "train")]
impl Serialize for crate::train::TrainingSettings {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Self::serialize(self, serializer)
    }
}

#[cfg(feature = "train")]
impl<'de> Deserialize<'de> for crate::train::TrainingSettings {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let settings = Self::deserialize(deserializer)?;
        settings.validate().map_err(D::Error::custom)?;
        Ok(settings)
    }
}

/// Minimum and maximum of each input and output.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Scaling", deny_unknown_fields)]
struct StoredScaling {
    input: Vec<(f64, f64)>,
    output: Vec<(f64, f64)>,
}

impl Serialize for Scaling {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let ends = |ranges: &[ScalingRange<f64>]| {
            ranges.iter().map(|r| (r.minimum(), r.maximum())).collect()
        };
        StoredScaling {
            input: ends(self.input()),
            output: ends(self.output()),
        }
        .serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Scaling {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let stored = StoredScaling::deserialize(deserializer)?;
        Self::from_ranges(&stored.input, &stored.output).map_err(D::Error::custom)
    }
}

/// What is usual need not be there.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Architecture", deny_unknown_fields)]
struct StoredArchitecture {
    shape: Shape,
    #[serde(default)]
    links: Links,
    #[serde(default)]
    transfers: Vec<Activation>,
    #[serde(default)]
    dropped_inputs: Vec<usize>,
}

impl Serialize for Architecture {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        StoredArchitecture {
            shape: self.shape().clone(),
            links: self.links(),
            transfers: self.transfers().to_vec(),
            dropped_inputs: self.dropped_inputs().to_vec(),
        }
        .serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Architecture {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let stored = StoredArchitecture::deserialize(deserializer)?;
        let mut architecture = Self::from(stored.shape).with_links(stored.links);
        if !stored.transfers.is_empty() {
            architecture =
                (architecture.with_transfers(&stored.transfers)).map_err(D::Error::custom)?;
        }
        (architecture.without_inputs(&stored.dropped_inputs)).map_err(D::Error::custom)
    }
}

#[derive(Serialize, Deserialize)]
#[serde(rename = "Network", deny_unknown_fields)]
struct StoredNetwork {
    architecture: Architecture,
    scaling: Scaling,
    weights: Vec<f64>,
}

impl Serialize for Network {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        StoredNetwork {
            architecture: self.architecture().clone(),
            scaling: self.scaling().clone(),
            weights: self.weights().to_vec(),
        }
        .serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Network {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let stored = StoredNetwork::deserialize(deserializer)?;
        Self::new(stored.architecture, stored.scaling, stored.weights).map_err(D::Error::custom)
    }
}
