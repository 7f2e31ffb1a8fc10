//! Programs against paths by hand.

use std::f64::consts::{FRAC_PI_2, PI};

use proptest::prelude::*;
use toolpath::gcode::{GcodeError, ProgramRun, read, read_blended};
use toolpath::{Blend, PathSegment, PathTolerances};

fn program(text: &str) -> Vec<ProgramRun> {
    read(text, [0.0; 3], &PathTolerances::default()).unwrap()
}

fn refused(text: &str) -> String {
    read(text, [0.0; 3], &PathTolerances::default())
        .unwrap_err()
        .to_string()
}

fn near(a: [f64; 3], b: [f64; 3]) {
    assert!(
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15),
        "{a:?} {b:?}"
    );
}

#[test]
fn a_program_of_each_kind() {
    let runs = program(
        "%\nN10 G21 G90 G17 (millimetres)\nG0 X10 Y0 ; rapid\nG1 x20 f600\nG3 X30 Y10 I0 J10\n\
         G2 X40 Y20 R10\nF1200 G1 Y30\nM30\nG1 X99",
    );
    assert_eq!(runs.len(), 3);
    assert_eq!((runs[0].feed, runs[0].lines), (None, (3, 3)));
    let run = &runs[1];
    assert!((run.feed.unwrap() - 0.01).abs() < 1e-18);
    assert_eq!(run.lines, (4, 6));
    assert!((run.path.length() - (0.01 + 0.01 * PI)).abs() < 1e-15);
    assert!(run.path.corners().is_empty());
    near(
        run.path.at(0.01 + 0.005 * FRAC_PI_2).position,
        [
            0.02 + 0.01 * (PI / 4.0).sin(),
            0.01 - 0.01 * (PI / 4.0).cos(),
            0.0,
        ],
    );
    near(run.path.at(1.0).position, [0.04, 0.02, 0.0]);
    assert!((runs[2].feed.unwrap() - 0.02).abs() < 1e-18);
    near(runs[2].path.at(1.0).position, [0.04, 0.03, 0.0]);
}

#[test]
fn inches_increments_and_centres() {
    let runs = program("G20 G91 G1 X1 F60\nX1\nG90.1 G3 X-2 I1 J0");
    let path = &runs[0].path;
    near(path.at(0.0508).position, [0.0508, 0.0, 0.0]);
    near(path.at(1.0).position, [0.0, 0.0, 0.0]);
    assert!((path.length() - 0.0254 * (2.0 + PI)).abs() < 1e-15);
    assert!((runs[0].feed.unwrap() - 0.0254).abs() < 1e-18);
}

/// Quarter turns counterclockwise in each plane: from the first axis to the second.
#[test]
fn each_plane() {
    for (g, from, to, letter, middle) in [
        (17, "X10", "X0 Y10", "I-10", [1.0, 1.0, 0.0]),
        (18, "Z10", "Z0 X10", "K-10", [1.0, 0.0, 1.0]),
        (19, "Y10", "Y0 Z10", "J-10", [0.0, 1.0, 1.0]),
    ] {
        let runs = program(&format!("G{g} G0 {from}\nG3 {to} {letter} F100"));
        let path = &runs[1].path;
        assert!((path.length() - 0.01 * FRAC_PI_2).abs() < 1e-16);
        near(
            path.at(0.5 * path.length()).position,
            middle.map(|x| x * 0.01 * 0.5f64.sqrt()),
        );
    }
}

#[test]
fn full_circles_long_arcs_and_helices() {
    let runs = program("G0 X10\nG2 I-10 F100\nG3 X0 Y10 R-10\nG3 X-10 Y0 Z5 I0 J-10");
    let sweeps = runs[1].path.segments().iter().map(|s| match s {
        PathSegment::Arc(arc) => arc.sweep(),
        other => panic!("{other:?}"),
    });
    let sweeps: Vec<f64> = sweeps.collect();
    for (sweep, exact) in sweeps.iter().zip([2.0 * PI, 1.5 * PI, FRAC_PI_2]) {
        assert!((sweep - exact).abs() < 1e-12, "{sweeps:?}");
    }
    near(runs[1].path.at(1.0).position, [-0.01, 0.0, 0.005]);
    // R-10 from (10, 0) to (0, 10): centre at (10, 10), by the longer arc.
    let PathSegment::Arc(long) = &runs[1].path.segments()[1] else {
        unreachable!()
    };
    near(long.centre(), [0.01, 0.01, 0.0]);
}

/// Ends that are rounded to a micrometre are met, not left open.
#[test]
fn rounded_centres_are_moved() {
    let runs = program("G0 X10\nG3 X7.071 Y7.071 I-10 J0 F100\nG1 X0");
    assert!((runs[1].path.at(0.0).position[0] - 0.01).abs() < 1e-16);
    let refused = read(
        "G0 X10\nG3 X7.071 Y7.08 I-10 F9",
        [0.0; 3],
        &PathTolerances::default(),
    );
    assert!(
        matches!(refused, Err(GcodeError::Radii { line: 2, .. })),
        "{refused:?}"
    );
}

