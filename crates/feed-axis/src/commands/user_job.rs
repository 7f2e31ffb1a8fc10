//! The jobs of users.

use clap::Subcommand;

use super::{robustness, sample, study};
use crate::jobs::{JobOptions, Jobs};

/// The jobs of users.
#[derive(Subcommand)]
pub enum UserJob {
    /// Simulate one-cycle samples over a Latin hypercube (Section 4.2)
    Sample(sample::Options),
    /// Train networks of other damping, layers, neurons and epochs over several seeds (Tables 7 to
    /// 10)
    Study(study::Options),
    /// Tracking error that compensation leaves when its model is wrong, draw by draw
    Robustness(robustness::Options),
}

impl Jobs for UserJob {
    fn options(&self) -> &dyn JobOptions {
        match self {
            Self::Sample(options) => options,
            Self::Study(options) => options,
            Self::Robustness(options) => options,
        }
    }
}
