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
//! | F | feed per minute, kept until the next (G94, which is accepted) |
//! | N, comments, % | without effect |
//! | M2, M30 | end |
//! | other M, S, T | without effect: they move no axis |
//!
//! Anything else is refused, with its line. The [gcode](https://crates.io/crates/gcode) crate is not
//! used for the words: its 0.7.0 keeps numbers in single precision, 30 nm at 1 m, and panics at a
//! command number above 429 496 729.

mod words;

use std::f64::consts::TAU;

use crate::error::ToolpathError;
use crate::vector::{norm, sub};
use crate::{Arc, Line, Path, PathSegment, PathTolerances};
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
    let mut state = State {
        position: start,
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
        let segments = run.iter().map(|m| m.segment.clone()).collect();
        let path =
            Path::with_tolerances(segments, tolerances).map_err(|source| GcodeError::Path {
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

const KNOWN: &str = "G0 to G3, G17 to G21, G90, G91, G90.1, G91.1 or G94";

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
                'X' | 'Y' | 'Z' | 'I' | 'J' | 'K' | 'R' | 'F' | 'N' | 'S' | 'T' if twice => {
                    return block.refuse(&word.text, "each letter but G and M once in a line");
                }
                'X' | 'Y' | 'Z' | 'I' | 'J' | 'K' | 'R' | 'F' | 'N' | 'S' | 'T' => {}
                _ => {
                    return block
                        .refuse(&word.text, "one of the letters F G I J K M N R S T X Y Z");
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
        let mut seen: Vec<u8> = Vec::new();
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
                _ => return block.refuse(&word.text, KNOWN),
            };
            if seen.contains(&group) {
                return block.refuse(&word.text, "one word of its group in a line");
            }
            seen.push(group);
        }
        Ok(())
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
            line: block.line,
        }));
        self.position = target;
        Ok(())
    }

    fn arc(
        &self,
        block: &Block,
        target: [f64; 3],
        counterclockwise: bool,
    ) -> Result<PathSegment<3>, GcodeError> {
        let [a, b, c] = self.plane;
        let start = [self.position[a], self.position[b]];
        let end = [target[a], target[b]];
        let sign = if counterclockwise { 1.0 } else { -1.0 };
        let centre = match block.get('R') {
            Some(radius) => self.centre_of_radius(block, (start, end), radius * self.unit, sign)?,
            None => self.centre_of_words(block, (start, end))?,
        };
        let spoke = sub(&start, &centre);
        let last = sub(&end, &centre);
        let turn = libm::atan2(
            spoke[0] * last[1] - spoke[1] * last[0],
            spoke[0] * last[0] + spoke[1] * last[1],
        );
        let mut sweep = sign * turn;
        if start == end {
            sweep = TAU;
        } else if sweep <= 0.0 {
            sweep += TAU;
        }
        let (mut middle, mut towards, mut advance) = (self.position, [0.0; 3], [0.0; 3]);
        (middle[a], middle[b]) = (centre[0], centre[1]);
        (towards[a], towards[b]) = (-sign * spoke[1], sign * spoke[0]);
        advance[c] = target[c] - self.position[c];
        let arc = Arc::new(middle, self.position, towards, sweep);
        let arc = if advance[c] == 0.0 {
            arc
        } else {
            arc.and_then(|arc| arc.helix(advance))
        };
        Ok(arc
            .map_err(|source| GcodeError::Path {
                line: block.line,
                source,
            })?
            .into())
    }

    /// The centre of I, J and K, moved onto the line of equal distance from both ends.
    fn centre_of_words(
        &self,
        block: &Block,
        (start, end): ([f64; 2], [f64; 2]),
    ) -> Result<[f64; 2], GcodeError> {
        let letters = ['I', 'J', 'K'];
        let normal = letters[self.plane[2]];
        if block.get(normal).is_some() {
            return block.refuse(
                &block.text("IJK"),
                "the two letters of the plane's axes alone",
            );
        }
        let given = [0, 1].map(|k| block.get(letters[self.plane[k]]));
        if given == [None; 2] {
            return block.refuse(&block.text("GXYZ"), "a centre (I J K) or a radius (R)");
        }
        let centre: [f64; 2] = std::array::from_fn(|k| match (given[k], self.absolute_centre) {
            (Some(value), true) => value * self.unit,
            (Some(value), false) => start[k] + value * self.unit,
            // An absolute centre has both coordinates, a relative one is zero off in the other.
            (None, _) => start[k],
        });
        if self.absolute_centre && given.contains(&None) {
            return block.refuse(
                &block.text("IJK"),
                "both letters of the plane's axes with G90.1",
            );
        }
        if start == end {
            return Ok(centre);
        }
        let (begin, last) = (norm(&sub(&start, &centre)), norm(&sub(&end, &centre)));
        // False for a NaN too.
        let holds = (begin - last).abs() <= RADIUS_TOLERANCE;
        if !holds {
            let (line, word) = (block.line, block.text("IJK"));
            return Err(GcodeError::Radii {
                line,
                word,
                begin,
                end: last,
            });
        }
        let chord = sub(&end, &start);
        let middle: [f64; 2] = std::array::from_fn(|k| 0.5 * (start[k] + end[k]));
        let offset = sub(&centre, &middle);
        let size = chord[0] * chord[0] + chord[1] * chord[1];
        let along = (offset[0] * chord[0] + offset[1] * chord[1]) / size;
        Ok(std::array::from_fn(|k| centre[k] - along * chord[k]))
    }

    fn centre_of_radius(
        &self,
        block: &Block,
        (start, end): ([f64; 2], [f64; 2]),
        radius: f64,
        sign: f64,
    ) -> Result<[f64; 2], GcodeError> {
        if block.words.iter().any(|w| "IJK".contains(w.letter)) {
            return block.refuse(
                &block.text("IJKR"),
                "a centre (I J K) or a radius (R), not both",
            );
        }
        let chord = sub(&end, &start);
        let half = 0.5 * norm(&chord);
        // False for a NaN too.
        let holds = half > 0.0;
        if !holds {
            return block.refuse(&block.text("R"), "a centre (I J K) for a full circle");
        }
        // False for a NaN too.
        let holds = radius.abs() >= half - RADIUS_TOLERANCE;
        if !holds {
            return block.refuse(
                &block.text("R"),
                "a radius of at least half of the distance to the end",
            );
        }
        let height = (radius * radius - half * half).max(0.0).sqrt();
        // The shorter arc has its centre on the side to which it turns.
        let side = sign * height.copysign(height * radius) / (2.0 * half);
        Ok([
            0.5 * (start[0] + end[0]) - side * chord[1],
            0.5 * (start[1] + end[1]) + side * chord[0],
        ])
    }
}
