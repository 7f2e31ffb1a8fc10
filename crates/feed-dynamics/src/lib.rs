//! Dynamics of a ball-screw feed drive: M(x), C(x), K(x), modes, frequency response, time stepping
