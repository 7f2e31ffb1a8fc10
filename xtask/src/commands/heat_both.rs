//! Growth and dynamic error compensated together, on a machine that another simulator warms up.

use std::path::Path;
use std::sync::Arc;

use axis_pipeline::PipelineError;
use axis_pipeline::heat::{DutyHeat, HeatAhead, HeatError, ModelHeat, WarmMoves, warm_axis};
use axis_pipeline::moves::NamedMotion;
use axis_pipeline::strategies::{
    NONE, NextMove, Predictors, STRATEGIES, SharedMotion, Strategy, StrategyKind, named,
};
use axis_sim::{Axis, Measured};
use axis_thermal::{ThermalModel, ThermalParameters};
use compensator::{Compensator, Correction, Sample};
use independent_axis::{HeatedScrew, Motion, there_and_back};
use miette::{IntoDiagnostic, Result, miette};
use serde::{Deserialize, Serialize};
use trajectories::{Limits, Program, Step};

use super::heat_identified::Fitted;

/// Minutes of the duty before each pass.
pub const AFTER: [f64; 4] = [0.0, 5.0, 20.0, 60.0];

/// Peak of the table's error on two strokes there and back on end, after each of [`AFTER`].
#[derive(Clone, Deserialize, Serialize)]
pub struct Compensated {
    pub what: String,
    pub peaks_um: [f64; 4],
}

/// How a strategy uses the predicted heat.
#[derive(Clone, Copy, PartialEq)]
enum Use {
    Nothing,
    GrowthAlone,
    Both,
    /// The friction of the machine itself.
    Machine,
}

/// A row of a table.
struct Case {
    what: String,
    strategy: &'static str,
    used: Use,
    model: ThermalParameters,
    /// Whether the machine has the model's own numbers and laws.
    own: bool,
}

/// The rows of an axis, each made when it is asked for and not kept.
pub struct Cases<'a> {
    axis: &'a Axis,
    cases: Vec<Case>,
}

impl<'a> Cases<'a> {
    /// With the position from the motor.
    pub fn of_motor(axis: &'a Axis, fitted: &[Fitted]) -> Self {
        let (assumed, best) = (axis.thermal_parameters(), &fitted[fitted.len() - 1].1);
        let case = |what: &str, strategy, used, model: &ThermalParameters| Case {
            what: what.to_owned(),
            strategy,
            used,
            model: model.clone(),
            own: false,
        };
        let mut cases = vec![
            case("none", "none", Use::Nothing, &assumed),
            case("plan alone", "plan", Use::Nothing, &assumed),
            case("growth alone", "none", Use::GrowthAlone, best),
            case(
                "both, friction of the cold axis",
                "plan",
                Use::GrowthAlone,
                best,
            ),
        ];
        for (name, model) in fitted {
            cases.push(case(&format!("both; {name}"), "plan", Use::Both, model));
        }
        cases.push(Case {
            own: true,
            ..case(
                "both; a machine of the model's own numbers and laws",
                "plan",
                Use::Both,
                &assumed,
            )
        });
        Self { axis, cases }
    }

    /// With the position from the scale; the friction's schedule is of the models that were fitted to its power.
    pub fn of_scale(axis: &'a Axis, fitted: &[Fitted]) -> Self {
        let case = |what: &str, strategy, used, model: usize| {
            let mut model = fitted[model].1.clone();
            // The scale's own growth is not in the dynamic part, so none may be subtracted.
            model.expansion.scale = 0.0;
            model.expansion.bed = 0.0;
            Case {
                what: what.to_owned(),
                strategy,
                used,
                model,
                own: false,
            }
        };
        let last = fitted.len() - 1;
        let (cold, scheduled, own) = (
            "friction of the cold axis",
            "friction scheduled",
            "the machine's own friction",
        );
        let mut cases = vec![
            case("none", "none", Use::Nothing, last),
            case(&format!("plan, {cold}"), "plan", Use::Nothing, last),
        ];
        for model in [last - 1, last] {
            let what = format!("plan, {scheduled}; {}", fitted[model].0);
            cases.push(case(&what, "plan", Use::Both, model));
        }
        cases.extend([
            case(&format!("plan, {own}"), "plan", Use::Machine, last),
            case(&format!("adaptive, {cold}"), "adaptive", Use::Nothing, last),
            case(&format!("feedback, {cold}"), "feedback", Use::Nothing, last),
            case(
                &format!("feedback, {scheduled}"),
                "feedback",
                Use::Both,
                last,
            ),
            case(&format!("feedback, {own}"), "feedback", Use::Machine, last),
        ]);
        Self { axis, cases }
    }

