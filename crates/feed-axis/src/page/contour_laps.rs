//! The page of a machine on a path: magnified pictures, error along the path, laps, feeds.

use axis_report::{Cell, Figure, Page, Section, Series, Table, engineering};

use crate::commands::contour_found::{Contoured, MachineContoured};

/// Points of a line in a figure at most: more than a screen has.
const MOST_POINTS: usize = 4000;

/// Colours of what is drawn beside the measured lines.
const BLACK: usize = 6;

/// The page; `radius` (m) of a circle.
pub fn page(found: &MachineContoured, radius: Option<f64>) -> Page {
    let mut error = Section::new("Contour error").table(laps(found));
    error = match radius {
        Some(radius) => error.figure_grid(
            found.directions.iter().map(|d| polar(d, radius)).collect(),
            2,
        ),
        None => error.figure_grid(found.directions.iter().map(plan_view).collect(), 2),
    };
    error = error.figure(along(found, radius));
    let mut page = Page::new("A machine on a path")
        .lead(found.title())
        .section(error);
    if let Some(found) = &found.identified {
        let table = Table::new(
            "Found from circles at two feeds",
            ["", "value", "standard error"],
        )
        .row(row(
            "squareness of X and Y, µm/m",
            found.squareness_um_per_m,
        ))
        .row(row(
            "cross-talk of X by Y, µm/(m/s²)",
            found.crosstalk_um_per_m_per_s2,
        ))
        .note("Standard errors as if the residuals were independent; what friction leaves is not.");
        page = page.section(Section::new("Squareness and cross-talk").table(table));
    }
    if !found.networks.is_empty() {
        page = page.section(networks(found));
    }
    if let Some(section) = places(found) {
        page = page.section(section);
    }
    if !found.feeds.is_empty() {
        page = page.section(feeds(found));
    }
    page
}

fn row(name: &str, [value, error]: [f64; 2]) -> [Cell; 3] {
    [
        Cell::text(name),
        Cell::number(value, 2),
        Cell::number(error, 2),
    ]
}

/// What the training of each axis' network showed.
fn networks(found: &MachineContoured) -> Section {
    let mut table = Table::new(
        "Errors of the predicted position on samples that no training saw: network, and the best linear map of as many samples",
        [
            "axis",
            "samples",
            "network, greatest",
            "mean",
            "linear map, greatest",
            "mean",
        ],
    );
    for one in &found.networks {
        let value = |v| Cell::text(engineering(1e-6 * v, "m", 3));
        table = table.row([
            Cell::text(format!("{} {}", one.axis, one.name)),
            Cell::text(one.samples.to_string()),
            value(one.unseen_um[0]),
            value(one.unseen_um[1]),
            value(one.linear_um[0]),
            value(one.linear_um[1]),
        ]);
    }
    Section::new("One-cycle networks").table(table)
}

fn laps(found: &MachineContoured) -> Table {
    let mut table = Table::new("Laps", ["lap", "greatest", "99 %", "root mean square"]);
    for one in &found.directions {
        for lap in &one.laps {
            let value = |v| Cell::quantity(v, "µm", 3);
            table = table.row([
                Cell::text(format!("{}, {}", one.direction, lap.lap)),
                value(lap.contour_error_um),
                value(lap.p99_um),
                value(lap.rms_um),
            ]);
        }
    }
    match &found.both {
        Some(both) => table.note(format!(
            "Both directions of the last lap, in the manner of ISO 230-4: G(b) {:.3} µm, H {:.3} µm, D {:.3} µm.",
            both.g_um, both.h_um, both.d_um
        )),
        None => table,
    }
}

/// 1, 2 or 5 times a power of ten, at most `value`.
fn round_down(value: f64) -> f64 {
    let power = 10_f64.powf(value.log10().floor());
    let step = [5.0, 2.0]
        .into_iter()
        .find(|step| step * power <= value * (1.0 + 1e-12));
    step.unwrap_or(1.0) * power
}

/// By how much deviations of at most `error` (m) are magnified beside a size (m).
fn magnification(error: f64, size: f64) -> f64 {
    round_down(0.5 * size / error.max(1e-12))
}

