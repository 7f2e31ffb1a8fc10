//! What a browser needs to zoom a figure: its points, thinned, and the script that draws them.
//!
//! The points stand in the page as JSON: of each coordinate a start, a step and whole numbers,
//! each the difference to the one before. uPlot (vendor/uplot) draws; `plots.js` gives it
//! the points, units and colours.

use maud::{Markup, PreEscaped, html};
use serde_json::{Value, json};

use crate::decimate;
use crate::figure::{Figure, Scale, Series, Style};
use crate::page::{Block, Page};
use crate::plot::{self, Canvas};
use crate::scale::Fitted;
use crate::unit::Unit;

/// Styles of uPlot, for pages with figures.
pub(crate) const STYLE: &str = include_str!("../vendor/uplot/uPlot.min.css");

const LICENSE: &str = include_str!("../vendor/uplot/LICENSE");
const UPLOT: &str = include_str!("../vendor/uplot/uPlot.iife.min.js");
const PLOTS: &str = include_str!("plots.js");

/// Points that a page may keep for its figures, at about seven bytes each.
const POINTS: usize = 210_000;

/// Steps between the least and the greatest value of a series, on which values are kept.
const LEVELS: f64 = 65_536.0;

/// The same across, where samples are not evenly spaced.
const COLUMNS: f64 = 1_048_576.0;

/// The scripts, once a page.
pub(crate) fn script() -> Markup {
    html! { script { (PreEscaped(format!("/*\n{LICENSE}*/\n{UPLOT}\n{PLOTS}"))) } }
}

/// Pixel columns that figures are thinned for, as a multiple of those of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Detail(u32);

impl Detail {
    /// The finest that keeps the page small.
    pub fn of(page: &Page) -> Self {
        let mut sizes = Vec::new();
        let sections = page.sections.iter().flat_map(|s| &s.blocks);
        for block in page.first.iter().chain(sections) {
            series_of(block, &mut sizes);
        }
        let points = |detail: u32| -> usize {
            let most = |width: f64| 2 * width as usize * detail as usize;
            sizes.iter().map(|&(n, width)| n.min(most(width))).sum()
        };
        let finest = [16, 8, 4, 2].into_iter().find(|&d| points(d) <= POINTS);
        Self(finest.unwrap_or(1))
    }

    fn canvas(self, canvas: Canvas) -> Canvas {
        let times = f64::from(self.0);
        Canvas {
            width: times * canvas.width,
            height: times * canvas.height,
            ..canvas
        }
    }
}

/// The points of each series of a block, and the width of its picture.
fn series_of(block: &Block, sizes: &mut Vec<(usize, f64)>) {
    let mut of = |figure: &Figure, canvas: Canvas| {
        sizes.extend(figure.series.iter().map(|s| (s.x.len(), canvas.width)));
    };
    match block {
        Block::Figure(figure) => of(figure, plot::WIDE),
        Block::FigureGrid { figures, .. } => figures.iter().for_each(|f| of(f, plot::NARROW)),
        Block::Folded { blocks, .. } => blocks.iter().for_each(|b| series_of(b, sizes)),
        _ => {}
    }
}

/// The points of a checked figure in units without prefix, and how many they are of how many;
/// none if a line goes back, as a hysteresis loop does: such a figure stays a picture.
pub(crate) fn keep(figure: &Figure, canvas: Canvas, detail: Detail) -> Option<Markup> {
    let (x, y) = plot::fit(figure, canvas);
    let fine = detail.canvas(canvas);
    let mut kept = 0;
    let mut series = Vec::new();
    for (index, s) in figure.series.iter().enumerate() {
        let points = points(s, fine, &x, &y)?;
        kept += points.len();
        series.push(json!({
            "name": s.name,
            "style": style(s),
            "dash": plot::is_dashed(s, index),
            "colour": plot::place(s, index),
            "x": across(&s.x, &points, figure.x_scale)?,
            "y": grid(&s.y, &points, figure.y_scale, LEVELS)?,
        }));
    }
    let value = json!({
        "x": axis(&figure.x_label, &figure.x_unit, &x),
        "y": axis(&figure.y_label, &figure.y_unit, &y),
        "rows": figure.rows,
        "link": figure.linked,
        "series": series,
    });
    let all = figure.series.iter().map(|s| s.x.len()).sum();
    Some(html! {
        script type="application/json" { (PreEscaped(value.to_string().replace('<', "\\u003c"))) }
        @if kept < all {
            p.thinned { "Kept for zooming: " (kept) " of " (all) " points, every peak among them." }
        }
    })
}

/// Indices of the points to keep, from left to right; none if the line goes back.
fn points(series: &Series, canvas: Canvas, x: &Fitted, y: &Fitted) -> Option<Vec<usize>> {
    let pixels = plot::pixels(series, canvas, x, y);
    if series.style == Style::Dots {
        let mut kept = decimate::dots(&pixels);
        kept.sort_by(|&a, &b| series.x[a].total_cmp(&series.x[b]));
        return Some(kept);
    }
    let goes_on = series.x.windows(2).all(|w| w[0] <= w[1]);
    goes_on.then(|| decimate::line(&pixels))
}