    /// What each row is called.
    pub fn names(&self) -> Vec<&str> {
        self.cases.iter().map(|case| case.what.as_str()).collect()
    }

    /// Peaks of a strategy whose model has the machine's friction of each time: what knowing it any better would leave.
    fn with_its_own_friction(
        &self,
        case: &Case,
        truth: &mut OtherHeat,
        after: &[f64; 4],
        moves: &[NamedMotion; 2],
    ) -> Result<[f64; 4]> {
        let mut peaks_um = [0.0; 4];
        for (peak, time) in peaks_um.iter_mut().zip(after) {
            truth.until(*time).into_diagnostic()?;
            let friction = truth.friction().into_diagnostic()?;
            let axis = warm_axis(self.axis, friction).into_diagnostic()?;
            let pass = 2.0 * moves[0].motion.duration();
            let warm = WarmMoves::new(&axis, &mut Constant, &[0.0], pass).into_diagnostic()?;
            let mut strategy = strategy(&axis, case.strategy, Use::Nothing)?;
            let passes = warm.run(&mut *strategy, moves, None, |_: &mut Measured| (), || ());
            let passes = passes.into_diagnostic()?;
            let all = passes.iter().flatten().map(|run| run.figures.max);
            *peak = all.fold(0.0, f64::max);
        }
        Ok(peaks_um)
    }

    /// Computes a row. `with_growth`: the error of the table, else the dynamic part alone.
    pub fn row(&self, number: usize, with_growth: bool) -> Result<Compensated> {
        let case = &self.cases[number];
        let stroke: SharedMotion = Arc::new(stroke()?);
        let machine = match case.own {
            true => HeatedScrew::assumed(20.0),
            false => HeatedScrew::other(20.0),
        };
        let mut truth = OtherHeat {
            machine,
            motion: there_and_back(0.45, 0.95, 0.2, 1.0),
            with_growth,
        };
        // Two strokes on end.
        let pass = 2.0 * stroke.duration();
        let after = AFTER.map(|minutes| 60.0 * minutes);
        let moves = [1, 2].map(|pass| NamedMotion {
            name: format!("stroke {pass}"),
            motion: stroke.clone(),
            learned: None,
        });
        if case.used == Use::Machine {
            let peaks_um = self.with_its_own_friction(case, &mut truth, &after, &moves)?;
            return Ok(Compensated {
                what: case.what.clone(),
                peaks_um,
            });
        }
        let warm = WarmMoves::new(self.axis, &mut truth, &after, pass).into_diagnostic()?;
        let model = ThermalModel::new(case.model.clone()).into_diagnostic()?;
        let duty = [stroke.clone()];
        let heat = ModelHeat::of(self.axis, model, &duty, 20.0).into_diagnostic()?;
        let mut strategy = strategy(self.axis, case.strategy, case.used)?;
        let heat = (case.used != Use::Nothing).then_some(heat);
        let passes = warm.run(&mut *strategy, &moves, heat, |_: &mut Measured| (), || ());
        let passes = passes.into_diagnostic()?;
        let mut peaks_um = [0.0; 4];
        for (peak, pass) in peaks_um.iter_mut().zip(&passes) {
            // What adapts has seen a move at this temperature.
            let seen = usize::from(case.strategy == "adaptive");
            let all = pass.iter().skip(seen).map(|run| run.figures.max);
            *peak = all.fold(0.0, f64::max);
        }
        Ok(Compensated {
            what: case.what.clone(),
            peaks_um,
        })
    }
}

/// An axis that stays as it is.
struct Constant;

impl DutyHeat for Constant {
    fn until(&mut self, _: f64) -> std::result::Result<(), HeatError> {
        Ok(())
    }

    fn friction(&self) -> std::result::Result<[f64; 2], HeatError> {
        Ok([1.0; 2])
    }

    fn growth(&self, _: f64) -> f64 {
        0.0
    }
}

/// The duty of `there_and_back` as a program.
fn stroke() -> Result<Program> {
    let limits = Limits::new(0.2, 1.0, 10.0).into_diagnostic()?;
    let rest = Step::Dwell { duration: 1.0 };
    let to = |to: f64| Step::Move { to, limits };
    Program::new(0.45, vec![to(0.95), rest, to(0.45), rest]).into_diagnostic()
}

/// The second simulator's heat.
struct OtherHeat {
    machine: HeatedScrew,
    motion: Motion,
    with_growth: bool,
}