/// Every how many points are drawn.
fn every(count: usize) -> usize {
    count.div_ceil(MOST_POINTS).max(1)
}

/// The circle with its radial deviation magnified, as in the pictures of ISO 230-4.
fn polar(one: &Contoured, radius: f64) -> Figure {
    let deviation = |at: &[[f64; 2]; 2]| at[0][0].hypot(at[0][1]) - radius;
    let worst = one
        .shown
        .at
        .iter()
        .map(|at| deviation(at).abs())
        .fold(0.0, f64::max);
    let by = magnification(worst, radius);
    let ring = round_down(0.5 * radius / by);
    let drawn = one.shown.at.iter().step_by(every(one.shown.at.len()));
    let of = |at: &[[f64; 2]; 2]| {
        let angle = at[0][1].atan2(at[0][0]);
        let r = 1e3 * (radius + by * deviation(at));
        (r * angle.cos(), r * angle.sin())
    };
    let (x, y) = drawn.map(of).unzip();
    let circle = |r: f64| -> (Vec<f64>, Vec<f64>) {
        let point = |k: u32| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 360.0).sin_cos();
            (1e3 * r * cos, 1e3 * r * sin)
        };
        (0..=360).map(point).unzip()
    };
    let mut figure = Figure::new(
        format!("Radial deviation, {}, last lap, magnified {by:.0} times", one.direction),
        "X",
        "Y",
    )
    .units("mm", "mm")
    .square()
    .caption(format!(
        "Circles: the nominal one, and {} µm outside and inside it. X reverses at 0° and 180°, Y at 90° and 270°.",
        short(1e6 * ring)
    ));
    for (name, r) in [
        ("nominal", radius),
        ("", radius + by * ring),
        ("", radius - by * ring),
    ] {
        let (x, y) = circle(r);
        let line = Series::line(name, x, y).colour(BLACK);
        figure = figure.series(if name.is_empty() { line.dashed() } else { line });
    }
    figure.series(Series::line(one.direction.clone(), x, y).colour(0))
}

/// A number without zeros at its end.
fn short(value: f64) -> String {
    format!("{:.6}", value)
        .trim_end_matches('0')
        .trim_end_matches('.')
        .to_owned()
}

