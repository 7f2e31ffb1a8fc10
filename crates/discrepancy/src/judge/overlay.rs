//! Measured beside simulated, for pictures.

use crate::answers::LogSet;
use crate::answers::Rest;

/// Measured, model before and after, for pictures: one channel of one log.
#[derive(Clone, Debug)]
pub struct Overlay {
    /// Log and channel.
    pub title: String,
    /// Name with unit.
    pub channel: String,
    /// s.
    pub time: Vec<f64>,
    /// Measured minus model, before.
    pub before: Vec<f64>,
    /// Measured minus model, after.
    pub after: Vec<f64>,
}

/// Every channel of every log, with its residuals before and after.
pub(super) fn overlays(set: &LogSet, before: &Rest, after: &Rest) -> Vec<Overlay> {
    let mut all = Vec::new();
    for (l, log) in set.logs.iter().enumerate() {
        for (c, name) in set.channels.iter().enumerate() {
            all.push(Overlay {
                title: format!("{}: {name}", log.name),
                channel: (*name).to_owned(),
                time: log.log.time().to_vec(),
                before: before[l][c].clone(),
                after: after[l][c].clone(),
            });
        }
    }
    all
}