impl DutyHeat for OtherHeat {
    fn until(&mut self, time: f64) -> std::result::Result<(), HeatError> {
        let more = time - self.machine.time;
        if more > 0.0 {
            self.machine.run(Some(&self.motion), more, |_| 20.0);
        }
        Ok(())
    }

    fn friction(&self) -> std::result::Result<[f64; 2], HeatError> {
        // The loop has one friction for all of the stroke: that of the mean over it.
        const PLACES: u32 = 50;
        let mut mean = [0.0; 2];
        for k in 0..PLACES {
            let x = 0.45 + 0.5 * (f64::from(k) + 0.5) / f64::from(PLACES);
            let there = self.machine.friction_factors(x);
            mean = [0, 1].map(|i| mean[i] + there[i] / f64::from(PLACES));
        }
        Ok(mean)
    }

    fn growth(&self, x: f64) -> f64 {
        match self.with_growth {
            true => self.machine.growth(20.0, x),
            false => 0.0,
        }
    }
}

fn strategy(axis: &Axis, name: &str, used: Use) -> Result<Box<dyn Strategy>> {
    let kind: &StrategyKind = match name {
        "none" if used == Use::GrowthAlone => {
            return Ok(Box::new(GrowthAlone {
                period: axis.period,
                heat: None,
            }));
        }
        "none" => &NONE,
        name => {
            named(STRATEGIES, name).ok_or_else(|| miette!("there is no strategy \"{name}\""))?
        }
    };
    let strategy = kind.strategy(&Predictors::of(axis)).into_diagnostic()?;
    Ok(match used {
        Use::GrowthAlone => Box::new(ColdFriction(strategy)),
        _ => strategy,
    })
}

/// A strategy that does not follow how friction falls.
struct ColdFriction(Box<dyn Strategy>);

impl Strategy for ColdFriction {
    fn compensator(
        &mut self,
        next: &NextMove,
    ) -> std::result::Result<Box<dyn Compensator + Send>, PipelineError> {
        self.0.compensator(next)
    }

    fn warmed(&mut self, heat: Option<Arc<HeatAhead>>) {
        self.0
            .warmed(heat.map(|heat| Arc::new(heat.growth_alone())));
    }
}

/// The drive as it is, growth subtracted from its reference.
struct GrowthAlone {
    period: f64,
    heat: Option<Arc<HeatAhead>>,
}

impl Strategy for GrowthAlone {
    fn compensator(
        &mut self,
        _: &NextMove,
    ) -> std::result::Result<Box<dyn Compensator + Send>, PipelineError> {
        Ok(Box::new(Less {
            period: self.period,
            heat: self.heat.clone(),
            cycle: 0,
        }))
    }

    fn warmed(&mut self, heat: Option<Arc<HeatAhead>>) {
        self.heat = heat;
    }
}

struct Less {
    period: f64,
    heat: Option<Arc<HeatAhead>>,
    cycle: u32,
}

impl Compensator for Less {
    fn reset(&mut self) {
        self.cycle = 0;
    }

    fn correct(&mut self, sample: &Sample) -> Correction {
        let time = f64::from(self.cycle) * self.period;
        self.cycle += 1;
        let growth = |heat: &Arc<HeatAhead>| heat.growth(time, sample.reference.position)[0];
        Correction {
            position: -self.heat.as_ref().map_or(0.0, growth),
            command: 0.0,
        }
    }
}

/// A row that is kept as a file, so that a run that was stopped goes on; computed if it is not there, or of another
/// program.
pub fn kept<T: Clone + Serialize + for<'de> Deserialize<'de>>(
    folder: &Path,
    name: &str,
    key: &str,
    compute: impl FnOnce() -> Result<T>,
) -> Result<T> {
    #[derive(Deserialize, Serialize)]
    struct Kept<T> {
        key: String,
        row: T,
    }
    let file = folder.join(format!("{name}.json"));
    let text = std::fs::read_to_string(&file).ok();
    let found: Option<Kept<T>> = text.and_then(|text| serde_json::from_str(&text).ok());
    if let Some(found) = found.filter(|found| found.key == key) {
        return Ok(found.row);
    }
    let row = compute()?;
    std::fs::create_dir_all(folder).into_diagnostic()?;
    let key = key.to_owned();
    let kept = Kept {
        key,
        row: row.clone(),
    };
    let text = serde_json::to_string_pretty(&kept).into_diagnostic()?;
    std::fs::write(&file, text).into_diagnostic()?;
    Ok(row)
}