#[test]
fn errors_say_line_word_and_what_would_be_valid() {
    for (text, parts) in [
        ("G1 X1", ["line 1", "G1 X1", "an F word"]),
        ("\nX5", ["line 2", "X5", "G0, G1, G2 or G3"]),
        ("G5 X1", ["line 1", "G5", "G17 to G21"]),
        ("G1 F1 X1..2", ["line 1", "X1..2", "such as X-1.5"]),
        ("G1 F1 X#1", ["line 1", "X:", "a letter and a number"]),
        ("G1 F1 X", ["line 1", "X:", "a letter and a number"]),
        ("G1 (open", ["line 1", "(open", "within one line"]),
        ("G1 F-1 X1", ["line 1", "F-1", "a feed from"]),
        ("G0 G1 X1 F1", ["line 1", "G1", "one word of its group"]),
        ("G1 F1 X1 X2", ["line 1", "X2", "once in a line"]),
        ("G1 F1 X1 I2", ["line 1", "I2", "G2 or G3"]),
        (
            "G2 F1 X1",
            ["line 1", "G2 X1", "a centre (I J K) or a radius (R)"],
        ),
        ("G2 F1 X10 R1", ["line 1", "R1", "at least half"]),
        ("G2 F1 R1", ["line 1", "R1", "for a full circle"]),
        ("G2 F1 X1 I1 R1", ["line 1", "I1 R1", "not both"]),
        ("G2 F1 X1 I1 K1", ["line 1", "I1 K1", "the two letters"]),
        ("G1 F1 A5", ["line 1", "A5", "one of the letters"]),
        ("G4294967296 X1", ["line 1", "G4294967296", "G0 to G3"]),
        ("G0 X1e9", ["line 1", "E9", "one of the letters"]),
        (
            "G0 X9999999999",
            ["line 1", "9999999.999", "from -1e6 to 1e6"],
        ),
    ] {
        let message = refused(text);
        for part in parts {
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}

/// G64 P blends the corners of lines from its line on, G61 ends that; a corner at which the feed changes stays.
#[test]
fn g64_blends_corners_and_g61_does_not() {
    let square = "G1 X20 F3000\nY20\nX0\nY0";
    let corners = |text: &str| -> Vec<usize> {
        let runs = program(text);
        runs.iter().map(|run| run.path.corners().len()).collect()
    };
    assert_eq!(corners(square), [3]);
    assert_eq!(corners(&format!("G64 P0.1\n{square}")), [0]);
    assert_eq!(corners(&format!("G61\n{square}")), [3]);
    assert_eq!(corners("G64 P0.1\nG1 X20 F3000\nY20\nG61 X0\nY0"), [1]);
    assert_eq!(corners("G64 P0.1\nG1 X20 F3000\nY20 F1000\nX0"), [0, 0]);
    // 0.1 mm, and 0.004 inches, wherever G20 stands in the line.
    let cut = |text: &str| {
        let path = &program(text)[0].path;
        let whole = path.segments()[1].length();
        let middle = path.segments()[1].at(0.5 * whole).position;
        (middle[0] - 0.02).hypot(middle[1])
    };
    assert!((cut(&format!("G64 P0.1\n{square}")) - 1e-4).abs() < 1e-12);
    let inches = square.replace("20", "0.787401574803149606");
    for line in ["G20 G64 P0.004", "G64 P0.004 G20"] {
        let cut = cut(&format!("{line}\n{inches}"));
        assert!((cut - 0.1016e-3).abs() < 1e-9, "{cut}");
    }
    // Before its first G61 or G64 what the caller says.
    let tolerances = PathTolerances::default();
    let blending = (Blend::Arc, Some(1e-4));
    let of = |text: &str| read_blended(text, [0.0; 3], &tolerances, blending).unwrap();
    assert!(of(square)[0].path.corners().is_empty());
    assert!(matches!(
        of(square)[0].path.segments()[1],
        PathSegment::Arc(_)
    ));
    assert_eq!(of(&format!("G61\n{square}"))[0].path.corners().len(), 3);
    // In the plane it is the same path.
    let flat = of(square)[0].path.flattened().unwrap();
    assert!((flat.length() - of(square)[0].path.length()).abs() < 1e-12);
    let quintic = program(&format!("G64 P0.1\n{square}"));
    let flat = quintic[0].path.flattened().unwrap();
    assert!(flat.corners().is_empty() && (flat.length() - quintic[0].path.length()).abs() < 1e-12);
    assert!(program("G1 X1 Z1 F100")[0].path.flattened().is_none());
    for (text, valid) in [
        ("G64", "G64 with P"),
        ("G64 P-1", "G64 with P"),
        ("G64 P0", "G64 with P"),
        ("G1 X1 P1 F100", "G64 in the same line"),
        ("G61 P1", "G64 in the same line"),
        ("G61 G64 P1", "one word of its group"),
    ] {
        let message = refused(text);
        assert!(
            message.contains("line 1") && message.contains(valid),
            "{message}"
        );
    }
}

proptest! {
    #[test]
    fn any_text_is_taken(text in "([GXYZIJKRFNMP][-+]?[0-9]{0,3}[.]?[0-9]{0,2} ?|\n|[ -~]){0,40}") {
        let _ = read(&text, [0.0; 3], &PathTolerances::default());
    }

    /// What is written is read.
    #[test]
    fn points_come_back(points in prop::collection::vec([-9999..9999i32, -9999..9999i32, -9999..9999i32], 2..20)) {
        let mm = |p: &[i32; 3]| p.map(|x| f64::from(x) / 1000.0);
        let lines: Vec<String> = points.iter().map(|p| {
            let [x, y, z] = mm(p);
            format!("G1 X{x:.3} Y{y:.3} Z{z:.3} F100")
        }).collect();
        if let Ok(runs) = read(&lines.join("\n"), [1.0; 3], &PathTolerances::default()) {
            let path = &runs[0].path;
            let mut ends = path.starts().to_vec();
            ends.remove(0);
            let last = path.at(path.length()).position;
            let wanted = mm(&points[points.len() - 1]).map(|x| 1e-3 * x);
            prop_assert!(last.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12), "{last:?} {wanted:?}");
        }
    }
}
