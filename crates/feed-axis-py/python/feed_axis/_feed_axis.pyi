"""Types of the compiled module. SI units throughout; the last part of a name is its unit."""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, Final, Literal, Protocol, SupportsIndex, TypeAlias, final, type_check_only

import numpy as np
import pandas as pd
import polars as pl
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Self

__all__ = [
    "STRATEGIES",
    "Axis",
    "AxisError",
    "Beam",
    "CirclesFound",
    "Compensator",
    "Contour",
    "Correction",
    "Discovery",
    "Effect",
    "FeedAxisError",
    "GeneralLuGre",
    "LogError",
    "LoopError",
    "LuGre",
    "Machine",
    "MachineError",
    "MotionError",
    "Move",
    "MoveCorrection",
    "Network",
    "NetworkError",
    "Parameter",
    "ParameterError",
    "Program",
    "Run",
    "SCurve",
    "Sample",
    "Samples",
    "SearchError",
    "SimulationError",
    "StrategyError",
    "Toolpath",
    "TransferFunctions",
    "__version__",
    "discover",
    "examples",
    "fit_circles",
    "halton",
    "identify",
    "identify_control",
    "latin_hypercube",
    "learn",
    "new",
    "sobol",
]

__version__: Final[str]
STRATEGIES: Final[dict[str, str]]

_Floats: TypeAlias = NDArray[np.float64]
_Path: TypeAlias = str | os.PathLike[str]
# What is done, how much of it, of how much: None where that is not known.
_Progress: TypeAlias = Callable[[str, int, int | None], object]
# Positions, one each control period; or instants evenly apart, and positions.
_Positions: TypeAlias = Sequence[float] | NDArray[Any] | pd.Series[Any] | pl.Series
_Motion: TypeAlias = Move | SCurve | Program | _Positions | tuple[_Positions, _Positions]
# A channel, or a channel and the factor to its unit.
_Columns: TypeAlias = Mapping[str, str | tuple[str, float]]
# An int, of Python or NumPy.
_Whole: TypeAlias = SupportsIndex
# Neurons of the hidden layers.
_Layers: TypeAlias = int | Sequence[int] | NDArray[np.integer[Any]]
# Position, speed, acceleration.
_Reference: TypeAlias = tuple[float, float, float]

@type_check_only
class _Frame(Protocol):
    # What pandas' and polars' frames have in common.
    @property
    def columns(self) -> Iterable[Any]: ...
    def __getitem__(self, name: Any, /) -> Any: ...

# A path, points in rows (m), or the text of a program in G-code.
_Toolpath: TypeAlias = Toolpath | str | Sequence[Sequence[float]] | NDArray[Any]
# A value and its standard error.
_Estimate: TypeAlias = tuple[float, float]

_Log: TypeAlias = _Path | Run | _Frame | Mapping[str, ArrayLike]

class FeedAxisError(ValueError):
    """What every error of this module is, but those that are Python's own: TypeError for what is of a wrong type, FileNotFoundError and other
    OSErrors for a file that cannot be read or written, ValueError for a number out of its range.

    Its words say what is wrong, where, and what would be valid.
    """
class AxisError(FeedAxisError):
    """An axis file, or a dict in its place, that makes no axis. The words name file, line and field, and what would be valid."""
class LogError(FeedAxisError):
    """A log of which no conclusion would be worth anything, or a channel that is not there."""
class LoopError(FeedAxisError):
    """Loops that cannot be analysed or tuned, or not as it was asked for."""
class MachineError(FeedAxisError):
    """A machine file, or axes in its place, that make no machine, or none for a path."""
class MotionError(FeedAxisError):
    """A motion that cannot be planned, or not on this axis."""
class NetworkError(FeedAxisError):
    """Samples, a network or a training that are not valid."""
class ParameterError(FeedAxisError):
    """A number outside its range: friction, beam or design."""
class SearchError(FeedAxisError):
    """A search that cannot be made as it was asked for."""
class SimulationError(FeedAxisError):
    """A run that did not come to its end: when, why, and in which state."""
class StrategyError(FeedAxisError):
    """A compensation, or an identification for one, that cannot be made for this axis."""

