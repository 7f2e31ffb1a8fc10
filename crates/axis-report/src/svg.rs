//! kuva's drawing to SVG text.
//!
//! kuva's own writer gives its clip paths a number that counts up through the
//! process, leaves out the `viewBox` and writes coordinates with all their
//! digits; here the same page must give the same text, a drawing must scale, and
//! forty figures must stay small. So its list of shapes is written out here:
//! coordinates in tenths of a pixel, paths in relative steps.

use std::fmt::Write;

use kuva::render::color::Color;
use kuva::render::render::{Primitive, Scene, TextAnchor};

/// Writes the drawing as an `svg` element that scales with its box. `id` must be
/// unique in the page.
pub(crate) fn write(scene: &Scene, alt: &str, id: &str) -> String {
    let mut out = String::new();
    // Writing to a String cannot fail.
    let _ = write!(
        out,
        "<svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">",
        scene.width,
        scene.height,
        escape(alt)
    );
    for shape in &scene.elements {
        write_shape(&mut out, shape, id);
    }
    out.push_str("</svg>");
    out
}

fn write_shape(out: &mut String, shape: &Primitive, id: &str) {
    match shape {
        Primitive::Line { .. } => write_line(out, shape),
        Primitive::Text { .. } => write_text(out, shape),
        Primitive::PolyLine {
            points,
            stroke,
            stroke_width,
            stroke_dasharray,
        } => {
            let _ = write!(
                out,
                "<path fill=\"none\" stroke-linejoin=\"round\" stroke=\"{}\" stroke-width=\"{}\"",
                colour(stroke),
                Tenths(*stroke_width)
            );
            if let Some(dash) = stroke_dasharray {
                let _ = write!(out, " stroke-dasharray=\"{}\"", escape(dash));
            }
            let _ = write!(out, " d=\"{}\"/>", path(points));
        }
        Primitive::CircleBatch {
            cx, cy, r, fill, ..
        } => {
            let centres: Vec<(f64, f64)> = cx.iter().copied().zip(cy.iter().copied()).collect();
            write_dots(out, &centres, *r, fill);
        }
        Primitive::Circle {
            cx, cy, r, fill, ..
        } => write_dots(out, &[(*cx, *cy)], *r, fill),
        Primitive::ClipStart {
            x,
            y,
            width,
            height,
            ..
        } => {
            let _ = write!(
                out,
                "<clipPath id=\"{id}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\
                 </clipPath><g clip-path=\"url(#{id})\">",
                Tenths(*x),
                Tenths(*y),
                Tenths(*width),
                Tenths(*height)
            );
        }
        Primitive::ClipEnd => out.push_str("</g>"),
        // No other shape occurs in line and dot plots without legend and title.
        _ => {}
    }
}

fn write_line(out: &mut String, shape: &Primitive) {
    if let Primitive::Line {
        x1,
        y1,
        x2,
        y2,
        stroke,
        ..
    } = shape
    {
        let _ = write!(
            out,
            "<path stroke=\"{}\" d=\"{}\"/>",
            colour(stroke),
            path(&[(*x1, *y1), (*x2, *y2)])
        );
    }
}

fn write_text(out: &mut String, shape: &Primitive) {
    if let Primitive::Text {
        x,
        y,
        content,
        size,
        anchor,
        rotate,
        ..
    } = shape
    {
        let anchor = match anchor {
            TextAnchor::Start => "start",
            TextAnchor::Middle => "middle",
            TextAnchor::End => "end",
        };
        let (x, y) = (Tenths(*x), Tenths(*y));
        let _ = write!(
            out,
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\""
        );
        if let Some(angle) = rotate {
            let _ = write!(out, " transform=\"rotate({angle} {x} {y})\"");
        }
        let _ = write!(out, ">{}</text>", escape(content));
    }
}

/// All dots as one path: strokes of no length with round ends.
fn write_dots(out: &mut String, centres: &[(f64, f64)], radius: f64, fill: &Color) {
    let _ = write!(
        out,
        "<path fill=\"none\" stroke-linecap=\"round\" stroke=\"{}\" stroke-width=\"{}\" d=\"",
        colour(fill),
        Tenths(2.0 * radius)
    );
    for &(x, y) in centres {
        let _ = write!(out, "M{} {}h0", Tenths(x), Tenths(y));
    }
    out.push_str("\"/>");
}

/// Path data through the points: the first in absolute, the others in relative
/// coordinates, all on a grid of 0.1, on which the steps add up exactly.
fn path(points: &[(f64, f64)]) -> String {
    let mut out = String::new();
    let mut last: Option<(i64, i64)> = None;
    for &(x, y) in points {
        let here = (tenths(x), tenths(y));
        match last {
            None => {
                let _ = write!(out, "M{} {}", Grid(here.0), Grid(here.1));
            }
            // Points that fall together add nothing.
            Some(before) if before == here => continue,
            Some(before) => {
                let (dx, dy) = (here.0 - before.0, here.1 - before.1);
                let gap = if dy < 0 { "" } else { " " };
                let _ = write!(out, "l{}{gap}{}", Grid(dx), Grid(dy));
            }
        }
        last = Some(here);
    }
    out
}

fn tenths(value: f64) -> i64 {
    (value * 10.0).round() as i64
}

/// A number rounded to one decimal.
struct Tenths(f64);

impl std::fmt::Display for Tenths {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        Grid(tenths(self.0)).fmt(f)
    }
}

/// A number of tenths.
struct Grid(i64);

impl std::fmt::Display for Grid {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (whole, rest) = (self.0.abs() / 10, self.0.abs() % 10);
        if self.0 < 0 {
            f.write_str("-")?;
        }
        match (whole, rest) {
            (_, 0) => write!(f, "{whole}"),
            (0, _) => write!(f, ".{rest}"),
            _ => write!(f, "{whole}.{rest}"),
        }
    }
}

fn colour(colour: &Color) -> String {
    colour.to_svg_string()
}

fn escape(text: &str) -> String {
    maud::html! { (text) }.into_string()
}
