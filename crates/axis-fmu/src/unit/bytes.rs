//! States as bytes.

use super::Unit;
use crate::digest::digest;
use crate::error::UnitError;
use crate::history::{History, MOST_STEPS};
use crate::mode::FmiMode;

/// What such bytes begin with, and the number of their form.
const MAGIC: u64 = u64::from_le_bytes(*b"fa-fmu-2");

const MODES: [FmiMode; 4] = [
    FmiMode::Instantiated,
    FmiMode::Initialization,
    FmiMode::Step,
    FmiMode::Terminated,
];

impl Unit {
    /// The state as bytes, for [`Unit::from_bytes`] of a unit of the same token: what was set, and
    /// what was done since the initialisation.
    ///
    /// # Errors
    /// [`UnitError::State`] of a run that had to be given up, and of one with more than 262144
    /// communication steps that differ from the one before.
    pub fn to_bytes(&self) -> Result<Vec<u8>, UnitError> {
        let mode = MODES.iter().position(|mode| *mode == self.mode);
        let Some(mode) = mode else {
            return Err(UnitError::State(format!(
                "it is {}; valid: another one",
                self.mode
            )));
        };
        if self.history.is_lost {
            return Err(UnitError::State(format!(
                "it has a history of more than {MOST_STEPS} communication steps that differ from the one before; \
                 valid: fewer, or a state in memory"
            )));
        }
        let mut words = vec![MAGIC, digest(self.token().as_bytes()), mode as u64];
        words.extend(self.span.map(f64::to_bits));
        words.push(u64::from(self.run.is_some()));
        for values in [&self.values, &self.begun] {
            words.push(values.len() as u64);
            words.extend(values.iter().map(|value| value.to_bits()));
        }
        words.push(self.history.len() as u64);
        for repeated in self.history.iter() {
            words.extend(repeated.step.iter().copied());
            words.push(repeated.count);
        }
        let mut bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        bytes.extend(digest(&bytes).to_le_bytes());
        Ok(bytes)
    }

    /// The state of these bytes. It is simulated again: a hundredth of the simulated time or so.
    ///
    /// # Errors
    /// [`UnitError::State`] for other bytes than those of [`Unit::to_bytes`], or of another unit; and
    /// whatever the simulation meets, where it goes on otherwise.
    pub fn from_bytes(&self, bytes: &[u8]) -> Result<Self, UnitError> {
        let (bytes, check) = bytes.split_at(bytes.len().saturating_sub(8));
        let (words, rest) = bytes.as_chunks::<8>();
        if !rest.is_empty() || check != digest(bytes).to_le_bytes() {
            return refused("they are damaged, or no state");
        }
        let words = words.iter().map(|word| u64::from_le_bytes(*word));
        let mut reader = Reader(words.collect::<Vec<_>>().into_iter());
        if reader.word()? != MAGIC {
            return refused("they are of another version");
        }
        if reader.word()? != digest(self.token().as_bytes()) {
            return refused("they are of another unit");
        }
        let mode = MODES.get(reader.word()? as usize).copied();
        let span = [reader.number()?, reader.number()?];
        let runs = reader.word()? != 0;
        let (values, begun) = (reader.numbers()?, reader.numbers()?);
        let is_of_unit = |values: &[f64]| values.len() == self.values.len();
        let (Some(mode), true, true) = (mode, is_of_unit(&values), is_of_unit(&begun)) else {
            return refused("they are of another unit");
        };
        let mut unit = self.clone();
        (unit.span, unit.begun, unit.run) = (span, begun, None);
        unit.values.clone_from(&unit.begun);
        unit.history = History::new(self.history.words());
        if runs {
            unit.settled()?;
            unit.mode = FmiMode::Step;
            for _ in 0..reader.word()? {
                let step = (0..self.history.words()).map(|_| reader.word());
                let step = step.collect::<Result<Vec<_>, _>>()?;
                unit.again(&step, reader.word()?)?;
            }
        }
        (unit.values, unit.mode) = (values, mode);
        Ok(unit)
    }
}

/// Words, from the first on.
struct Reader(std::vec::IntoIter<u64>);

impl Reader {
    fn word(&mut self) -> Result<u64, UnitError> {
        match self.0.next() {
            Some(word) => Ok(word),
            None => refused("they end early"),
        }
    }

    fn number(&mut self) -> Result<f64, UnitError> {
        Ok(f64::from_bits(self.word()?))
    }

    fn numbers(&mut self) -> Result<Vec<f64>, UnitError> {
        (0..self.word()?).map(|_| self.number()).collect()
    }
}

fn refused<T>(why: &str) -> Result<T, UnitError> {
    Err(UnitError::State(format!(
        "the bytes are not taken, {why}; valid: those of a state of the same unit"
    )))
}
