//! Communication steps.

use super::Unit;
use crate::error::UnitError;
use crate::mode::FmiMode;

/// Share of the control period by which a communication point may be off: what rounding makes
/// of a time that is added up.
const POINT_TOLERANCE: f64 = 1e-2;

/// Share of the stop time by which a step may end behind it: importers compare times to about
/// nine digits.
const STOP_TOLERANCE: f64 = 1e-9;

/// Most control cycles in one communication step.
const MOST_CYCLES: f64 = 1e9;

impl Unit {
    /// Goes from `point` (s), where the unit is, over `step` (s), of any length; the inputs are
    /// held. A control cycle takes those of the point where it begins. Where the step ends between
    /// two samples, outputs show the machine as of the last one, or, with the parameter
    /// `unit.exact_between_samples`, as it is. Gives the time reached, s.
    ///
    /// # Errors
    /// [`UnitError::Order`] unless in step mode; [`UnitError::Time`] for another point, a step that
    /// is not above 0 or ends behind the stop time, and then nothing has been done;
    /// [`UnitError::Stopped`] if the run had to be given up.
    pub fn step(&mut self, point: f64, step: f64) -> Result<f64, UnitError> {
        self.in_mode("a step", &[FmiMode::Step], "after the initialization")?;
        let periods = self.periods(point, step)?;
        let (given, exact) = (self.inputs(), self.is_exact());
        let Some(run) = &mut self.run else {
            return Err(self.order("a step", "after the initialization"));
        };
        if let Err(stopped) = run.0.run_on(periods, &given, exact) {
            self.mode = FmiMode::Failed;
            return Err(stopped);
        }
        let values = self
            .input_places()
            .map(|place| self.values[place].to_bits());
        let step: Vec<u64> = values.chain([periods.to_bits()]).collect();
        self.history.push(&step, 1);
        Ok(self.time())
    }

    /// Makes steps of a history again.
    pub(super) fn again(&mut self, step: &[u64], count: u64) -> Result<(), UnitError> {
        let places: Vec<usize> = self.input_places().collect();
        for (place, bits) in places.into_iter().zip(step) {
            self.values[place] = f64::from_bits(*bits);
        }
        let periods = step.last().copied().map_or(0.0, f64::from_bits);
        let (given, exact) = (self.inputs(), self.is_exact());
        if let (Some(run), true) = (&mut self.run, periods > 0.0 && periods <= MOST_CYCLES) {
            (0..count).try_for_each(|_| run.0.run_on(periods, &given, exact))?;
        }
        self.history.push(step, count);
        Ok(())
    }

    /// Control periods of a communication step.
    fn periods(&self, point: f64, step: f64) -> Result<f64, UnitError> {
        let (now, period) = (self.time(), self.period());
        let refused = |what, value, valid| Err(UnitError::Time { what, value, valid });
        let is_here = (point - now).abs() <= POINT_TOLERANCE * period;
        if !is_here {
            return refused(
                "communication point",
                point,
                format!("where the unit is, {now} s"),
            );
        }
        let most = MOST_CYCLES * period;
        if !(step > 0.0 && step <= most) {
            let valid = format!("above 0 and at most {most} s");
            return refused("communication step", step, valid);
        }
        let (left, stop) = (self.span[1] - now, self.span[1]);
        if step > left + (POINT_TOLERANCE * period).max(STOP_TOLERANCE * stop.abs()) {
            let valid = format!("up to the stop time, {stop} s");
            return refused("communication step", step, valid);
        }
        Ok(step / period)
    }
}
