"""Networks that `derivatives` printed, by NumPy and scikit-learn: python compare.py OURS.csv

Outputs by the definition; derivatives by the complex step, which loses no digits (Squire and Trapp 1998,
doi 10.1137/S003614459631241X); the regularised linear network by scikit-learn's BayesianRidge; of the one with
neurons, the conditions that a minimum and the estimates must meet. Exit code 1 if a figure is above its limit.
"""

import csv
import sys

import numpy as np
import sklearn
from sklearn.linear_model import BayesianRidge

TRANSFER = [np.tanh, lambda n: 1 / (1 + np.exp(-n)), lambda n: n, lambda n: np.where(n.real > 0, n, 0)]
STEP = 1e-200
# Of an output's half-range or the largest entry of a table: some fifty roundings through four layers.
ROUNDING = 5e-15

nets = {}
with open(sys.argv[1], newline="") as file:
    for name, quantity, *values in csv.reader(file):
        nets.setdefault(name, {})[quantity] = np.array([float(v) for v in values if v])


def scaled(x, ranges):
    low, high = ranges.reshape(-1, 2).T
    return 2 * (x - low) / (high - low) - 1


def outputs(net, weights, x, in_units=True):
    """Rows of outputs; `weights` or `x` may be complex."""
    sizes = net["sizes"].astype(int)
    groups = [scaled(x, net["input_ranges"])]
    groups[0][:, net["dropped"].astype(int)] = 0
    first = 0
    for layer, neurons in enumerate(sizes[1:]):
        seen = np.hstack([np.ones((len(x), 1)), *groups])
        own = weights[first : first + seen.shape[1] * neurons].reshape(-1, neurons)
        first += own.size
        if net["feed_forward"][0] and layer > 0:
            own = np.vstack([own[:1], own[-groups[-1].shape[1] :]])
            seen = np.hstack([seen[:, :1], groups[-1]])
        net_input = seen @ own
        if layer + 2 == len(sizes):
            break
        groups.append(TRANSFER[int(net["transfers"][layer])](net_input))
    if not in_units:
        return net_input
    low, high = net["output_ranges"].reshape(-1, 2).T
    return low + (net_input + 1) * (high - low) / 2


def free(net):
    """Which weights the network has: those of links that are there."""
    sizes = net["sizes"].astype(int)
    mask = []
    for layer, neurons in enumerate(sizes[1:]):
        sees = np.ones(1 + sizes[: layer + 1].sum(), bool)
        sees[1 + net["dropped"].astype(int)] = False
        if net["feed_forward"][0] and layer > 0:
            sees[1 : len(sees) - sizes[layer]] = False
        mask.append(np.repeat(sees, neurons))
    return np.concatenate(mask)


def slopes(net, x, of, in_units=True):
    """Rows of derivatives by each weight that the network has, or by each input."""
    rows = len(x) * int(net["sizes"][-1])
    columns = len(net["weights"]) if of == "weights" else x.shape[1]
    table = np.zeros((rows, columns))
    for c in np.flatnonzero(free(net)) if of == "weights" else range(columns):
        weights, moved = net["weights"].astype(complex), x.astype(complex)
        (weights if of == "weights" else moved.T)[c] += 1j * STEP
        table[:, c] = outputs(net, weights, moved, in_units).imag.ravel() / STEP
    return table


failed = False


def report(name, what, off, limit):
    global failed
    failed |= not off <= limit
    print(f"{name:<9} {what:<34} {off:8.1e}")


print(f"NumPy {np.__version__}, scikit-learn {sklearn.__version__}; greatest difference, relative")
for name, net in nets.items():
    x = net["inputs"].reshape(-1, int(net["sizes"][0]))
    if "outputs" in net:
        half = np.diff(net["output_ranges"].reshape(-1, 2)).max() / 2
        y = outputs(net, net["weights"], x.copy())
        report(name, "outputs", np.abs(net["outputs"] - y.ravel()).max() / half, ROUNDING)
        for what, of in [("jacobian", "weights"), ("sensitivities", "inputs")]:
            theirs = slopes(net, x, of).ravel()
            report(name, what, np.abs(net[what] - theirs).max() / np.abs(theirs).max(), ROUNDING)
        continue
    alpha, beta, gamma = net["estimates"]
    weights, target = net["weights"], scaled(net["targets"], net["output_ranges"])
    if name == "ridge":
        table = np.column_stack([np.ones(len(x)), scaled(x, net["input_ranges"])])
        none = dict(alpha_1=0, alpha_2=0, lambda_1=0, lambda_2=0)
        ridge = BayesianRidge(fit_intercept=False, tol=1e-13, max_iter=100000, **none).fit(table, target)
        report(name, "weights", np.abs(ridge.coef_ - weights).max() / np.abs(weights).max(), 4e-13)
        report(name, "2 alpha, lambda_ of BayesianRidge", abs(2 * alpha / ridge.lambda_ - 1), 6e-13)
        report(name, "2 beta, alpha_ of BayesianRidge", abs(2 * beta / ridge.alpha_ - 1), 5e-14)
    residual = outputs(net, weights, x.copy(), False).ravel() - target
    jacobian = slopes(net, x, "weights", False)
    gradient = beta * jacobian.T @ residual + alpha * weights
    # Where training stops: α, β and γ settled to 1e-10 of an epoch's change.
    linear = name == "ridge"
    stationary, estimate = (3e-11, 2e-15) if linear else (3e-7, 4e-12)
    report(name, "gradient of the two parts' sum", np.abs(gradient).max() / np.abs(alpha * weights).max(), stationary)
    eigenvalues = beta * np.linalg.svd(jacobian, compute_uv=False) ** 2
    effective = (eigenvalues / (eigenvalues + alpha)).sum()
    report(name, f"gamma, {gamma:.3f} of {len(weights)}", abs(gamma / effective - 1), estimate)
    report(name, "2 alpha sum w², gamma", abs(2 * alpha * (weights @ weights) / effective - 1), estimate)
    noise = 2 * beta * (residual @ residual) / (len(residual) - effective)
    report(name, "2 beta sum r², n - gamma", abs(noise - 1), estimate)
sys.exit(1 if failed else 0)
