"""Types of the compiled module. SI units throughout; the last part of a name is its unit."""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, Final, Literal, Protocol, TypeAlias, final, type_check_only

import numpy as np
import pandas as pd
import polars as pl
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Self

__all__ = [
    "STRATEGIES",
    "Axis",
    "AxisError",
    "Beam",
    "Compensator",
    "Correction",
    "Discovery",
    "Effect",
    "FeedAxisError",
    "LogError",
    "LuGre",
    "MotionError",
    "Move",
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
    "TransferFunctions",
    "__version__",
    "discover",
    "latin_hypercube",
]

__version__: Final[str]
STRATEGIES: Final[dict[str, str]]

_Floats: TypeAlias = NDArray[np.float64]
_Path: TypeAlias = str | os.PathLike[str]
# What is done, how much of it, of how much: None where that is not known.
_Progress: TypeAlias = Callable[[str, int, int | None], object]
_Motion: TypeAlias = Move | SCurve | Program
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

_Log: TypeAlias = _Path | Run | _Frame | Mapping[str, ArrayLike]

class FeedAxisError(ValueError): ...
class AxisError(FeedAxisError): ...
class LogError(FeedAxisError): ...
class MotionError(FeedAxisError): ...
class NetworkError(FeedAxisError): ...
class ParameterError(FeedAxisError): ...
class SearchError(FeedAxisError): ...
class SimulationError(FeedAxisError): ...
class StrategyError(FeedAxisError): ...

