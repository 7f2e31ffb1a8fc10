//! One test program: stages of the pipeline as library calls.

mod drive_terms;
mod heat;
mod heat_sampled;
mod learning;
mod moves;
mod robustness;
mod samples;
mod warm;
