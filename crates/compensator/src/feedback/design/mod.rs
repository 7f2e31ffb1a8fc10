//! Design of a [`Feedback`]: linear-quadratic state feedback and Kalman filter at each χ.

mod cut;
mod drive_loops;
mod error;
mod hessenberg;
mod linear;
mod margins;
mod riccati;
mod settings;

use nalgebra::{DMatrix, DVector};
use std::vec::Vec;

use super::gains::{Gains, Node, States};
use super::{Feedback, MOST_MEASURED, MOST_STATES, NODES};
use crate::model::{DriveModel, Mode};
pub use error::DesignError;
pub use hessenberg::SampledResponse;
use linear::stribeck_damping;
pub use linear::{DriveSituation, SampledDrive};
use margins::MarginSearch;
pub use margins::{Margins, Variation};
pub use settings::FeedbackSettings;

/// χ at which gains are held: friction changes fastest where few bristles stick.
const STICKING: [f64; NODES] = [0.0, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0];

/// Steps of bandwidth that are tried, and in each factors of how much the force wanders, of
/// how uncertain the command is, and of how far friction is reckoned to feed vibrations.
const SOFTENINGS: usize = 11;
const TRIED: [[f64; 3]; 12] = [
    [1.0, 1.0, 1.0],
    [1.0, 4.0, 1.0],
    [1.0, 16.0, 1.0],
    [1.0, 1.0, 0.5],
    [0.1, 1.0, 1.0],
    [0.1, 4.0, 1.0],
    [0.1, 16.0, 1.0],
    [0.1, 1.0, 0.5],
    [0.1, 1.0, 0.25],
    [0.1, 1.0, 0.0],
    [0.01, 1.0, 0.0],
    [0.01, 4.0, 1.0],
];

/// One more attempt, for axes that none of those suits.
struct SlowTry {
    /// Factors of how much the force wanders, of how uncertain the command is, and of the noise of
    /// position and speed.
    wandering: f64,
    command: f64,
    noise: f64,
    /// Share of the bristles' stiffness and damping that is relied on.
    bristles: f64,
}

/// Bandwidths of these, in halves.
const SLOW_HALVINGS: usize = 12;

/// An observer that follows slowly where a resonance lies in the loop (noise), and one that relies
/// on the drive's own measurements (command) where the loop is slow against its delays.
const SLOW_TRIED: [SlowTry; 4] = [
    SlowTry {
        wandering: 0.01,
        command: 64.0,
        noise: 1.0,
        bristles: 1.0,
    },
    SlowTry {
        wandering: 0.01,
        command: 64.0,
        noise: 1.0,
        bristles: 0.5,
    },
    SlowTry {
        wandering: 0.01,
        command: 1.0,
        noise: 30.0,
        bristles: 0.1,
    },
    SlowTry {
        wandering: 0.01,
        command: 1.0,
        noise: 30.0,
        bristles: 0.5,
    },
];

/// The settings that are tried, one after the other.
fn softer_ones(settings: &FeedbackSettings) -> impl Iterator<Item = FeedbackSettings> {
    let bandwidth = |step: usize| (0..step).fold(1.0, |b, _| b * std::f64::consts::FRAC_1_SQRT_2);
    let quick = (0..SOFTENINGS).flat_map(move |step| {
        TRIED.iter().map(move |&[wandering, command, stribeck]| {
            let mut softer = settings.softened(bandwidth(step), wandering, command);
            softer.stribeck *= stribeck;
            softer
        })
    });
    let slow = (0..SLOW_HALVINGS).flat_map(move |halving| {
        SLOW_TRIED.iter().map(move |tried| {
            let softer = settings.softened(bandwidth(2 * halving), tried.wandering, tried.command);
            FeedbackSettings {
                position: tried.noise * softer.position,
                speed: tried.noise * softer.speed,
                bristles: tried.bristles,
                ..softer
            }
        })
    });
    quick.chain(slow)
}

/// Gains at one χ.
#[derive(Clone, Debug)]
struct Design {
    linear: SampledDrive,
    /// State feedback, the disturbance's cancellation last; u and states in their own units.
    k: DVector<f64>,
    l: DMatrix<f64>,
    /// Deviation of each innovation, SI: the root of the diagonal of C P Cᵀ + R.
    expected: DVector<f64>,
}

/// A feedback, designed and checked, with all that its margins are computed from.
#[derive(Clone, Debug)]
pub struct FeedbackDesign {
    model: DriveModel,
    modes: Vec<Mode>,
    settings: FeedbackSettings,
    /// Damping of slow sliding, N·s/m at the load.
    stribeck: f64,
    designs: Vec<Design>,
    residual: f64,
}

