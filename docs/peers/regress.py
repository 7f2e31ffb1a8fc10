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
# Candidates that SINDy-PI solves for beside the residual.
PI_LEFTS = 3
# Share of a candidate that the machine's own columns must leave, or it is one of them.
LEFT = 0.02
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


def without_own(fit, check, own):
    """The residual and candidates with the machine's own columns fitted out of each: what a
    threshold or a regulariser then does leaves these as free as IDIM-LS does.

    Candidates of which that leaves nothing but a numerical rest are null.
    """
    y, told, more = fit[:, :1], fit[:, 1 : 1 + own], fit[:, 1 + own :]
    by, *_ = np.linalg.lstsq(told, np.column_stack([y, more]), rcond=None)
    rest = np.column_stack([y, more]) - told @ by
    scale = np.sqrt(np.mean(rest**2, axis=0))
    before = np.sqrt(np.mean(np.column_stack([y, more]) ** 2, axis=0))
    empty = scale <= LEFT * before
    empty[0] = False
    rest[:, empty], scale[empty] = 0.0, 1.0
    scale[scale == 0.0] = 1.0
    return rest / scale


def with_own(candidates, fit, check, names, own):
    """Of sets of candidates the best: each term must take WORTH of the check log's error
    away. The machine's own terms are in all; no candidate is a set too.
    """
    tried = []
    for chosen in {(), *candidates}:
        inside = [*range(1, 1 + own), *chosen]
        c, covariance, _ = fitted(fit[:, inside], fit[:, 0])
        error = np.log(rms(check[:, 0] - check[:, inside] @ c))
        cost = WORTH * len(groups([names[k - 1] for k in chosen]))
        tried.append((error + cost, inside, c, covariance))
    _, inside, c, covariance = min(tried, key=lambda t: (t[0], t[1]))
    deviation = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    return Terms([names[k - 1] for k in inside], c, deviation, covariance[:own, :own])


def sindy(fit, check, names, own):
    """E-SINDy: STLSQ on bagged rows; a term stays whose inclusion probability is INCLUSION.

    Columns and residual are normalised, so that the threshold is a share of the residual.
    Coefficients are those of least squares on what stays.
    """
    rest = without_own(fit, check, own)
    np.random.seed(0)
    candidates = []
    for threshold in THRESHOLDS:
        stlsq = ps.STLSQ(threshold=threshold, alpha=1e-3 * len(rest), max_iter=50)
        opt = ps.EnsembleOptimizer(stlsq, bagging=True, n_models=MODELS)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            opt.fit(rest[:, 1:], rest[:, :1])
        included = np.mean([c[0] != 0.0 for c in opt.coef_list], axis=0)
        candidates.append(tuple(1 + own + np.flatnonzero(included >= INCLUSION)))
    return with_own(candidates, fit, check, names, own)


def sindy_pi(fit, check, names, own):
    """SINDy-PI: the implicit form 0 = f(residual, candidates), solved for the residual and for
    each candidate that is like it (PySINDy's l1 regulariser, normalised columns).

    A relation in which the residual stands is written for the residual and refitted by least
    squares, without bias.
    """
    theta = without_own(fit, check, own)
    alike = np.abs(theta[:, 1:].T @ theta[:, 0])
    lefts = [0, *(1 + np.argsort(-alike)[:PI_LEFTS])]
    candidates = []
    for weight in PI_WEIGHTS:
        for left in lefts:
            opt = ps.SINDyPI(reg_weight_lam=2.0 * weight * len(theta), regularizer="l1", model_subset=[int(left)], tol=1e-4)
            with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
                warnings.simplefilter("ignore")
                opt.fit(theta, theta)
            relation = {left, *np.flatnonzero(np.abs(np.asarray(opt.coef_)[left]) > PI_LEAST)}
            if 0 in relation:
                candidates.append(tuple(own + k for k in sorted(relation - {0})))
    return with_own(candidates, fit, check, names, own)
