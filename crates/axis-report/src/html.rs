//! Page to HTML.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::error::ReportError;
use crate::figure::{Figure, Series, Style};
use crate::interactive::{self, Detail};
use crate::number::{fixed, scientific};
use crate::page::{Block, KeyValues, Notice, Page};
use crate::plot;
use crate::table::{Cell, Mark, Table};
use crate::unit::engineering;

const STYLE: &str = include_str!("style.css");

/// What the browser may do with the page: nothing comes from or goes to any address.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'";

/// The page as one HTML text: style, plots and the script that makes them
/// interactive inline, nothing fetched, the same bytes for the same page.
///
/// # Errors
/// The first [`ReportError`] in reading order: a number that is not finite, a
/// table or series whose lengths disagree, a series without points.
pub fn render(page: &Page) -> Result<String, ReportError> {
    let mut numbers = Numbers {
        figures: 0,
        tables: 0,
        detail: Detail::of(page),
    };
    let first = numbers.blocks(&page.first)?;
    let sections = page
        .sections
        .iter()
        .map(|s| numbers.blocks(&s.blocks))
        .collect::<Result<Vec<_>, _>>()?;
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="color-scheme" content="light dark";
                title { (page.title) }
                style { (PreEscaped(STYLE)) }
                @if numbers.figures > 0 { style { (PreEscaped(interactive::STYLE)) } }
            }
            body {
                header {
                    h1 { (page.title) }
                    @if !page.lead.is_empty() { p.lead { (page.lead) } }
                    (first)
                }
                @if page.sections.len() > 1 { (contents(page)) }
                @if numbers.figures > 0 {
                    p.hint { "Figures: drag to zoom, double-click to show all, point at a curve for its values, click a name to hide it." }
                }
                main {
                    @for (index, (section, body)) in page.sections.iter().zip(&sections).enumerate() {
                        section id={ "s" (index + 1) } {
                            h2 { (section.title) }
                            (body)
                        }
                    }
                }
                @if numbers.figures > 0 { (interactive::script()) }
            }
        }
    };
    Ok(markup.into_string())
}

fn contents(page: &Page) -> Markup {
    html! {
        nav aria-label="Contents" {
            ol {
                @for (index, section) in page.sections.iter().enumerate() {
                    li { a href={ "#s" (index + 1) } { (section.title) } }
                }
            }
        }
    }
}

/// Running numbers of figures and tables, and how finely figures are kept.
struct Numbers {
    figures: usize,
    tables: usize,
    detail: Detail,
}

impl Numbers {
    fn blocks(&mut self, blocks: &[Block]) -> Result<Markup, ReportError> {
        let parts = blocks
            .iter()
            .map(|b| self.block(b))
            .collect::<Result<Vec<_>, _>>()?;
        Ok(html! { @for part in parts { (part) } })
    }

    fn block(&mut self, block: &Block) -> Result<Markup, ReportError> {
        Ok(match block {
            Block::Paragraph(text) => html! { p { (text) } },
            Block::List(items) => html! { ul { @for item in items { li { (item) } } } },
            Block::Preformatted(text) => html! { div.scroll { pre { (text) } } },
            Block::Notice(kind, text) => notice(*kind, text),
            Block::Table(table) => self.table(table)?,
            Block::Figure(figure) => self.figure(figure, true)?,
            Block::FigureGrid { figures, columns } => self.grid(figures, *columns)?,
            Block::KeyValues(list) => key_values(list),
            Block::Answers(all) => answers(all),
            Block::Folded { summary, blocks } => {
                let body = self.blocks(blocks)?;
                html! { details { summary { (summary) } (body) } }
            }
        })
    }

    fn grid(&mut self, figures: &[Figure], columns: usize) -> Result<Markup, ReportError> {
        let parts = figures
            .iter()
            .map(|f| self.figure(f, false))
            .collect::<Result<Vec<_>, _>>()?;
        Ok(html! {
            div.grid style={ "--columns:" (columns.max(1)) } {
                @for part in parts { (part) }
            }
        })
    }

    fn figure(&mut self, figure: &Figure, full_width: bool) -> Result<Markup, ReportError> {
        figure.check()?;
        self.figures += 1;
        let number = self.figures;
        let figure = &figure.in_base_units();
        let narrow = plot::draw(figure, plot::NARROW, &format!("c{number}n"));
        let canvas = if full_width { plot::WIDE } else { plot::NARROW };
        let kept = interactive::keep(figure, canvas, self.detail);
        Ok(html! {
            figure {
                div.title { b { "Figure " (number) } " " (figure.title) }
                (legend(&figure.series))
                div.drawing {
                    @if full_width {
                        div.wide { (PreEscaped(plot::draw(figure, plot::WIDE, &format!("c{number}w")))) }
                        div.narrow { (PreEscaped(narrow)) }
                    } @else {
                        div { (PreEscaped(narrow)) }
                    }
                }
                @if let Some(kept) = kept { (kept) }
                @if !figure.caption.is_empty() { figcaption { (figure.caption) } }
            }
        })
    }

