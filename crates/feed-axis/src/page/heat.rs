//! The page of hours of a duty.

use axis_report::{Cell, Figure, Notice, Page, Section, Series, Table};
use axis_sim::SixDigits;

use crate::commands::heat_words::Heated;

/// Figures share the time.
const TIME: &str = "time";

/// The page.
pub fn page(found: &Heated) -> Page {
    let page = Page::new(format!("Heat of {}", found.axis)).lead(found.title());
    let page = page.section(overview(found)).section(temperatures(found));
    let page = match found.places.is_empty() {
        true => page,
        false => page.section(growth(found)),
    };
    let page = match &found.force {
        Some(_) => page.section(force(found)),
        None => page,
    };
    page.section(losses(found))
}

fn over_time(title: &str, what: &str, unit: &str) -> Figure {
    let figure = Figure::new(title, "time", what);
    figure.units("min", unit).linked(TIME)
}

fn line(found: &Heated, name: impl Into<String>, values: &[f64]) -> Series {
    Series::line(name, found.time_min.clone(), values.to_vec())
}

fn at(position_mm: f64) -> String {
    format!("at {} mm", SixDigits(position_mm))
}

fn overview(found: &Heated) -> Section {
    let unseen = found.unseen();
    let ends = unseen
        .iter()
        .map(|(at, growth)| (*at, growth.last().copied().unwrap_or(0.0)));
    let worst = ends.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    let mut section = Section::new("Overview");
    if let Some((position, growth)) = worst {
        section = section.notice(
            Notice::Warn,
            format!(
                "After {} min the table is off by {growth:.1} µm {}. {}",
                SixDigits(found.duration_s / 60.0),
                at(position),
                found.what_counts()
            ),
        );
    }
    let mut heads = vec![
        "after".to_owned(),
        "loss, W".to_owned(),
        "viscous friction ×".to_owned(),
    ];
    heads.extend(
        unseen
            .iter()
            .map(|(position, _)| format!("{}, µm", at(*position))),
    );
    let mut table = Table::new("Losses and what the controller does not see", heads);
    for i in found.rows() {
        let growth = unseen.iter().map(|(_, growth)| Cell::number(growth[i], 1));
        let first = [
            Cell::text(format!("{} min", SixDigits(found.time_min[i]))),
            Cell::number(found.loss_w[i], 1),
            Cell::number(found.viscous_factor[i], 3),
        ];
        table = table.row(first.into_iter().chain(growth));
    }
    section
        .notice(
            Notice::Info,
            format!(
                "Simulated; no measured log has shown these temperatures. {}",
                found.assumed()
            ),
        )
        .table(table)
}

fn temperatures(found: &Heated) -> Section {
    let mut bodies = over_time("Temperatures", "temperature", "°C");
    for node in &found.nodes {
        bodies = bodies.series(line(found, node.name, &node.temperature_c));
    }
    if !found.screw_mean_c.is_empty() {
        bodies = bodies.series(line(found, "screw, mean", &found.screw_mean_c));
    }
    let section = Section::new("Temperatures").figure(bodies);
    let Some(segment) = found.screw_segment_mm else {
        return section;
    };
    let places = (0..found.screw_at_end_c.len()).map(|i| (i as f64 + 0.5) * segment);
    let along = Series::line("in the end", places.collect(), found.screw_at_end_c.clone());
    let title = "Screw from the driven end";
    let figure = Figure::new(title, "place", "temperature").units("mm", "°C");
    section.figure(figure.series(along))
}

fn growth(found: &Heated) -> Section {
    let mut section = Section::new("Growth").paragraph(format!(
        "Since the start, against the front bearing's place on the bed. {}",
        found.what_counts()
    ));
    let mut screw = over_time("Growth of the screw", "growth", "µm");
    let mut scale = over_time("Growth of the scale", "growth", "µm");
    let mut bed = over_time("Growth of the bed", "growth", "µm");
    let mut any = false;
    for place in &found.places {
        let name = || at(place.position_mm);
        if let Some(values) = &place.screw_um {
            any = true;
            screw = screw.series(line(found, name(), values));
        }
        scale = scale.series(line(found, name(), &place.scale_um));
        bed = bed.series(line(found, name(), &place.bed_um));
    }
    if any {
        section = section.figure(screw);
    }
    section.figure(scale).figure(bed)
}

fn force(found: &Heated) -> Section {
    let mut figure = over_time("Force of the screw held at both ends", "force", "N");
    let mut lost = false;
    if let Some(force) = &found.force {
        lost = force.tension_n.iter().any(|tension| *tension < 0.0);
        figure = figure
            .series(line(found, "compression by heat", &force.compression_n))
            .series(line(found, "tension left", &force.tension_n));
    }
    let section = Section::new("Thermal force");
    let section = match lost {
        true => section.notice(
            Notice::Warn,
            "The pretension does not last: the screw is compressed. The model goes on as if both bearings still held it.",
        ),
        false => section,
    };
    section.figure(figure)
}

fn losses(found: &Heated) -> Section {
    let loss = over_time("Losses", "loss", "W").series(line(found, "all", &found.loss_w));
    let factors = over_time(
        "Friction against that at the reference temperature",
        "factor",
        "",
    )
    .series(line(found, "dry", &found.dry_factor))
    .series(line(found, "viscous", &found.viscous_factor));
    Section::new("Losses and friction")
        .figure(loss)
        .figure(factors)
}