@final
class Axis:
    @classmethod
    def load(cls, path: _Path) -> Axis: ...
    @classmethod
    def from_toml(cls, text: str, name: str = "<text>") -> Axis: ...
    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Axis: ...
    def to_dict(self) -> dict[str, Any]: ...
    def to_toml(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def description(self) -> str: ...
    @property
    def period_s(self) -> float: ...
    @property
    def unit(self) -> Literal["m", "rad"]: ...
    @property
    def stroke(self) -> tuple[float, float, float]: ...
    @property
    def channels(self) -> list[str]: ...
    @property
    def trajectories(self) -> list[Move]: ...
    @property
    def fingerprint(self) -> str: ...
    def frequencies_hz(self, position: float | None = None) -> _Floats: ...
    def simulate(
        self,
        motion: _Motion,
        *,
        compensation: Compensator | Callable[[Sample], Correction] | None = None,
        noise: float = 0.0,
        exact: bool = False,
        seed: int = 1,
        progress: _Progress | None = None,
    ) -> Run: ...
    def sample(
        self,
        count: int,
        *,
        seed: int = 1,
        near_zero: bool = False,
        progress: _Progress | None = None,
    ) -> Samples: ...
    def train(
        self,
        samples: Samples,
        *,
        hidden: _Layers = ...,
        epochs: int = 500,
        seed: int = 1,
        threads: int = 0,
        progress: _Progress | None = None,
    ) -> Network: ...
    def identify_friction(
        self,
        *,
        noise: float = 1.0,
        seed: int = 0,
        progress: _Progress | None = None,
    ) -> LuGre: ...
    def identify_transfer(
        self, *, seed: int = 0, progress: _Progress | None = None
    ) -> TransferFunctions: ...

@final
class Move:
    def __new__(
        cls,
        *,
        distance_m: float,
        speed_m_s: float,
        acceleration_m_s2: float,
        jerk_m_s3: float,
    ) -> Self: ...
    @staticmethod
    def turn(
        *,
        distance_rad: float,
        speed_rad_s: float,
        acceleration_rad_s2: float,
        jerk_rad_s3: float,
    ) -> Move: ...
    @property
    def distance_m(self) -> float: ...
    @property
    def speed_m_s(self) -> float: ...
    @property
    def acceleration_m_s2(self) -> float: ...
    @property
    def jerk_m_s3(self) -> float: ...
    @property
    def distance_rad(self) -> float: ...
    @property
    def speed_rad_s(self) -> float: ...
    @property
    def acceleration_rad_s2(self) -> float: ...
    @property
    def jerk_rad_s3(self) -> float: ...

@final
class SCurve:
    def __new__(
        cls,
        start_m: float,
        end_m: float,
        *,
        speed_m_s: float,
        acceleration_m_s2: float,
        jerk_m_s3: float,
    ) -> Self: ...
    @staticmethod
    def turn(
        start_rad: float,
        end_rad: float,
        *,
        speed_rad_s: float,
        acceleration_rad_s2: float,
        jerk_rad_s3: float,
    ) -> SCurve: ...
    @property
    def duration_s(self) -> float: ...
    def sample(self, period_s: float) -> dict[str, _Floats]: ...

@final
class Program:
    @classmethod
    def load(cls, path: _Path) -> Program: ...
    @classmethod
    def from_toml(cls, text: str) -> Program: ...
    def to_toml(self) -> str: ...
    @property
    def duration_s(self) -> float: ...
    def sample(self, period_s: float) -> dict[str, _Floats]: ...

@final
class Run:
    def __getitem__(self, name: str, /) -> _Floats: ...
    def __contains__(self, name: str, /) -> bool: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[str]: ...
    def keys(self) -> list[str]: ...
    @property
    def units(self) -> dict[str, str]: ...
    @property
    def cycles(self) -> int: ...
    @property
    def error(self) -> _Floats: ...
    @property
    def error_unit(self) -> str: ...
    @property
    def max_error(self) -> float: ...
    @property
    def mean_error(self) -> float: ...
    def to_pandas(self) -> pd.DataFrame: ...
    def to_polars(self) -> pl.DataFrame: ...
    def _repr_html_(self) -> str: ...

@final
class Parameter:
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> float: ...
    @property
    def unit(self) -> str: ...
    @property
    def interval(self) -> tuple[float, float]: ...

@final
class Effect:
    @property
    def name(self) -> str: ...
    @property
    def summary(self) -> str: ...
    @property
    def parameters(self) -> list[Parameter]: ...
    @property
    def indistinguishable_from(self) -> list[str]: ...
    @property
    def channel(self) -> str: ...
    @property
    def share_of_gap(self) -> float: ...

@final
class Discovery:
    @property
    def verdict(
        self,
    ) -> Literal["explained", "partly-explained", "other-form", "nothing-missing", "unknown"]: ...
    @property
    def effects(self) -> list[Effect]: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def size(self) -> float | None: ...
    @property
    def interval(self) -> tuple[float, float] | None: ...
    @property
    def unit(self) -> str | None: ...
    @property
    def sentence(self) -> str: ...
    @property
    def words(self) -> str: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def gap(self) -> list[tuple[str, float, float, float]]: ...
    @property
    def axis(self) -> Axis: ...
    @property
    def next_experiment(self) -> Program | None: ...
    def to_dict(self) -> dict[str, Any]: ...
    def _repr_html_(self) -> str: ...

def discover(
    axis: Axis,
    fit: Sequence[_Log],
    check: Sequence[_Log],
    *,
    test: Sequence[_Log] = ...,
    accept: Sequence[str] = ...,
    reject: Sequence[str] = ...,
    balance: bool = False,
    progress: _Progress | None = None,
) -> Discovery: ...

@final
class Sample:
    reference: _Reference
    next_reference: _Reference
    position_m: float
    motor_angle_rad: float
    motor_speed_rad_s: float
    iq_a: float
    iq_command_a: float
    def __new__(
        cls,
        *,
        reference: ArrayLike = ...,
        next_reference: ArrayLike = ...,
        position_m: float = 0.0,
        motor_angle_rad: float = 0.0,
        motor_speed_rad_s: float = 0.0,
        iq_a: float = 0.0,
        iq_command_a: float = 0.0,
    ) -> Self: ...

@final
class Correction:
    def __new__(cls, position_m: float = 0.0, iq_a: float = 0.0) -> Self: ...
    @property
    def position_m(self) -> float: ...
    @property
    def iq_a(self) -> float: ...

@final
class Compensator:
    def __new__(
        cls,
        axis: Axis,
        strategy: str,
        *,
        network: Network | None = None,
        transfer: TransferFunctions | None = None,
        friction: LuGre | None = None,
        motion: _Motion | None = None,
    ) -> Self: ...
    def start(self, motion: _Motion) -> None: ...
    def update(self, sample: Sample) -> Correction: ...
    @property
    def strategy(self) -> str: ...

@final
class TransferFunctions: ...

@final
class Samples:
    def __len__(self) -> int: ...
    @property
    def inputs(self) -> _Floats: ...
    @property
    def increments_m(self) -> _Floats: ...

@final
class Network:
    @classmethod
    def train(
        cls,
        x: ArrayLike,
        y: ArrayLike,
        *,
        hidden: _Layers = ...,
        epochs: int = 100,
        seed: int = 1,
        threads: int = 0,
        progress: _Progress | None = None,
    ) -> Network: ...
    @classmethod
    def load(cls, path: _Path) -> Network: ...
    def predict(self, x: ArrayLike) -> _Floats: ...
    def test(self, samples: Samples) -> tuple[float, float]: ...
    def to_bytes(self) -> bytes: ...
    @property
    def losses(self) -> _Floats: ...
    @property
    def shape(self) -> tuple[int, list[int], int]: ...

@final
class LuGre:
    def __new__(
        cls,
        *,
        coulomb_n_m: float,
        stiction_n_m: float,
        stribeck_speed_rad_s: float,
        stiffness_n_m_rad: float,
        damping_n_m_s_rad: float,
        viscous_n_m_s_rad: float,
    ) -> Self: ...
    @classmethod
    def liu2025(cls) -> LuGre: ...
    @property
    def coulomb_n_m(self) -> float: ...
    @property
    def stiction_n_m(self) -> float: ...
    @property
    def stribeck_speed_rad_s(self) -> float: ...
    @property
    def stiffness_n_m_rad(self) -> float: ...
    @property
    def damping_n_m_s_rad(self) -> float: ...
    @property
    def viscous_n_m_s_rad(self) -> float: ...
    def steady_state(self, speed_rad_s: ArrayLike) -> _Floats: ...
    def simulate(self, speed_rad_s: ArrayLike, dt_s: float) -> _Floats: ...

@final
class Beam:
    def __new__(
        cls,
        *,
        length_m: float,
        diameter_m: float,
        elements: int = 10,
        youngs_modulus_pa: float = 206e9,
        poisson_ratio: float = 0.3,
        density_kg_m3: float = 7850.0,
    ) -> Self: ...
    def frequencies_hz(
        self, count: int, *, supports: Literal["free", "pinned"] = "free"
    ) -> _Floats: ...

def latin_hypercube(
    n: int,
    bounds: ArrayLike,
    *,
    seed: int = 1,
    centred: bool = False,
) -> _Floats: ...
