//! Arcs of a program: centres from I, J, K or R.

use std::f64::consts::TAU;

use super::{Block, GcodeError, RADIUS_TOLERANCE, State};
use crate::vector::{norm, sub};
use crate::{Arc, PathSegment};

impl State {
    pub(super) fn arc(
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
