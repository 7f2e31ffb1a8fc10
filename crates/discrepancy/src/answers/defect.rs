//! What the simulation that a log is compared with leaves out: the mechanism's exact method, and the steps and the noise of
//! the sensors in the loop, which on average are not nothing.

use axis_sim::{Axis, ClosedLoop, Replay, ReplayError, Trace};
use rayon::prelude::*;

use super::set::{LogSet, Prepared};
use super::share::{BY_CHANCE, misfit};
use super::shown::{Shown, as_shown, window};
use super::state::State;

/// Runs with sensors as the log shows them, whose mean is taken.
const RUNS: u64 = 8;

/// By channel.
type Defect = Vec<Vec<f64>>;

impl LogSet {
    /// Simulates each log with what the fast, quiet simulation leaves out, and keeps the difference.
    /// A screw's fixed mesh is too stiff between its nodes by nanometres. A controller that sees steps does not
    /// integrate what lies within one, and noise lets dry friction slip: where an axis holds, both change its torque by
    /// more than the noise of it. Either would be found as an effect.
    ///
    /// # Errors
    /// [`ReplayError`] if the machine does not run at this state.
    pub fn correct_defects(&mut self, machine: &Axis, state: &State) -> Result<(), ReplayError> {
        if self.is_balanced() {
            return Ok(());
        }
        let known = machine.with_known(&state.shares);
        let with_effects = |mut axis: Axis| {
            axis.effects.extend_from_slice(&state.effects);
            axis
        };
        let exact = known.mechanism.exact_step();
        let exact = exact.map(|step| ClosedLoop::exact(&with_effects(known.clone()), step));
        let exact = exact.transpose()?.map(ClosedLoop::without_noise);
        let one = |log: &Prepared| -> Result<[Defect; 2], ReplayError> {
            let nothing = || vec![vec![0.0; log.log.len()]; self.channels.len()];
            let (Some(replay), shown) = (log.answer.replay(), as_shown(&known, log)?) else {
                return Ok([nothing(), nothing()]);
            };
            if exact.is_none() && shown.is_none() {
                return Ok([nothing(), nothing()]);
            }
            let fast = log.answer.run(&known, &state.effects, None)?;
            let of_mesh = match &exact {
                Some(exact) => self.differences(&replay.follow(exact, |_| ())?, &fast),
                None => nothing(),
            };
            let Some(Shown { axis, is_read }) = shown else {
                return Ok([of_mesh, nothing()]);
            };
            let sensed = self.of_sensors(replay, &with_effects(axis), &fast, window(log))?;
            let misfit = |sensed: &Defect| misfit(&self.residual(log, &fast, [&of_mesh, sensed]));
            let is_kept = is_read || misfit(&sensed) < misfit(&nothing()) - BY_CHANCE;
            Ok([of_mesh, if is_kept { sensed } else { nothing() }])
        };
        let found: Vec<_> = (self.logs.par_iter().map(one)).collect::<Result<_, _>>()?;
        for (log, found) in self.logs.iter_mut().zip(found) {
            [log.defect, log.sensed] = found;
        }
        Ok(())
    }

    /// What steps and noise of the sensors change on average, by channel.
    fn of_sensors(
        &self,
        replay: &Replay,
        sensed: &Axis,
        quiet: &Trace,
        window: usize,
    ) -> Result<Defect, ReplayError> {
        let sensed = ClosedLoop::new(sensed)?;
        let run = |seed: u64| -> Result<_, ReplayError> {
            let noisy = replay.follow(&sensed.clone().with_seed(seed), |_| ())?;
            Ok(self.differences(&noisy, quiet))
        };
        let runs = (1..=RUNS).into_par_iter().map(run);
        let runs: Vec<Vec<Vec<f64>>> = runs.collect::<Result<_, _>>()?;
        let channels = 0..self.channels.len();
        let of_channel = |c: usize| runs.iter().map(|run| run[c].as_slice()).collect::<Vec<_>>();
        Ok(channels
            .map(|c| mean_beyond_chance(&of_channel(c), window))
            .collect())
    }

    /// One simulation minus another, by channel.
    fn differences(&self, a: &Trace, b: &Trace) -> Vec<Vec<f64>> {
        let of_channel = |c: usize| {
            let pairs = self.simulated(a, c).into_iter().zip(self.simulated(b, c));
            pairs.map(|(a, b)| a - b).collect()
        };
        (0..self.channels.len()).map(of_channel).collect()
    }
}

