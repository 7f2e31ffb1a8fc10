//! Growth along a slow log, predicted from its reference as a controller predicts it, and set right by a probe now
//! and then.

use axis_thermal::{GrowthPredictor, GrowthZeros, ThermalModel};

use super::ahead::Unseen;
use super::{HeatError, SlowLog};

/// How growth is predicted.
#[derive(Clone, Debug)]
pub struct FollowOptions {
    /// Window of the predictor, s: growth comes so much late, without jumps.
    pub window: f64,
    /// Time since the log's begin at which the axis was homed, s: growth counts from then.
    pub homed: f64,
    /// Time between two readings that set the prediction right, s; none are used if it is not stated.
    pub probe_each: Option<f64>,
    /// Positions at which growth is predicted, m.
    pub places: Vec<f64>,
}

impl Default for FollowOptions {
    /// A minute; homed at the begin; nothing set right; no positions.
    fn default() -> Self {
        Self {
            window: 60.0,
            homed: 0.0,
            probe_each: None,
            places: Vec::new(),
        }
    }
}

/// Growth at one row of the log.
#[derive(Clone, Debug, PartialEq)]
pub struct FollowedRow {
    /// Since the log's begin, s.
    pub time: f64,
    /// Of the screw at each of the places, m, whatever the axis measures by.
    pub growth: Vec<f64>,
    /// At the reference's position, m: what a correction subtracts from it. Growth of the screw on an axis that
    /// measures at the motor, of the scale on one that measures by it. None if the log has no reference.
    pub at_reference: Option<f64>,
    /// Dry and viscous friction as multiples of those at the reference temperature.
    pub friction: [f64; 2],
}

/// A prediction along a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Following {
    /// One for each row.
    pub rows: Vec<FollowedRow>,
    /// Position, reading and prediction (m) of each reading that no correction was made from.
    pub readings: Vec<[f64; 3]>,
    /// Probings that the prediction was set right by, each of the readings of a minute.
    pub probings: usize,
}

/// Readings so near in time to the first of a probing belong to it, s.
const ONE_PROBING: f64 = 60.0;

/// Predicts growth along a log.
///
/// # Errors
/// [`HeatError`] if an option makes no sense, or the model refuses.
pub fn follow(
    model: ThermalModel,
    log: &SlowLog<'_>,
    options: &FollowOptions,
) -> Result<Following, HeatError> {
    let last = log.time()[log.time().len() - 1];
    if !(0.0..=last).contains(&options.homed) {
        return Err(HeatError::Option {
            name: "homed",
            value: options.homed,
            valid: "a time within the log, s since its begin",
        });
    }
    if let Some(each) = options
        .probe_each
        .filter(|each| !(*each > 0.0 && each.is_finite()))
    {
        return Err(HeatError::Option {
            name: "probe_each",
            value: each,
            valid: "above 0 s, and finite",
        });
    }
    let first = log.air()[0];
    let mut run = Run {
        predictor: GrowthPredictor::new(model.clone(), first, options.window)?,
        unseen: Unseen::of(log.axis())?,
        log,
        options,
        model,
        zeros: GrowthZeros::new(log.reads().1),
        probing: Vec::new(),
        probing_since: None,
        next_probing: options.probe_each.map(|each| options.homed + each),
        is_homed: false,
        found: Following::default(),
    };
    run.rows()?;
    Ok(run.found)
}

struct Run<'a> {
    predictor: GrowthPredictor,
    log: &'a SlowLog<'a>,
    unseen: Unseen,
    options: &'a FollowOptions,
    model: ThermalModel,
    zeros: GrowthZeros,
    /// Positions of the probing that goes on, and by how much growth is off there, m.
    probing: Vec<[f64; 2]>,
    probing_since: Option<f64>,
    next_probing: Option<f64>,
    is_homed: bool,
    found: Following,
}

impl Run<'_> {
    fn rows(&mut self) -> Result<(), HeatError> {
        let mut ends = self.log.ends().iter().peekable();
        for row in 0..self.log.time().len() {
            if row > 0 {
                self.advance(row)?;
            }
            let now = self.log.time()[row];
            if !self.is_homed && now >= self.options.homed {
                self.predictor.home();
                self.is_homed = true;
            }
            if let Some(since) = self.probing_since
                && now > since + ONE_PROBING
            {
                self.set_right()?;
            }
            if let Some(end) = ends.next_if(|end| end.row == row) {
                for &[place, read] in &end.found {
                    self.read(now, place, read);
                }
            }
            self.found.rows.push(self.row(row));
        }
        // A probing at the log's end sets the last row right.
        if self.probing_since.is_some() {
            self.set_right()?;
            self.found.rows.pop();
            let last = self.row(self.found.rows.len());
            self.found.rows.push(last);
        }
        Ok(())
    }

    fn advance(&mut self, row: usize) -> Result<(), HeatError> {
        let (time, air) = (self.log.time(), self.log.air());
        if self.log.reference().is_some() {
            let sample = self.log.sample(row - 1);
            return Ok(self.predictor.push(&sample, air[row])?);
        }
        let duty = self.log.duty(&self.model, row - 1, row);
        let (begun, whole) = (self.predictor.state().time, time[row] - time[row - 1]);
        let [from, to] = [air[row - 1], air[row]];
        let air = |t: f64| from + (to - from) * (t - begun) / whole;
        Ok(self.predictor.advance(&duty, whole, air)?)
    }

    /// Growth as a controller has it: a window late along a reference; at the rows of a log of duties, whose
    /// stretches are long, at once.
    fn growth(&self, place: f64) -> axis_thermal::Growth {
        match self.log.reference() {
            Some(_) => self.predictor.growth(place),
            None => self.predictor.growth_at_end(place),
        }
    }

    fn read(&mut self, now: f64, place: f64, read: f64) {
        let (of, _) = self.log.reads();
        let predicted = self.growth(place).read(of);
        let Some(reading) = self.zeros.counted([place, read, predicted]) else {
            return;
        };
        if !self.is_homed {
            return;
        }
        let starts = self
            .next_probing
            .is_some_and(|next| now >= next - 0.5 * ONE_PROBING);
        if self.probing_since.is_none() && starts {
            self.probing_since = Some(now);
            self.next_probing = self.options.probe_each.map(|each| now + each);
        }
        match self.probing_since {
            // By how much it is off at the time of the reading.
            Some(_) => self.probing.push([place, reading[1] - reading[2]]),
            None => self.found.readings.push(reading),
        }
    }

    fn set_right(&mut self) -> Result<(), HeatError> {
        let (of, _) = self.log.reads();
        // Time has gone on since the readings; what was off stays so.
        let now = |[place, off]: [f64; 2]| {
            let growth = self.predictor.growth_at_end(place).read(of);
            [place, growth + off]
        };
        let read: Vec<[f64; 2]> = self.probing.drain(..).map(now).collect();
        self.predictor.probed(of, &read)?;
        self.found.probings += 1;
        self.probing_since = None;
        Ok(())
    }

    fn row(&self, row: usize) -> FollowedRow {
        let growth = |place: &f64| self.growth(*place).screw;
        let position = self.log.reference().map(|reference| reference[row]);
        FollowedRow {
            time: self.log.time()[row],
            growth: self.options.places.iter().map(growth).collect(),
            at_reference: position.map(|x| self.unseen.read(&self.growth(x))),
            friction: self.predictor.friction_factors(),
        }
    }
}
