//! Pseudo-random binary sequences.

use super::check_amplitude;
use crate::error::ResponseError;

/// Least and greatest length of the shift register.
const REGISTERS: [u32; 2] = [5, 20];

/// Taps of registers of 5 to 20 bits whose sequence is of the greatest length, 2ⁿ − 1: P. Alfke, Xilinx
/// application note XAPP 052 (1996), table 3. The tests walk through every one.
const TAPS: [&[u32]; 16] = [
    &[5, 3],
    &[6, 5],
    &[7, 6],
    &[8, 6, 5, 4],
    &[9, 5],
    &[10, 7],
    &[11, 9],
    &[12, 6, 4, 1],
    &[13, 4, 3, 1],
    &[14, 5, 3, 1],
    &[15, 14],
    &[16, 15, 13, 4],
    &[17, 14],
    &[18, 11],
    &[19, 6, 2, 1],
    &[20, 17],
];

/// A pseudo-random binary sequence of the greatest length.
///
/// Its mean is 1/(2ⁿ − 1) of the amplitude, and its power over the frequency falls with the hold of
/// its clock, (sin πfτ/πfτ)², τ the clock: 3.9 dB at half the clock's rate, nothing at that rate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Prbs {
    /// Half the distance of its two values, in the unit of the command.
    pub amplitude: f64,
    /// Bits of the shift register, 5 to 20.
    pub register: u32,
    /// Samples for which each value is held.
    pub clock: usize,
    /// Where in the sequence it begins.
    pub seed: u64,
}

impl Default for Prbs {
    fn default() -> Self {
        Self {
            amplitude: 1.0,
            register: 12,
            clock: 2,
            seed: 0,
        }
    }
}

impl Prbs {
    /// Samples after which it repeats.
    #[must_use]
    pub fn period(&self) -> usize {
        let bits = self.register.clamp(REGISTERS[0], REGISTERS[1]);
        ((1usize << bits) - 1).saturating_mul(self.clock.max(1))
    }

    pub(super) fn samples(&self, count: usize) -> Result<Vec<f64>, ResponseError> {
        check_amplitude(self.amplitude)?;
        if !(REGISTERS[0]..=REGISTERS[1]).contains(&self.register) {
            return Err(ResponseError::Setting {
                name: "the shift register",
                value: f64::from(self.register),
                valid: "5 to 20 bits",
            });
        }
        if !(1..=1_000_000).contains(&self.clock) {
            return Err(ResponseError::Setting {
                name: "the clock",
                value: self.clock as f64,
                valid: "1 to 1000000 samples",
            });
        }
        let taps = TAPS[(self.register - REGISTERS[0]) as usize];
        let mask = (1u64 << self.register) - 1;
        // Every state but 0 is on the sequence.
        let mut state = (self.seed % mask) + 1;
        let mut all = Vec::with_capacity(count);
        while all.len() < count {
            let bit = taps.iter().fold(0, |bit, tap| bit ^ (state >> (tap - 1))) & 1;
            state = ((state << 1) | bit) & mask;
            let value = if bit == 1 {
                self.amplitude
            } else {
                -self.amplitude
            };
            let left = self.clock.min(count - all.len());
            all.extend(std::iter::repeat_n(value, left));
        }
        Ok(all)
    }
}
