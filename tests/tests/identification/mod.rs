//! Friction identified from logs: of the whole simulated axis, of a generator that shares no code
//! with the project, and of a real bench.

mod bench;
mod drawn;
mod simulated;

use axis_sim::Axis;

fn axis(name: &str) -> Axis {
    let file = format!("{}/../data/axes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Axis::read(file.as_ref()).unwrap()
}
