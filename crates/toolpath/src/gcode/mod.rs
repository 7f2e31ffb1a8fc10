//! Programs in G-code, to paths with feeds.
//!
//! | words | |
//! |---|---|
//! | G0; G1; G2, G3 | rapid; straight line; arc clockwise, counterclockwise, in the plane, with motion along its normal a helix |
//! | G17, G18, G19 | plane XY, ZX, YZ |
//! | G20, G21 | inches, millimetres (at first) |
//! | G90, G91 | positions absolute (at first), or from the last position |
//! | G90.1, G91.1 | centres absolute, or from the arc's begin (at first) |
//! | X Y Z; I J K; R | position; centre; radius, negative for the longer of the two arcs |
//! | G61; G64 P | corners stay (at first); blends within P of each corner of lines and arcs of one feed ([`PathBlending`](crate::PathBlending)) |
//! | F | feed per minute, kept until the next (G94, which is accepted) |
//! | N, comments, % | without effect |
//! | M2, M30 | end |
//! | other M, S, T | without effect: they move no axis |
//!
//! Anything else is refused, with its line. The [gcode](https://crates.io/crates/gcode) crate is not
//! used for the words: its 0.7.0 keeps numbers in single precision, 30 nm at 1 m, and panics at a
//! command number above 429 496 729.

mod arcs;
mod words;

use crate::blending::blended;
use crate::error::ToolpathError;
use crate::vector::{norm, sub};
use crate::{Blend, Line, Path, PathSegment, PathTolerances};
use words::{Word, words};

/// Why a program was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GcodeError {
    /// A word cannot be read, is not known, or does not fit the others of its line.
    #[error("line {line}: {word}: expected {valid}")]
    Word {
        /// Line, counted from 1.
        line: usize,
        /// The word as it stands there, or the words that are missing one.
        word: String,
        /// What would be valid.
        valid: &'static str,
    },
    /// The distances of an arc's begin and end from its centre differ.
    #[error(
        "line {line}: {word}: the arc begins {begin} m and ends {end} m from its centre; at most \
         {RADIUS_TOLERANCE} m of difference are allowed"
    )]
    Radii {
        /// Line, counted from 1.
        line: usize,
        /// The words of the centre.
        word: String,
        /// Distance of the begin from the centre, m.
        begin: f64,
        /// Distance of the end from the centre, m.
        end: f64,
    },
    /// A segment or a path was refused.
    #[error("line {line}: {source}")]
    Path {
        /// Line, counted from 1.
        line: usize,
        /// What is wrong with it.
        source: ToolpathError,
    },
}

/// Greatest difference of an arc's two radii, m: programs have three decimals of a millimetre in
/// each of four numbers, and the centre is moved so that both ends are met.
pub const RADIUS_TOLERANCE: f64 = 2e-6;

/// A path at one feed.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramRun {
    /// The path, m.
    pub path: Path<3>,
    /// Feed, m/s; `None` for rapids.
    pub feed: Option<f64>,
    /// First and last line, counted from 1.
    pub lines: (usize, usize),
}

/// Reads a program that begins at `start` (m): runs of segments that follow one another at one
/// feed, in order. Moves shorter than 1e-9 m are left out.
///
/// # Errors
/// [`GcodeError`], with the line.
pub fn read(
    text: &str,
    start: [f64; 3],
    tolerances: &PathTolerances,
) -> Result<Vec<ProgramRun>, GcodeError> {
    read_blended(text, start, tolerances, (Blend::Quintic, None))
}

