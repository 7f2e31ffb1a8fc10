//! The run of a machine along a path, all drives in lockstep.

use std::sync::Arc;

use axis_sim::{Cycle, LoopState, MOST_STEPS, Measured, RunStopped, Start, Stop, StopReason};
use compensator::{Compensator, Correction, HomedAt, Sample};
use trajectories::{Motion, Setpoint};

use crate::base::BaseState;
use crate::error::{MOST_SAMPLES, MachineError};
use crate::machine::{CoupledMachine, MachineDrive};
use crate::motion::{AxisMotion, HALF_WINDOW};
use crate::traced::Traced;

/// What corrects a drive, and what its sensors make of what they see.
pub struct DriveLaw<'a> {
    /// The corrections.
    pub compensator: &'a mut dyn Compensator,
    /// Makes of what the axis' sensors read what the drive gets to read, as [`axis_sim::ClosedLoop::run_sensed`] takes it.
    pub sense: &'a mut dyn FnMut(&mut Measured),
}

/// A machine between two runs.
#[derive(Clone, Debug)]
pub struct MachineState {
    pub(crate) loops: Vec<LoopState>,
    bases: Vec<BaseState>,
}

/// One run along a path.
#[derive(Clone, Debug)]
pub struct Lap<const D: usize> {
    /// Where the tool was.
    pub traced: Traced<D>,
    /// What each drive's controller saw in each of its cycles.
    pub records: Vec<Vec<Sample>>,
    /// Displacement of each axis' base at the instants of the positions, m; empty without one.
    pub bases: Vec<Vec<f64>>,
    /// What each compensator added last, and how the drive was homed.
    pub(crate) left: Vec<(Correction, HomedAt)>,
}

/// A drive on its way.
struct Going<'a, const D: usize> {
    motion: &'a AxisMotion<D>,
    reference: Setpoint,
    cycles: u64,
    done: u64,
    record: Vec<Sample>,
    last: Correction,
    columns: [Vec<f64>; 2],
}

impl<const D: usize> CoupledMachine<D> {
    /// The machine at standstill, settled where each motion begins.
    ///
    /// # Errors
    /// [`MachineError::Setup`] if a load cannot be there.
    pub fn start(&self, motions: &[Arc<AxisMotion<D>>]) -> Result<MachineState, MachineError> {
        self.one_each(motions.len())?;
        let start = |(drive, motion): (&MachineDrive, &Arc<AxisMotion<D>>)| {
            let begin = Start::at(motion.at(0.0).position);
            let started = drive.closed_loop.start(&begin);
            started.map_err(|source| MachineError::Setup {
                axis: drive.axis + 1,
                source,
            })
        };
        let loops = self.drives().iter().zip(motions).map(start);
        Ok(MachineState::settled::<D>(loops.collect::<Result<_, _>>()?))
    }

