//! Figure to SVG. kuva lays out and draws axes, ticks, grid and series.

use kuva::plot::{LinePlot, ScatterPlot};
use kuva::render::layout::{Layout, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::render::render_multiple;
use kuva::render::render_utils::wrap_text;

use crate::decimate;
use crate::figure::{Figure, Scale, Series, Style};
use crate::scale::Fitted;
use crate::svg;
use crate::unit::Unit;

/// Okabe and Ito's colours, safe for colour-blind readers
/// (<https://jfly.uni-koeln.de/color/>), in an order that tells neighbours
/// apart; without the yellow, which fades on white.
const PALETTE: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000",
];

/// Size of a drawing in its own pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Canvas {
    pub width: f64,
    pub height: f64,
    pub font: u32,
}

/// For a figure over the full width of a desktop page.
pub(crate) const WIDE: Canvas = Canvas {
    width: 880.0,
    height: 340.0,
    font: 13,
};

/// For a phone and for a figure in a grid.
pub(crate) const NARROW: Canvas = Canvas {
    width: 420.0,
    height: 280.0,
    font: 13,
};

/// Colour of series number `index` of its figure.
pub(crate) fn colour(series: &Series, index: usize) -> &'static str {
    PALETTE[place(series, index)]
}

/// Its place in the palette.
pub(crate) fn place(series: &Series, index: usize) -> usize {
    series.colour.unwrap_or(index) % PALETTE.len()
}

/// Whether series number `index` is dashed: on request, and from the eighth on
/// to tell it from the series that has the same colour.
pub(crate) fn is_dashed(series: &Series, index: usize) -> bool {
    series.dashed || (series.colour.is_none() && index >= PALETTE.len())
}

/// Height of a named row, and of what a drawing has above and below its rows.
const ROW: f64 = 24.0;
const AROUND: f64 = 70.0;

/// Draws a checked figure in units without prefix, without title and legend. `id` must be
/// unique in the page.
pub(crate) fn draw(figure: &Figure, mut canvas: Canvas, id: &str) -> String {
    if !figure.rows.is_empty() {
        canvas.height = AROUND + ROW * figure.rows.len() as f64;
    }
    if figure.square {
        canvas = NARROW;
    }
    let (x, y) = fit(figure, canvas);
    if figure.square {
        let [left, right, above, below] = margins(figure, canvas, &x, &y);
        canvas.height = canvas.width - left - right + above + below;
    }
    let plots = figure
        .series
        .iter()
        .enumerate()
        .map(|(index, series)| plot(series, index, canvas, &x, &y))
        .collect();
    let scene = render_multiple(plots, layout(figure, canvas, &x, &y));
    svg::write(&scene, &figure.alt_text(), id)
}

/// Both axes, fitted to the series.
pub(crate) fn fit(figure: &Figure, canvas: Canvas) -> (Fitted, Fitted) {
    let all = |pick: fn(&Series) -> &Vec<f64>| {
        figure
            .series
            .iter()
            .flat_map(move |s| pick(s).iter().copied())
    };
    if figure.square {
        let [x, y] = [all(|s| &s.x).collect(), all(|s| &s.y).collect()];
        return square(figure, canvas, [x, y]);
    }
    // Dots on the frame would be cut in half, so only lines end at the frame. Figures that share an axis all end there.
    let tight = !figure.linked.is_empty() || figure.series.iter().all(|s| s.style != Style::Dots);
    let y = match &figure.rows[..] {
        [] => {
            let (unit, ticks) = (Unit::parse(&figure.y_unit), canvas.height / 55.0);
            Fitted::new(figure.y_scale, unit, all(|s| &s.y), ticks, false)
        }
        names => Fitted::rows(names.iter().map(|name| short(name, canvas)).collect()),
    };
    let (unit, ticks) = (Unit::parse(&figure.x_unit), canvas.width / 90.0);
    let x = Fitted::new(figure.x_scale, unit, all(|s| &s.x), ticks, tight);
    (x, y)
}

/// Both axes of a picture of a plane: of one length, that of the longer, and a little more.
fn square(figure: &Figure, canvas: Canvas, values: [Vec<f64>; 2]) -> (Fitted, Fitted) {
    let ends = values.map(|all| {
        let ends = (f64::MAX, f64::MIN);
        all.iter().fold(ends, |(a, b), v| (a.min(*v), b.max(*v)))
    });
    let half = 0.53 * ends.iter().map(|(a, b)| b - a).fold(0.0, f64::max);
    let [x, y] = ends.map(|(a, b)| 0.5 * (a + b));
    let fitted = |unit: &str, scale, middle: f64| {
        let values = [middle - half, middle + half].into_iter();
        Fitted::new(scale, Unit::parse(unit), values, canvas.width / 90.0, true)
    };
    (
        fitted(&figure.x_unit, figure.x_scale, x),
        fitted(&figure.y_unit, figure.y_scale, y),
    )
}

