//! The jobs of this program: those of users, and the matrix.

use clap::Subcommand;
use feed_axis::commands::UserJob;
use feed_axis::jobs::{JobOptions, Jobs};

use crate::commands::discover_matrix;

/// One line a job.
#[derive(Subcommand)]
pub enum Job {
    /// A job of users.
    #[command(flatten)]
    User(UserJob),
    /// Hide effects in simulated machines, search for them blind, and score the answers
    DiscoverMatrix(discover_matrix::Options),
}

impl Jobs for Job {
    fn options(&self) -> &dyn JobOptions {
        match self {
            Self::User(job) => job.options(),
            Self::DiscoverMatrix(options) => options,
        }
    }
}
