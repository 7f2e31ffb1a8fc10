//! Figures: series of points over two axes.

use crate::error::{PlotAxis, ReportError};
use crate::unit::Unit;

/// A plot of one or several series.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// What the figure shows.
    pub title: String,
    /// Label of the horizontal axis; with its unit, `t (s)`, where `x_unit` does not name it.
    pub x_label: String,
    /// Label of the vertical axis, likewise.
    pub y_label: String,
    /// Unit of the horizontal coordinates, with or without SI prefix: `s`, `µm`. Where it is
    /// known, ticks and the value under the pointer take the prefix that reads best. Empty
    /// if the label says all.
    pub x_unit: String,
    /// Unit of the vertical coordinates, likewise.
    pub y_unit: String,
    /// Figures of one page with the same name here share their horizontal axis: a zoom of one
    /// is a zoom of all, and the pointer shows in all. Empty for none.
    pub linked: String,
    /// Scale of the horizontal axis.
    pub x_scale: Scale,
    /// Scale of the vertical axis.
    pub y_scale: Scale,
    /// Whether both axes have one scale and one length, as in a picture of a plane. For a grid of figures: over the width of a page it would be higher than a screen.
    pub square: bool,
    /// Names of the places 0, 1, 2, … of the vertical axis, from the top down; empty if
    /// it is one of numbers. A narrow drawing shows each up to its first space.
    pub rows: Vec<String>,
    /// The series, drawn in this order; later ones lie above earlier ones.
    pub series: Vec<Series>,
    /// Text below the figure; empty for none.
    pub caption: String,
    /// What a reader who cannot see the figure should know; where empty, it is
    /// made of title, labels and names.
    pub alt: String,
}

/// How an axis maps values to lengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Equal steps, equal lengths.
    #[default]
    Linear,
    /// Equal ratios, equal lengths; all values must be positive
    /// (and lie between 1e-150 and 1e150).
    Log,
}

/// How the points of a series are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// Joined by straight lines. Where several consecutive points share a pixel
    /// column, the lowest and the highest of them are drawn.
    Line,
    /// Each value is held until the next point; thinned as a line is.
    Step,
    /// Separate dots; of those that share a pixel, the first is drawn.
    Dots,
}

/// Named points in one style.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name in the legend; empty for no entry.
    pub name: String,
    /// Horizontal coordinates, in any order.
    pub x: Vec<f64>,
    /// Vertical coordinates, one for each of `x`.
    pub y: Vec<f64>,
    /// How the points are drawn.
    pub style: Style,
    /// Whether lines and steps are dashed.
    pub dashed: bool,
    /// Place in the palette (Okabe and Ito's colour-blind-safe set without its
    /// yellow, counted round its seven colours); `None` takes the place of the
    /// series in its figure.
    pub colour: Option<usize>,
}

impl Series {
    /// A solid line.
    pub fn line(name: impl Into<String>, x: Vec<f64>, y: Vec<f64>) -> Self {
        Self {
            name: name.into(),
            x,
            y,
            style: Style::Line,
            dashed: false,
            colour: None,
        }
    }

    /// Separate dots.
    pub fn dots(name: impl Into<String>, x: Vec<f64>, y: Vec<f64>) -> Self {
        Self {
            style: Style::Dots,
            ..Self::line(name, x, y)
        }
    }

    /// Values held until the next point.
    pub fn step(name: impl Into<String>, x: Vec<f64>, y: Vec<f64>) -> Self {
        Self {
            style: Style::Step,
            ..Self::line(name, x, y)
        }
    }

    /// The same series dashed.
    pub fn dashed(mut self) -> Self {
        self.dashed = true;
        self
    }

    /// The same series in the palette's colour of that place.
    pub fn colour(mut self, place: usize) -> Self {
        self.colour = Some(place);
        self
    }
}

impl Figure {
    /// A figure without series, both scales linear.
    pub fn new(
        title: impl Into<String>,
        x_label: impl Into<String>,
        y_label: impl Into<String>,
    ) -> Self {
        Self {
            title: title.into(),
            x_label: x_label.into(),
            y_label: y_label.into(),
            x_unit: String::new(),
            y_unit: String::new(),
            linked: String::new(),
            x_scale: Scale::Linear,
            y_scale: Scale::Linear,
            square: false,
            rows: Vec::new(),
            series: Vec::new(),
            caption: String::new(),
            alt: String::new(),
        }
    }

