"""Rows of crates/foc-pmsm/examples/operating_points.rs against motulator.

    compare.py ROWS.csv [--figures]

Of each row the inputs go to motulator, and its outputs are compared with those of the row. A difference is
relative to the largest output of its kind and machine, of a vector to that of its two parts. `--figures` prints outputs of motulator as well."""

import sys
from types import SimpleNamespace

import numpy as np
from motulator.common.control import PWM
from motulator.drive.control.sm._common import Observer, ObserverCfg
from motulator.drive.control.sm._torque import TorqueCharacteristics
from motulator.drive.model import SynchronousMachine
from motulator.drive.utils import SynchronousMachinePars

# What is allowed, and why it is not less: rounding of either program, but for the largest torque, which motulator
# interpolates between points of its loci, and the observer, which it integrates by another rule.
ALLOWED = {"mtpa": 1e-14, "mtpv": 1e-14, "voltage": 1e-14, "most": 1e-8, "saturated": 1e-14, "duties": 1e-14,
           "observer": 1e-3}
NODES = 20_001


def machine(numbers):
    n_p, resistance, l_d, l_q, psi = numbers
    return SynchronousMachinePars(n_p=int(n_p), R_s=resistance, L_d=l_d, L_q=l_q, psi_f=psi)


def mtpa(par, current):
    tq = TorqueCharacteristics(par)
    i = current * np.exp(1j * tq.mtpa(current))
    return [i.real, i.imag, tq.torque(tq.flux(i))]


def mtpv(par, flux):
    tq = TorqueCharacteristics(par)
    psi = flux * np.exp(1j * tq.mtpv(flux))
    i = tq.current(psi)
    return [i.real, i.imag, tq.torque(psi)]


def voltage(par, i_d, i_q, speed):
    """The voltage at which the flux of motulator's machine stands still."""
    model = SynchronousMachine(par)
    model.state.psi_s = TorqueCharacteristics(par).flux(i_d + 1j * i_q)
    model.inp = SimpleNamespace(u_ss=0j, w_M=speed)
    model.out = SimpleNamespace()
    model.set_outputs(None)
    rate = model.rhs()[0]
    return [-rate.real, -rate.imag, model.out.tau_M]


def most(limits, flux):
    return [float(limits.tau_M_vs_abs_psi_s(flux))]


def saturated(psi_d, psi_q):
    """The 6.7 kW reluctance machine: currents, and the flux again, which the crate has from them. motulator has this
    model in its examples, not in the package; here it is from the equations of doi 10.1109/TIA.2016.2644624."""
    a_d0, a_dd, s, a_q0, a_qq, t, a_dq, u, v = 17.4, 373.0, 5, 52.1, 658.0, 1, 1120.0, 1, 0
    d, q = abs(psi_d), abs(psi_q)
    i_d = (a_d0 + a_dd * d**s + a_dq / (v + 2) * d**u * q ** (v + 2)) * psi_d
    i_q = (a_q0 + a_qq * q**t + a_dq / (u + 2) * d ** (u + 2) * q**v) * psi_q
    return [i_d, i_q, psi_d, psi_q]


def duties(name, alpha, beta):
    pwm = PWM(k_comp=0, overmodulation=name)
    return list(pwm.output(1e-4, alpha + 1j * beta, 540.0, 0.0)[0])


def observer(par, i_d, i_q, omega, bandwidth, period, steps):
    """Sine and cosine of the angle, flux, speed after so many steps, as the example begins them."""
    law = Observer(ObserverCfg(par, sensorless=True, alpha_o=bandwidth))
    law.est.theta_m, law.est.w_m = 0.3, 0.9 * omega
    i = i_d + 1j * i_q
    u = par.R_s * i + 1j * omega * TorqueCharacteristics(par).flux(i)
    for step in range(int(steps) + 1):
        angle = omega * period * step
        fbk = SimpleNamespace(i_ss=i * np.exp(1j * angle), u_ss=u * np.exp(1j * (angle + 0.5 * omega * period)))
        fbk = law.output(fbk)
        if step == steps:
            return [np.sin(fbk.theta_m), np.cos(fbk.theta_m), fbk.psi_s.real, fbk.psi_s.imag, fbk.w_m]
        law.update(period, fbk)


def main():
    rows, figures = sys.argv[1], "--figures" in sys.argv[2:]
    machines, limits, theirs, ours = {}, {}, {}, {}
    for line in open(rows):
        kind, name, *numbers = line.strip().split(",")
        numbers = [float(x) for x in numbers]
        if kind == "machine":
            machines[name] = machine(numbers)
            continue
        par = machines.get(name)
        if kind == "mtpa":
            inputs, other = numbers[:1], mtpa(par, numbers[0])
        elif kind == "mtpv":
            inputs, other = numbers[:1], mtpv(par, numbers[0])
        elif kind == "voltage":
            inputs, other = numbers[:3], voltage(par, *numbers[:3])
        elif kind == "most":
            inputs = numbers[:2]
            if name not in limits:
                limits[name] = TorqueCharacteristics(par).mtpv_and_current_limits(inputs[0], N=NODES)
            other = most(limits[name], inputs[1])
        elif kind == "observer":
            inputs, other = numbers[:6], observer(par, *numbers[:6])
        elif kind == "saturated":
            inputs, other = numbers[:2], saturated(*numbers[:2])
        else:
            inputs, other = numbers[:2], duties(name, *numbers[:2])
        theirs.setdefault((kind, name), []).append(other)
        ours.setdefault((kind, name), []).append(numbers[len(inputs):])
        if figures and kind in ("mtpa", "mtpv", "most", "saturated", "observer"):
            print(kind, name, *inputs, *(repr(float(x)) for x in other), sep=",")
    print(f"{'what':10} {'machine':11} rows   largest difference, relative")
    failed = False
    for key, other in theirs.items():
        other, own = np.array(other), np.array(ours[key])
        scale = np.max(np.abs(other), axis=0)
        # The d and the q part of a vector are of one scale.
        for first in (0, 2) if other.shape[1] > 3 else (0,):
            scale[first : first + 2] = np.max(scale[first : first + 2])
        difference = float(np.max(np.abs(other - own) / scale))
        failed |= not difference <= ALLOWED[key[0]]
        print(f"{key[0]:10} {key[1]:11} {len(own):4}   {difference:.1e}{'' if difference <= ALLOWED[key[0]] else '  above'}")
    sys.exit(failed)


if __name__ == "__main__":
    main()
