//! One test program: stages of the pipeline as library calls.

mod drive_terms;
mod learning;
mod moves;
mod robustness;
mod samples;