@final
class Axis:
    """A feed axis: mechanism, motor, control, sensors, friction and loads, checked once.

    Made by `load`, `from_toml` or `from_dict`; it cannot be changed afterwards.

    >>> axis = fa.Axis.load("data/axes/liu2025.toml")
    """

    @classmethod
    def load(cls, path: _Path) -> Axis:
        """Reads an axis file.

        Raises AxisError with file, line and what would be valid; FileNotFoundError, or another OSError, if the file cannot be read.
        """
    @classmethod
    def from_toml(cls, text: str, name: str = "<text>") -> Axis:
        """Reads the text of an axis file; `name` stands for the file in messages.

        Raises AxisError.
        """
    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Axis:
        """An axis from a dict with the keys of an axis file, as `to_dict` gives it.

        Raises AxisError.

        >>> values = axis.to_dict(); values["control"]["velocity_feedforward"] = 0.9
        >>> other = fa.Axis.from_dict(values)
        """
    def to_dict(self) -> dict[str, Any]:
        """The values of its file as a dict, to change and to give to `from_dict`."""
    def to_toml(self) -> str:
        """The text of its file."""
    @property
    def name(self) -> str:
        """Short name."""
    @property
    def description(self) -> str:
        """One line for people."""
    @property
    def period_s(self) -> float:
        """Control period, s."""
    @property
    def unit(self) -> Literal["m", "rad"]:
        """Unit of the load's position: "m", or "rad" if it turns."""
    @property
    def stroke(self) -> tuple[float, float, float]:
        """Least position, greatest position, and where motions start, m or rad."""
    @property
    def channels(self) -> list[str]:
        """Names of the channels that its runs and logs have, with their units as last part."""
    @property
    def trajectories(self) -> list[Move]:
        """The moves on which it is judged: those of `[[trajectory]]`."""
    @property
    def fingerprint(self) -> str:
        """Hash of all values: the same for files that differ in comments, units or order only."""
    def frequencies_hz(self, position: float | None = None) -> _Floats:
        """Natural frequencies without rigid motion, Hz, in an array of one dimension.

        `position`: of the load, m or rad; where motions start, if it is left out.

        Raises ParameterError.
        """
    def analyse(
        self,
        *,
        positions: ArrayLike | None = None,
        masses: ArrayLike | None = None,
        frictions: ArrayLike | None = None,
        delay_cycles: float = 0.0,
    ) -> dict[str, Any]:
        """Margins of the drive's sampled position and speed loops, with the load sliding and stuck, as plain dicts, lists and numbers.

        - `positions`: of the load, m or rad; start, ends and middle of the stroke, if left out.
        - `masses`: of the load, as shares of the file's; 0.9, 1 and 1.4, if left out.
        - `frictions`: as shares of the file's; 1, if left out.
        - `delay_cycles`: delay besides the file's, control cycles.

        Its keys are those of `feed-axis analyse --format json`: `worst` has the maximum sensitivities, `corners` the margins of each case,
        `curves` the frequency responses of the first two cases: `frequency_hz`, and pairs of real and imaginary part in `open_command`,
        `open_position`, `speed_followed` and `compliance` (the load's motion per force on it).

        Raises LoopError.

        >>> curve = axis.analyse()["curves"][0]
        >>> response = np.array(curve["compliance"]) @ [1, 1j]
        """
    def heat(
        self,
        motion: _Motion | None = None,
        *,
        duration_s: float = 3600.0,
        air_degc: float = 20.0,
        at_m: Sequence[float] | None = None,
        losses: Literal["reference", "simulation"] = "reference",
    ) -> dict[str, Any]:
        """Hours of a duty: temperatures, growth by position, friction and losses over time, by the file's `[thermal]`; what it leaves out is assumed.

        - `motion`: the duty, repeated without end; the file's first trajectory there and back, with standstills of 1 s, if left out.
        - `air_degc`: temperature of the air, and of the whole axis at the start.
        - `at_m`: positions of the table; five over the stroke if left out.
        - `losses`: from the reference alone, or from the motion simulated once in closed loop.

        Keys are those of `feed-axis heat --format json`: `time_min`, `nodes`, `places`, `loss_w`, `dry_factor`, `viscous_factor` and others.

        Raises MotionError, SimulationError.

        >>> hour = axis.heat(duration_s=3600, at_m=[0.95])
        >>> hour["places"][0]["screw_um"][-1]
        """
    def fit_heat(
        self,
        logs: _Log | Sequence[_Log],
        *,
        duties: Sequence[_Motion] | None = None,
        air_degc: float = 20.0,
        held_out: float = 0.25,
        probe_against: Literal["bearing", "bed"] = "bearing",
        probe_zero: Literal["begin", "first"] = "begin",
    ) -> tuple[Axis, dict[str, Any]]:
        """Fits the thermal model of a screw to logs of hours: the axis with the fitted `[thermal]`, and how well it predicts what was held out.

        - `logs`: a log or a list of them, each begun cold: paths, frames or dicts with the channels of `feed-axis heat --fit`
          (`t_s`; `duty_1` or `position_ref_m`; `place_m` and `growth_m`, or `position_m` and `motor_angle_rad`).
        - `duties`: motions that `duty_1` counts from 1.
        - `held_out`: last share of each log that is predicted, not fitted.
        - `probe_against`: what a probe reads growth against: the bed at the front bearing, or at the same position.
        - `probe_zero`: whether readings count from the log's begin or from the first at each position.

        Raises LogError, MotionError.

        >>> fitted, found = axis.fit_heat("data/heat/probed.csv", duties=duties)
        >>> found["fitted_numbers"]["greatest_um"]
        """
    def predict_growth(
        self,
        log: _Log,
        *,
        duties: Sequence[_Motion] | None = None,
        air_degc: float = 20.0,
        at_m: Sequence[float] | None = None,
        homed_s: float = 0.0,
        probe_each_s: float | None = None,
        probe_against: Literal["bearing", "bed"] = "bearing",
        probe_zero: Literal["begin", "first"] = "begin",
    ) -> dict[str, Any]:
        """Growth of the screw along a log of hours, from its reference alone, as a controller predicts it.

        - `at_m`: positions at which it is predicted.
        - `homed_s`: when the axis was homed, after the log's begin; growth counts from then.
        - `probe_each_s`: the readings of the log so far apart set the prediction right; the others check it.

        Other options as of `fit_heat`. Keys: the arrays `t_s`, `dry_factor`, `viscous_factor`; `growth_m`, at the reference if the log has one: what a
        correction subtracts from it, the growth of the screw on an axis that measures at the motor, of the scale on one that measures by it;
        a list of arrays `growth_at_m`, the growth of the screw at the positions `at_m`; and `figures` (errors of the readings).

        Raises LogError, MotionError.

        >>> along = fitted.predict_growth(log, at_m=[0.95])
        >>> corrected = reference - along["growth_m"]
        """
    def check(self, *, motion: _Motion | None = None, logs: _Log | Sequence[_Log] | None = None) -> list[dict[str, Any]]:
        """What a duty asks of the axis' parts, beside what the `[rating]` of its file allows: an item a dict.

        - `motion`: the duty, as of `simulate`, simulated once and taken as repeated without a pause; all trajectories of the file there and
          back, if neither this nor `logs` is set.
        - `logs`: the duty from a log or a list of logs: the load's position or the motor's angle, and a torque, force, current or the command of one.

        Keys of an item: `name`, `title`, `value`, `limit`, `unit`, `bound` ("at most" or "at least"), `margin` (at 1 the limit is just reached, below 1 exceeded),
        `verdict` ("ok", "over", "not known"), `give` (keys that would make it known). What is not known is None; what has no bound is `float("inf")`.

        Raises MotionError, SimulationError, LogError; AxisError if numbers of `[rating]` contradict each other.

        >>> over = [item["name"] for item in axis.check() if item["verdict"] == "over"]
        """
    def state_space(self, *, position: float | None = None, stuck: bool = False) -> dict[str, Any]:
        """The drive without its position and speed controllers, sampled once in each control period: x(k+1) = A x(k) + B u(k), y = C x + D u.

        - `position`: of the load, m or rad; where motions start, if left out.
        - `stuck`: whether the load's friction holds it by its bristles; it slides otherwise.

        Keys: the arrays `A`, `B`, `C` and `D`, the period `dt_s`, and the names and units of `inputs` (the command; a force against the load, held
        over the period) and `outputs` (position of the load, motor's angle and speed). Delays of the command and of the current loops are states.
        States have scales of their own. Three natural modes at most.

        Raises LoopError.

        >>> s = axis.state_space()
        >>> plant = control.ss(s["A"], s["B"], s["C"], s["D"], s["dt_s"])  # python-control
        """
    def frequency_response(
        self, *, position: float | None = None, stuck: bool = False, delay_cycles: float = 0.0
    ) -> dict[str, NDArray[Any]]:
        """Frequency responses of the loops, as complex arrays over `frequency_hz` (real).

        `position` and `stuck` as of `state_space`; `delay_cycles`: delay besides the file's, control cycles. Keys: `open_command` (the loop cut at
        the command), `open_position` (the position loop, its speed loop closed), `speed_followed` (the motor's speed per set point of the speed
        controller; empty of a PID controller), `compliance` (the load's motion per force on it, m/N or rad/(N·m)). They are those of `analyse`.

        Raises LoopError.

        >>> r = axis.frequency_response()
        >>> loop = control.frd(r["open_command"], 2 * np.pi * r["frequency_hz"])  # python-control
        """
    def tune(
        self,
        *,
        sensitivity: float = 1.6,
        sensitivity_late: float = 2.0,
        ripple: float = 0.02,
        positions: ArrayLike | None = None,
        masses: ArrayLike | None = None,
        frictions: ArrayLike | None = None,
        acceleration: bool = True,
        notch: bool = True,
        current: bool = False,
        frf: _Log | Sequence[_Log] | None = None,
    ) -> tuple[Axis, dict[str, Any]]:
        """Gains of the loops that hold the load best within limits of the sensitivity: the axis that has them, and what was found.

        - `sensitivity`: maximum sensitivity at the command and at the position, in every case.
        - `sensitivity_late`: the same with one more cycle of delay.
        - `ripple`: greatest ripple of the command by the steps of the speed's sensor, as a share of the greatest command (RMS).
        - `positions`, `masses`, `frictions`: the cases, as of `analyse`.
        - `acceleration`: whether the acceleration is fed forward; `notch`: whether a notch may be set; `current`: whether the current
          controllers are set too.
        - `frf`: a log or a list of logs of the excited axis, as of `frf`: the limits hold for the loops with the measured responses too,
          and the delay that they show is in the model's.

        What was found has the keys of `feed-axis tune --format json`: `keys` has the keys of the axis file that were set, `limiting` what
        limits the gains, `helps` what would help, `moves` the moves of the file simulated before and after.

        Raises LoopError, also for a measured response that must not be tuned on; LogError.

        >>> tuned, found = axis.tune(sensitivity=1.5)
        """
    def frf(
        self,
        logs: _Log | Sequence[_Log],
        *,
        columns: _Columns = ...,
        step_hz: float | None = None,
        coherence: float = 0.9,
        poles: _Whole = 10,
    ) -> list[dict[str, Any]]:
        """Frequency responses estimated from logs of the excited axis: a dict for each log.

        - `logs`: a log or a list of logs, one for each place of the load, with position, command and excitation (`excitation_a`,
          `excitation_n_m`, `excitation_n` or `drive_command_added_v`), every control cycle.
        - `columns`: channels of columns with other names, as of `discover`.
        - `step_hz`: distance of two lines; those of a periodic excitation, or 1.2 Hz, if left out.
        - `coherence`: least coherence of a line that counts. `poles`: most poles of the fit; a mode has two.

        Keys are those of an item of `measurements` of `feed-axis frf --format json`: `motor_speed` and `load` have the lines (`frequency_hz`,
        `value` as real and imaginary part, `deviation`, `coherence`), `fit` the modes, `margins` those with the gains of the file, `compliance`
        the motion of the load per force on it (`compliance_missing` why there is none), `comparison` what differs from the model, `traps` what is wrong with the measurement.

        Raises LoopError if no response can be estimated; LogError.

        >>> found = axis.frf("slide.parquet")[0]
        >>> delay_s = found["comparison"]["delay_s"]["value"]
        """
    def simulate(
        self,
        motion: _Motion,
        *,
        compensation: Compensator | Callable[[Sample], Correction] | None = None,
        noise: float = 0.0,
        exact: bool = False,
        seed: _Whole = 1,
        excitation: ArrayLike | None = None,
        progress: _Progress | None = None,
    ) -> Run:
        """Follows a motion in closed loop.

        - `motion`: a Move, an SCurve or a Program, in the unit of the axis; or an array of positions (m or rad), one each control period; or
          a tuple of arrays (t_s, positions), with instants evenly apart. Speed and acceleration of positions are those of a spline through
          them.
        - `compensation`: a Compensator, or a function that is called with each cycle's Sample and gives a Correction.
        - `noise`: noise of every sensor beside the axis file's own, in multiples of good sensors' noise, 0 or above.
        - `exact`: simulate by the slow, exact method, to stand for a machine.
        - `seed`: of the noise; the same seed gives the same bits.
        - `excitation`: numbers that are added to the command behind the controller, one for each control cycle from the first on, in the
          unit of the command; zeros if there are fewer. The run has them as a channel, such as `excitation_a`.
        - `progress`: called with (what, done, total) on this thread, at most every 50 ms; what it raises ends the work.

        Raises MotionError if the axis cannot take the motion, SimulationError if the run does not come to its end, ValueError for a noise below 0.

        >>> run = axis.simulate(axis.trajectories[0])
        """
    def sample(
        self,
        count: _Whole,
        *,
        seed: _Whole = 1,
        near_zero: bool = False,
        progress: _Progress | None = None,
    ) -> Samples:
        """Draws `count` one-cycle samples over a Latin hypercube of the axis' sample ranges.

        `near_zero` makes speeds denser near zero, where friction changes most. `progress` as of `simulate`.

        Raises NetworkError, also if the axis has neither `[samples]` nor trajectories.
        """
    def train(
        self,
        samples: Samples,
        *,
        hidden: _Layers = ...,
        epochs: _Whole = 500,
        seed: _Whole = 1,
        threads: _Whole = 0,
        progress: _Progress | None = None,
    ) -> Network:
        """Trains the one-cycle predictor: a network for what the best linear map of the samples leaves.

        `hidden`: neurons of the hidden layers, (34, 19, 8) if left out; `threads`: 0 for all cores, the result does not depend on it. `progress` as of `simulate`.

        Raises NetworkError.
        """
    def identify_friction(
        self,
        *,
        noise: float = 1.0,
        seed: _Whole = 0,
        progress: _Progress | None = None,
    ) -> LuGre:
        """Identifies the friction of this axis from simulated experiments: constant speeds and small motions about a standstill.

        `noise`: of scale, motor encoder and current sensor, in multiples of good sensors' noise. `progress` as of `simulate`.

        Raises StrategyError.
        """
    def identify_transfer(
        self, *, seed: _Whole = 0, progress: _Progress | None = None
    ) -> TransferFunctions:
        """Identifies transfer functions of this axis' tracking error from simulated moves.

        `progress` as of `simulate`.

        Raises StrategyError.
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Move:
    """A move from standstill to standstill, from where the axis' motions start.

    A move along a line is made by the constructor, one about an axis by `turn`. The properties of the other unit raise AttributeError.

    >>> move = fa.Move(distance_m=0.3, speed_m_s=0.1, acceleration_m_s2=0.225, jerk_m_s3=1.2)
    """

    def __new__(
        cls,
        *,
        distance_m: float,
        speed_m_s: float,
        acceleration_m_s2: float,
        jerk_m_s3: float,
    ) -> Self:
        """A move along a line: distance with its sign, and the greatest speed, acceleration and jerk.

        Raises MotionError for limits that are not finite and above 0.
        """
    @staticmethod
    def turn(
        *,
        distance_rad: float,
        speed_rad_s: float,
        acceleration_rad_s2: float,
        jerk_rad_s3: float,
    ) -> Move:
        """A move of an axis that turns, in rad.

        Raises MotionError.
        """
    @property
    def distance_m(self) -> float:
        """Distance with its sign, m."""
    @property
    def speed_m_s(self) -> float:
        """Greatest speed, m/s."""
    @property
    def acceleration_m_s2(self) -> float:
        """Greatest acceleration, m/s²."""
    @property
    def jerk_m_s3(self) -> float:
        """Greatest jerk, m/s³."""
    @property
    def distance_rad(self) -> float:
        """Distance with its sign, rad."""
    @property
    def speed_rad_s(self) -> float:
        """Greatest speed, rad/s."""
    @property
    def acceleration_rad_s2(self) -> float:
        """Greatest acceleration, rad/s²."""
    @property
    def jerk_rad_s3(self) -> float:
        """Greatest jerk, rad/s³."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class SCurve:
    """The move in least time between two standstills within limits of speed, acceleration and jerk.

    >>> fa.SCurve(0.0, 0.3, speed_m_s=0.1, acceleration_m_s2=0.225, jerk_m_s3=1.2).duration_s
    """

    def __new__(
        cls,
        start_m: float,
        end_m: float,
        *,
        speed_m_s: float,
        acceleration_m_s2: float,
        jerk_m_s3: float,
    ) -> Self:
        """From `start_m` to `end_m` along a line.

        Raises MotionError.
        """
    @staticmethod
    def turn(
        start_rad: float,
        end_rad: float,
        *,
        speed_rad_s: float,
        acceleration_rad_s2: float,
        jerk_rad_s3: float,
    ) -> SCurve:
        """The same of an axis that turns, in rad.

        Raises MotionError.
        """
    @property
    def duration_s(self) -> float:
        """Time from standstill to standstill, s."""
    def sample(self, period_s: float) -> dict[str, _Floats]:
        """The motion every `period_s`: a dict of arrays of one dimension and one length.

        Keys: `t_s`, `position_m`, `speed_m_s`, `acceleration_m_s2`, `jerk_m_s3`; of one that turns `position_rad` and so on.

        Raises MotionError for a period that is not above 0, or that gives more than 1e8 samples.
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Program:
    """Moves, dwells, sines and chirps one after the other: a motion program.

    >>> fa.Program.load("motion.toml").duration_s
    """

    @classmethod
    def load(cls, path: _Path) -> Program:
        """Reads a motion program (TOML).

        Raises MotionError; FileNotFoundError, or another OSError, if the file cannot be read.
        """
    @classmethod
    def from_toml(cls, text: str) -> Program:
        """Reads the text of a motion program.

        Raises MotionError.
        """
    def to_toml(self) -> str:
        """Its text, as `from_toml` reads it."""
    @property
    def duration_s(self) -> float:
        """Time from the first to the last instant, s."""
    def sample(self, period_s: float) -> dict[str, _Floats]:
        """The motion every `period_s`, as `SCurve.sample`."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Run:
    """A simulated run: its channels as NumPy arrays, by name.

    Arrays have one dimension, one number for each control cycle. They cannot be written to, so that a run stays what was simulated: change a
    copy. Runs are equal if all their samples are, to the bit.

    >>> run["position_m"]
    """

    def __getitem__(self, name: str, /) -> _Floats:
        """The samples of a channel; the same array each time, on the memory that the simulation filled.

        Raises KeyError with the names of the channels.
        """
    def __contains__(self, name: str, /) -> bool:
        """Whether there is a channel of that name."""
    def __len__(self) -> int:
        """Number of channels."""
    def __iter__(self) -> Iterator[str]:
        """The names of the channels."""
    def keys(self) -> list[str]:
        """Names of the channels; the last part of each is its unit."""
    @property
    def units(self) -> dict[str, str]:
        """Unit of each channel, by its name."""
    @property
    def cycles(self) -> int:
        """Number of control cycles."""
    @property
    def error(self) -> _Floats:
        """Tracking error, reference minus true position of the load, m or rad."""
    @property
    def error_unit(self) -> str:
        """Unit of the errors: "m", or "rad" if the load turns."""
    @property
    def max_error(self) -> float:
        """Greatest absolute tracking error, m or rad."""
    @property
    def mean_error(self) -> float:
        """Mean absolute tracking error, m or rad."""
    def to_pandas(self) -> pd.DataFrame:
        """The channels as a pandas DataFrame. Needs pandas; ImportError without."""
    def to_polars(self) -> pl.DataFrame:
        """The channels as a polars DataFrame. Needs polars; ImportError without."""
    def plot(self, *channels: str, ax: Axes | None = None) -> Axes:
        """Draws channels over time with matplotlib, into `ax` or a new figure; the tracking error if none is named.

        Raises KeyError for a channel that is not there, ImportError without matplotlib.

        >>> run.plot("position_ref_m", "position_m")
        """
    def to_html(self, path: _Path | None = None) -> str:
        """A page of the run as text, its tracking error and every channel over time; written to `path` too if given. One file, no network.

        Raises OSError if the file cannot be written.
        """
    def _repr_html_(self) -> str: ...
    def __eq__(self, other: object, /) -> bool: ...