/// Power of a mean over that by chance from which on a window of it is kept: noise of twenty independent samples or more in
/// a window has as much in one of two hundred.
const CLEAR: f64 = 2.0;

/// The mean of runs, of which each window keeps the share that chance does not explain (Wiener's), if that is clear.
fn mean_beyond_chance(runs: &[&[f64]], window: usize) -> Vec<f64> {
    let n = runs.len() as f64;
    let samples = runs.first().map_or(0, |run| run.len());
    let at = |i: usize| runs.iter().map(move |run| run[i]);
    let mut mean: Vec<f64> = (0..samples).map(|i| at(i).sum::<f64>() / n).collect();
    let by_chance = |i: usize, mean: f64| -> f64 {
        at(i).map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n * (n - 1.0))
    };
    for (w, means) in mean.chunks_mut(window).enumerate() {
        let power: f64 = means.iter().map(|m| m * m).sum();
        let chance: f64 = (means.iter().enumerate())
            .map(|(k, m)| by_chance(w * window + k, *m))
            .sum();
        let share = match power > CLEAR * chance {
            true => 1.0 - chance / power,
            false => 0.0,
        };
        means.iter_mut().for_each(|m| *m *= share);
    }
    mean
}

#[cfg(test)]
mod tests {
    use axis_sim::{Axis, ClosedLoop, Recorder};
    use compensator::NoCompensation;
    use trajectories::{Limits, Program, Step};

    use super::mean_beyond_chance;
    use crate::answers::{LogSet, State};

    /// Norm of the residual torque's means over 40 ms: standstill and reversals, with little of the noise.
    fn slow_residual(set: &LogSet, machine: &Axis) -> f64 {
        let traces = set.simulate(machine, &State::initial(machine)).unwrap();
        let torque = set.channels.iter().position(|c| *c == "torque_ref_n_m");
        let rest = &set.rest(&traces)[0][torque.unwrap()];
        let window = (0.04 / set.logs[0].period) as usize;
        let means = rest.chunks_exact(window);
        let means = means.map(|w| w.iter().sum::<f64>() / window as f64);
        means.map(|m| m * m).sum::<f64>().sqrt()
    }

    /// A scale of 0.1 µm and an encoder of 0.3″ in a loop with tuned gains: where the rack holds, the integrator
    /// stays at what it was when the scale last changed. Without noise every run is the same, and nothing is left.
    #[test]
    fn steps_of_the_sensors_are_no_gap() {
        let file = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../data/axes/tuned/rack.toml"
        );
        let machine = Axis::read(file.as_ref()).unwrap();
        let from = machine.stroke.start;
        let limits = Limits::new(0.3, 3.0, 30.0).unwrap();
        let rest = Step::Dwell { duration: 0.3 };
        let to = |to: f64| Step::Move { to, limits };
        let steps = vec![rest, to(from + 0.1), rest, to(from), rest];
        let program = Program::new(from, steps).unwrap();
        let mut recorder = Recorder::new(&machine);
        ClosedLoop::new(&machine)
            .unwrap()
            .with_seed(77)
            .run(&program, &mut NoCompensation, |c| recorder.push(c))
            .completed()
            .unwrap();
        let log = || vec![("log".to_owned(), recorder.log().unwrap(), machine.period)];
        let without = LogSet::prepared(log(), &machine).unwrap();
        let with = LogSet::new(log(), &machine).unwrap();
        let [without, with] = [without, with].map(|set| slow_residual(&set, &machine));
        println!("{with} of {without}");
        assert!(with < 0.1 * without, "{with} of {without}");
    }

    #[test]
    fn what_chance_explains_is_taken_out_of_a_mean() {
        // Runs that cancel around nothing, then around 1.
        let run = |sign: f64| -> Vec<f64> {
            let around = |i: usize| if i < 50 { 0.0 } else { 1.0 };
            (0..100).map(|i| around(i) + 0.1 * sign).collect()
        };
        let runs: Vec<Vec<f64>> = [1.0, 1.0, 1.0, -1.0].map(run).to_vec();
        let runs: Vec<&[f64]> = runs.iter().map(Vec::as_slice).collect();
        // The mean is off by 0.05, its deviation 0.05: nothing is left of the first half.
        let mean = mean_beyond_chance(&runs, 50);
        assert!(mean[..50].iter().all(|m| m.abs() < 1e-12), "{mean:?}");
        assert!(
            mean[50..].iter().all(|m| (m - 1.05).abs() < 0.01),
            "{mean:?}"
        );
    }
}