    fn table(&mut self, table: &Table) -> Result<Markup, ReportError> {
        table.check()?;
        self.tables += 1;
        let heading = html! { b { "Table " (self.tables) } " " (table.caption) };
        let labels = labels(table);
        let body = html! {
            div.scroll.stack[table.columns.len() > MOST_ON_A_PHONE].many[table.columns.len() > MOST_WITH_ROOM] tabindex="0" role="region" aria-label=(table.caption) {
                table {
                    thead { (table_head(table)) }
                    tbody { @for row in &table.rows { (table_row(row, &labels)) } }
                }
            }
            @for note in &table.notes { p.note { (note) } }
        };
        Ok(html! {
            div.table {
                @if table.folded {
                    details {
                        summary { (heading) " (" (table.rows.len()) " rows)" }
                        (body)
                    }
                } @else {
                    div.title { (heading) }
                    (body)
                }
            }
        })
    }
}

fn notice(kind: Notice, text: &str) -> Markup {
    let (class, label) = match kind {
        Notice::Info => ("info", "Note"),
        Notice::Good => ("good", "✓"),
        Notice::Warn => ("warn", "Attention"),
    };
    html! { div class={ "notice " (class) } role="note" { b { (label) } " " (text) } }
}

fn key_values(list: &KeyValues) -> Markup {
    html! {
        div.table {
            @if !list.caption.is_empty() { div.title { b { (list.caption) } } }
            dl {
                @for (name, value) in &list.entries {
                    div { dt { (name) } dd { (value) } }
                }
            }
        }
    }
}

fn answers(all: &[(String, Vec<String>)]) -> Markup {
    html! {
        dl.answers {
            @for (question, lines) in all {
                div {
                    dt { (question) }
                    dd { @for line in lines { p { (line) } } }
                }
            }
        }
    }
}

fn legend(series: &[Series]) -> Markup {
    html! {
        @if series.iter().any(|s| !s.name.is_empty()) {
            ul.legend {
                @for (index, s) in series.iter().enumerate() {
                    @if !s.name.is_empty() { li { (swatch(s, index)) (s.name) } }
                }
            }
        }
    }
}

fn swatch(series: &Series, index: usize) -> Markup {
    let colour = plot::colour(series, index);
    let dash = plot::is_dashed(series, index).then_some("6 4");
    html! {
        svg viewBox="0 0 26 10" width="26" height="10" aria-hidden="true" {
            @if series.style == Style::Dots {
                circle cx="13" cy="5" r="3" fill=(colour) {}
            } @else {
                path d="M0 5h26" stroke=(colour) stroke-width="2.4" stroke-dasharray=[dash] {}
            }
        }
    }
}

fn table_head(table: &Table) -> Markup {
    html! {
        @if !table.groups.is_empty() {
            tr.groups {
                @for group in &table.groups {
                    th colspan=(group.span) scope="colgroup" { (group.label) }
                }
            }
        }
        tr {
            @for (index, column) in table.columns.iter().enumerate() {
                th scope="col" class=[numeric(table, index).then_some("n")] { (column) }
            }
        }
    }
}

/// A column is headed on the right where it holds numbers.
fn numeric(table: &Table, column: usize) -> bool {
    table
        .rows
        .iter()
        .any(|row| class(&row[column]).is_some_and(|_| row[column] != Cell::Missing))
}

/// Columns that a phone's width shows beside each other. A table with more is stacked there: a row
/// becomes a block, each value on a line of its own behind the name of its column.
const MOST_ON_A_PHONE: usize = 4;

/// Columns that have room between them at a desk's width; of more the columns stand closer.
const MOST_WITH_ROOM: usize = 7;

/// What names each column where the header is not shown: its own text behind that of its group.
fn labels(table: &Table) -> Vec<String> {
    let spans = table.groups.iter();
    let groups = spans.flat_map(|group| std::iter::repeat_n(group.label.as_str(), group.span));
    let groups = groups.chain(std::iter::repeat(""));
    let named = table.columns.iter().zip(groups);
    named
        .map(|(column, group)| match group {
            "" => column.clone(),
            _ => format!("{group}, {column}"),
        })
        .collect()
}

fn table_row(row: &[Cell], labels: &[String]) -> Markup {
    html! {
        tr {
            @for (index, cell) in row.iter().enumerate() {
                @if index == 0 {
                    th scope="row" { (content(cell)) }
                } @else {
                    td class=[class(cell)] data-label=(labels[index]) { (content(cell)) }
                }
            }
        }
    }
}

fn class(cell: &Cell) -> Option<&'static str> {
    match cell {
        Cell::Text(_) => None,
        Cell::Missing => Some("n"),
        Cell::Number { mark, .. } | Cell::Scientific { mark, .. } | Cell::Quantity { mark, .. } => {
            Some(match mark {
                Mark::Plain => "n",
                Mark::Best => "n best",
                Mark::Failing => "n failing",
            })
        }
    }
}

fn content(cell: &Cell) -> Markup {
    match cell {
        Cell::Text(text) => html! { (text) },
        Cell::Missing => html! { "–" },
        Cell::Number { value, digits, .. } => html! { (fixed(*value, *digits)) },
        Cell::Scientific { value, digits, .. } => html! { (scientific(*value, *digits)) },
        Cell::Quantity {
            value,
            unit,
            digits,
            ..
        } => html! { (engineering(*value, unit, *digits)) },
    }
}