@final
class Toolpath:
    """A path of two or three axes, in m.

    Points, a program, or one of the paths below. A path begins where the axes' motions begin.

    >>> path = fa.Toolpath.circle(0.05)
    >>> path = fa.Toolpath.gcode("G21 G90\\nF3000\\nG1 X20\\nG3 X30 Y10 I0 J10")
    """

    @staticmethod
    def circle(radius_m: float, *, tilt_rad: float | None = None) -> Toolpath:
        """A circular test about the origin, run in both directions: half a turn in, one that counts, half a turn out. Tilted about X it needs
        three axes.

        Raises MotionError for a radius that is not above 0.
        """
    @staticmethod
    def butterfly() -> Toolpath:
        """The butterfly: a NURBS curve of 383 mm with tips of 0.02 mm radius, on which feed planners are compared."""
    @staticmethod
    def nurbs(points_m: ArrayLike, knots: ArrayLike, *, degree: int = 3, weights: ArrayLike | None = None) -> Toolpath:
        """A NURBS curve: control points in rows of 2 or 3 coordinates (m), as many knots as points plus degree plus 1; weights of 1 if left out.

        Raises MotionError for numbers that are no curve.
        """
    @staticmethod
    def points(
        points_m: ArrayLike, *, blend_m: float | None = None, blend_shape: Literal["quintic", "arc", "parabola"] = "quintic"
    ) -> Toolpath:
        """Straight lines through points, a row of 2 or 3 coordinates (m) each. The feed stops at every corner, unless `blend_m` blends it within
        this distance; at the ends of an arc or a parabola it stops too, unless `acceleration_step` allows a step.

        Raises MotionError for fewer than two points, or two alike that follow one another.
        """
    @staticmethod
    def gcode(
        text: str, *, blend_m: float | None = None, blend_shape: Literal["quintic", "arc", "parabola"] = "quintic"
    ) -> Toolpath:
        """A program in G-code (G0 to G3), from its text; it begins at the origin. `blend_m` is the tolerance before the first G61 or G64 P,
        `blend_shape` that of all blends.

        Raises MotionError with the line, and what would be valid.
        """
    @classmethod
    def load(
        cls, path: _Path, *, blend_m: float | None = None, blend_shape: Literal["quintic", "arc", "parabola"] = "quintic"
    ) -> Toolpath:
        """A program in G-code, from a file; blends as in `gcode`.

        Raises MotionError as `gcode`, FileNotFoundError or another OSError if the file cannot be read.
        """
    @property
    def name(self) -> str:
        """What it is called."""
    @property
    def length_m(self) -> float:
        """Length, m; of a program that of all its parts, of a circular test that of one turn."""
    def positions(self, count: int = 1000) -> _Floats:
        """Positions at even steps of the arc length, shape (count, 2 or 3), m; of a circular test one turn.

        Raises MotionError for fewer than two.
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Machine:
    """Two or three axes that carry a tool along a path, and what lies between them.

    >>> machine = fa.Machine("data/machines/liu2025-xy.toml")
    >>> machine = fa.Machine([fa.new("linear-motor", "x"), fa.new("belt", "y")])
    """

    def __new__(
        cls,
        axes: _Path | Sequence[Axis] | Mapping[str, Axis],
        *,
        name: str | None = None,
        coupling: Sequence[Mapping[str, Any]] | None = None,
        base: Sequence[Mapping[str, Any]] | None = None,
        gantry: Sequence[Mapping[str, Any]] | None = None,
    ) -> Machine:
        """Of a machine file, or of two or three axes in their order, or by "x", "y" and "z". `coupling`, `base` and `gantry` have the keys of
        the tables of a machine file; the "second" of a gantry is an Axis.

        Raises MachineError for what is no machine, AxisError for an axis file, FileNotFoundError or another OSError if a file cannot be read.

        >>> machine = fa.Machine([x, y], coupling=[{"of": "x", "by": "y", "squareness_um_per_m": 20}])
        """
    @classmethod
    def load(cls, path: _Path) -> Machine:
        """Reads a machine file.

        Raises as the constructor.
        """
    @property
    def name(self) -> str:
        """Short name."""
    @property
    def axes(self) -> list[Axis]:
        """The axes of x, y and, of three, z."""
    @property
    def drives(self) -> list[Axis]:
        """The drives in the order of their compensations: of each axis its own, then the second of a gantry."""
    def contour(
        self,
        path: _Toolpath,
        *,
        feed: float = 0.05,
        compensation: str | Sequence[Compensator] | None = None,
        laps: int = 1,
        correct: bool | CirclesFound | None = None,
        feeds: ArrayLike | None = None,
        acceleration: float = 1.0,
        jerk: float = 20.0,
        acceleration_step: float = 0.0,
        rapid: float = 0.25,
        noise: float = 0.0,
        seed: int = 1,
        progress: _Progress | None = None,
    ) -> Contour:
        """Runs the machine along a path; of a circle in both directions.

        `feed` is along the path, m/s; of a program before its first F. `acceleration` (m/s²) and `jerk` (m/s³) limit each axis;
        `acceleration_step` (m/s²) is allowed where the curvature jumps, with 0 the feed stops there; `rapid` is the feed of G0, m/s.
        `compensation` is the name of a strategy that needs nothing else (`STRATEGIES`), or a Compensator for each of `drives`. One that learns
        goes on from lap to lap. `correct=True` takes squareness, straightness and cross-talk of the machine file off the references; what
        `identify` found may be passed instead. `feeds` (m/s) makes a table of feed against error. `noise` is that of the sensors in multiples of
        good ones. `progress("laps", done, total)`.

        Raises MotionError for a path or limits, StrategyError for a compensation, MachineError if the path has more coordinates than
        the machine has axes, SimulationError if an axis stops.

        >>> contour = machine.contour(fa.Toolpath.circle(0.05), compensation="adaptive-feedback", laps=2, noise=1)
        """
    def identify(
        self,
        feeds: ArrayLike,
        *,
        radius: float = 0.05,
        compensation: str | Sequence[Compensator] | None = None,
        acceleration: float = 1.0,
        jerk: float = 20.0,
        noise: float = 0.0,
        seed: int = 1,
        progress: _Progress | None = None,
    ) -> CirclesFound:
        """Squareness and cross-talk of X and Y from simulated circular tests at several feeds (m/s), in both directions.

        Raises SearchError if the circles do not tell them apart, as at one feed; else as `contour`.

        >>> found = machine.identify([0.05, 0.167], compensation="plan", noise=1)
        >>> better = machine.contour(fa.Toolpath.circle(0.05), compensation="plan", correct=found)
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Contour:
    """A machine on a path: figures of all laps, and the last lap as arrays by direction.

    Directions are "clockwise" and "counterclockwise" of a circle, one of another path.

    >>> contour["clockwise"]["error_m"]
    """

    def __getitem__(self, direction: str, /) -> dict[str, _Floats]:
        """The counted part of the last lap in one direction, an array each: "s_m" (arc length), "error_m" (distance from the path), "x_m", "y_m"
        and, in space, "z_m" of the tool, "foot_x_m" and so on of the nearest point of the path; of a circle also "angle_rad" (from +X towards +Y, in its
        plane, 0 to 2 pi) and "deviation_m" (radial).

        Raises KeyError with the directions.
        """
    def __contains__(self, direction: str, /) -> bool:
        """Whether there is a direction of that name."""
    def __len__(self) -> int:
        """Number of directions."""
    def __iter__(self) -> Iterator[str]:
        """The directions."""
    def keys(self) -> list[str]:
        """The directions."""
    @property
    def max_error(self) -> float:
        """Greatest contour error of the last lap, m."""
    @property
    def laps(self) -> list[dict[str, Any]]:
        """Contour error of every lap: "direction", "lap" (from 1), "max_error_m", "p99_error_m" (99 % are below), "rms_error_m"."""
    @property
    def figures(self) -> dict[str, Any] | None:
        """Figures of a circular test in the manner of ISO 230-4, last lap: "clockwise" and "counterclockwise", each with "g_m" (circular
        deviation G), "f_max_m" and "f_min_m" (radial deviation F); of both "g_bidirectional_m" (G(b)), "h_m" (circular hysteresis H) and "d_m"
        (mean bidirectional radial deviation D). None of another path."""
    @property
    def reversals(self) -> list[dict[str, Any]]:
        """Peaks of the radial deviation after an axis of a circle has reversed, last lap: "direction", "axis", "angle_rad", "peak_m"."""
    @property
    def corners(self) -> list[dict[str, Any]]:
        """Corners, last lap: "part", "s_m", "angle_rad", "error_m" (greatest within 0.5 mm)."""
    @property
    def curves(self) -> list[dict[str, Any]]:
        """Tightest curves, last lap: "part", "s_m", "radius_m", "error_m" (greatest within 0.5 mm)."""
    @property
    def feeds(self) -> list[dict[str, Any]]:
        """Feed against error: "feed_m_s", "fastest_m_s" (reached), "duration_s", "first_max_error_m", "last_max_error_m" (first, last lap)."""
    @property
    def duration_s(self) -> float:
        """Time of one lap in one direction, run-in and run-out included, s."""
    @property
    def radius_m(self) -> float | None:
        """Radius of a circular test, m; None of another path."""
    def to_pandas(self) -> pd.DataFrame:
        """The last lap of all directions as a pandas DataFrame: "direction" and the arrays. Needs pandas; ImportError without."""
    def to_polars(self) -> pl.DataFrame:
        """The last lap of all directions as a polars DataFrame. Needs polars; ImportError without."""
    def plot(self, ax: Axes | None = None) -> Axes:
        """Draws the last lap with matplotlib, into `ax` or a new figure: of a circle the radial deviation over the angle (`ax` may be polar), else
        the contour error along the path. Needs matplotlib; ImportError without."""
    def to_html(self, path: _Path | None = None) -> str:
        """The page that `contour --report` writes, as text; written to `path` too if given.

        Raises OSError if the file cannot be written.
        """
    def _repr_html_(self) -> str: ...
    def __eq__(self, other: object, /) -> bool: ...

