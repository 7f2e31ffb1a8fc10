//! Structures fitted, and the best of them.

use axis_log::Log;
use axis_sim::{Axis, Replay};

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::equation::Equation;
use super::law::Law;
use super::own::BETTER;
use super::seen::Seen;
use super::solve::Solved;
use super::start::start;
use super::structure::{Structure, structures};

/// A structure, fitted.
pub struct Fitted {
    pub structure: Structure,
    pub law: Law,
    /// By least squares.
    squares: Solved,
    /// By instruments, where it was tried and these are strong enough.
    instrumented: Option<Solved>,
    /// Share of the check logs' command that it leaves.
    pub left: f64,
}

impl Fitted {
    /// By what structures are compared: each value more must leave a hundredth less.
    fn score(&self) -> f64 {
        self.left * 1.01f64.powi(self.law.free.len() as i32)
    }

    /// For people: the structure, and which of the two minima of a cascade it is at.
    pub fn name(&self, travel: f64) -> String {
        let name = self.structure.name();
        let corner = Structure::corner(&self.law, &self.squares.at);
        let control = self.law.control(&self.squares.at).ok();
        match control.and_then(|control| control.velocity_gain(travel)) {
            Some(_) if corner <= 0.0 => name,
            Some(kv) if kv < corner => name + ", Kv below 1/T_i",
            Some(_) => name + ", Kv above 1/T_i",
            None => name,
        }
    }

    /// Whether both ended at one minimum.
    fn is_at(&self, other: &Self) -> bool {
        let (here, there) = (&self.squares.at, &other.squares.at);
        let pairs = here.iter().zip(there).zip(&self.law.free);
        let mut apart = pairs.map(|((a, b), free)| ((a - b) / free.scale).abs());
        self.law.kind.name == other.law.kind.name && apart.all(|by| by < 1e-3)
    }

    /// Fits it again behind the high pass, and by instruments too.
    fn instrument(
        &mut self,
        fit: &Equation<'_>,
        check: &Equation<'_>,
        logs: &[(String, Log, f64)],
    ) {
        self.law.washout = Structure::corner(&self.law, &self.squares.at);
        if let Some(squares) = fit.solve(&self.law, &self.squares.at, None) {
            self.squares = squares;
        }
        let at = &self.squares.at;
        let shown = instruments(fit.axis, &self.law, at, logs);
        let Some(found) = shown.and_then(|z| fit.solve(&self.law, at, Some(&z))) else {
            return;
        };
        // Weak instruments lead anywhere.
        let left = |at: &[f64]| fit.left(&self.law, at).unwrap_or(f64::INFINITY);
        if left(&found.at) <= 1.5 * left(at)
            && let Some(left) = check.left(&self.law, &found.at)
        {
            (self.left, self.instrumented) = (left, Some(found));
        }
    }

    /// Whether it has no low pass, or one that is told from none by twice its interval: one
    /// that is not there takes noise of the log out of the command, and the delay makes up
    /// for it.
    fn needs_filter(&self) -> bool {
        let solved = self.instrumented.as_ref().unwrap_or(&self.squares);
        let all = self.law.free.iter().enumerate();
        let mut filters = all.filter(|(_, free)| self.structure.filters(free.key));
        let reach = |i: usize| (2.0 * solved.half_widths[i] / solved.at[i]).exp() * solved.at[i];
        filters.all(|(i, free)| reach(i) < free.room[1])
    }

    /// Least squares, or what the instruments say where that differs; and whether it is
    /// these.
    pub fn solved(&self) -> (Solved, bool) {
        match &self.instrumented {
            Some(found) if found.is_beside(&self.squares) => (found.clone(), true),
            Some(found) => (self.squares.widened(found), false),
            None => (self.squares.clone(), false),
        }
    }
}

impl Fitted {
    /// Whether check logs tell that it leaves less than `other`: the mean difference of what both leave in
    /// parts of the logs is above 0 by its 95 % interval (Student's t of paired differences). What another
    /// has besides may always be there, too weak to be seen; it is told apart if it is not needed.
    pub fn is_told_from(&self, other: &Self, check: &Equation<'_>) -> bool {
        if self.structure.is_part_of(&other.structure) {
            return true;
        }
        let losses = |of: &Self| check.losses(&of.law, &of.solved().0.at);
        let (Some(own), Some(others)) = (losses(self), losses(other)) else {
            return true;
        };
        let more: Vec<f64> = others.iter().zip(&own).map(|(b, a)| b - a).collect();
        let n = more.len() as f64;
        let mean = more.iter().sum::<f64>() / n;
        let squares: f64 = more.iter().map(|m| (m - mean).powi(2)).sum();
        let deviation = (squares / (n * (n - 1.0).max(1.0))).sqrt();
        let t = StudentsT::new(0.0, 1.0, (n - 1.0).max(1.0)).map(|t| t.inverse_cdf(0.975));
        mean > t.unwrap_or(f64::INFINITY) * deviation
    }
}

/// All structures, the best one first, then by their scores; and the names of those that
/// cannot give these commands.
pub fn all(
    fit: &Equation<'_>,
    check: &Equation<'_>,
    logs: &[(String, Log, f64)],
) -> (Vec<Fitted>, Vec<String>) {
    let (mut fitted, mut failed): (Vec<Fitted>, _) = (Vec::new(), Vec::new());
    for structure in structures(fit.axis, logs) {
        let name = structure.name();
        match squares(fit, check, structure) {
            // Both ways may lead to one minimum.
            Some(found)
                if found.structure.exchanged
                    && fitted.last().is_some_and(|last| found.is_at(last)) => {}
            Some(found) => fitted.push(found),
            None => failed.push(name),
        }
    }
    fitted.sort_by(|a, b| a.score().total_cmp(&b.score()));
    // Noise of the log makes a low pass look better, but not as much as another controller would be.
    let all: Vec<(Structure, f64)> = fitted
        .iter()
        .map(|found| (found.structure.clone(), found.left))
        .collect();
    let outdoes_bare = |found: &Fitted| {
        let bare = all.iter().filter(|(s, _)| s.is_part_of(&found.structure));
        let least = bare.map(|(_, left)| *left).fold(f64::INFINITY, f64::min);
        found.left < BETTER * least
    };
    let best = fitted.iter_mut().position(|found| {
        found.instrument(fit, check, logs);
        found.needs_filter() || outdoes_bare(found)
    });
    if let Some(best) = best {
        fitted[..=best].rotate_right(1);
    }
    (fitted, failed)
}

/// A structure by least squares; none if it cannot give these commands.
fn squares(fit: &Equation<'_>, check: &Equation<'_>, structure: Structure) -> Option<Fitted> {
    let begin = start(fit, structure.form, structure.reads_motor())?;
    let law = structure.law(fit.axis, begin);
    let squares = fit.solve(&law, &law.start(), None)?;
    let left = check.left(&law, &squares.at)?;
    Some(Fitted {
        structure,
        law,
        squares,
        instrumented: None,
        left,
    })
}

/// What the controller would see in a closed-loop simulation of the logs, which carries no
/// noise; none if the loop does not hold.
fn instruments(
    machine: &Axis,
    law: &Law,
    at: &[f64],
    logs: &[(String, Log, f64)],
) -> Option<Vec<Seen>> {
    let mut axis = machine.clone();
    axis.control = law.control(at).ok()?;
    let one = |log: &(String, Log, f64)| {
        let trace = Replay::of_axis(&log.1, log.2, machine).ok()?;
        let trace = trace.run(&axis, &[], None).ok()?;
        Seen::simulated(machine, log, &trace)
    };
    logs.iter().map(one).collect()
}