/// As [`read`], with blends of that shape, and the tolerance (m) that holds before the first G61 or G64; none to stop at corners.
///
/// # Errors
/// As [`read`].
pub fn read_blended(
    text: &str,
    start: [f64; 3],
    tolerances: &PathTolerances,
    (shape, blending): (Blend, Option<f64>),
) -> Result<Vec<ProgramRun>, GcodeError> {
    let mut state = State {
        position: start,
        blending,
        ..State::default()
    };
    let mut moves = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        let words = words(number, line)?;
        if state.block(number, &words, &mut moves)? {
            break;
        }
    }
    let mut runs = Vec::new();
    let mut i = 0;
    while i < moves.len() {
        let feed = moves[i].feed;
        let count = moves[i..].iter().take_while(|m| m.feed == feed).count();
        let run = &moves[i..i + count];
        let lines = (run[0].line, run[count - 1].line);
        let segments: Vec<_> = run.iter().map(|m| m.segment.clone()).collect();
        let within: Vec<_> = run.iter().map(|m| m.blending).collect();
        let segments = blended(&segments, &within, shape);
        let path = segments.and_then(|segments| Path::with_tolerances(segments, tolerances));
        let path = path.map_err(|source| GcodeError::Path {
            line: lines.0,
            source,
        })?;
        runs.push(ProgramRun { path, feed, lines });
        i += count;
    }
    Ok(runs)
}

struct Move {
    segment: PathSegment<3>,
    feed: Option<f64>,
    /// Tolerance of the blend at its end, m.
    blending: Option<f64>,
    line: usize,
}

/// What is kept from line to line.
#[derive(Clone, Debug)]
struct State {
    position: [f64; 3],
    motion: Option<u32>,
    /// First axis, second axis and normal of the plane.
    plane: [usize; 3],
    unit: f64,
    absolute: bool,
    absolute_centre: bool,
    feed: Option<f64>,
    blending: Option<f64>,
}

impl Default for State {
    fn default() -> Self {
        Self {
            position: [0.0; 3],
            motion: None,
            plane: [0, 1, 2],
            unit: 1e-3,
            absolute: true,
            absolute_centre: false,
            feed: None,
            blending: None,
        }
    }
}

/// One line, its words sorted.
struct Block<'a> {
    line: usize,
    words: &'a [Word],
}

impl Block<'_> {
    fn get(&self, letter: char) -> Option<f64> {
        self.words
            .iter()
            .find(|w| w.letter == letter)
            .map(|w| w.value)
    }

    fn text(&self, letters: &str) -> String {
        let chosen = self.words.iter().filter(|w| letters.contains(w.letter));
        chosen
            .map(|w| w.text.as_str())
            .collect::<Vec<_>>()
            .join(" ")
    }

    fn refuse<T>(&self, word: &str, valid: &'static str) -> Result<T, GcodeError> {
        Err(GcodeError::Word {
            line: self.line,
            word: word.to_owned(),
            valid,
        })
    }
}

const KNOWN: &str = "G0 to G3, G17 to G21, G61, G64 P, G90, G91, G90.1, G91.1 or G94";

impl State {
    /// Takes one line; `true` at the end of the program.
    fn block(
        &mut self,
        line: usize,
        words: &[Word],
        moves: &mut Vec<Move>,
    ) -> Result<bool, GcodeError> {
        let block = Block { line, words };
        let mut end = false;
        for (i, word) in words.iter().enumerate() {
            let twice = words[..i].iter().any(|w| w.letter == word.letter);
            match word.letter {
                'G' => {}
                'M' => end |= word.value == 2.0 || word.value == 30.0,
                'X' | 'Y' | 'Z' | 'I' | 'J' | 'K' | 'R' | 'F' | 'N' | 'P' | 'S' | 'T' if twice => {
                    return block.refuse(&word.text, "each letter but G and M once in a line");
                }
                'X' | 'Y' | 'Z' | 'I' | 'J' | 'K' | 'R' | 'F' | 'N' | 'P' | 'S' | 'T' => {}
                _ => {
                    return block
                        .refuse(&word.text, "one of the letters F G I J K M N P R S T X Y Z");
                }
            }
        }
        self.modes(&block)?;
        if let Some(feed) = block.get('F') {
            let feed_rate = feed * self.unit / 60.0;
            if !(1e-9..=1e3).contains(&feed_rate) {
                return block.refuse(&block.text("F"), "a feed from 1e-9 to 1e3 m/s");
            }
            self.feed = Some(feed_rate);
        }
        let moving = block.words.iter().any(|w| "XYZ".contains(w.letter));
        let centred = block.words.iter().any(|w| "IJKR".contains(w.letter));
        if moving || centred {
            self.go(&block, centred, moves)?;
        }
        Ok(end)
    }

