//! How a model answers a log: by its closed loop, or by its torque balance.

use axis_sim::effects::ActiveEffect;
use axis_sim::{Axis, Balance, Probe, Replay, ReplayError, Trace};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::noise::Floor;

/// What a model makes of a log.
#[derive(Clone, Debug)]
pub enum Answer {
    /// The logged reference goes through the simulated closed loop: for machines whose
    /// controller is known.
    Replay(Replay),
    /// The measured motion asks for a motor torque, which is compared with what the log
    /// shows of it: for all others.
    Balance(Box<Balance>),
}

/// Parts of a log that are turned round, or not, as a whole.
const BLOCKS: usize = 32;

impl Answer {
    /// As the file of results has it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Replay(_) => "closed-loop-replay",
            Self::Balance(_) => "torque-balance",
        }
    }

    /// The answer of a machine with effects and, where asked, a disturbance.
    ///
    /// # Errors
    /// [`ReplayError`] where the machine cannot be set up, or its loop does not hold.
    pub fn run(
        &self,
        machine: &Axis,
        effects: &[ActiveEffect],
        probe: Option<&Probe>,
    ) -> Result<Trace, ReplayError> {
        match self {
            Self::Replay(replay) => replay.run(machine, effects, probe),
            Self::Balance(balance) => balance.run(machine, effects, probe),
        }
    }

    /// The reference's replay; none of a torque balance.
    pub fn replay(&self) -> Option<&Replay> {
        match self {
            Self::Replay(replay) => Some(replay),
            Self::Balance(_) => None,
        }
    }

    /// The torque balance; none of a replay.
    pub fn balance(&self) -> Option<&Balance> {
        match self {
            Self::Balance(balance) => Some(balance),
            Self::Replay(_) => None,
        }
    }
}

/// Noise of a balance's channel: the least that its log leaves possible. Nobody knows what
/// its controller makes of its sensors' noise, and a floor that is too low never lets a rest
/// pass for noise.
pub fn floor(balances: &[&Balance]) -> Floor {
    let samples = balances.iter().map(|b| b.quality().samples[0] as f64);
    let squares = balances.iter().map(|b| b.quality().floor.powi(2));
    let sum: f64 = samples.clone().zip(squares).map(|(n, s)| n * s).sum();
    let independent: f64 = samples.sum();
    let rms = (sum / independent.max(1.0)).sqrt();
    Floor {
        rms,
        most: rms,
        independent,
    }
}

/// A rest as it may as well have been: each of its parts with a sign by chance.
///
/// What a balance leaves is what the model lacks as well as noise, strong here and weak
/// there, and slow. Parts that are longer than its memory keep all that (the wild
/// bootstrap of R. Y. Liu, Ann. Statist. 16 (1988) 1696–1708, doi:10.1214/aos/1176351062,
/// in blocks).
pub fn turned(rest: &[Vec<Vec<f64>>], seed: u64) -> Vec<Vec<Vec<f64>>> {
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
