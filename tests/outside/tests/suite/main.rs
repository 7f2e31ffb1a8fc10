//! What a program of one's own adds to the libraries works as what they hold themselves.

mod axis_file;
mod docs;
mod hoist;
mod own_time;
mod power;
mod strategy;

use axis_sim::Axis;

/// Drag of 80 N at 0.2 m/s, to put behind the text of the axis file.
const DRAG: &str = "\n[[effects]]\nname = \"quadratic-drag\"\ncoefficient = 2000\n";

/// Reads the text of a hoist's axis file.
fn read(text: &str) -> Axis {
    Axis::parse_with("hoist.toml", text, &outside::registry()).unwrap()
}
