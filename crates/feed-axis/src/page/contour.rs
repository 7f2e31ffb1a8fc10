//! The page of a circle that two axes ran in both directions.

use axis_report::{Cell, Figure, Page, Section, Series, Table};
use toolpath::iso230_4::NominalCircle;

use crate::commands::contour_circle::Contoured;

/// Points of a line in a figure at most: more than a screen has.
const MOST_POINTS: usize = 2000;

/// The page. `turns` are the positions (m) of the clockwise and the counterclockwise turn.
pub fn page(found: &Contoured<'_>, nominal: &NominalCircle, turns: [&[[f64; 2]]; 2]) -> Page {
    let mut over_angle = Figure::new("Radial deviation over angle", "angle", "radial deviation")
        .units("°", "µm")
        .caption("Distance from the nominal centre less the nominal radius; X reverses at 0° and 180°, Y at 90° and 270°.");
    for (name, turn) in ["clockwise", "counterclockwise"].into_iter().zip(turns) {
        over_angle = over_angle.series(by_angle(name, deviations(nominal, turn)));
    }
    let mut table = Table::new(
        "Figures of the counted turns, in the manner of ISO 230-4",
        ["figure", "clockwise", "counterclockwise", "both"],
    );
    for (name, there, back) in found.rows() {
        let value = |v| Cell::quantity(v, "µm", 3);
        table = table.row([Cell::text(name), value(there), value(back), Cell::text("")]);
    }
    for (name, value) in found.together() {
        let none = || Cell::text("");
        table = table.row([
            Cell::text(name),
            none(),
            none(),
            Cell::quantity(value, "µm", 3),
        ]);
    }
    Page::new("Two axes on a circle")
        .lead(found.title())
        .section(
            Section::new("Contour error")
                .figure(over_angle)
                .table(table),
        )
}

/// Angle (degrees, 0 to 360) and radial deviation (µm) of so many points of a turn.
fn deviations(nominal: &NominalCircle, turn: &[[f64; 2]]) -> (Vec<f64>, Vec<f64>) {
    let every = turn.len().div_ceil(MOST_POINTS).max(1);
    let of = |&[x, y]: &[f64; 2]| {
        let (x, y) = (x - nominal.centre[0], y - nominal.centre[1]);
        let angle = y.atan2(x).to_degrees().rem_euclid(360.0);
        (angle, 1e6 * (x.hypot(y) - nominal.radius))
    };
    turn.iter().step_by(every).map(of).unzip()
}

/// A line over the angle, in its order.
fn by_angle(name: &str, (angles, deviations): (Vec<f64>, Vec<f64>)) -> Series {
    let mut pairs: Vec<(f64, f64)> = angles.into_iter().zip(deviations).collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (x, y) = pairs.into_iter().unzip();
    Series::line(name, x, y)
}
