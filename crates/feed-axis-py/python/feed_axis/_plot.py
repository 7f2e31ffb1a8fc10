"""Plots of runs and findings; matplotlib is asked for when one is drawn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._feed_axis import Contour, Discovery, Run


def _axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    try:
        from matplotlib import pyplot
    except ImportError as error:
        raise ImportError("plot needs matplotlib; install it: pip install matplotlib") from error
    return pyplot.figure().add_subplot()


def plot_run(run: Run, channels: Sequence[str], ax: Axes | None) -> Axes:
    """Channels over time; the tracking error where none is named."""
    series = [(name, run[name], run.units[name]) for name in channels]
    if not series:
        series = [("tracking error", 1e6 * run.error, f"µ{run.error_unit}")]
    ax = _axes(ax)
    units = []
    for name, values, unit in series:
        ax.plot(run["t_s"], values, label=name)
        units += [unit] * (unit not in units)
    ax.set_xlabel("time (s)")
    ax.set_ylabel(f"{series[0][0]} ({units[0]})" if len(series) == 1 else ", ".join(units))
    if len(series) > 1:
        ax.legend()
    return ax


def plot_discovery(found: Discovery, ax: Axes | None) -> Axes:
    """The gap on motion that was not fitted to: before, after, and noise, by channel."""
    ax = _axes(ax)
    names = [name for name, *_ in found.gap]
    for k, label in enumerate(("before", "after", "noise"), start=1):
        places = [place + 0.27 * (k - 2) for place in range(len(names))]
        ax.bar(places, [float(row[k]) for row in found.gap], width=0.27, label=label)
    ax.set_xticks(range(len(names)), names, rotation=20, ha="right")
    ax.set_yscale("log")
    ax.set_ylabel("RMS gap (SI unit of the channel)")
    ax.set_title(found.verdict)
    ax.legend()
    return ax


def plot_contour(contour: Contour, ax: Axes | None) -> Axes:
    """Radial deviation of a circle over the angle; of another path the contour error along it."""
    radius = contour.radius_m
    if ax is None and radius is not None:
        try:
            from matplotlib import pyplot
        except ImportError as error:
            raise ImportError("plot needs matplotlib; install it: pip install matplotlib") from error
        ax = pyplot.figure().add_subplot(projection="polar")
    ax = _axes(ax)
    is_polar, worst = ax.name == "polar", 0.0
    for direction in contour:
        lap = contour[direction]
        if radius is None:
            ax.plot(1e3 * lap["s_m"], 1e6 * lap["error_m"], label=direction)
            continue
        order = np.argsort(lap["angle_rad"])
        angle, deviation = lap["angle_rad"][order], 1e6 * lap["deviation_m"][order]
        worst = max(worst, float(np.abs(deviation).max()))
        ax.plot(angle if is_polar else np.degrees(angle), deviation, label=direction, linewidth=0.8)
    if is_polar:
        # The nominal circle in the middle of the ring.
        ax.set_ylim(-2.5 * worst, 1.2 * worst)
        ax.set_title("radial deviation (µm)")
    else:
        ax.set_xlabel("arc length (mm)" if radius is None else "angle (°)")
        ax.set_ylabel("contour error (µm)" if radius is None else "radial deviation (µm)")
    ax.legend(loc="lower left")
    return ax