/// The path, and where the tool was with its contour error magnified.
fn plan_view(one: &Contoured) -> Figure {
    let at = &one.shown.at;
    let least = |axis: usize| at.iter().map(|p| p[1][axis]).fold(f64::INFINITY, f64::min);
    let most = |axis: usize| {
        at.iter()
            .map(|p| p[1][axis])
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let size = [0, 1]
        .map(|axis| most(axis) - least(axis))
        .into_iter()
        .fold(1e-9, f64::max);
    let worst = one.shown.error.iter().copied().fold(0.0, f64::max);
    let by = magnification(worst, 0.3 * size);
    let step = every(at.len());
    let points = |of: &dyn Fn(&[[f64; 2]; 2]) -> [f64; 2]| -> (Vec<f64>, Vec<f64>) {
        at.iter()
            .step_by(step)
            .map(|p| of(p).map(|v| 1e3 * v).into())
            .unzip()
    };
    let (x, y) = points(&|p| p[1]);
    let (u, v) = points(&|p| [0, 1].map(|i| p[1][i] + by * (p[0][i] - p[1][i])));
    Figure::new(
        format!(
            "Path and tool, last lap, contour error magnified {} times",
            short(by)
        ),
        "X",
        "Y",
    )
    .units("mm", "mm")
    .square()
    .series(Series::line("path", x, y).colour(BLACK))
    .series(Series::line("tool", u, v).colour(0))
}

/// Error over arc length, of a circle radial deviation over the angle.
fn along(found: &MachineContoured, radius: Option<f64>) -> Figure {
    let mut figure = match radius {
        Some(_) => Figure::new("Radial deviation over angle, last lap", "angle", "radial deviation")
            .units("°", "µm")
            .caption("Distance from the nominal centre less the nominal radius; X reverses at 0° and 180°, Y at 90° and 270°."),
        None => Figure::new("Contour error along the path, last lap", "arc length", "contour error").units("mm", "µm"),
    };
    for one in &found.directions {
        let step = every(one.shown.s.len());
        let mut pairs: Vec<(f64, f64)> = match radius {
            Some(radius) => (one.shown.at.iter().step_by(step))
                .map(|at| {
                    let [x, y] = at[0];
                    (
                        y.atan2(x).to_degrees().rem_euclid(360.0),
                        1e6 * (x.hypot(y) - radius),
                    )
                })
                .collect(),
            None => peaks(&one.shown.s, &one.shown.error, step),
        };
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (x, y) = pairs.into_iter().unzip();
        figure = figure.series(Series::line(one.direction.clone(), x, y));
    }
    figure
}

/// The greatest of each `step` errors, mm and µm.
fn peaks(s: &[f64], error: &[f64], step: usize) -> Vec<(f64, f64)> {
    let both = s.chunks(step).zip(error.chunks(step));
    both.map(|(s, e)| (1e3 * s[0], 1e6 * e.iter().copied().fold(0.0, f64::max)))
        .collect()
}

fn places(found: &MachineContoured) -> Option<Section> {
    let mut section = Section::new("Reversals, corners and curves");
    let mut any = false;
    let micro = |v| Cell::quantity(v, "µm", 3);
    let mut peaks = Table::new(
        "Peaks of the radial deviation after a reversal, last lap",
        ["axis", "direction", "at", "peak"],
    );
    for one in &found.directions {
        for r in &one.reversals {
            peaks = peaks.row([
                Cell::text(r.axis.clone()),
                Cell::text(one.direction.clone()),
                Cell::text(format!("{:.0}°", r.angle_deg)),
                micro(r.peak_um),
            ]);
        }
    }
    if !peaks.rows.is_empty() {
        (section, any) = (section.table(peaks), true);
    }
    let kinds = [("Corners", "angle"), ("Tightest curves", "radius")];
    for (i, (title, shape)) in kinds.into_iter().enumerate() {
        let mut table = Table::new(
            format!("{title}: greatest contour error within 0.5 mm, last lap"),
            ["part", "arc length", shape, "error"],
        );
        for one in &found.directions {
            for place in if i == 0 { &one.corners } else { &one.curves } {
                table = table.row([
                    Cell::text(place.part.clone()),
                    Cell::quantity(place.s_mm, "mm", 3),
                    Cell::text(place.shape().replace("radius ", "")),
                    micro(place.error_um),
                ]);
            }
        }
        if !table.rows.is_empty() {
            (section, any) = (section.table(table), true);
        }
    }
    any.then_some(section)
}

fn feeds(found: &MachineContoured) -> Section {
    let mut table = Table::new(
        "Feed against contour error",
        ["feed", "reached", "duration", "first lap", "last lap"],
    );
    for row in &found.feeds {
        table = table.row([
            Cell::text(format!("{} m/min", row.feed_m_per_min)),
            Cell::text(format!("{:.2} m/min", row.fastest_m_per_min)),
            Cell::quantity(row.duration_s, "s", 2),
            Cell::quantity(row.first_um, "µm", 3),
            Cell::quantity(row.last_um, "µm", 3),
        ]);
    }
    let mut rows: Vec<_> = found.feeds.iter().collect();
    rows.sort_by(|a, b| a.feed_m_per_min.total_cmp(&b.feed_m_per_min));
    let of = |pick: fn(&crate::commands::contour_found::FeedRow) -> f64| -> Vec<f64> {
        rows.iter().map(|r| pick(r)).collect()
    };
    let figure = Figure::new(
        "Feed against greatest contour error",
        "feed (m/min)",
        "contour error",
    )
    .units("", "µm")
    .series(Series::line(
        "first lap",
        of(|r| r.feed_m_per_min),
        of(|r| r.first_um),
    ))
    .series(Series::line(
        "last lap",
        of(|r| r.feed_m_per_min),
        of(|r| r.last_um),
    ));
    Section::new("Feed").figure(figure).table(table)
}