@final
class CirclesFound:
    """What circular tests show of two axes: each value with its standard error, as if the residuals were independent."""

    @property
    def squareness(self) -> _Estimate:
        """Squareness error of both axes, rad (m/m): X moves so far per travel of Y."""
    @property
    def crosstalk(self) -> _Estimate:
        """Cross-talk, m/(m/s²): of X by the acceleration of Y and of Y by that of X together."""
    @property
    def centre(self) -> tuple[_Estimate, _Estimate]:
        """Centre less the nominal one, m."""
    @property
    def radius(self) -> _Estimate:
        """Radius less the nominal one, m."""
    @property
    def lag(self) -> _Estimate | None:
        """Lag of Y less that of X, s; None if all circles had one direction."""
    @property
    def residual(self) -> float:
        """Root mean square of the radial residuals, m."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

def fit_circles(
    circles: Sequence[tuple[float, Literal["clockwise", "counterclockwise"], ArrayLike]],
    *,
    radius: ArrayLike,
    centre: tuple[float, float] | None = None,
) -> CirclesFound:
    """Squareness and cross-talk of two axes from measured circles, as of a ball bar or a grid encoder: feed (m/s), direction and points (m, in rows
    of x and y, evenly over the turn) of each. `radius` is the nominal one (m), or one for each circle; `centre` the
    nominal one (m), the origin if left out.

    Raises SearchError if the circles do not tell them apart, as at one feed.

    >>> found = fa.fit_circles([(0.05, "clockwise", slow), (0.167, "clockwise", fast)], radius=0.05)
    """

@final
class Parameter:
    """A number of an effect, with its 95 % interval."""

    @property
    def name(self) -> str:
        """Name, as in the axis file."""
    @property
    def value(self) -> float:
        """Estimate, in `unit`."""
    @property
    def unit(self) -> str:
        """SI unit."""
    @property
    def interval(self) -> tuple[float, float]:
        """95 % interval: from, to."""

@final
class Effect:
    """An effect that was named."""

    @property
    def name(self) -> str:
        """Name, as in the axis file."""
    @property
    def summary(self) -> str:
        """One line for people."""
    @property
    def parameters(self) -> list[Parameter]:
        """Its numbers."""
    @property
    def indistinguishable_from(self) -> list[str]:
        """Effects that these logs cannot tell from it."""
    @property
    def channel(self) -> str:
        """Where it shows first, such as "torque balance"."""
    @property
    def share_of_gap(self) -> float:
        """Share of the check logs' gap that comes back without it."""

