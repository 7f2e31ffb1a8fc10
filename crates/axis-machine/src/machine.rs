//! A machine: its drives, and what lies between them.

use std::sync::Arc;

use axis_sim::mechanism::Freedom;
use axis_sim::{Axis, ClosedLoop};
use toolpath::FeedProfile;

use crate::base::BaseMode;
use crate::coupling::Coupling;
use crate::error::MachineError;
use crate::gantry::GantryBeam;
use crate::motion::AxisMotion;

/// Axes of any kinds, run in lockstep, with what lies between them: squareness, straightness, cross-talk, a base
/// that moves, a beam on two drives.
///
/// ```
/// use axis_machine::{AxisCoupling, Coupling, CoupledMachine};
/// use axis_sim::Axis;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/linear-stage.toml");
/// let stage = Axis::read(file.as_ref())?;
/// // 20 µm/m between X and Y; X is moved 20 µm per m/s² of Y.
/// let coupling = Coupling::new(vec![AxisCoupling {
///     of: 0,
///     by: 1,
///     squareness: 20e-6,
///     crosstalk: 20e-6,
///     ..AxisCoupling::default()
/// }])?;
/// let machine = CoupledMachine::new([&stage, &stage])?.with_coupling(coupling);
/// assert_eq!(machine.drives().len(), 2);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct CoupledMachine<const D: usize> {
    drives: Vec<MachineDrive>,
    pub(crate) coupling: Coupling,
    pub(crate) bases: [Option<BaseMode>; D],
    pub(crate) beams: [Option<GantryBeam>; D],
    /// The shortest time of which all control periods are whole parts, s: the slowest of them, if the others are parts of it.
    pub(crate) period: f64,
}

/// One drive of a machine.
#[derive(Clone, Debug)]
pub struct MachineDrive {
    /// Coordinate that it moves, from 0.
    pub axis: usize,
    /// The axis as its file has it.
    pub nominal: Axis,
    /// Its closed loop.
    pub closed_loop: ClosedLoop,
    /// Its control periods in that time.
    pub(crate) parts: u64,
}

impl<const D: usize> CoupledMachine<D> {
    /// One drive for each coordinate, and nothing between them.
    ///
    /// # Errors
    /// [`MachineError::Setup`] for an axis without a closed loop, [`MachineError::Rotary`] for one that turns,
    /// [`MachineError::Periods`] if control periods have no instant in common every 16 of the slowest.
    pub fn new(axes: [&Axis; D]) -> Result<Self, MachineError> {
        let mut machine = Self {
            drives: Vec::new(),
            coupling: Coupling::default(),
            bases: [None; D],
            beams: [None; D],
            period: 0.0,
        };
        for (coordinate, axis) in axes.into_iter().enumerate() {
            machine.drives.push(drive(coordinate, axis)?);
        }
        machine.share_instants()?;
        Ok(machine)
    }

    /// With couplings in place of those before.
    #[must_use]
    pub fn with_coupling(self, coupling: Coupling) -> Self {
        Self { coupling, ..self }
    }

    /// With a base that moves under axis `axis` (from 0; one that is not there is passed over).
    ///
    /// # Errors
    /// [`MachineError::Invalid`] for a value out of its range.
    pub fn with_base(mut self, axis: usize, base: BaseMode) -> Result<Self, MachineError> {
        base.check(axis)?;
        if let Some(slot) = self.bases.get_mut(axis) {
            *slot = Some(base);
        }
        Ok(self)
    }

    /// With a second drive at coordinate `axis` (from 0; one that is not there is passed over), which carries one beam with the first.
    ///
    /// # Errors
    /// As [`CoupledMachine::new`], and [`MachineError::Invalid`] for a value of the beam that is out of its range.
    pub fn with_gantry(
        mut self,
        axis: usize,
        second: &Axis,
        beam: GantryBeam,
    ) -> Result<Self, MachineError> {
        let Some(first) = self.drives.iter().position(|drive| drive.axis == axis) else {
            return Ok(self);
        };
        self.drives.retain({
            let mut seen = false;
            move |drive| drive.axis != axis || !std::mem::replace(&mut seen, true)
        });
        self.drives.insert(first + 1, drive(axis, second)?);
        self.share_instants()?;
        let masses = [first, first + 1].map(|d| self.drives[d].mass());
        beam.check(axis, masses, self.period)?;
        self.beams[axis] = Some(beam);
        Ok(self)
    }

