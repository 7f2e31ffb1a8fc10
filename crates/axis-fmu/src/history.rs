//! What was done with a unit since its initialisation: all that is needed to do it again.
//!
//! A state in memory is a copy of the simulation. A state as bytes is this history, as solvers,
//! controllers and sensors of any kind are of no common form: who reads it simulates again, with the
//! same calls, and so comes to the same bits.

use std::sync::Arc;

/// Steps that differ from the one before, beyond which no history is kept: 15 MB of an axis, 36 MB of a machine
/// of three.
pub(crate) const MOST_STEPS: usize = 1 << 18;

/// Steps in a block that copies share.
const BLOCK: usize = 512;

/// Equal communication steps that follow each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Repeated<'a> {
    /// Inputs, by their places among the inputs, and the step's length in control periods, as
    /// bits: steps are equal if their bits are.
    pub step: &'a [u64],
    /// How many.
    pub count: u64,
}

/// The history of a run. A copy shares all but the last steps.
#[derive(Clone, Debug)]
pub(crate) struct History {
    /// Numbers of a step; behind them stands how many such steps there were.
    words: usize,
    blocks: Vec<Arc<[u64]>>,
    last: Vec<u64>,
    /// Whether there was too much of it.
    pub is_lost: bool,
}

impl History {
    /// None yet, of steps of so many numbers.
    pub fn new(words: usize) -> Self {
        Self {
            words,
            blocks: Vec::new(),
            last: Vec::new(),
            is_lost: false,
        }
    }

    /// Numbers of a step.
    pub fn words(&self) -> usize {
        self.words
    }

    /// Adds `count` equal steps.
    pub fn push(&mut self, step: &[u64], count: u64) {
        if self.is_lost {
            return;
        }
        match self.last.rchunks_exact_mut(self.words + 1).next() {
            Some([before @ .., times]) if *before == *step => {
                *times = times.saturating_add(count);
            }
            _ => {
                self.last.extend(step);
                self.last.push(count);
            }
        }
        // The last one stays, so that it can be counted on.
        let block = BLOCK * (self.words + 1);
        if self.last.len() > block {
            let rest = self.last.split_off(block);
            self.blocks
                .push(std::mem::replace(&mut self.last, rest).into());
        }
        if self.len() > MOST_STEPS {
            *self = Self {
                is_lost: true,
                ..Self::new(self.words)
            };
        }
    }

    /// Different steps.
    pub fn len(&self) -> usize {
        self.blocks.len() * BLOCK + self.last.len() / (self.words + 1)
    }

    /// From the first on.
    pub fn iter(&self) -> impl Iterator<Item = Repeated<'_>> {
        let blocks = self.blocks.iter().map(|block| &**block);
        let numbers = blocks.chain([&*self.last]);
        let entries = numbers.flat_map(|numbers| numbers.chunks_exact(self.words + 1));
        entries.filter_map(|entry| match entry {
            [step @ .., count] => Some(Repeated {
                step,
                count: *count,
            }),
            [] => None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_pushed_is_kept_in_order_until_it_is_too_much() {
        for words in [3, 7, 16] {
            let mut history = History::new(words);
            for i in 0..3000_u64 {
                history.push(&vec![i / 2; words], 1 + i % 2);
            }
            let copy = history.clone();
            let steps: Vec<_> = copy.iter().collect();
            assert_eq!((steps.len(), history.len()), (1500, 1500));
            for (i, step) in (0..).zip(steps) {
                assert_eq!((step.step, step.count), (&*vec![i; words], 3));
            }
            (0..MOST_STEPS as u64).for_each(|i| history.push(&vec![i; words], 1));
            assert!(history.is_lost && history.len() == 0 && !copy.is_lost);
        }
    }
}