@final
class Discovery:
    """What a model lacks: verdict, effects with their sizes, words, and the model with them."""

    @property
    def verdict(
        self,
    ) -> Literal["explained", "partly-explained", "other-form", "nothing-missing", "unknown"]:
        """"explained", "partly-explained", "other-form", "nothing-missing" or "unknown"."""
    @property
    def effects(self) -> list[Effect]:
        """The named effects, largest share of the gap first."""
    @property
    def names(self) -> list[str]:
        """Their names."""
    @property
    def size(self) -> float | None:
        """First number of the first effect, SI; None if nothing was named."""
    @property
    def interval(self) -> tuple[float, float] | None:
        """Its 95 % interval; None if nothing was named."""
    @property
    def unit(self) -> str | None:
        """Its unit; None if nothing was named."""
    @property
    def sentence(self) -> str:
        """The verdict in a sentence."""
    @property
    def words(self) -> str:
        """The sentence, and what the command prints beside it."""
    @property
    def notes(self) -> list[str]:
        """What was done to the logs, and what must be known of them."""
    @property
    def gap(self) -> list[tuple[str, float, float, float]]:
        """RMS gap on motion that was not fitted to: for each channel its name, before, after, and noise, in its SI unit."""
    @property
    def axis(self) -> Axis:
        """The axis with what was found added to it."""
    @property
    def next_experiment(self) -> Program | None:
        """The motion to record next if effects look alike; None otherwise."""
    def to_dict(self) -> dict[str, Any]:
        """All of it, as `discovery.json` of the command has it."""
    def to_pandas(self) -> pd.DataFrame:
        """The numbers of the effects as a pandas DataFrame, a row each: effect, parameter, value, 95 % interval (from, to), unit.

        Needs pandas; ImportError without.
        """
    def plot(self, *, ax: Axes | None = None) -> Axes:
        """Draws the RMS gap before and after, and the noise, for each channel, with matplotlib, into `ax` or a new figure.

        Raises ImportError without matplotlib.
        """
    def to_html(self, path: _Path | None = None) -> str:
        """The page that the command `discover` writes, as text; written to `path` too if given. One file, no network.

        Raises OSError if the file cannot be written.
        """
    def _repr_html_(self) -> str: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

