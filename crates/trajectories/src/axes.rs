//! Several axes that start and end together.

use crate::{Motion, Real, Setpoint, TrajectoryError, Transfer, TransferLimits, VelocityLimits};

/// A motion of several axes was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("axis {axis}: {source}")]
pub struct AxisError {
    /// Which axis, counted from 0.
    pub axis: usize,
    /// What is wrong with it.
    pub source: TrajectoryError,
}

/// What one axis is to do, and within which limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisTask<T = f64> {
    /// State at the start; its jerk is not read.
    pub start: Setpoint<T>,
    /// State at the end; its jerk is not read.
    pub target: Setpoint<T>,
    /// Limits of the axis.
    pub limits: TransferLimits<T>,
}

/// Motions of `N` axes that start together and end together, in the least time in which that is possible.
///
/// ```
/// use trajectories::{Axes, AxisTask, Limits, Setpoint};
///
/// let limits = Limits::<f64>::new(1.0, 5.0, 100.0)?.into(); // m/s, m/s², m/s³
/// let to = |x| AxisTask { start: Setpoint::at_rest(0.0), target: Setpoint::at_rest(x), limits };
/// let axes = Axes::together(&[to(0.3), to(-0.1)])?;
/// let [x, y] = axes.at(0.5 * axes.duration());
/// assert!((x.position - 0.15).abs() < 1e-12 && (y.position + 0.05).abs() < 1e-12);
///
/// // On a straight line, at all times.
/// let line = Axes::straight(&[to(0.3), to(-0.1)])?.expect("both stand still at both ends");
/// let [x, y] = line.at(0.1);
/// assert!((x.position + 3.0 * y.position).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes<T, const N: usize> {
    axes: [Transfer<T>; N],
    duration: T,
}

impl<T: Real, const N: usize> Axes<T, N> {
    /// Each axis reaches its target at the same time, the least that is possible for all: an axis that would be there
    /// earlier goes more slowly ([`Transfer::lasting`]).
    ///
    /// # Errors
    /// [`AxisError`] with the number of the axis and why, as [`Transfer::plan`], its transfer is refused.
    pub fn together(tasks: &[AxisTask<T>; N]) -> Result<Self, AxisError> {
        let mut axes = try_each(tasks, |task| {
            Transfer::plan(&task.start, &task.target, &task.limits)
        })?;
        let mut duration = longest(&axes);
        // Durations that are not possible form few and bounded gaps for each axis: each pass that goes on has left
        // one behind.
        for _ in 0..16 * N {
            for (axis, (transfer, task)) in axes.iter_mut().zip(tasks).enumerate() {
                let behind = duration - transfer.duration();
                if behind <= T::of(4.0) * T::EPSILON * duration {
                    continue;
                }
                let AxisTask {
                    start,
                    target,
                    limits,
                } = task;
                *transfer = Transfer::lasting(start, target, limits, duration)
                    .map_err(|source| AxisError { axis, source })?;
            }
            let next = longest(&axes);
            if next <= duration * (T::ONE + T::of(4.0) * T::EPSILON) {
                break;
            }
            duration = next;
        }
        Ok(Self {
            duration: longest(&axes),
            axes,
        })
    }

    /// All axes on the straight line from the start to the end, in the least time in which they can be; none if
    /// their velocities and accelerations at start and end do not all point along that line.
    ///
    /// It lasts at least as long as [`together`](Self::together), since the axes cannot each use their own limits.
    ///
    /// # Errors
    /// [`AxisError`] as [`together`](Self::together).
    pub fn straight(tasks: &[AxisTask<T>; N]) -> Result<Option<Self>, AxisError> {
        // Each axis is checked by its own limits and names.
        let alone = try_each(tasks, |task| {
            Transfer::plan(&task.start, &task.target, &task.limits)
        })?;
        let Some((axis, length)) = leading(tasks) else {
            // No axis has a distance to go: a line has no direction.
            let still = longest(&alone) == T::ZERO;
            return Ok(still.then_some(Self {
                axes: alone,
                duration: T::ZERO,
            }));
        };
        let first = &tasks[axis];
        let ratios = tasks.map(|task| (task.target.position - task.start.position) / length);
        if !collinear(tasks, &ratios, axis) {
            return Ok(None);
        }
        let limits = shared(tasks, &ratios).map_err(|source| AxisError { axis, source })?;
        let Ok(lead) = Transfer::plan(&first.start, &first.target, &limits) else {
            // A target that each axis can reach by its own limits, but not all on the line.
            return Ok(None);
        };
        let mut axes = [lead; N];
        for ((transfer, task), ratio) in axes.iter_mut().zip(tasks).zip(ratios) {
            *transfer = lead.scaled(ratio, &task.start, &task.target);
        }
        Ok(Some(Self {
            duration: lead.duration(),
            axes,
        }))
    }

