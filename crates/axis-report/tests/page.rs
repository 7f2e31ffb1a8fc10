//! The whole page: well formed, self-contained, escaped, deterministic.

use axis_report::{
    Block, Cell, Figure, KeyValues, Mark, Notice, Page, PageWriteError, ReportError, Section,
    Series, Table, render, write_atomic,
};

fn ramp(n: usize) -> Vec<f64> {
    (0..n).map(|k| k as f64).collect()
}

fn figure(title: &str) -> Figure {
    Figure::new(title, "t (s)", "e (µm)").series(Series::line("a", ramp(5), ramp(5)))
}

fn table() -> Table {
    Table::new("Peaks", ["case", "max"]).row([Cell::text("none"), Cell::number(-1.5, 2)])
}

/// One of everything, with text that would break out of elements, attributes,
/// styles and comments.
fn full_page() -> Page {
    let evil = "</style><script>alert('x')</script> \" onload=\"x --> & ${1}";
    Page::new(evil)
        .lead(evil)
        .section(
            Section::new(evil)
                .paragraph(evil)
                .notice(Notice::Warn, evil)
                .block(Block::List(vec![evil.into()]))
                .block(Block::Preformatted(evil.into()))
                .table(
                    Table::new(evil, [evil, "n", "m"])
                        .group("", 1)
                        .group(evil, 2)
                        .row([
                            Cell::text(evil),
                            Cell::number(1.0, 1).marked(Mark::Best),
                            Cell::Missing,
                        ])
                        .note(evil)
                        .folded(),
                )
                .key_values(KeyValues::new(evil).entry(evil, evil))
                .folded(evil, vec![Block::Paragraph(evil.into())]),
        )
        .section(
            Section::new("Figures")
                .figure(
                    Figure::new(evil, evil, evil)
                        .series(Series::line(evil, ramp(9), ramp(9)).dashed())
                        .caption(evil),
                )
                .figure_grid(vec![figure("one").alt(evil), figure("two")], 2),
        )
}

/// The page without its scripts and the points that they draw, and these.
fn apart(html: &str) -> (String, Vec<&str>) {
    let mut rest = String::new();
    let mut scripts = Vec::new();
    let mut pieces = html.split("<script");
    rest.push_str(pieces.next().unwrap());
    for piece in pieces {
        let (script, after) = piece.split_once("</script>").expect("a script ends");
        scripts.push(script);
        rest.push_str(after);
    }
    (rest, scripts)
}

/// Opening and closing tags must nest; comments must not occur.
fn assert_well_formed(html: &str) {
    const VOID: [&str; 2] = ["meta", "br"];
    let body = html.strip_prefix("<!DOCTYPE html>").expect("doctype");
    let mut open: Vec<&str> = Vec::new();
    for piece in body.split('<').skip(1) {
        let (tag, _) = piece.split_once('>').expect("a tag ends");
        assert!(!tag.starts_with('!'), "comment or declaration: {tag}");
        assert_eq!(tag.matches('"').count() % 2, 0, "quotes: {tag}");
        let name = tag
            .trim_start_matches('/')
            .split([' ', '/'])
            .next()
            .unwrap();
        assert_ne!(name, "script");
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "closing {tag}");
        } else if !tag.ends_with('/') && !VOID.contains(&name) {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "left open: {open:?}");
}

#[test]
fn the_page_is_well_formed_and_escaped() {
    let page = render(&full_page()).unwrap();
    let (html, scripts) = apart(&page);
    assert_well_formed(&html);
    // The points of three figures, and the one that draws them.
    assert_eq!(scripts.len(), 4);
    for points in &scripts[..3] {
        let json = points.strip_prefix(" type=\"application/json\">").unwrap();
        let value: serde_json::Value = serde_json::from_str(json).unwrap();
        assert!(value["series"].is_array());
    }
    assert!(!html.contains("alert('x')</script>"));
    assert!(html.contains("&lt;script&gt;"));
    assert!(!html.contains("\" onload="));
    // Text passes through the plotting library untouched.
    assert!(html.contains("${1}"));
}