/// The name of a row as far as there is room for it.
fn short(name: &str, canvas: Canvas) -> String {
    let narrow = canvas.width <= NARROW.width;
    let end = if narrow { name.find(' ') } else { None };
    name[..end.unwrap_or(name.len())].to_owned()
}

fn layout(figure: &Figure, canvas: Canvas, x: &Fitted, y: &Fitted) -> Layout {
    let format = |axis: &Fitted| {
        let axis = axis.clone();
        TickFormat::Custom(std::sync::Arc::new(move |v| axis.tick_label(v)))
    };
    let mut layout = Layout::new(x.range, y.range)
        .with_width(canvas.width)
        .with_height(canvas.height)
        .with_x_tick_format(format(x))
        .with_y_tick_format(format(y))
        .with_x_axis_min(x.range.0)
        .with_x_axis_max(x.range.1)
        .with_y_axis_min(y.range.0)
        .with_y_axis_max(y.range.1)
        .with_label_size(canvas.font)
        .with_tick_size(canvas.font - 1)
        .with_box_axes();
    layout = match figure.x_scale {
        Scale::Linear => layout.with_x_tick_step(x.step),
        Scale::Log => layout.with_log_x(),
    };
    layout = match figure.y_scale {
        Scale::Linear => layout.with_y_tick_step(y.step),
        Scale::Log => layout.with_log_y(),
    };
    layout.theme.grid_color = "#e3e6ea".into();
    layout.theme.axis_color = "#8a929b".into();
    layout.theme.tick_color = "#8a929b".into();
    with_labels(layout, figure, canvas, x, y)
}

/// Axis labels, wrapped where they are longer than their axis, and the margins
/// that they and the tick labels need. kuva would measure its own labels of a
/// logarithmic axis, not these.
fn with_labels(layout: Layout, figure: &Figure, canvas: Canvas, x: &Fitted, y: &Fitted) -> Layout {
    let [left, right, above, below] = margins(figure, canvas, x, y);
    let [x_wrap, y_wrap] = wraps(canvas);
    layout
        .with_x_label(format!("{}{}", figure.x_label, x.label_suffix()))
        .with_y_label(format!("{}{}", figure.y_label, y.label_suffix()))
        .with_x_label_wrap(x_wrap)
        .with_y_label_wrap(y_wrap)
        .with_force_margins(left, right)
        .with_force_margins_y(above, below)
}

/// Characters of a label on one line.
fn wraps(canvas: Canvas) -> [usize; 2] {
    let character = 0.56 * f64::from(canvas.font);
    [canvas.width - 90.0, canvas.height - 60.0].map(|room| (room / character) as usize)
}

/// Margins left, right, above and below.
fn margins(figure: &Figure, canvas: Canvas, x: &Fitted, y: &Fitted) -> [f64; 4] {
    let font = f64::from(canvas.font);
    let line = 1.2 * font;
    let x_label = format!("{}{}", figure.x_label, x.label_suffix());
    let y_label = format!("{}{}", figure.y_label, y.label_suffix());
    let [x_wrap, y_wrap] = wraps(canvas);
    let lines = |label: &str, wrap| wrap_text(label, wrap).len() as f64;
    let left = line * lines(&y_label, y_wrap) + 0.58 * font * y.widest_label() as f64 + 20.0;
    let right = (0.3 * font * x.widest_label() as f64).max(12.0);
    let below = line * lines(&x_label, x_wrap) + font + 18.0;
    [left, right, 10.0, below]
}

/// The points of a series on a canvas.
pub(crate) fn pixels(series: &Series, canvas: Canvas, x: &Fitted, y: &Fitted) -> Vec<(f64, f64)> {
    let place = |(&a, &b)| (x.fraction(a) * canvas.width, y.fraction(b) * canvas.height);
    series.x.iter().zip(&series.y).map(place).collect()
}

fn plot(series: &Series, index: usize, canvas: Canvas, x: &Fitted, y: &Fitted) -> Plot {
    let pixels = pixels(series, canvas, x, y);
    let point = |k: usize| (x.drawn(series.x[k]), y.drawn(series.y[k]));
    // A line through one point would not be seen.
    if series.style == Style::Dots || series.x.len() == 1 {
        return ScatterPlot::new()
            .with_data(decimate::dots(&pixels).into_iter().map(point))
            .with_color(colour(series, index))
            .with_size(2.0)
            .into();
    }
    let mut line = LinePlot::new()
        .with_data(decimate::line(&pixels).into_iter().map(point))
        .with_color(colour(series, index))
        .with_stroke_width(1.5);
    if is_dashed(series, index) {
        line = line.with_line_style(kuva::plot::LineStyle::Custom("6 4".into()));
    }
    if series.style == Style::Step {
        line = line.with_step();
    }
    line.into()
}
