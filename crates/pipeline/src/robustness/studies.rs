//! The rows of the table: what is wrong, under which strategy, and what is asked.

use axis_sim::Axis;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::{Draw, Machine, constant_speed, machines, pre_roll, random_program, wrong_belief};
use crate::PipelineError;
use crate::moves::NamedMotion;
use crate::tracking::{Planned, plan_all};

/// What is asked of a counted move, in the worst of all draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// Shares that are taken away at least, %: of the peak, and of the mean, where one is
    /// asked; and of the peak in the median of all draws.
    Taken {
        /// Of the peak, worst draw.
        peak: f64,
        /// Of the mean, worst draw.
        mean: Option<f64>,
        /// Of the peak, median draw.
        median: Option<f64>,
    },
    /// Greatest error that is left, µm.
    Left(f64),
}

/// A row: draws of one kind under one strategy.
pub struct Study {
    /// What is wrong or asked, in words.
    pub name: String,
    /// Name of the strategy.
    pub strategy: &'static str,
    /// Whether the sensors are noisy.
    pub noise: bool,
    /// Counted moves: in words, and what is asked.
    pub moves: Vec<(&'static str, Goal)>,
    /// The draws.
    pub draws: Vec<Draw>,
}

/// Shares by which friction and mass are off.
pub(crate) const WRONG: [f64; 2] = [0.2, 0.1];
/// Ordinary moves from which what no parameter holds is learned.
const ORDINARY: usize = 10;

/// Way of a pre-roll, m.
const PRE_ROLL: f64 = 1e-3;

/// What the rows are made of.
struct Ground<'a> {
    axis: &'a Axis,
    machine: &'a Axis,
    motions: Vec<NamedMotion>,
    seed: u64,
    draws: usize,
}

/// The rows for an axis and what stands for its machine; `quick` makes fewer draws. What
/// is believed is right or wrong about the machine, not about the axis file.
///
/// # Errors
/// [`PipelineError`] where the axis has no trajectories or no plan can be made of it.
pub fn studies(
    axis: &Axis,
    machine: &Axis,
    seed: u64,
    quick: bool,
) -> Result<Vec<Study>, PipelineError> {
    let ground = Ground {
        axis,
        machine,
        motions: plan_all(axis)?.into_iter().map(Planned::named).collect(),
        seed,
        draws: if quick { 2 } else { 50 },
    };
    let mut rows = vec![
        ground.right("belief right, no noise", "plan", false, [99.9, 99.9])?,
        ground.right("belief right", "feedback", true, [99.85, 99.65])?,
        ground.wrong("adaptive", &[80.0, 90.0, 98.9, 99.7], 91.0)?,
        ground.rolled()?,
        ground.wrong("adaptive_feedback", &[96.0, 99.3, 99.8], 98.0)?,
        ground.repeated()?,
        ground.slow()?,
        ground.programs(quick)?,
    ];
    for (machine, goal) in machines(machine)
        .into_iter()
        .zip([0.15, 0.6, 0.2, 0.5, 0.3])
    {
        rows.push(ground.another(&machine, goal)?);
    }
    Ok(rows)
}