    /// On the straight line if that is possible, else [`together`](Self::together).
    ///
    /// # Errors
    /// [`AxisError`] as [`together`](Self::together).
    pub fn straight_or_together(tasks: &[AxisTask<T>; N]) -> Result<Self, AxisError> {
        match Self::straight(tasks)? {
            Some(line) => Ok(line),
            None => Self::together(tasks),
        }
    }

    /// Duration of the motion of all axes, s.
    #[inline]
    pub const fn duration(&self) -> T {
        self.duration
    }

    /// State of each axis at `t` (s), as [`Motion::at`].
    pub fn at(&self, t: T) -> [Setpoint<T>; N] {
        // The durations of the axes differ by rounding: all end at the last one.
        let over = t >= self.duration;
        self.axes.each_ref().map(|axis| {
            let end = axis.duration();
            axis.at(if over {
                end + (t - self.duration)
            } else {
                t.min(end)
            })
        })
    }

    /// The motion of each axis.
    #[inline]
    pub const fn axes(&self) -> &[Transfer<T>; N] {
        &self.axes
    }
}

fn longest<T: Real>(axes: &[Transfer<T>]) -> T {
    let durations = axes.iter().map(Motion::duration);
    durations.fold(T::ZERO, |longest, x| longest.max(x))
}

fn try_each<T: Real, const N: usize>(
    tasks: &[AxisTask<T>; N],
    plan: impl Fn(&AxisTask<T>) -> Result<Transfer<T>, TrajectoryError>,
) -> Result<[Transfer<T>; N], AxisError> {
    let mut axes = [Transfer::at_rest(); N];
    for (axis, (transfer, task)) in axes.iter_mut().zip(tasks).enumerate() {
        *transfer = plan(task).map_err(|source| AxisError { axis, source })?;
    }
    Ok(axes)
}

/// The axis with the longest distance, and that distance.
fn leading<T: Real>(tasks: &[AxisTask<T>]) -> Option<(usize, T)> {
    let mut found = None;
    let mut longest = T::ZERO;
    for (axis, task) in tasks.iter().enumerate() {
        let distance = task.target.position - task.start.position;
        if distance.abs() > longest {
            longest = distance.abs();
            found = Some((axis, distance));
        }
    }
    found
}

/// Whether velocities and accelerations are those of the leading axis times the ratio, to rounding.
fn collinear<T: Real, const N: usize>(
    tasks: &[AxisTask<T>; N],
    ratios: &[T; N],
    axis: usize,
) -> bool {
    let values = |task: &AxisTask<T>| {
        let (s, e) = (&task.start, &task.target);
        [s.velocity, s.acceleration, e.velocity, e.acceleration]
    };
    let lead = values(&tasks[axis]);
    tasks.iter().zip(ratios).all(|(task, &ratio)| {
        values(task).iter().zip(lead).all(|(&x, lead)| {
            let rounding = T::of(16.0) * T::EPSILON * (x.abs() + lead.abs());
            (x - ratio * lead).abs() <= rounding
        })
    })
}

/// Limits of the leading axis that keep those of all.
fn shared<T: Real, const N: usize>(
    tasks: &[AxisTask<T>; N],
    ratios: &[T; N],
) -> Result<TransferLimits<T>, TrajectoryError> {
    let most = T::MAX;
    let (mut back, mut fast, mut least, mut greatest, mut jerk) =
        (-most, most, -most, most, T::INFINITY);
    for (task, &ratio) in tasks.iter().zip(ratios) {
        if ratio == T::ZERO {
            continue;
        }
        let (own, change) = (&task.limits, task.limits.change());
        let pair = |low: T, high: T| {
            let (low, high) = (low / ratio, high / ratio);
            (low.min(high), low.max(high))
        };
        let (low, high) = pair(own.velocity_min(), own.velocity_max());
        (back, fast) = (back.max(low), fast.min(high));
        let (low, high) = pair(change.acceleration_min(), change.acceleration_max());
        (least, greatest) = (least.max(low), greatest.min(high));
        jerk = jerk.min(change.jerk() / ratio.abs());
    }
    TransferLimits::new(back, fast, VelocityLimits::new(least, greatest, jerk)?)
}
