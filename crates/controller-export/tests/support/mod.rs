//! A controller's samples, the strategies in Rust on them, and a C program that compares.
#![allow(dead_code, reason = "each test and example uses a part")]

pub mod laws;
pub mod program;
pub mod samples;

use std::error::Error;

/// What may go wrong, told by the test.
pub type Outcome<T> = Result<T, Box<dyn Error>>;