impl Ground<'_> {
    fn random(&self, row: u64, draw: usize) -> ChaCha8Rng {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(1000 * row + draw as u64);
        random
    }

    /// A draw whose belief is right.
    fn draw(&self, motions: Vec<NamedMotion>, counted: usize) -> Result<Draw, PipelineError> {
        Ok(Draw {
            believed: self.machine.drive_model()?,
            machine: self.machine.clone(),
            motions,
            counted,
            seed: self.seed,
        })
    }

    /// Each trajectory after those before it, `count` of them in all.
    fn from(&self, first: usize, count: usize) -> Vec<NamedMotion> {
        let all = self.motions.iter().cycle();
        all.skip(first).take(count).cloned().collect()
    }

    fn right(
        &self,
        name: &str,
        strategy: &'static str,
        noise: bool,
        [peak, mean]: [f64; 2],
    ) -> Result<Study, PipelineError> {
        let draws = (0..self.motions.len()).map(|i| self.draw(self.from(i, 1), 1));
        let goal = Goal::Taken {
            peak,
            mean: Some(mean),
            median: None,
        };
        Ok(Study {
            name: name.to_owned(),
            strategy,
            noise,
            moves: vec![("first move", goal)],
            draws: draws.collect::<Result<_, _>>()?,
        })
    }

    fn wrong(
        &self,
        strategy: &'static str,
        peaks: &[f64],
        median: f64,
    ) -> Result<Study, PipelineError> {
        const MOVES: [&str; 4] = ["first move", "after 1 move", "after 2", "after 3"];
        let count = peaks.len();
        let truth = self.machine.drive_model()?;
        let mut draws = Vec::new();
        for i in 0..self.draws {
            let believed = wrong_belief(&truth, WRONG, &mut self.random(1, i))?;
            for first in 0..self.motions.len() {
                draws.push(Draw {
                    believed,
                    seed: self.seed + i as u64,
                    ..self.draw(self.from(first, count), count)?
                });
            }
        }
        let goals = peaks.iter().enumerate().map(|(i, &peak)| Goal::Taken {
            peak,
            mean: None,
            median: (i == 0).then_some(median),
        });
        Ok(Study {
            name: "belief wrong".to_owned(),
            strategy,
            noise: true,
            moves: MOVES.into_iter().zip(goals).collect(),
            draws,
        })
    }

    /// The same beliefs as in [`Ground::wrong`], one trajectory each, after a pre-roll of a
    /// millimetre that is learned from.
    fn rolled(&self) -> Result<Study, PipelineError> {
        let truth = self.machine.drive_model()?;
        let draw = |i: usize| {
            let believed = wrong_belief(&truth, WRONG, &mut self.random(1, i))?;
            let counted = self.from(i, 1);
            let start = counted[0].motion.at(0.0).position;
            let motions = std::iter::once(pre_roll(start, PRE_ROLL)?).chain(counted);
            Ok(Draw {
                believed,
                seed: self.seed + i as u64,
                ..self.draw(motions.collect(), 1)?
            })
        };
        Ok(Study {
            name: "belief wrong, pre-roll".to_owned(),
            strategy: "adaptive",
            noise: true,
            moves: vec![(
                "first move",
                Goal::Taken {
                    peak: 80.0,
                    mean: None,
                    median: Some(91.0),
                },
            )],
            draws: (0..self.draws)
                .map(draw)
                .collect::<Result<_, PipelineError>>()?,
        })
    }

    /// Friction believed at 1/0.8 of what it is; each move four times.
    fn repeated(&self) -> Result<Study, PipelineError> {
        let mut believed = self.machine.drive_model()?;
        let p = believed.friction.parameters();
        believed.friction = lugre::LuGre::new(lugre::Parameters {
            coulomb: p.coulomb / 0.8,
            stiction: p.stiction / 0.8,
            ..p
        })?;
        let draws = self.motions.iter().map(|motion| {
            let draw = self.draw(vec![motion.clone(); 4], 1)?;
            Ok(Draw { believed, ..draw })
        });
        Ok(Study {
            name: "friction × 0.8".to_owned(),
            strategy: "learned",
            noise: true,
            moves: vec![("after 3 repetitions", Goal::Left(0.1))],
            draws: draws.collect::<Result<_, PipelineError>>()?,
        })
    }

    fn slow(&self) -> Result<Study, PipelineError> {
        let start = self.axis.stroke.start;
        let draws = (1..=8).map(|speed| {
            let speed = 1e-3 * f64::from(speed);
            self.draw(vec![constant_speed(start, 3.0 * speed, speed)?], 1)
        });
        Ok(Study {
            name: "constant speed, 1 to 8 mm/s".to_owned(),
            strategy: "feedback",
            noise: true,
            moves: vec![("first move", Goal::Left(0.1))],
            draws: draws.collect::<Result<_, PipelineError>>()?,
        })
    }

    fn programs(&self, quick: bool) -> Result<Study, PipelineError> {
        let truth = self.machine.drive_model()?;
        let within = room(self.axis);
        let draw = |i| {
            let random = &mut self.random(2, i);
            let believed = wrong_belief(&truth, WRONG, random)?;
            let mut motions = self.from(i, 3);
            motions.push(random_program(
                &format!("program {}", i + 1),
                within,
                random,
            )?);
            let draw = self.draw(motions, 1)?;
            Ok(Draw { believed, ..draw })
        };
        let count = if quick { 2 } else { 12 };
        Ok(Study {
            name: "random programs, belief wrong".to_owned(),
            strategy: "adaptive_feedback",
            noise: true,
            moves: vec![("after 3 other moves", Goal::Left(0.6))],
            draws: (0..count).map(draw).collect::<Result<_, PipelineError>>()?,
        })
    }

    fn another(&self, machine: &Machine, goal: f64) -> Result<Study, PipelineError> {
        let truth = self.machine.drive_model()?;
        let peculiar = machine.axis.effects.len() > 1;
        let (row, strategy) = match peculiar {
            true => (4, "learned"),
            false => (3, "adaptive_feedback"),
        };
        let mut draws = Vec::new();
        for i in 0..self.motions.len() {
            let random = &mut self.random(row, i);
            let believed = wrong_belief(&truth, WRONG, random)?;
            let mut motions = match peculiar {
                true => (0..ORDINARY)
                    .map(|k| {
                        random_program(&format!("ordinary {}", k + 1), room(self.axis), random)
                    })
                    .collect::<Result<_, _>>()?,
                false => self.from(i + 1, 3),
            };
            motions.extend(self.from(i, 1));
            let draw = self.draw(motions, 1)?;
            draws.push(Draw {
                believed,
                machine: machine.axis.clone(),
                ..draw
            });
        }
        let moves = match peculiar {
            true => "after 10 other programs",
            false => "after 3 other moves",
        };
        Ok(Study {
            name: format!("{}, belief wrong", machine.name),
            strategy,
            noise: true,
            moves: vec![(moves, Goal::Left(goal))],
            draws,
        })
    }
}

/// Where moves go: around the middle of the stroke.
#[must_use]
pub fn room(axis: &Axis) -> [f64; 2] {
    let stroke = &axis.stroke;
    let length = stroke.maximum - stroke.minimum;
    [stroke.minimum + 0.3 * length, stroke.minimum + 0.7 * length]
}