def discover(
    axis: Axis,
    fit: Sequence[_Log],
    check: Sequence[_Log],
    *,
    test: Sequence[_Log] = ...,
    accept: Sequence[str] = ...,
    reject: Sequence[str] = ...,
    balance: bool = False,
    columns: _Columns = ...,
    progress: _Progress | None = None,
) -> Discovery:
    """Finds what an axis' model lacks beside measured logs.

    - `fit`: logs to fit to.
    - `check`: logs of other motion, on which what is named must prove itself.
    - `test`: logs that take no part in any choice, for the figures.
    - `accept`, `reject`: names of effects that are taken as present, or never named.
    - `balance`: compare by torque balance, without the controller.
    - `columns`: of frames and dicts whose columns have other names than their channels: `{"time": "t_s", "x": ("position_m", 1e-3)}` says
      which channel a column is, and by which factor its numbers come to the channel's unit. Columns that it does not name count if their
      names are channels', and are left out otherwise.
    - `progress`: called with (what, stage, None).

    A log is a path (`a.csv+b.csv` is one log in two files), a pandas or polars frame, a Run, or a dict of arrays. A path is read as
    the axis file's `[log]` maps its columns; the others have channels as names, `t_s` among them, and NaN, or a mask, for missing values.

    Raises LogError for a log of which no conclusion would be worth anything, SearchError for an unknown effect, AxisError, FileNotFoundError. Ctrl-C raises at
    once; the search itself ends at its next stage.

    >>> fa.discover(axis, fit=["fit.csv"], check=["check.csv"]).names
    """

@final
class Sample:
    """What a controller knows at the start of a control cycle. SI units, at the load; rad for m on an axis that turns.

    - `reference`, `next_reference`: position, speed and acceleration of the reference now and one cycle ahead.
    - `position_m`: measured position of the load.
    - `motor_angle_rad`, `motor_speed_rad_s`: measured.
    - `iq_a`: measured q current; 0 if the actuator has none.
    - `last_command`: command of the cycle before, in the actuator's unit.
    """

    reference: _Reference
    next_reference: _Reference
    position_m: float
    motor_angle_rad: float
    motor_speed_rad_s: float
    iq_a: float
    last_command: float
    def __new__(
        cls,
        *,
        reference: ArrayLike = ...,
        next_reference: ArrayLike = ...,
        position_m: float = 0.0,
        motor_angle_rad: float = 0.0,
        motor_speed_rad_s: float = 0.0,
        iq_a: float = 0.0,
        last_command: float = 0.0,
    ) -> Self:
        """A sample of these values; a reference is any three numbers."""
    def __eq__(self, other: object, /) -> bool: ...

@final
class Correction:
    """What is added to the controller in a cycle.

    >>> run = axis.simulate(axis.trajectories[0], compensation=lambda sample: fa.Correction(command=0.1))
    """

    def __new__(cls, position_m: float = 0.0, command: float = 0.0) -> Self:
        """Position (m or rad) and command (A, N·m, N or V, as the actuator takes) to add."""
    @property
    def position_m(self) -> float:
        """Added to the position error, m or rad."""
    @property
    def command(self) -> float:
        """Added to the speed controller's command, in the actuator's unit: A, N·m, N or V."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Compensator:
    """A compensation strategy on an axis.

    Equal are compensators of one strategy on equal axes with equal predictors. A copy, or one from a pickle, has not begun a motion, whatever
    the original is doing.

    >>> plan = fa.Compensator(axis, "plan")
    >>> run = axis.simulate(axis.trajectories[0], compensation=plan)
    """

    def __new__(
        cls,
        axis: Axis,
        strategy: str,
        *,
        network: Network | None = None,
        transfer: TransferFunctions | None = None,
        friction: LuGre | None = None,
        correction: MoveCorrection | None = None,
        motion: _Motion | None = None,
    ) -> Self:
        """The strategy of that name (a key of `STRATEGIES`), with what it needs.

        `network` is of `Axis.train`, `transfer` of `Axis.identify_transfer`, `friction` of `Axis.identify_friction` or `identify`,
        `correction` of `learn`, for a strategy that plans. With `motion` it is started.

        Raises StrategyError for an unknown name or for what is missing.
        """
    def start(self, motion: _Motion) -> None:
        """Begins a motion from standstill: the next `update` is its first cycle.

        Raises MotionError or StrategyError.
        """
    def update(self, sample: Sample) -> Correction:
        """The correction for the cycle that begins with this sample.

        Raises StrategyError if no motion was begun.
        """
    def export(
        self,
        folder: _Path,
        *,
        target: Literal["c", "linuxcnc", "onnx"] = "c",
        name: str | None = None,
        precision: Literal["f32", "f64"] = "f64",
        limit_position: float | None = None,
        limit_command: float | None = None,
        limit_surprise: float | None = None,
        patience_s: float = 0.002,
        fade_s: float = 0.1,
    ) -> list[str]:
        """Writes the strategy for a controller into a folder that exists, and gives the paths of the files.

        - `target`: "c" (C99 without allocation: NAME.h, NAME.c), "linuxcnc" (NAME.comp, NAME.hal), or "onnx" (the one-cycle network of the
          strategy alone: NAME.onnx).
        - `name`: of files, types and functions; the strategy's (of ONNX "network"), if left out.
        - `precision`: of the C code's numbers.
        - `limit_position` (m or rad), `limit_command` (A, N·m, N or V), `limit_surprise` (standard deviations; of the strategy "feedback"): at
          what the guard trips. The axis' own, if left out and the axis has them.
        - `patience_s`: how long a limit may be exceeded; `fade_s`: time in which corrections are faded in and out.

        Raises StrategyError for a strategy that no controller can run, or a limit that is missing; ValueError; OSError.

        >>> fa.Compensator(axis, "plan").export(".", target="linuxcnc", name="x_plan")
        """
    @property
    def strategy(self) -> str:
        """Name of the strategy."""
    def __eq__(self, other: object, /) -> bool: ...

@final
class TransferFunctions:
    """Linear models of an axis' tracking error, without and with friction feed-forward. Made by `Axis.identify_transfer`."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Samples:
    """One-cycle samples: state and command at the start of a cycle, and how far the load went. Made by `Axis.sample`."""

    def __len__(self) -> int:
        """Number of samples."""
    @property
    def inputs(self) -> _Floats:
        """Position (m), speed (m/s), acceleration (m/s²) and commanded current (A): an array of shape (samples, 4)."""
    @property
    def increments_m(self) -> _Floats:
        """How far the load went in the cycle, m: an array of shape (samples,)."""
    def __eq__(self, other: object, /) -> bool: ...

