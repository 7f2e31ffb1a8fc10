//! One test program: stages of the pipeline as library calls.

mod drive_terms;
mod learning;
mod robustness;
mod samples;