impl FeedbackDesign {
    /// For the axis `model`, whose natural modes, the rigid motion first, are `modes` with the
    /// load where its gains are to be made for: mid-stroke. The first
    /// [`FeedbackSettings::modes`] of them count.
    ///
    /// # Errors
    /// [`DesignError`] says what cannot be carried: no speed loop that could be replaced, or one
    /// that runs at a rate of its own, a position that is not the measured one, too many states, a Riccati equation without solution, margins that are not met.
    pub fn new(
        model: &DriveModel,
        modes: &[Mode],
        settings: &FeedbackSettings,
    ) -> Result<Self, DesignError> {
        let designed = Self::unchecked(model, modes, settings)?;
        designed.require_margins(&[], &mut MarginSearch::default())?;
        Ok(designed)
    }

    /// The quickest feedback whose margins hold with the load anywhere: weights go down from
    /// those of `settings` in steps of √2 in bandwidth, down to a thirty-second of it, and in each
    /// the force is taken to wander less and the command as less certain, until the margins
    /// are there. What none of these suits gets a slower one, with an observer of its own (down
    /// to 1/2048 of the bandwidth). `elsewhere` has
    /// the modes at other positions.
    ///
    /// # Errors
    /// As [`FeedbackDesign::new`]; where no weights do, what the nearest of them fall short of.
    pub fn within_margins(
        model: &DriveModel,
        modes: &[Mode],
        elsewhere: &[&[Mode]],
        settings: &FeedbackSettings,
    ) -> Result<Self, DesignError> {
        let mut search = MarginSearch::default();
        let mut nearest: Option<DesignError> = None;
        for softer in softer_ones(settings) {
            let designed = match Self::unchecked(model, modes, &softer) {
                Ok(designed) => designed,
                // Weights so far apart that an equation is not solved are no answer.
                Err(DesignError::Riccati { .. }) if nearest.is_some() => continue,
                Err(error) => return Err(error),
            };
            match designed.require_margins(elsewhere, &mut search) {
                Ok(()) => return Ok(designed),
                Err(error) if nearest.as_ref().is_none_or(|n| error.excess() < n.excess()) => {
                    nearest = Some(error);
                }
                Err(_) => {}
            }
        }
        Err(nearest.unwrap_or(DesignError::Modes("there is none")))
    }

    /// What it was designed with.
    pub fn settings(&self) -> &FeedbackSettings {
        &self.settings
    }

    /// Without a look at the margins.
    fn unchecked(
        model: &DriveModel,
        modes: &[Mode],
        settings: &FeedbackSettings,
    ) -> Result<Self, DesignError> {
        model.check()?;
        settings.check(model)?;
        let c = &model.cascade;
        if c.position <= 0.0 {
            return Err(DesignError::Control(
                "it has no speed controller whose set point an offset of the position sets",
            ));
        }
        if c.speed <= 0.0 {
            return Err(DesignError::Control("its speed controller has no gain"));
        }
        drive_loops::check(&c.signal_path)?;
        let modes = settings.used(modes)?;
        let stribeck = stribeck_damping(model, &modes);
        let mut designed = Self {
            model: *model,
            modes,
            settings: *settings,
            stribeck,
            designs: Vec::new(),
            residual: 0.0,
        };
        for sticking in STICKING {
            let (design, residual) = designed.design(sticking)?;
            designed.designs.push(design);
            designed.residual = designed.residual.max(residual);
        }
        Ok(designed)
    }

    /// The feedback, at the start of a motion.
    pub fn feedback(&self) -> Feedback {
        let mut nodes = [Node::ZERO; NODES];
        for (node, design) in nodes.iter_mut().zip(&self.designs) {
            for (to, from) in node.a.iter_mut().zip(design.linear.a.column_iter()) {
                *to = states(from.iter());
            }
            node.b = states(design.linear.b.iter());
            for (to, from) in node.l.iter_mut().zip(design.l.column_iter()) {
                *to = states(from.iter());
            }
            node.k = states(design.k.iter());
            for (to, from) in node.expected.iter_mut().zip(design.expected.iter()) {
                *to = *from;
            }
        }
        let linear = &self.designs[0].linear;
        let mut c = [[0.0; MOST_STATES]; MOST_MEASURED];
        for (to, from) in c.iter_mut().zip(linear.c.row_iter()) {
            *to = states(from.iter());
        }
        Feedback::new(Gains {
            states: linear.size(),
            measured: linear.c.nrows(),
            sticking: STICKING,
            nodes,
            c,
            load: [&linear.load, &linear.load_speed].map(|row| states(row.iter())),
            force: linear.units[linear.size() - 1],
            limit: self.model.effort_limit,
            travel: self.model.travel,
            differences: self.settings.speed_by_differences,
            cascade: self.model.cascade,
        })
    }

