//! Field-oriented control of a permanent-magnet synchronous motor: frames, motor, PI, SVPWM, inverter, cascade