fn style(series: &Series) -> &'static str {
    match series.style {
        // A line through one point would not be seen.
        _ if series.x.len() == 1 => "dots",
        Style::Line => "line",
        Style::Step => "step",
        Style::Dots => "dots",
    }
}

fn axis(label: &str, unit: &str, fitted: &Fitted) -> Value {
    let unit = Unit::parse(unit);
    let ends = [fitted.range.0, fitted.range.1].map(|v| fitted.undrawn(v));
    json!({
        "label": label,
        "unit": unit.base,
        "prefixes": unit.prefixes,
        "log": fitted.scale == Scale::Log,
        "ends": ends,
    })
}

/// Evenly spaced samples are kept by their number, which is exact.
fn across(values: &[f64], kept: &[usize], scale: Scale) -> Option<Value> {
    let (first, last) = (values[0], values[values.len() - 1]);
    let step = (last - first) / (values.len().max(2) - 1) as f64;
    let off = |(k, v): (usize, &f64)| (v - (first + k as f64 * step)).abs();
    let even = values.iter().enumerate().map(off).all(|d| d <= 1e-6 * step);
    if scale == Scale::Linear && even && step > 0.0 {
        let numbers = kept.iter().map(|&k| k as i64);
        return Some(differences(first, step, numbers));
    }
    grid(values, kept, scale, COLUMNS)
}

/// Values (on a logarithmic scale their logarithms to base 10) on a grid of so many steps;
/// none if they lie too far apart for one.
fn grid(values: &[f64], kept: &[usize], scale: Scale, levels: f64) -> Option<Value> {
    let value = |&k: &usize| match scale {
        Scale::Linear => values[k],
        Scale::Log => values[k].log10(),
    };
    let least = kept.iter().map(value).fold(f64::MAX, f64::min);
    let most = kept.iter().map(value).fold(f64::MIN, f64::max);
    let step = (most - least) / levels;
    if !step.is_finite() || (most > least && !step.is_normal()) {
        return None;
    }
    let number = |k| match step {
        0.0 => 0,
        step => ((value(k) - least) / step).round() as i64,
    };
    Some(differences(least, step, kept.iter().map(number)))
}

fn differences(start: f64, step: f64, numbers: impl Iterator<Item = i64>) -> Value {
    let mut before = 0;
    let steps: Vec<i64> = numbers
        .map(|n| n - std::mem::replace(&mut before, n))
        .collect();
    json!([start, step, steps])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn undone(kept: &Value) -> Vec<f64> {
        let [start, step] = [0, 1].map(|k| kept[k].as_f64().unwrap());
        let mut sum = 0;
        let steps = kept[2].as_array().unwrap().iter();
        steps
            .map(|d| {
                sum += d.as_i64().unwrap();
                start + step * sum as f64
            })
            .collect()
    }

    proptest! {
        /// What a browser adds up is the value, to half a step of the grid.
        #[test]
        fn kept_values_are_the_values(values in prop::collection::vec(-1e3..1e3f64, 1..50)) {
            let all: Vec<usize> = (0..values.len()).collect();
            let kept = grid(&values, &all, Scale::Linear, LEVELS).unwrap();
            let span = values.iter().fold(f64::MIN, |a, &b| a.max(b))
                - values.iter().fold(f64::MAX, |a, &b| a.min(b));
            for (a, b) in undone(&kept).iter().zip(&values) {
                prop_assert!((a - b).abs() <= 0.501 * span / LEVELS + 1e-10, "{a} {b}");
            }
        }
    }

    #[test]
    fn samples_at_a_clock_keep_their_time() {
        let time: Vec<f64> = (0..36_000).map(|k| f64::from(k) * 1e-4).collect();
        let some = [0, 17_321, 35_999];
        let kept = undone(&across(&time, &some, Scale::Linear).unwrap());
        for (k, t) in some.iter().zip(kept) {
            assert!((t - time[*k]).abs() < 1e-12, "{t}");
        }
    }

    #[test]
    fn few_figures_are_kept_finer_than_many() {
        let long = || vec![0.0; 100_000];
        let figure = Figure::new("f", "x", "y").series(Series::line("", long(), long()));
        let page = |n| {
            let section = crate::page::Section::new("s").figure_grid(vec![figure.clone(); n], 2);
            Detail::of(&Page::new("p").section(section))
        };
        assert_eq!(
            (page(1), page(60), page(400)),
            (Detail(16), Detail(4), Detail(1))
        );
    }

    #[test]
    fn a_loop_stays_a_picture() {
        let line = |x: Vec<f64>| {
            let y = vec![0.0; x.len()];
            let figure = Figure::new("f", "x", "y").series(Series::line("", x, y));
            keep(&figure, plot::NARROW, Detail(1))
        };
        assert!(line(vec![0.0, 1.0, 0.5]).is_none());
        assert!(line(vec![0.0, 0.5, 0.5, 1.0]).is_some());
    }
}