@final
class Network:
    """A cascade-forward network."""

    @classmethod
    def train(
        cls,
        x: ArrayLike,
        y: ArrayLike,
        *,
        hidden: _Layers = ...,
        epochs: _Whole = 100,
        seed: _Whole = 1,
        threads: _Whole = 0,
        progress: _Progress | None = None,
    ) -> Network:
        """Trains by Levenberg–Marquardt.

        - `x`, `y`: inputs and targets, of shapes (samples, inputs) and (samples, outputs); of one variable also of one dimension.
        - `hidden`: neurons of the hidden layers, 10 if left out.
        - `threads`: 0 for all cores; the result does not depend on it.
        - `progress`: called with ("train", epoch, epochs).

        Raises NetworkError.

        >>> network = fa.Network.train(x, y, hidden=[20, 10], epochs=200)
        """
    @classmethod
    def load(cls, path: _Path) -> Network:
        """Reads a network's file, also one of the stage `train`.

        Raises NetworkError; FileNotFoundError, or another OSError, if the file cannot be read.
        """
    def predict(self, x: ArrayLike) -> _Floats:
        """The outputs for inputs `x` of shape (samples, inputs): an array of shape (samples, outputs).

        One row, or inputs of one variable, may have one dimension. Raises NetworkError for another number of inputs.
        """
    def test(self, samples: Samples) -> tuple[float, float]:
        """Maximum and mean absolute error on one-cycle samples, µm or µrad. Raises NetworkError."""
    def save(self, path: _Path) -> None:
        """Writes the network to a file that `load` reads.

        Raises OSError if the file cannot be written.
        """
    def to_onnx(
        self, path: _Path, *, inputs: Sequence[str] | None = None, outputs: Sequence[str] | None = None
    ) -> None:
        """Writes the network as an ONNX file, in double precision.

        `inputs`, `outputs`: names for its description, one each; x1, x2 … and y1, y2 … if left out. Raises NetworkError for another number of
        names, OSError if the file cannot be written.
        """
    def to_bytes(self) -> bytes:
        """The network as bytes with a hash: what `save` writes."""
    @property
    def losses(self) -> _Floats:
        """Mean square of the scaled residuals after each epoch; empty for a network from a file."""
    @property
    def shape(self) -> tuple[int, list[int], int]:
        """Number of inputs, neurons of each hidden layer, number of outputs."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class LuGre:
    """LuGre friction: bristles, Stribeck curve, viscous share. For a contact that slides along a line read N for N·m and m for rad.

    >>> fa.LuGre.liu2025().steady_state([0.1, 1.0, 10.0])
    """

    def __new__(
        cls,
        *,
        coulomb_n_m: float,
        stiction_n_m: float,
        stribeck_speed_rad_s: float,
        stiffness_n_m_rad: float,
        damping_n_m_s_rad: float,
        viscous_n_m_s_rad: float,
    ) -> Self:
        """A law of these parameters.

        Raises ParameterError.
        """
    @classmethod
    def liu2025(cls) -> LuGre:
        """The parameters that Liu et al. 2025 print, at the screw of their axis."""
    @property
    def coulomb_n_m(self) -> float:
        """Coulomb level T_C, N·m."""
    @property
    def stiction_n_m(self) -> float:
        """Break-away torque T_S, N·m."""
    @property
    def stribeck_speed_rad_s(self) -> float:
        """Stribeck speed Ω_S, rad/s."""
    @property
    def stiffness_n_m_rad(self) -> float:
        """Stiffness of the bristles σ0, N·m/rad."""
    @property
    def damping_n_m_s_rad(self) -> float:
        """Damping of the bristles σ1, N·m·s/rad."""
    @property
    def viscous_n_m_s_rad(self) -> float:
        """Viscous friction σ2, N·m·s/rad."""
    def steady_state(self, speed_rad_s: ArrayLike) -> _Floats:
        """Friction at constant speeds (rad/s), N·m: an array of one dimension. Raises ParameterError."""
    def simulate(self, speed_rad_s: ArrayLike, dt_s: float) -> _Floats:
        """Friction (N·m) along speeds (rad/s) that lie `dt_s` apart, linear between; bristles at rest at the first.

        Raises ParameterError.
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class GeneralLuGre:
    """LuGre friction with levels by direction, an exponent of the Stribeck curve and viscous friction of second and third order: the keys of `friction` in an axis file. For a contact that slides along a line read N for N·m and m for rad.

    The friction at constant speed v is g sign v + k₁ v + k₂ v |v| + k₃ v³, with g = F_C + (F_S − F_C) exp(−(|v|/v_S)^δ).

    >>> bristles = {"stribeck_speed_rad_s": 0.3, "stiffness_n_m_rad": 2e3, "damping_n_m_s_rad": 1.0, "viscous_n_m_s_rad": 0.02}
    >>> law = fa.GeneralLuGre(coulomb_n_m=1.0, stiction_n_m=1.5, coulomb_backward_n_m=1.2, **bristles)
    >>> law.steady_state([-10.0, 10.0])
    """

    def __new__(
        cls,
        *,
        coulomb_n_m: float,
        stiction_n_m: float,
        stribeck_speed_rad_s: float,
        stiffness_n_m_rad: float,
        damping_n_m_s_rad: float,
        viscous_n_m_s_rad: float,
        coulomb_backward_n_m: float | None = None,
        stiction_backward_n_m: float | None = None,
        stribeck_exponent: float = 2.0,
        viscous_quadratic_n_m_s2_rad2: float = 0.0,
        viscous_cubic_n_m_s3_rad3: float = 0.0,
    ) -> Self:
        """A law of these parameters. Levels at negative speeds are those at positive ones, if left out.

        Raises ParameterError.
        """
    @property
    def coulomb_n_m(self) -> float:
        """Coulomb level at positive speeds, N·m."""
    @property
    def stiction_n_m(self) -> float:
        """Break-away level at positive speeds, N·m."""
    @property
    def coulomb_backward_n_m(self) -> float:
        """Coulomb level at negative speeds, a positive number, N·m."""
    @property
    def stiction_backward_n_m(self) -> float:
        """Break-away level at negative speeds, a positive number, N·m."""
    @property
    def stribeck_speed_rad_s(self) -> float:
        """Stribeck speed, rad/s."""
    @property
    def stribeck_exponent(self) -> float:
        """Exponent δ of the Stribeck curve."""
    @property
    def stiffness_n_m_rad(self) -> float:
        """Stiffness of the bristles σ0, N·m/rad."""
    @property
    def damping_n_m_s_rad(self) -> float:
        """Damping of the bristles σ1, N·m·s/rad."""
    @property
    def viscous_n_m_s_rad(self) -> float:
        """Viscous friction of first order k₁, N·m·s/rad."""
    @property
    def viscous_quadratic_n_m_s2_rad2(self) -> float:
        """Viscous friction of second order k₂, N·m·s²/rad²."""
    @property
    def viscous_cubic_n_m_s3_rad3(self) -> float:
        """Viscous friction of third order k₃, N·m·s³/rad³."""
    def steady_state(self, speed_rad_s: ArrayLike) -> _Floats:
        """Friction at constant speeds (rad/s), N·m: an array of one dimension. Raises ParameterError."""
    def simulate(self, speed_rad_s: ArrayLike, dt_s: float) -> _Floats:
        """Friction (N·m) along speeds (rad/s) that lie `dt_s` apart, linear between; bristles at rest at the first.

        Raises ParameterError.
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class MoveCorrection:
    """What was learned of a move: where its load is to be led besides, cycle by cycle. `learn` makes it, `Compensator` uses it.

    >>> correction, found = fa.learn(axis, axis.simulate(move, compensation=plan))
    >>> better = fa.Compensator(axis, "plan", correction=correction)
    """

    @classmethod
    def load(cls, path: _Path) -> MoveCorrection:
        """Reads a correction, also one that the command `learn` has written.

        Raises StrategyError; FileNotFoundError, or another OSError, if the file cannot be read.
        """
    def save(self, path: _Path) -> None:
        """Writes it to a file that `load` and the command read. Raises OSError if the file cannot be written."""
    @property
    def rounds(self) -> int:
        """Rounds of learning so far."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

