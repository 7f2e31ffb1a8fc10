"""The peers: IDIM-LS, and PySINDy's ensemble SINDy and SINDy-PI, on the same columns."""

import contextlib
import io
import warnings

import numpy as np
import pysindy as ps

# A term of IDIM stays while its relative standard deviation is below this (Gautier's rule of
# thumb for an identifiable parameter is 10 %).
RELATIVE_DEVIATION = 0.1
# A term must take this share of the check log's rms error away, for both peers.
WORTH = 0.01
THRESHOLDS = (0.02, 0.05, 0.1, 0.2, 0.4)
MODELS = 20
# SINDy-PI: weights of the regulariser as shares of that at which nothing is left where a column
# is the sought one, and the least coefficient of normalised columns.
PI_WEIGHTS = (0.01, 0.03, 0.1, 0.3)
PI_LEAST = 0.02
INCLUSION = 0.9


class Terms:
    """What survived: coefficient and standard deviation by term."""

    def __init__(self, names, value, deviation, covariance=None):
        self.value = dict(zip(names, value))
        self.deviation = dict(zip(names, deviation))
        self.covariance = covariance
        self.names = list(names)


def fitted(columns, y):
    """Least squares, with a covariance that takes the residual's correlation into account."""
    scale = np.linalg.norm(columns, axis=0)
    scale[scale == 0.0] = 1.0
    w = columns / scale
    c, *_ = np.linalg.lstsq(w, y, rcond=1e-10)
    rest = y - w @ c
    free = max(len(y) / correlated(rest) - len(c), 1.0)
    covariance = np.linalg.pinv(w.T @ w) * (rest @ rest) / free
    return c / scale, covariance / np.outer(scale, scale), rest


def correlated(rest):
    """Samples that count as one: 1 + 2 sum of the autocorrelation up to its first zero."""
    rest = rest - rest.mean()
    power = np.fft.rfft(rest, 2 * len(rest))
    r = np.fft.irfft(np.abs(power) ** 2)[: len(rest)]
    if r[0] <= 0.0:
        return 1.0
    r = r / r[0]
    below = np.flatnonzero(r <= 0.0)
    return max(1.0, 1.0 + 2.0 * r[1 : below[0] if len(below) else len(r)].sum())


def groups(names):
    """Terms that enter together: sine and cosine."""
    together = {}
    for k, name in enumerate(names):
        together.setdefault(name.removesuffix(" sin").removesuffix(" cos"), []).append(k)
    return together


def rms(x):
    return float(np.sqrt(np.mean(x**2)))


def idim(fit, check, names, own):
    """IDIM-LS, stepwise.

    The machine's own terms are always in. Of the others the one that lowers BIC most
    enters, if every coefficient is significant and the check log is better by WORTH; in the
    end what lost its significance leaves.
    """
    y, w = fit[:, 0], fit[:, 1:]
    yc, wc = check[:, 0], check[:, 1:]
    inside = list(range(own))
    together = {g: k for g, k in groups(names).items() if min(k) >= own}
    c, covariance, rest = fitted(w[:, inside], y)
    while True:
        count = len(y) / correlated(rest)
        bic = lambda r, n: count * np.log(rms(r) ** 2) + n * np.log(count)
        best = (bic(rest, len(inside)), None)
        for group in together.values():
            if group[0] not in inside:
                _, _, r = fitted(w[:, inside + group], y)
                best = min(best, (bic(r, len(inside) + len(group)), group), key=lambda b: b[0])
        if best[1] is None:
            break
        new = inside + best[1]
        nc, ncov, nrest = fitted(w[:, new], y)
        size = np.linalg.norm(nc[-len(best[1]) :])
        deviation = np.sqrt(np.trace(ncov[-len(best[1]) :, -len(best[1]) :]) / len(best[1]))
        before, after = rms(yc - wc[:, inside] @ c), rms(yc - wc[:, new] @ nc)
        if deviation > RELATIVE_DEVIATION * size or after > (1.0 - WORTH) * before:
            together = {g: k for g, k in together.items() if k != best[1]}
            continue
        inside, c, covariance, rest = new, nc, ncov, nrest
    return Terms([names[k] for k in inside], c, np.sqrt(np.diag(covariance)), covariance[:own, :own])


def sindy(fit, check, names, own):
    """E-SINDy: STLSQ on bagged rows; a term stays whose inclusion probability is 90 %.

    Columns and residual are normalised, so that the threshold is a share of the residual;
    of the thresholds the one with fewest terms is taken whose check error is within WORTH of
    the least. Coefficients are those of least squares on what stays.
    """
    y, w = fit[:, 0], fit[:, 1:]
    scale, size = np.sqrt(np.mean(w**2, axis=0)), rms(y)
    scale[scale == 0.0] = 1.0
    np.random.seed(0)
    tried = []
    for threshold in THRESHOLDS:
        opt = ps.EnsembleOptimizer(ps.STLSQ(threshold=threshold, alpha=1e-3 * len(y), max_iter=50), bagging=True, n_models=MODELS)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            opt.fit(w / scale, (y / size)[:, None])
        included = np.mean([c[0] != 0.0 for c in opt.coef_list], axis=0)
        inside = [k for k in range(len(names)) if included[k] >= INCLUSION]
        c, covariance, _ = fitted(w[:, inside], y) if inside else (np.zeros(0), np.zeros((0, 0)), y)
        error = rms(check[:, 0] - check[:, 1:][:, inside] @ c)
        bagged = [o[0][inside] * size / scale[inside] for o in opt.coef_list]
        tried.append((error, inside, c, covariance, np.std(bagged, axis=0)))
    least = min(t[0] for t in tried)
    _, inside, c, covariance, bagged = min((t for t in tried if t[0] <= (1.0 + WORTH) * least), key=lambda t: len(t[1]))
    deviation = np.maximum(np.sqrt(np.maximum(np.diag(covariance), 0.0)), bagged)
    return Terms([names[k] for k in inside], c, deviation)


def sindy_pi(fit, check, names, own):
    """SINDy-PI: the implicit form 0 = f(residual, a, v, ...), solved for the residual and for
    each of the machine's own terms (PySINDy's l1 regulariser, normalised columns).

    A relation in which the residual stands is written for the residual and refitted by least
    squares, without bias; of these the one with fewest terms is taken whose check error is
    within WORTH of the least. "Nothing" is among them.
    """
    scale = np.sqrt(np.mean(fit**2, axis=0))
    scale[scale == 0.0] = 1.0
    theta = fit / scale
    tried = [(rms(check[:, 0]), [], np.zeros(0), np.zeros((0, 0)))]
    for weight in PI_WEIGHTS:
        for left in range(own + 1):
            opt = ps.SINDyPI(reg_weight_lam=2.0 * weight * len(theta), regularizer="l1", model_subset=[left], tol=1e-4)
            with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
                warnings.simplefilter("ignore")
                opt.fit(theta, theta)
            c = np.asarray(opt.coef_)[left]
            relation = {left, *np.flatnonzero(np.abs(c) > PI_LEAST)}
            if 0 not in relation or len(relation) == 1:
                continue
            inside = sorted(relation - {0})
            c, covariance, _ = fitted(fit[:, inside], fit[:, 0])
            tried.append((rms(check[:, 0] - check[:, inside] @ c), inside, c, covariance))
    least = min(t[0] for t in tried)
    _, inside, c, covariance = min((t for t in tried if t[0] <= (1.0 + WORTH) * least), key=lambda t: len(t[1]))
    return Terms([names[k - 1] for k in inside], c, np.sqrt(np.maximum(np.diag(covariance), 0.0)))