#[test]
fn the_page_refers_to_nothing_outside() {
    let page = render(&full_page()).unwrap();
    let (html, scripts) = apart(&page);
    for word in ["http:", "https:", "//", "src=", "@import", "<link", "data:"] {
        assert!(!html.contains(word), "{word}");
    }
    // Nor can it: a browser is told to fetch nothing.
    assert!(html.contains("default-src &#39;none&#39;") || html.contains("default-src 'none'"));
    let drawing = scripts.last().unwrap();
    for word in [
        "fetch(",
        "XMLHttpRequest",
        "WebSocket",
        "import(",
        "eval(",
        "innerHTML",
    ] {
        assert!(!drawing.contains(word), "{word}");
    }
    for reference in html
        .split("url(")
        .skip(1)
        .chain(html.split("href=\"").skip(1))
    {
        assert!(reference.starts_with('#'), "{}", &reference[..20]);
    }
}

#[test]
fn the_same_page_gives_the_same_text() {
    assert_eq!(render(&full_page()), render(&full_page()));
}

#[test]
fn ids_are_unique() {
    let html = render(&full_page()).unwrap();
    let mut ids: Vec<&str> = html
        .split(" id=\"")
        .skip(1)
        .map(|s| s.split('"').next().unwrap())
        .collect();
    let all = ids.len();
    ids.sort_unstable();
    ids.dedup();
    // Two sections; one wide figure in two drawings, two small ones.
    assert_eq!((all, ids.len()), (6, 6));
}

#[test]
fn every_series_is_drawn() {
    let figure = Figure::new("f", "x", "y")
        .series(Series::line("line", ramp(9), ramp(9)))
        .series(Series::step("step", ramp(9), ramp(9)).dashed())
        .series(Series::dots("dots", ramp(9), ramp(9)))
        .series(Series::line("one point", vec![3.0], vec![4.0]));
    let page = Page::new("p").section(Section::new("s").figure_grid(vec![figure], 1));
    let html = render(&page).unwrap();
    for colour in ["#0072b2", "#d55e00", "#009e73", "#cc79a7"] {
        // Once in the legend, once in the drawing.
        let shown = html.matches(&format!("stroke=\"{colour}\"")).count()
            + html.matches(&format!("fill=\"{colour}\"")).count();
        assert_eq!(shown, 2, "{colour}");
    }
    assert_eq!(html.matches("stroke-dasharray").count(), 2);
}

#[test]
fn a_long_series_stays_small_and_keeps_its_spike() {
    let mut y = vec![0.0; 36_000];
    y[20_000] = 1.0;
    let draw = |y: Vec<f64>| {
        let figure = Figure::new("f", "x", "y").series(Series::line("", ramp(36_000), y));
        let page = Page::new("p").section(Section::new("s").figure_grid(vec![figure], 1));
        render(&page).unwrap()
    };
    let page = draw(y);
    let (html, scripts) = apart(&page);
    // The line is the last path; its points go up to the spike and back: the
    // plot is about 220 px high, and the axis ends close above the spike.
    let path = html.rsplit(" d=\"").next().unwrap();
    let climbs: f64 = path
        .split('"')
        .next()
        .unwrap()
        .split('l')
        .skip(1)
        .filter_map(|step| step.rfind('-').map(|at| step[at..].parse::<f64>().unwrap()))
        .sum();
    assert!(climbs < -150.0, "{climbs}");
    // About 420 columns of at most two points of at most 10 bytes, the frame and the styles.
    assert!(html.len() < 25_000, "{}", html.len());
    // Sixteen times as many columns are kept for zooming, nearly all of them flat.
    assert!(scripts[0].len() < 100_000, "{}", scripts[0].len());
}

#[test]
fn forty_noisy_figures_stay_below_five_megabytes() {
    // A fixed linear congruential generator: noise that no thinning can shorten.
    let mut state = 1u64;
    let mut noise = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64
    };
    let noisy = |name, y| Series::line(name, ramp(36_000), y);
    let mut section = Section::new("s");
    for _ in 0..40 {
        let mut figure = Figure::new("f", "x", "y");
        for name in ["a", "b", "c"] {
            figure = figure.series(noisy(name, (0..36_000).map(|_| noise()).collect()));
        }
        section = section.figure(figure);
    }
    let size = render(&Page::new("p").section(section)).unwrap().len();
    println!("{size} bytes");
    assert!(size < 5_000_000, "{size}");
}

