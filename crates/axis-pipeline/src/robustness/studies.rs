//! The rows of the table: what is wrong, under which strategy, and what is asked.

use std::sync::Arc;

use axis_sim::Axis;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::{Draw, Machine, constant_speed, machines, pre_roll, random_program, wrong_model};
use crate::moves::NamedMotion;
use crate::tracking::{PlannedTrajectory, plan_all};
use crate::{ErrorUnit, PipelineError};

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
    /// Greatest error that is left, µm or µrad.
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
    /// Number of draws.
    pub draws: usize,
    /// Makes a draw ready, from its number.
    draw: Box<dyn Fn(usize) -> Result<Draw, PipelineError> + Send + Sync>,
}

impl Study {
    /// Draw `i`, from 0, ready to be made. A draw follows from the seed and its number alone.
    ///
    /// # Errors
    /// [`PipelineError`] if its moves cannot be planned.
    pub fn draw(&self, i: usize) -> Result<Draw, PipelineError> {
        (self.draw)(i)
    }
}

/// How many are drawn in the rows where chance draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Draws {
    /// wrong models; each makes every trajectory.
    pub models: usize,
    /// Random programs.
    pub programs: usize,
}

impl Draws {
    /// Those of the table.
    pub const FULL: Self = Self {
        models: 50,
        programs: 12,
    };
    /// A few, for trying out.
    pub const QUICK: Self = Self {
        models: 2,
        programs: 2,
    };
}

/// Shares by which friction and mass are off.
pub(crate) const WRONG: [f64; 2] = [0.2, 0.1];
/// Ordinary moves from which what no parameter holds is learned.
const ORDINARY: usize = 10;

/// Way of a pre-roll, m or rad.
const PRE_ROLL: f64 = 1e-3;

/// What the rows are made of.
struct Ground {
    axis: Axis,
    machine: Axis,
    motions: Vec<NamedMotion>,
    seed: u64,
    draws: Draws,
}

/// The rows for an axis and what stands for its machine. The model is right or wrong
/// about the machine, not about the axis file.
///
/// # Errors
/// [`PipelineError`] if the axis has no trajectories or no plan can be made of it.
pub fn studies(
    axis: &Axis,
    machine: &Axis,
    seed: u64,
    draws: Draws,
) -> Result<Vec<Study>, PipelineError> {
    let ground = &Arc::new(Ground {
        axis: axis.clone(),
        machine: machine.clone(),
        motions: plan_all(axis)?
            .into_iter()
            .map(PlannedTrajectory::named)
            .collect(),
        seed,
        draws,
    });
    let mut rows = vec![
        ground.right("model right, no noise", "plan", false, [99.9, 99.9]),
        ground.right("assumed right", "feedback", true, [99.85, 99.65]),
        ground.wrong("adaptive", &[80.0, 90.0, 98.9, 99.7], 91.0)?,
        ground.rolled()?,
        ground.wrong("adaptive_feedback", &[96.0, 99.3, 99.8], 98.0)?,
        ground.repeated()?,
        ground.slow(),
        ground.programs()?,
    ];
    for (machine, goal) in machines(machine)
        .into_iter()
        .zip([0.15, 0.6, 0.2, 0.5, 0.3])
    {
        rows.push(ground.another(machine, goal)?);
    }
    Ok(rows)
}

impl Ground {
    fn random(&self, row: u64, draw: usize) -> ChaCha8Rng {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        random.set_stream(1000 * row + draw as u64);
        random
    }

    fn unit(&self) -> ErrorUnit {
        ErrorUnit::of(&self.axis)
    }

