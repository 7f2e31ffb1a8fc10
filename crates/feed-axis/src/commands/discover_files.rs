//! The files that `discover` writes.

/// What was found, and the axis file with it.
pub(super) const DISCOVERY: &str = "discovery.json";
pub(super) const AXIS: &str = "axis.toml";
/// File of the proposed motion.
pub(super) const NEXT: &str = "next-experiment.toml";
/// What logs and what a table of errors show: in one folder, neither takes the other's
/// place, nor that of `pipeline`'s summary.json.
pub(super) const REPORT: &str = "report.html";