#[test]
fn numbers_that_are_none_are_refused_by_name() {
    let refused = |section| render(&Page::new("p").section(section)).unwrap_err();
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for cell in [
            Cell::number(value, 2),
            Cell::scientific(value, 2),
            Cell::quantity(value, "m", 2),
        ] {
            let error = refused(Section::new("s").table(table().row([Cell::text("x"), cell])));
            let text = error.to_string();
            assert!(
                text.starts_with("table \"Peaks\", row 2, column 2 (\"max\"): "),
                "{text}"
            );
        }
        let bad = figure("f").series(Series::dots("b", vec![0.0, 1.0], vec![0.0, value]));
        let text = refused(Section::new("s").figure(bad.clone())).to_string();
        assert!(
            text.starts_with("figure \"f\", series \"b\", point 2: y = "),
            "{text}"
        );
        let folded = Block::FigureGrid {
            figures: vec![bad],
            columns: 2,
        };
        refused(Section::new("s").folded("more", vec![folded]));
    }
}

#[test]
fn shapes_that_do_not_fit_are_refused() {
    let refused = |section| render(&Page::new("p").section(section)).unwrap_err();
    let error = refused(Section::new("s").table(table().row([Cell::Missing])));
    assert!(matches!(
        error,
        ReportError::RowLength {
            row: 2,
            found: 1,
            expected: 2,
            ..
        }
    ));
    let error = refused(Section::new("s").table(table().group("g", 3)));
    assert!(matches!(error, ReportError::GroupSpan { found: 3, .. }));
    let error = refused(Section::new("s").figure(Figure::new("f", "x", "y")));
    assert!(matches!(error, ReportError::NoSeries { .. }));
    let with = |x, y| Section::new("s").figure(figure("f").series(Series::line("b", x, y)));
    let error = refused(with(vec![], vec![]));
    assert!(matches!(error, ReportError::EmptySeries { .. }));
    let error = refused(with(ramp(2), ramp(3)));
    assert!(matches!(
        error,
        ReportError::SeriesLength { x: 2, y: 3, .. }
    ));
    // `ramp` starts at zero, which has no logarithm.
    let error = refused(Section::new("s").figure(figure("f").log_y()));
    assert!(matches!(error, ReportError::PointValue { point: 1, .. }));
}

#[test]
fn figures_are_shown_as_written() {
    let row = [
        Cell::text("r"),
        Cell::number(-0.0004, 2),
        Cell::number(-1234.5, 1),
        Cell::scientific(-1.7e-5, 1),
        Cell::scientific(2.0, 1),
        Cell::Missing,
        Cell::quantity(-1.234e-5, "m", 3),
    ];
    let table = Table::new("t", ["", "a", "b", "c", "d", "e", "f"]).row(row);
    let html = render(&Page::new("p").section(Section::new("s").table(table))).unwrap();
    for (column, shown) in [
        ("a", "0.00"),
        ("b", "\u{2212}1234.5"),
        ("c", "\u{2212}1.7·10⁻⁵"),
        ("d", "2.0"),
        ("e", "–"),
        ("f", "\u{2212}12.3 µm"),
    ] {
        let cell = format!("<td class=\"n\" data-label=\"{column}\">{shown}</td>");
        assert!(html.contains(&cell), "{shown}");
    }
}

#[test]
fn pages_are_written_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("report.html");
    write_atomic(&path, &full_page()).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert_eq!(text, render(&full_page()).unwrap());
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = std::fs::metadata(&path).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o644);
    }
    let bad = Page::new("p").section(Section::new("s").figure(Figure::new("f", "x", "y")));
    assert!(matches!(
        write_atomic(&path, &bad),
        Err(PageWriteError::Report(_))
    ));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    let absent = folder.path().join("absent").join("report.html");
    let error = write_atomic(&absent, &full_page()).unwrap_err().to_string();
    assert!(error.starts_with(&absent.display().to_string()), "{error}");
}

/// The vendored files are those of the npm package uplot 1.6.32 (vendor/uplot/README.md).
#[test]
fn uplot_is_as_it_was_published() {
    let hash = |bytes: &[u8]| blake3::hash(bytes).to_hex().to_string();
    let files: [(&[u8], &str); 3] = [
        (
            include_bytes!("../vendor/uplot/uPlot.iife.min.js"),
            "ea2d16ff65797375a846049c0f0a17f68b47a2850b9c73f2816ecf040ec9f2ce",
        ),
        (
            include_bytes!("../vendor/uplot/uPlot.min.css"),
            "70ead7542eab83ef6ff4269c1f139e3c40f5f59f98302552320b9f79188abba1",
        ),
        (
            include_bytes!("../vendor/uplot/LICENSE"),
            "80723da02446eaf6792b975295c3447a1492e3ca814b7645e8fbd366156b025a",
        ),
    ];
    for (bytes, expected) in files {
        assert_eq!(hash(bytes), expected);
    }
}