    /// A draw whose assumed model is right.
    fn draw(&self, motions: Vec<NamedMotion>, counted: usize) -> Result<Draw, PipelineError> {
        Ok(Draw {
            assumed_model: self.machine.drive_model()?,
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
        self: &Arc<Self>,
        name: &str,
        strategy: &'static str,
        noise: bool,
        [peak, mean]: [f64; 2],
    ) -> Study {
        let ground = Arc::clone(self);
        let goal = Goal::Taken {
            peak,
            mean: Some(mean),
            median: None,
        };
        Study {
            name: name.to_owned(),
            strategy,
            noise,
            moves: vec![("first move", goal)],
            draws: self.motions.len(),
            draw: Box::new(move |i| ground.draw(ground.from(i, 1), 1)),
        }
    }

    fn wrong(
        self: &Arc<Self>,
        strategy: &'static str,
        peaks: &[f64],
        median: f64,
    ) -> Result<Study, PipelineError> {
        const MOVES: [&str; 4] = ["first move", "after 1 move", "after 2", "after 3"];
        let count = peaks.len();
        let truth = self.machine.drive_model()?;
        let ground = Arc::clone(self);
        let draw = move |at: usize| {
            let (i, first) = (at / ground.motions.len(), at % ground.motions.len());
            Ok(Draw {
                assumed_model: wrong_model(&truth, WRONG, &mut ground.random(1, i))?,
                seed: ground.seed.wrapping_add(i as u64),
                ..ground.draw(ground.from(first, count), count)?
            })
        };
        let goals = peaks.iter().enumerate().map(|(i, &peak)| Goal::Taken {
            peak,
            mean: None,
            median: (i == 0).then_some(median),
        });
        Ok(Study {
            name: "assumed wrong".to_owned(),
            strategy,
            noise: true,
            moves: MOVES.into_iter().zip(goals).collect(),
            draws: self.draws.models * self.motions.len(),
            draw: Box::new(draw),
        })
    }

    /// The same models as in [`Ground::wrong`], one trajectory each, after a pre-roll of a
    /// millimetre that is learned from.
    fn rolled(self: &Arc<Self>) -> Result<Study, PipelineError> {
        let truth = self.machine.drive_model()?;
        let ground = Arc::clone(self);
        let draw = move |i: usize| {
            let assumed_model = wrong_model(&truth, WRONG, &mut ground.random(1, i))?;
            let counted = ground.from(i, 1);
            let start = counted[0].motion.at(0.0).position;
            let motions = std::iter::once(pre_roll(start, PRE_ROLL)?).chain(counted);
            Ok(Draw {
                assumed_model,
                seed: ground.seed.wrapping_add(i as u64),
                ..ground.draw(motions.collect(), 1)?
            })
        };
        Ok(Study {
            name: "model wrong, pre-roll".to_owned(),
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
            draws: self.draws.models,
            draw: Box::new(draw),
        })
    }

    /// Friction assumed at 1/0.8 of what it is; each move four times.
    fn repeated(self: &Arc<Self>) -> Result<Study, PipelineError> {
        let mut assumed_model = self.machine.drive_model()?;
        let p = assumed_model.friction.parameters();
        assumed_model.friction = lugre::LuGre::new(lugre::Parameters {
            coulomb: p.coulomb / 0.8,
            stiction: p.stiction / 0.8,
            ..p
        })?;
        let ground = Arc::clone(self);
        let draw = move |i: usize| {
            let draw = ground.draw(vec![ground.motions[i].clone(); 4], 1)?;
            Ok(Draw {
                assumed_model,
                ..draw
            })
        };
        Ok(Study {
            name: "friction × 0.8".to_owned(),
            strategy: "learned",
            noise: true,
            moves: vec![("after 3 repetitions", Goal::Left(0.1))],
            draws: self.motions.len(),
            draw: Box::new(draw),
        })
    }

    fn slow(self: &Arc<Self>) -> Study {
        let ground = Arc::clone(self);
        let draw = move |i: usize| {
            let (start, speed) = (ground.axis.stroke.start, 1e-3 * (i + 1) as f64);
            ground.draw(vec![constant_speed(start, 3.0 * speed, speed)?], 1)
        };
        Study {
            name: format!("constant speed, 1 to 8 {}/s", self.unit().thousand()),
            strategy: "feedback",
            noise: true,
            moves: vec![("first move", Goal::Left(0.1))],
            draws: 8,
            draw: Box::new(draw),
        }
    }

    fn programs(self: &Arc<Self>) -> Result<Study, PipelineError> {
        let truth = self.machine.drive_model()?;
        let within = room(&self.axis);
        let ground = Arc::clone(self);
        let draw = move |i: usize| {
            let random = &mut ground.random(2, i);
            let assumed_model = wrong_model(&truth, WRONG, random)?;
            let mut motions = ground.from(i, 3);
            motions.push(random_program(
                &format!("program {}", i + 1),
                within,
                random,
            )?);
            let draw = ground.draw(motions, 1)?;
            Ok(Draw {
                assumed_model,
                ..draw
            })
        };
        Ok(Study {
            name: "random programs, model wrong".to_owned(),
            strategy: "adaptive_feedback",
            noise: true,
            moves: vec![("after 3 other moves", Goal::Left(0.6))],
            draws: self.draws.programs,
            draw: Box::new(draw),
        })
    }

    fn another(self: &Arc<Self>, machine: Machine, goal: f64) -> Result<Study, PipelineError> {
        let truth = self.machine.drive_model()?;
        let peculiar = machine.axis.effects.len() > 1;
        let (row, strategy) = match peculiar {
            true => (4, "learned"),
            false => (3, "adaptive_feedback"),
        };
        let ground = Arc::clone(self);
        let name = format!("{}, assumed wrong", machine.name);
        let draw = move |i: usize| {
            let random = &mut ground.random(row, i);
            let assumed_model = wrong_model(&truth, WRONG, random)?;
            let mut motions = match peculiar {
                true => (0..ORDINARY)
                    .map(|k| {
                        random_program(&format!("ordinary {}", k + 1), room(&ground.axis), random)
                    })
                    .collect::<Result<_, _>>()?,
                false => ground.from(i + 1, 3),
            };
            motions.extend(ground.from(i, 1));
            let draw = ground.draw(motions, 1)?;
            Ok(Draw {
                assumed_model,
                machine: machine.axis.clone(),
                ..draw
            })
        };
        let moves = match peculiar {
            true => "after 10 other programs",
            false => "after 3 other moves",
        };
        Ok(Study {
            name,
            strategy,
            noise: true,
            moves: vec![(moves, Goal::Left(goal))],
            draws: self.motions.len(),
            draw: Box::new(draw),
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