    /// Adds a series.
    pub fn series(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Names the units of the coordinates as they are given.
    ///
    /// ```
    /// use axis_report::Figure;
    /// let figure = Figure::new("Error", "time", "tracking error").units("s", "µm");
    /// assert_eq!(figure.y_unit, "µm");
    /// ```
    pub fn units(mut self, x: impl Into<String>, y: impl Into<String>) -> Self {
        self.x_unit = x.into();
        self.y_unit = y.into();
        self
    }

    /// Shares the horizontal axis with the figures of that name.
    pub fn linked(mut self, name: impl Into<String>) -> Self {
        self.linked = name.into();
        self
    }

    /// Sets the text below the figure.
    pub fn caption(mut self, text: impl Into<String>) -> Self {
        self.caption = text.into();
        self
    }

    /// Sets the text for readers who cannot see the figure.
    pub fn alt(mut self, text: impl Into<String>) -> Self {
        self.alt = text.into();
        self
    }

    /// Makes the vertical axis one of named rows, from the top down: a point lies in the row
    /// that its vertical coordinate is nearest to, a little above or below its middle.
    pub fn rows<N: Into<String>>(mut self, names: impl IntoIterator<Item = N>) -> Self {
        self.rows = names.into_iter().map(Into::into).collect();
        self
    }

    /// Gives both axes one scale and one length: circles are round.
    pub fn square(mut self) -> Self {
        self.square = true;
        self
    }

    /// Makes the horizontal axis logarithmic.
    pub fn log_x(mut self) -> Self {
        self.x_scale = Scale::Log;
        self
    }

    /// Makes the vertical axis logarithmic.
    pub fn log_y(mut self) -> Self {
        self.y_scale = Scale::Log;
        self
    }

    /// The same figure with coordinates in units without prefix.
    pub(crate) fn in_base_units(&self) -> Self {
        let mut figure = self.clone();
        let [x, y] = [&self.x_unit, &self.y_unit].map(|text| Unit::parse(text));
        for series in &mut figure.series {
            for (unit, values) in [(&x, &mut series.x), (&y, &mut series.y)] {
                if unit.exponent != 0 {
                    values.iter_mut().for_each(|v| *v = unit.to_base(*v));
                }
            }
        }
        (figure.x_unit, figure.y_unit) = (x.base, y.base);
        figure
    }

    pub(crate) fn alt_text(&self) -> String {
        if !self.alt.is_empty() {
            return self.alt.clone();
        }
        let names: Vec<&str> = self.series.iter().map(|s| s.name.as_str()).collect();
        format!(
            "{}: {} against {}. Series: {}.",
            self.title,
            self.y_label,
            self.x_label,
            names.join(", ")
        )
    }

    pub(crate) fn check(&self) -> Result<(), ReportError> {
        if self.series.is_empty() {
            return Err(ReportError::NoSeries {
                figure: self.title.clone(),
            });
        }
        for series in &self.series {
            self.check_lengths(series)?;
            self.check_values(series, PlotAxis::X, &series.x, self.x_scale)?;
            self.check_values(series, PlotAxis::Y, &series.y, self.y_scale)?;
        }
        Ok(())
    }

    fn check_lengths(&self, series: &Series) -> Result<(), ReportError> {
        let (figure, name) = (self.title.clone(), series.name.clone());
        if series.x.len() != series.y.len() {
            return Err(ReportError::SeriesLength {
                figure,
                series: name,
                x: series.x.len(),
                y: series.y.len(),
            });
        }
        if series.x.is_empty() {
            return Err(ReportError::EmptySeries {
                figure,
                series: name,
            });
        }
        Ok(())
    }

    fn check_values(
        &self,
        series: &Series,
        axis: PlotAxis,
        values: &[f64],
        scale: Scale,
    ) -> Result<(), ReportError> {
        let (ok, valid): (fn(f64) -> bool, _) = match scale {
            Scale::Linear => (f64::is_finite, "it must be a finite number"),
            Scale::Log => (
                // Wider spans have no ratio in f64.
                |v| (1e-150..=1e150).contains(&v),
                "on a logarithmic scale it must lie above zero (between 1e-150 and 1e150)",
            ),
        };
        match values.iter().position(|&v| !ok(v)) {
            Some(index) => Err(ReportError::PointValue {
                figure: self.title.clone(),
                series: series.name.clone(),
                point: index + 1,
                axis,
                value: values[index],
                valid,
            }),
            None => Ok(()),
        }
    }
}
