//! One test program: what the search may be asked, and what it may not conclude.

mod bench;
mod controller;
mod fit;
mod law_error;
mod logs;
#[path = "../../../tests/needs.rs"]
mod needs;
mod nothing_missing;
mod over_speed;
mod prediction;
mod sensor_steps;
mod settings;
mod slow_noise;
mod starts;
