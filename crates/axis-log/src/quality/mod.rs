//! Whether a log is fit to draw conclusions from: even sampling, channels that
//! move, units that agree; what each channel is like, and whether channels agree.

mod channel;
mod crosscheck;
mod hold;
mod jitter;
mod noise;
mod outliers;
mod quantum;
mod relation;
mod sampling;
mod unit_slip;

pub use channel::{ChannelQuality, Clock, Delay, channel_quality, clock};
pub use crosscheck::{CrossCheckVerdict, Finding, cross_check};
pub use hold::{Hold, Saturation};
pub use jitter::{SampleJitter, sample_jitter};
pub use noise::{ChannelNoise, Colour};
pub use outliers::{Outlier, outliers};
pub use quantum::Quantum;
pub use relation::{Relation, RelationLaw};
pub use sampling::{
    MAX_JITTER, MAX_RATE_HZ, MIN_RATE_HZ, MIN_SAMPLES, Sampling, SamplingError, check_sampling,
    rate_of,
};
pub use unit_slip::{UnitSlip, unit_slip};

use crate::log::Log;

/// Names of the channels, the time apart, whose samples are all the same number:
/// a sensor that is not connected, or a channel that was not recorded.
pub fn constant_channels(log: &Log) -> Vec<String> {
    log.channels()
        .iter()
        .skip(1)
        .filter(|c| c.samples.windows(2).all(|w| w[0] == w[1]))
        .map(|c| c.name.clone())
        .collect()
}