    /// The G words, of each group at most one.
    fn modes(&mut self, block: &Block) -> Result<(), GcodeError> {
        let (mut seen, mut blends): (Vec<u8>, _) = (Vec::new(), None);
        for word in block.words.iter().filter(|w| w.letter == 'G') {
            // Tenths: 90.1 is 901.
            let tenths = word.value * 10.0;
            let code = tenths.round();
            // False for a NaN too.
            let holds = (0.0..1000.0).contains(&code) && (tenths - code).abs() < 1e-9;
            if !holds {
                return block.refuse(&word.text, KNOWN);
            }
            let group = match code as u32 {
                motion @ (0 | 10 | 20 | 30) => {
                    self.motion = Some(motion / 10);
                    1
                }
                plane @ (170 | 180 | 190) => {
                    self.plane = match plane {
                        170 => [0, 1, 2],
                        180 => [2, 0, 1],
                        _ => [1, 2, 0],
                    };
                    2
                }
                unit @ (200 | 210) => {
                    self.unit = if unit == 200 { 25.4e-3 } else { 1e-3 };
                    3
                }
                mode @ (900 | 910) => {
                    self.absolute = mode == 900;
                    4
                }
                mode @ (901 | 911) => {
                    self.absolute_centre = mode == 901;
                    5
                }
                940 => 6,
                mode @ (610 | 640) => {
                    blends = Some(mode == 640);
                    7
                }
                _ => return block.refuse(&word.text, KNOWN),
            };
            if seen.contains(&group) {
                return block.refuse(&word.text, "one word of its group in a line");
            }
            seen.push(group);
        }
        match blends {
            // Here, as a unit may stand behind it in its line.
            Some(true) => self.blending = Some(self.tolerance(block)?),
            _ if block.get('P').is_some() => {
                return block.refuse(&block.text("P"), "G64 in the same line");
            }
            Some(false) => self.blending = None,
            None => (),
        }
        Ok(())
    }

    /// The tolerance of a G64, m.
    fn tolerance(&self, block: &Block) -> Result<f64, GcodeError> {
        // Without P, LinuxCNC cuts corners as far as speed asks for.
        let valid = "G64 with P, a tolerance from 1e-9 m to 1 m";
        let Some(value) = block.get('P') else {
            return block.refuse("G64", valid);
        };
        let tolerance = value * self.unit;
        match (1e-9..=1.0).contains(&tolerance) {
            true => Ok(tolerance),
            false => block.refuse(&block.text("GP"), valid),
        }
    }

    fn go(
        &mut self,
        block: &Block,
        centred: bool,
        moves: &mut Vec<Move>,
    ) -> Result<(), GcodeError> {
        let Some(motion) = self.motion else {
            return block.refuse(&block.text("XYZIJKR"), "G0, G1, G2 or G3 before it");
        };
        if motion < 2 && centred {
            return block.refuse(&block.text("IJKR"), "G2 or G3 for a centre or a radius");
        }
        if motion > 0 && self.feed.is_none() {
            return block.refuse(&block.text("GXYZ"), "an F word before it or with it");
        }
        let mut target = self.position;
        for (i, letter) in ['X', 'Y', 'Z'].into_iter().enumerate() {
            if let Some(value) = block.get(letter) {
                let base = if self.absolute { 0.0 } else { self.position[i] };
                target[i] = base + value * self.unit;
            }
        }
        let segment = if motion >= 2 {
            Some(self.arc(block, target, motion == 3)?)
        } else if norm(&sub(&target, &self.position)) < 1e-9 {
            None
        } else {
            let line = Line::new(self.position, target);
            Some(
                line.map_err(|source| GcodeError::Path {
                    line: block.line,
                    source,
                })?
                .into(),
            )
        };
        let feed = if motion == 0 { None } else { self.feed };
        moves.extend(segment.map(|segment| Move {
            segment,
            feed,
            blending: self.blending,
            line: block.line,
        }));
        self.position = target;
        Ok(())
    }
}
