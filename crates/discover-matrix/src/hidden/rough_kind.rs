//! What noise of a case is.

use serde::{Deserialize, Serialize};

/// What is added to white noise in the loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoiseColour {
    /// White noise.
    White,
    /// First-order filtered noise and a line at one frequency.
    Coloured,
    /// Steps of a resolution.
    Quantised,
    /// Rare samples that are far off.
    Outliers,
}

/// Where that enters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Entry {
    /// In the sensors: the controller sees it as well.
    Loop,
    /// In the logger: only the log shows it.
    Logger,
}

/// Noise of a case. White noise of `level` in the loop is always there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rough {
    /// White noise in the loop, as a multiple of that of good sensors ([`Noise::good`](super::Noise::good)).
    pub level: f64,
    /// What comes beside it.
    pub colour: NoiseColour,
    /// Where that enters; outliers enter in the logger.
    pub entry: Entry,
    /// Standard deviation of what comes beside, or its resolution, as a multiple of the
    /// white noise.
    pub share: f64,
    /// Corner frequency of coloured noise, Hz.
    pub corner: f64,
    /// Frequency of its line, Hz.
    pub line: f64,
    /// Probability of an outlier in each sample of each channel.
    pub rare: f64,
    /// Size of outliers, as a multiple of the white noise.
    pub far: f64,
}