    /// Runs all drives along their motions ([`CoupledMachine::motions`]) from `state`, which is left as the machine is at the end.
    /// Positions of the tool are taken where all drives have an instant in common: at the control periods of the slowest, if
    /// those of the others are whole parts of it.
    ///
    /// Forces between drives (base, beam) are those in the middle of each of these periods, and held for it. The acceleration
    /// that cross-talk acts by is the mean over 5 ms to both sides: a structure that gives way by k a does so below its own modes
    /// alone, and is not moved by what noise makes of a at some 100 Hz.
    ///
    /// # Errors
    /// [`MachineError`] if a drive stops on its way, for a motion that is too long, or not one law for each drive.
    pub fn run(
        &self,
        motions: &[Arc<AxisMotion<D>>],
        laws: &mut [DriveLaw<'_>],
        state: &mut MachineState,
    ) -> Result<Lap<D>, MachineError> {
        self.one_each(motions.len())?;
        self.one_each(laws.len())?;
        self.one_each(state.loops.len())?;
        let Some(first) = motions.first() else {
            return Err(MachineError::Laws { laws: 0, drives: 0 });
        };
        let (duration, samples) = (first.duration(), first.duration() / self.period);
        if samples > MOST_SAMPLES {
            return Err(MachineError::TooLong { duration, samples });
        }
        let mut going = Vec::new();
        for (d, motion) in motions.iter().enumerate() {
            going.push(self.begin(d, motion)?);
            laws[d].compensator.reset();
        }
        let mut bases: Vec<Vec<f64>> = vec![Vec::new(); D];
        while going.iter().any(|g| g.done < g.cycles) {
            for (axis, column) in bases.iter_mut().enumerate() {
                if self.bases[axis].is_some() {
                    column.push(state.bases[axis].displacement);
                }
            }
            let before = self.speeds(state);
            let forces = self.forces(state);
            for (own, force) in state.loops.iter_mut().zip(forces) {
                force
                    .into_iter()
                    .for_each(|force| own.set_outer_load(force));
            }
            for (d, drive) in going.iter_mut().enumerate() {
                self.go(d, drive, &mut laws[d], &mut state.loops[d])?;
            }
            self.move_bases(state, &before, self.period);
        }
        Ok(self.lap(first, going, bases))
    }

    fn one_each(&self, laws: usize) -> Result<(), MachineError> {
        let drives = self.drives().len();
        match laws == drives {
            true => Ok(()),
            false => Err(MachineError::Laws { laws, drives }),
        }
    }

    fn begin<'a>(&self, d: usize, motion: &'a AxisMotion<D>) -> Result<Going<'a, D>, MachineError> {
        let drive = &self.drives()[d];
        let reference = motion.at(0.0);
        let steps = drive.closed_loop.steps(motion);
        if steps > MOST_STEPS {
            let at = Stop {
                position: reference.position,
                ..Stop::default()
            };
            let (time, reason) = (0.0, StopReason::TooLong(steps));
            return Err(MachineError::Stopped {
                axis: drive.axis + 1,
                why: RunStopped { time, reason, at },
            });
        }
        Ok(Going {
            motion,
            reference,
            cycles: drive.closed_loop.cycles(motion),
            done: 0,
            record: Vec::new(),
            last: Correction::default(),
            columns: [Vec::new(), Vec::new()],
        })
    }

    /// Moves the bases by a time (s) in which the speeds of the loads were `before` (m/s) at first.
    pub(crate) fn move_bases(&self, state: &mut MachineState, before: &[f64; D], time: f64) {
        let after = self.speeds(state);
        for (axis, base) in self.bases.iter().enumerate() {
            if let Some(base) = base {
                let acceleration = (after[axis] - before[axis]) / time;
                state.bases[axis] = base.advanced(&state.bases[axis], acceleration, time);
            }
        }
    }

    /// By how much each base moves the tool, m.
    pub(crate) fn bases_at_tool(&self, state: &MachineState) -> [f64; D] {
        std::array::from_fn(|axis| {
            let base = self.bases[axis];
            base.map_or(0.0, |base| base.at_tool * state.bases[axis].displacement)
        })
    }

    /// Speed of each coordinate's load, of a beam that of its tool, m/s.
    pub(crate) fn speeds(&self, state: &MachineState) -> [f64; D] {
        self.of_coordinates(|d| state.loops[d].plant().seen().speed)
    }

    /// Of each coordinate: the value of its drive, or that between the drives of a beam.
    pub(crate) fn of_coordinates(&self, value: impl Fn(usize) -> f64) -> [f64; D] {
        let mut all = [0.0; D];
        for (d, drive) in self.drives().iter().enumerate() {
            let second = d > 0 && self.drives()[d - 1].axis == drive.axis;
            let own = &mut all[drive.axis];
            *own = match (second, &self.beams[drive.axis]) {
                (true, Some(beam)) => (1.0 - beam.tool) * *own + beam.tool * value(d),
                _ => value(d),
            };
        }
        all
    }

    /// The force on each drive's load by base and beam in the coming period, N; none if there is neither.
    pub(crate) fn forces(&self, state: &MachineState) -> Vec<Option<f64>> {
        let one = |(d, drive): (usize, &MachineDrive)| {
            let base = self.bases[drive.axis];
            let beam = self.beams[drive.axis];
            if base.is_none() && beam.is_none() {
                return None;
            }
            let mut force = base.map_or(0.0, |base| {
                drive.mass() * base.acceleration_ahead(&state.bases[drive.axis], self.period)
            });
            if let Some(beam) = beam {
                let first = match d > 0 && self.drives()[d - 1].axis == drive.axis {
                    true => d - 1,
                    false => d,
                };
                let seen = [first, first + 1].map(|d| *state.loops[d].plant().seen());
                // Two ends that begin at different positions of their scales are not askew.
                let begun =
                    [first, first + 1].map(|d| self.drives()[d].closed_loop.axis().stroke.start);
                let positions = [0, 1].map(|end| seen[end].position - begun[end]);
                let on_first = beam.force(positions, seen.map(|s| s.speed), self.period);
                force += if d == first { on_first } else { -on_first };
            }
            Some(force)
        };
        self.drives().iter().enumerate().map(one).collect()
    }

    /// From one common instant to the next.
    fn go(
        &self,
        d: usize,
        going: &mut Going<'_, D>,
        law: &mut DriveLaw<'_>,
        state: &mut LoopState,
    ) -> Result<(), MachineError> {
        let drive = &self.drives()[d];
        let period = drive.closed_loop.axis().period;
        let seen = state.plant().seen();
        going.columns[0].push(seen.position - going.motion.zero());
        going.columns[1].push(seen.speed);
        let mut recording = Recording {
            inner: &mut *law.compensator,
            record: &mut going.record,
            last: &mut going.last,
        };
        for _ in 0..drive.parts {
            if going.done == going.cycles {
                break;
            }
            let next = going.motion.at((going.done + 1) as f64 * period);
            let references = [&going.reference, &next];
            let stepped: Result<Cycle, RunStopped> =
                drive
                    .closed_loop
                    .step(state, references, &mut recording, &mut *law.sense);
            stepped.map_err(|why| MachineError::Stopped {
                axis: drive.axis + 1,
                why,
            })?;
            going.reference = next;
            going.done += 1;
        }
        Ok(())
    }

    /// What became of it.
    fn lap(&self, first: &AxisMotion<D>, going: Vec<Going<'_, D>>, bases: Vec<Vec<f64>>) -> Lap<D> {
        let count = going.iter().map(|g| g.columns[0].len()).min().unwrap_or(0);
        let zeros: [f64; D] = std::array::from_fn(|axis| {
            let of = self.drives().iter().position(|drive| drive.axis == axis);
            of.map_or(0.0, |d| going[d].motion.zero())
        });
        let beside = ((HALF_WINDOW / self.period).round() as usize).max(1);
        let tool = |k: usize| -> [f64; D] {
            let positions = self.of_coordinates(|d| going[d].columns[0][k]);
            // Central difference, one-sided at the ends.
            let (from, to) = (k.saturating_sub(beside), (k + beside).min(count - 1));
            let over = (to - from).max(1) as f64 * self.period;
            let accelerations = self.of_coordinates(|d| {
                let speeds = &going[d].columns[1];
                (speeds[to] - speeds[from]) / over
            });
            let shift = self.coupling.shift(&positions, &zeros, &accelerations);
            std::array::from_fn(|axis| {
                let base = self.bases[axis].map_or(0.0, |base| base.at_tool * bases[axis][k]);
                positions[axis] + shift[axis] + base
            })
        };
        let positions = (0..count).map(tool).collect();
        let traced = Traced::new(first.profile().clone(), self.period, positions);
        let left = |g: &Going<'_, D>| {
            let here = g
                .record
                .first()
                .map_or_else(HomedAt::default, |sample| HomedAt {
                    position: sample.reference.position,
                    effort: sample.last_command,
                });
            (g.last, here)
        };
        Lap {
            traced: traced.delayed(first.delay()),
            left: going.iter().map(left).collect(),
            records: going.into_iter().map(|g| g.record).collect(),
            bases,
        }
    }
}

impl MachineState {
    /// Loops that have settled, on bases at standstill.
    pub(crate) fn settled<const D: usize>(loops: Vec<LoopState>) -> Self {
        let bases = vec![BaseState::default(); D];
        Self { loops, bases }
    }

    /// The same state at time 0, for the next run.
    pub(crate) fn at_rest(self) -> Self {
        Self {
            loops: self.loops.into_iter().map(LoopState::at_rest).collect(),
            bases: self.bases,
        }
    }
}

/// A compensator whose samples are kept: what a controller logs.
struct Recording<'a> {
    inner: &'a mut dyn Compensator,
    record: &'a mut Vec<Sample>,
    last: &'a mut Correction,
}

impl Compensator for Recording<'_> {
    fn reset(&mut self) {
        self.inner.reset();
    }

    fn correct(&mut self, sample: &Sample) -> Correction {
        self.record.push(*sample);
        *self.last = self.inner.correct(sample);
        *self.last
    }

    fn surprise(&self) -> f64 {
        self.inner.surprise()
    }
}