def learn(
    axis: Axis, log: _Log, correction: MoveCorrection | None = None, *, columns: _Columns = ...
) -> tuple[MoveCorrection, dict[str, Any]]:
    """The next correction of a move, from the log of a repetition that was made with `correction`; and what was found.

    The log holds time, reference and position of the load. Found are `rounds`, the tracking error in m or rad (`max_error`, of which
    `learnable_rms` can be learned and `noise_rms` is noise), and `advice`: "again", "done", "enough" or "restarted".

    Raises LogError, StrategyError.

    >>> correction, found = fa.learn(axis, run)
    """

def identify(
    axis: Axis, logs: Sequence[_Log], *, columns: _Columns = ...
) -> tuple[LuGre, dict[str, Any]]:
    """Identifies the friction of an axis from logs of its own runs: constant speeds in both directions, small motions about a standstill.

    `parameters` of what was found has each value with its 95 % interval, `None` if the logs do not tell it; `notes` has words.

    Raises LogError with what the logs lack.

    >>> friction, found = fa.identify(axis, ["slow.csv", "fast.csv"])
    """

def identify_control(
    axis: Axis,
    fit: Sequence[_Log],
    check: Sequence[_Log],
    *,
    frequency_hz: float | None = None,
    columns: _Columns = ...,
) -> tuple[Axis, dict[str, Any]]:
    """Estimates structure, gains and delay of an unknown controller from logs: the axis with that controller, and what was found.

    - `fit`, `check`: logs with reference, position and command, to fit to and to choose the structure by.
    - `frequency_hz`: control frequency; required if the axis has no control.

    Found are `controller` in words, `gains` with their 95 % intervals by the keys of the axis file, `command_delay_s`, the shares of the command
    that are explained (`explained_fit`, `explained_check`), `not_determined`, `notes`.

    Raises LogError, SearchError, AxisError.

    >>> axis, found = fa.identify_control(axis, ["fit.csv"], ["check.csv"], frequency_hz=1000)
    """

@final
class Beam:
    """A round solid shaft of Timoshenko elements.

    >>> fa.Beam(length_m=1.5, diameter_m=0.04).frequencies_hz(8)
    """

    def __new__(
        cls,
        *,
        length_m: float,
        diameter_m: float,
        elements: _Whole = 10,
        youngs_modulus_pa: float = 206e9,
        poisson_ratio: float = 0.3,
        density_kg_m3: float = 7850.0,
    ) -> Self:
        """A shaft; the default material is steel.

        Raises ParameterError.
        """
    def frequencies_hz(
        self, count: _Whole, *, supports: Literal["free", "pinned"] = "free"
    ) -> _Floats:
        """The `count` lowest natural frequencies, Hz; the rigid motions of a free beam are among them, as 0.

        `supports`: "free", or "pinned", where both ends hold deflection, stretch and twist. Raises ParameterError.
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

def examples() -> dict[str, Axis]:
    """Axes to begin with, by kind: "liu2025" is the paper's, the others are one for each mechanism.

    >>> fa.examples()["belt"]
    """

def new(kind: str, name: str | None = None) -> Axis:
    """The example of a kind (a key of `examples()`), under a name of one's own.

    Raises AxisError for an unknown kind.

    >>> axis = fa.new("ball-screw", "x-axis")
    >>> Path("x-axis.toml").write_text(axis.to_toml())
    """

def latin_hypercube(
    n: _Whole,
    bounds: ArrayLike,
    *,
    seed: _Whole = 1,
    centred: bool = False,
) -> _Floats:
    """`n` points between bounds: each of the n intervals of each variable holds exactly one. An array of shape (n, variables).

    `bounds`: least and greatest value of each variable, of shape (variables, 2). `centred` puts points into the middle of their intervals.

    Raises ParameterError.

    >>> fa.latin_hypercube(5, [(0.0, 1.0), (-1.0, 1.0)])
    """

def sobol(
    n: _Whole,
    bounds: ArrayLike,
    *,
    scrambling: Literal["owen", "linear-matrix"] | None = "owen",
    seed: _Whole = 1,
    start: _Whole = 0,
) -> _Floats:
    """`n` points of Sobol's sequence between bounds, from point `start` on: even in several variables together, for means over the points. An array of shape (n, variables).

    `bounds`: least and greatest value of each variable, of shape (variables, 2); at most 1024 variables. `scrambling`: `owen` flips each digit
    at random, `linear-matrix` does so by a random matrix and is made faster, None is the plain sequence, which begins at the least values. Take a power of two of the
    points, and the first among them.

    Raises ParameterError.

    >>> points = fa.sobol(1024, [(0.0, 1.0), (-1.0, 1.0)])
    >>> more = fa.sobol(1024, [(0.0, 1.0), (-1.0, 1.0)], start=1024)
    """

def halton(
    n: _Whole,
    bounds: ArrayLike,
    *,
    scrambled: bool = True,
    seed: _Whole = 1,
    start: _Whole = 0,
) -> _Floats:
    """`n` points of Halton's sequence between bounds, from point `start` on: any number of points is as good as the next. An array of shape (n, variables).

    `bounds`: least and greatest value of each variable, of shape (variables, 2); at most 1024 variables. `scrambled` permutes the digits of each variable at random;
    the plain sequence begins at the least values, and has bands in more than about ten variables.

    Raises ParameterError.

    >>> fa.halton(500, [(0.0, 1.0), (-1.0, 1.0)])
    """
