//! What was done with a unit since its initialisation: all that is needed to do it again.
//!
//! A state in memory is a copy of the simulation. A state as bytes is this history, as solvers,
//! controllers and sensors of any kind are of no common form: who reads it simulates again, with the
//! same calls, and so comes to the same bits.

use std::sync::Arc;

/// Steps that differ from the one before, beyond which no history is kept: 17 MB.
pub(crate) const MOST_STEPS: usize = 1 << 18;

/// Steps in a block that copies share.
const BLOCK: usize = 512;

/// Equal communication steps that follow each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Repeated {
    /// Inputs, by their places among the inputs, and the step's length in control periods, as
    /// bits: steps are equal if their bits are.
    pub step: [u64; Repeated::WORDS],
    /// How many.
    pub count: u64,
}

impl Repeated {
    /// Numbers of a step.
    pub const WORDS: usize = 7;
}

/// The history of a run. A copy shares all but the last steps.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    blocks: Vec<Arc<[Repeated]>>,
    last: Vec<Repeated>,
    /// Whether there was too much of it.
    pub is_lost: bool,
}

impl History {
    /// Adds `count` equal steps.
    pub fn push(&mut self, step: [u64; Repeated::WORDS], count: u64) {
        if self.is_lost {
            return;
        }
        match self.last.last_mut() {
            Some(before) if before.step == step => {
                before.count = before.count.saturating_add(count);
            }
            _ => self.last.push(Repeated { step, count }),
        }
        // The last one stays, so that it can be counted on.
        if self.last.len() > BLOCK {
            let rest = self.last.split_off(BLOCK);
            self.blocks
                .push(std::mem::replace(&mut self.last, rest).into());
        }
        if self.len() > MOST_STEPS {
            *self = Self {
                is_lost: true,
                ..Self::default()
            };
        }
    }

    /// Different steps.
    pub fn len(&self) -> usize {
        self.blocks.len() * BLOCK + self.last.len()
    }

    /// From the first on.
    pub fn iter(&self) -> impl Iterator<Item = &Repeated> {
        let blocks = self.blocks.iter().flat_map(|block| block.iter());
        blocks.chain(&self.last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_pushed_is_kept_in_order_until_it_is_too_much() {
        let mut history = History::default();
        for i in 0..3000_u64 {
            let step = [i / 2; Repeated::WORDS];
            history.push(step, 1 + i % 2);
        }
        let copy = history.clone();
        let steps: Vec<_> = copy.iter().copied().collect();
        assert_eq!((steps.len(), history.len()), (1500, 1500));
        for (i, step) in (0..).zip(steps) {
            assert_eq!((step.step[0], step.count), (i, 3));
        }
        (0..MOST_STEPS as u64).for_each(|i| history.push([i; Repeated::WORDS], 1));
        assert!(history.is_lost && history.len() == 0 && !copy.is_lost);
    }
}