    /// Its drives: those of a coordinate side by side, a gantry's second after its first.
    pub fn drives(&self) -> &[MachineDrive] {
        &self.drives
    }

    /// The shortest time of which the control periods of all drives are whole parts, s.
    pub fn period(&self) -> f64 {
        self.period
    }

    /// What lies between its axes.
    pub fn coupling(&self) -> &Coupling {
        &self.coupling
    }

    /// What each drive has to do along a profile. Each stands where its motions begin where the path's coordinates are
    /// `origin` (m): the begin of the first path that is run. With `correction`, less what that does to the tool.
    pub fn motions(
        &self,
        profile: &Arc<FeedProfile<D>>,
        origin: &[f64; D],
        correction: Option<&Arc<Coupling>>,
    ) -> Vec<Arc<AxisMotion<D>>> {
        let begin = profile.path().at(0.0).position;
        let start = |drive: &MachineDrive| drive.closed_loop.axis().stroke.start;
        let zeros: [f64; D] = std::array::from_fn(|axis| {
            let first = self.drives.iter().find(|drive| drive.axis == axis);
            first.map_or(0.0, start) - origin[axis]
        });
        let motion = |drive: &MachineDrive| {
            let axis = drive.axis;
            let at = start(drive) + begin[axis] - origin[axis];
            let motion = AxisMotion::new(profile.clone(), axis, at);
            Arc::new(match correction {
                Some(coupling) => motion.correcting(coupling.clone(), zeros),
                None => motion,
            })
        };
        self.drives.iter().map(motion).collect()
    }

    /// Finds the shortest time of which all control periods are whole parts.
    fn share_instants(&mut self) -> Result<(), MachineError> {
        let periods = self.drives.iter().map(|d| d.closed_loop.axis().period);
        let longest = periods.fold(0.0, f64::max);
        let mut refused = None;
        for times in 1..=MOST_PERIODS {
            let shared = f64::from(times) * longest;
            let parts = self
                .drives
                .iter()
                .map(|drive| whole_parts(drive.axis, drive.closed_loop.axis().period, shared));
            match parts.collect::<Result<Vec<_>, _>>() {
                Ok(parts) => {
                    for (drive, parts) in self.drives.iter_mut().zip(parts) {
                        drive.parts = parts;
                    }
                    self.period = shared;
                    return Ok(());
                }
                Err(error) => refused = refused.or(Some(error)),
            }
        }
        refused.map_or(Ok(()), Err)
    }
}

/// Control periods of the slowest drive within which all drives must have an instant in common: 8 and 10 kHz have one every
/// 0.5 ms, 4 of 8 kHz.
const MOST_PERIODS: u32 = 16;

impl MachineDrive {
    /// Mass of its load, kg.
    pub(crate) fn mass(&self) -> f64 {
        self.closed_loop.axis().mechanism.load_inertia()
    }
}

/// How many periods of axis `axis` (from 0) the longest of all has.
pub(crate) fn whole_parts(axis: usize, period: f64, longest: f64) -> Result<u64, MachineError> {
    let parts = longest / period;
    match (parts - parts.round()).abs() > 1e-9 * parts {
        true => Err(MachineError::Periods {
            axis: axis + 1,
            period,
            longest,
        }),
        false => Ok(parts.round() as u64),
    }
}

fn drive(coordinate: usize, axis: &Axis) -> Result<MachineDrive, MachineError> {
    if axis.freedom() == Freedom::Rotary {
        return Err(MachineError::Rotary {
            axis: coordinate + 1,
        });
    }
    let closed_loop = ClosedLoop::new(axis).map_err(|source| MachineError::Setup {
        axis: coordinate + 1,
        source,
    })?;
    Ok(MachineDrive {
        axis: coordinate,
        nominal: axis.clone(),
        closed_loop,
        parts: 1,
    })
}
