//! The page of an axis against its data sheets.

use axis_report::{Cell, Mark, Notice, Page, Section, Table};

use crate::commands::check_words::Checked;

/// The page.
pub fn page(found: &Checked) -> Page {
    let over = found.count("over");
    let notice = match (over, found.count("not known")) {
        (0, 0) => Notice::Good,
        (0, _) => Notice::Info,
        _ => Notice::Warn,
    };
    let mut table = Table::new(
        "Items",
        ["item", "what", "value", "limit", "margin", "verdict"],
    )
    .note("Margin: limit divided by value; of lives and safeties, value divided by limit. At 1 the limit is just reached. An item that the axis cannot have is left out.");
    for item in &found.items {
        let mark = match item.verdict {
            "over" => Mark::Failing,
            _ => Mark::Plain,
        };
        table = table.row([
            Cell::text(item.name),
            Cell::text(item.title),
            Cell::text(item.shown_value()),
            Cell::text(item.shown_limit()),
            match item.margin {
                Some(margin) if margin.is_finite() => Cell::number(margin, 2).marked(mark),
                _ => Cell::text(item.shown_margin()),
            },
            Cell::text(item.shown_verdict()),
        ]);
    }
    let how = match found.is_measured {
        true => "The duty is from logs; values that follow from it are computed.",
        false => "Simulated and computed, not measured.",
    };
    let limits = match found.keys_of_the_file {
        0 => "The axis file states no limit: it has no [rating].".to_owned(),
        1 => "Limits are 1 key of the axis file's [rating].".to_owned(),
        n => format!("Limits are {n} keys of the axis file's [rating]."),
    };
    let section = Section::new("Against the data sheets")
        .notice(notice, format!("{}.", found.result()))
        .table(table)
        .paragraph(format!("{how} {limits}"));
    Page::new(format!("Data sheets of {}", found.axis))
        .lead(found.title())
        .section(section)
}