/// The result in short stands above the table of contents.
#[test]
fn answers_come_first() {
    let answers = vec![("How much?".to_owned(), vec!["12.3 µm <b>".to_owned()])];
    let page = Page::new("p")
        .first(Block::Answers(answers))
        .section(Section::new("one"))
        .section(Section::new("two"));
    let html = render(&page).unwrap();
    assert_well_formed(&html);
    let at = |text| html.find(text).unwrap();
    assert!(at("How much?") < at("12.3 µm &lt;b&gt;") && at("12.3 µm") < at("<nav"));
    // Without a figure there is nothing to draw.
    assert!(!html.contains("<script"));
}

/// Units of pictures, and of the points kept: SI without prefix, read with one.
#[test]
fn figures_take_prefixes() {
    let figure = Figure::new("f", "time", "error")
        .units("ms", "µm")
        .series(Series::line("", vec![0.0, 2000.0], vec![0.0, 5.0]));
    let html = render(&Page::new("").section(Section::new("").figure(figure))).unwrap();
    assert!(html.contains(">time, s</text>") && html.contains(">error, µm</text>"));
    let (_, scripts) = apart(&html);
    let json = scripts[0].split_once('>').unwrap().1;
    let value: serde_json::Value = serde_json::from_str(json).unwrap();
    assert_eq!(value["x"]["unit"], "s");
    assert_eq!(value["y"]["unit"], "m");
    let [start, step, last] = [0, 1, 2].map(|k| value["series"][0]["y"][k].clone());
    let number = |v: &serde_json::Value| v.as_f64().unwrap();
    let end = number(&start) + number(&step) * number(&last[1]);
    assert!((end - 5e-6).abs() < 1e-12, "{end}");
}

/// Named rows: each has its name, in a narrow drawing up to the first space, from the top
/// down, and its points beside it.
#[test]
fn rows_have_names() {
    let figure = Figure::new("Left", "µm", "")
        .rows(["1 first case", "2 second case"])
        .log_x()
        .series(Series::dots("a", vec![0.1, 10.0], vec![0.0, 1.0]));
    let html = render(&Page::new("").section(Section::new("").figure(figure))).unwrap();
    assert!(html.contains("1 first case") && html.contains("2 second case"));
    assert!(html.contains(">1<") && html.contains(">2<"));
    // A dot is a line of no length, "M x y h0".
    let heights: Vec<f64> = html
        .split("h0")
        .filter_map(|dot| dot.rsplit('M').next()?.split(' ').nth(1)?.parse().ok())
        .collect();
    assert_eq!(heights.len(), 4, "{heights:?}");
    assert!(
        heights[0] < heights[1] && heights[2] < heights[3],
        "{heights:?}"
    );
}

/// On a phone a wide table is stacked: each value says its column, and the group that this is in.
#[test]
fn a_wide_table_names_the_column_beside_each_value() {
    let cells = |n| (0..n).map(|k| Cell::number(f64::from(k), 0));
    let wide = Table::new("Wide", ["case", "max", "mean", "max", "mean"])
        .group("", 1)
        .group("Model", 2)
        .group("Machine", 2)
        .row(cells(5));
    let small = Table::new("Small", ["case", "max", "mean", "RMS"]).row(cells(4));
    let of = |table| render(&Page::new("").section(Section::new("").table(table))).unwrap();
    let html = of(wide);
    assert!(html.contains("class=\"scroll stack\""), "five columns");
    for label in ["Model, max", "Model, mean", "Machine, max", "Machine, mean"] {
        assert!(html.contains(&format!("data-label=\"{label}\"")), "{label}");
    }
    assert!(
        !of(small).contains("class=\"scroll stack\""),
        "four columns"
    );
    // Without the rule that shows them the names would be nowhere on a phone.
    assert!(html.contains(".stack td::before{content:attr(data-label)"));
}
