//! Whether a log is fit to draw conclusions from: even sampling, channels that
//! move, units that agree.

mod outliers;
mod sampling;
mod unit_slip;

pub use outliers::{Outlier, outliers};
pub use sampling::{
    MAX_JITTER, MAX_RATE_HZ, MIN_RATE_HZ, MIN_SAMPLES, Sampling, SamplingError, check_sampling,
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
