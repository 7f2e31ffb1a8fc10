//! The rest of a torque balance, drawn anew.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::Rest;

/// Parts of a log that are turned round, or not, as a whole.
const BLOCKS: usize = 32;

/// A residual as it may as well have been: each of its parts with a sign by chance.
///
/// What a balance leaves is what the model lacks as well as noise, strong here and weak
/// there, and slow. Parts that are longer than its memory keep all that (the wild
/// bootstrap of R. Y. Liu, Ann. Statist. 16 (1988) 1696–1708, doi:10.1214/aos/1176351062,
/// in blocks).
pub fn turned(rest: &Rest, seed: u64) -> Rest {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut log = |channels: &Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        let signs: Vec<f64> = (0..BLOCKS)
            .map(|_| if random.random::<bool>() { 1.0 } else { -1.0 })
            .collect();
        let turn = |series: &Vec<f64>| {
            let n = series.len().max(1);
            let part = |k: usize| signs[k * BLOCKS / n];
            let all = series.iter().enumerate();
            all.map(|(k, value)| part(k) * value).collect()
        };
        channels.iter().map(turn).collect()
    };
    rest.iter().map(&mut log).collect()
}
