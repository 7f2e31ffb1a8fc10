//! Strategies that run cycle by cycle.

/// Names of the strategies that run cycle by cycle.
pub const CYCLE_BY_CYCLE: &[&str] = &[
    "network",
    "network_lugre",
    "network_lugre_printed",
    "transfer_function",
    "transfer_function_lugre",
    "lugre",
    "plan",
    "feedback",
];