    /// Greatest relative residual of the Riccati equations that were solved.
    pub fn residual(&self) -> f64 {
        self.residual
    }

    fn design(&self, sticking: f64) -> Result<(Design, f64), DesignError> {
        let (model, settings) = (&self.model, &self.settings);
        let situation = DriveSituation {
            sticking,
            mass: 1.0,
            friction: 1.0,
            bristles: settings.bristles,
            sliding: settings.stribeck * self.stribeck,
        };
        let linear = SampledDrive::new(
            model,
            &self.modes,
            settings.speed_by_differences,
            &situation,
        )
        .fits()?;
        let n = linear.size() - 1;
        let riccati = |what| {
            move |residual| DesignError::Riccati {
                what,
                sticking,
                residual,
            }
        };

        // State feedback: all but the disturbance, which no command moves.
        let (a, b) = (
            linear.a.view((0, 0), (n, n)).into_owned(),
            linear.b.rows(0, n),
        );
        let [position, speed] = settings.weights(model);
        let weigh = |row: &nalgebra::RowDVector<f64>, weight: f64| {
            let row = row.columns(0, n) * weight;
            row.transpose() * row
        };
        let q = weigh(&linear.weighed[0], position) + weigh(&linear.weighed[1], speed);
        let (p, first) =
            riccati::solve(&a, &(b * b.transpose()), &q).map_err(riccati("state feedback"))?;
        let pb = &p * b;
        let k = a.transpose() * &pb / (1.0 + b.dot(&pb));

        let cancelled = cancelled(&linear, &k, sticking)?;
        let k = k.push(cancelled);

        // Observer: the disturbance wanders, the command is uncertain.
        let noise = settings.noise(model, &self.modes[0]);
        let force = noise.force / linear.units[n];
        let mut w = &linear.b * linear.b.transpose() * (noise.command * noise.command);
        w[(n, n)] += force * force;
        let sigmas = [noise.position, noise.speed, noise.current];
        // Per deviation of the sensors, so that all of them weigh alike.
        let c = DMatrix::from_fn(linear.c.nrows(), n + 1, |i, j| linear.c[(i, j)] / sigmas[i]);
        let (p, second) = riccati::solve(&linear.a.transpose(), &(c.transpose() * &c), &w)
            .map_err(riccati("observer"))?;
        let pc = &p * c.transpose();
        let s = DMatrix::identity(c.nrows(), c.nrows()) + &c * &pc;
        let expected = DVector::from_fn(c.nrows(), |i, _| sigmas[i] * s[(i, i)].sqrt());
        let gain = s
            .lu()
            .solve(&pc.transpose())
            .ok_or(DesignError::Riccati {
                what: "observer",
                sticking,
                residual: f64::NAN,
            })?
            .transpose();
        let l = DMatrix::from_fn(n + 1, c.nrows(), |i, j| gain[(i, j)] / sigmas[j]);
        let design = Design {
            linear,
            k,
            l,
            expected,
        };
        Ok((design, first.max(second)))
    }
}

/// The command that cancels a constant unit force, `u = −K (x̂ − N_x d̂) + N_u d̂`: where the load stands still
/// under it.
fn cancelled(linear: &SampledDrive, k: &DVector<f64>, sticking: f64) -> Result<f64, DesignError> {
    let n = linear.size() - 1;
    let (a, b) = (
        linear.a.view((0, 0), (n, n)).into_owned(),
        linear.b.rows(0, n),
    );
    let mut steady = DMatrix::zeros(n + 1, n + 1);
    steady
        .view_mut((0, 0), (n, n))
        .copy_from(&(&a - DMatrix::identity(n, n)));
    steady.view_mut((0, n), (n, 1)).copy_from(&b);
    steady
        .view_mut((n, 0), (1, n))
        .copy_from(&linear.load.columns(0, n));
    let mut acting = DVector::zeros(n + 1);
    acting
        .rows_mut(0, n)
        .copy_from(&-linear.a.view((0, n), (n, 1)));
    let steady = steady
        .lu()
        .solve(&acting)
        .filter(|s| s.iter().all(|x| x.is_finite()))
        .ok_or(DesignError::SteadyState { sticking })?;
    Ok(-(k.dot(&steady.rows(0, n)) + steady[n]))
}

fn states<'a>(from: impl Iterator<Item = &'a f64>) -> States<f64> {
    let mut to = [0.0; MOST_STATES];
    to.iter_mut().zip(from).for_each(|(to, &from)| *to = from);
    to
}
