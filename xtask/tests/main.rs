//! One test program: the developers' commands.

mod bench;
mod cli;
#[path = "../../crates/feed-axis/tests/common/mod.rs"]
mod common;
mod torture;
mod tuning;
