"""Logs as regressions take them: despiked, differentiated, filtered alike on both sides."""

import csv

import numpy as np
import pysindy as ps
from scipy import signal

# Fourth-order Butterworth, forward and back, as Janot, Gautier and Brunot use it on EMPS.
ORDER = 4
# Samples are thinned to this many times the cut-off.
SAMPLES_PER_CUTOFF = 2.5


def read(path):
    """Channels of a CSV by name."""
    with open(path, newline="") as file:
        rows = csv.reader(file)
        names = next(rows)
        values = np.array([[float(v) if v else np.nan for v in row] for row in rows])
    return {name: filled(values[:, k]) for k, name in enumerate(names)}


def filled(x):
    """Missing samples by a line between their neighbours."""
    bad = ~np.isfinite(x)
    if bad.any() and not bad.all():
        x = x.copy()
        x[bad] = np.interp(np.flatnonzero(bad), np.flatnonzero(~bad), x[~bad])
    return x


def despiked(x):
    """Without single samples far from the median of five (Hampel's rule, six deviations)."""
    middle = signal.medfilt(x, 5)
    middle[:2], middle[-2:] = x[:2], x[-2:]
    off = np.abs(x - middle)
    limit = 6.0 * 1.4826 * np.median(off[off > 0.0]) if (off > 0.0).any() else 0.0
    return np.where(off > max(limit, 1e-300), middle, x)


def low_pass(x, period, cutoff):
    b, a = signal.butter(ORDER, min(2.0 * cutoff * period, 0.95))
    return signal.filtfilt(b, a, x, axis=0)


def motion(position, period, cutoff, derivative):
    """Position, speed and acceleration.

    "central": zero-phase Butterworth, then central differences (IDIM).
    "smooth": PySINDy's SmoothedFiniteDifference (Savitzky-Golay, cubic), twice.
    """
    t = period * np.arange(len(position))
    if derivative == "central":
        x = low_pass(position, period, cutoff)
        v = np.gradient(x, period)
        return x, v, np.gradient(v, period)
    # A cubic over n samples passes about 1.4 / (n period): near the cut-off.
    window = max(7, int(1.4 / (cutoff * period)) | 1)
    smooth = ps.SmoothedFiniteDifference(smoother_kws={"window_length": window, "polyorder": 3})
    v = np.asarray(smooth._differentiate(position[:, None], t))
    a = np.asarray(smooth._differentiate(v, t))[:, 0]
    x = signal.savgol_filter(position, window, 3)
    return x, v[:, 0], a


def thinned(columns, period, cutoff):
    """Columns through one and the same filter, then every n-th sample, without the ends."""
    every = max(1, int(1.0 / (SAMPLES_PER_CUTOFF * cutoff * period)))
    low = low_pass(columns, period, cutoff)
    ends = int(0.1 / period)
    return low[ends : len(low) - ends : every]
