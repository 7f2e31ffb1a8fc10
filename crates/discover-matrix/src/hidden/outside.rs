//! Effects that are in no library: what a search must not give a wrong name.

use std::sync::Mutex;

use axis_sim::SetupError;
use axis_sim::effects::{
    Changes, Effect, EffectChannel, EffectParameter, Measure, Nature, TableState,
};

/// All of them.
pub const OUTSIDE: [&Effect; 8] = [
    &ROOT_FRICTION,
    &QUADRATIC_DRAG,
    &POSITION_DAMPING,
    &FADING_FRICTION,
    &SPRING_LOAD,
    &WAVE_LOAD,
    &SATURATING_TORQUE,
    &LOCAL_RESONANCE,
];

const ROOT_FRICTION: Effect = outside(
    "root-friction",
    "friction with the root of speed",
    "speed",
    &[size("coefficient", Measure::Other("N*s^0.5/m^0.5"), 200.0)],
    |v, to| {
        let c = v[0];
        to.load(move |t| c * t.speed.abs().sqrt() * t.bristle);
        Ok(())
    },
);

const QUADRATIC_DRAG: Effect = outside(
    "quadratic-drag",
    "drag with the square of speed",
    "speed",
    &[size("coefficient", Measure::Other("N*s^2/m^2"), 6e3)],
    |v, to| {
        let c = v[0];
        to.load(move |t| c * t.speed * t.speed.abs());
        Ok(())
    },
);

const POSITION_DAMPING: Effect = outside(
    "position-damping",
    "viscous friction that grows along the stroke",
    "position and speed",
    &[
        size("slope", Measure::Other("N*s/m^2"), 1e4),
        place("zero", 0.7),
    ],
    |v, to| {
        let (c, zero) = (v[0], v[1]);
        to.load(move |t| c * (t.position - zero) * t.speed);
        Ok(())
    },
);

const FADING_FRICTION: Effect = outside(
    "fading-friction",
    "dry friction that fades as it warms",
    "time",
    &[
        size("force", Measure::Force, 60.0),
        shape(
            "time",
            Measure::Time,
            Nature::Time([1.0, 5.0], [1.0, 8.0]),
            3.0,
        ),
    ],
    |v, to| {
        let (force, time) = (v[0], v[1]);
        to.load(move |t| force * (-t.time / time).exp() * t.bristle);
        Ok(())
    },
);

const SPRING_LOAD: Effect = outside(
    "spring-load",
    "a spring between table and bed",
    "position",
    &[
        size("stiffness", Measure::Stiffness, 600.0),
        place("zero", 0.7),
    ],
    |v, to| {
        let (k, zero) = (v[0], v[1]);
        to.load(move |t| k * (t.position - zero) * t.pressed);
        Ok(())
    },
);

const WAVE_LOAD: Effect = outside(
    "wave-load",
    "a load that repeats along the stroke, as of a cable chain",
    "position",
    &[
        size("amplitude", Measure::Force, 30.0),
        shape("pitch", Measure::Way, Nature::Width([0.15, 0.4]), 0.045),
    ],
    |v, to| {
        let (amplitude, pitch) = (v[0], v[1]);
        to.load(move |t| {
            amplitude * (std::f64::consts::TAU * t.position / pitch).sin() * t.pressed
        });
        Ok(())
    },
);

const SATURATING_TORQUE: Effect = outside(
    "saturating-torque",
    "a motor whose torque falls behind its current",
    "current",
    &[size("cubic", Measure::Other("1/(N*m)^2"), 2e-3)],
    |v, to| {
        let c = v[0];
        to.torque(move |_, torque| -c * torque.powi(3));
        Ok(())
    },
);

const LOCAL_RESONANCE: Effect = outside(
    "local-resonance",
    "a body on the table that swings by itself",
    "acceleration, near one frequency",
    &[
        size("mass", Measure::Inertia, 20.0),
        shape(
            "frequency",
            Measure::Other("Hz"),
            Nature::Time([45.0, 45.0], [20.0, 120.0]),
            45.0,
        ),
    ],
    |v, to| {
        let (mass, omega) = (v[0], std::f64::consts::TAU * v[1]);
        let body = Mutex::new(Body::default());
        to.load(move |t| {
            let mut body = body
                .lock()
                .unwrap_or_else(std::sync::PoisonError::into_inner);
            mass * body.follow(t, omega)
        });
        Ok(())
    },
);

/// Damping ratio of the swinging body.
const DAMPING: f64 = 0.02;

/// A body on a spring and a damper on the table. One run at a time.
#[derive(Default)]
struct Body {
    time: f64,
    position: f64,
    speed: f64,
    /// Force on the table per kg, against positive motion.
    pull: f64,
}

impl Body {
    fn pull(&self, table: &TableState, omega: f64) -> f64 {
        omega * omega * (table.position - self.position)
            + 2.0 * DAMPING * omega * (table.speed - self.speed)
    }

    /// Moves on to the table's time, and gives the force on the way; a time that
    /// goes back begins anew.
    fn follow(&mut self, table: &TableState, omega: f64) -> f64 {
        let step = table.time - self.time;
        if step < 0.0 || (self.time == 0.0 && self.position == 0.0) {
            (self.position, self.speed, self.pull) = (table.position, table.speed, 0.0);
        } else if step > 0.0 {
            // The spring's length before the step: with the one after it, a
            // steady speed would pull.
            self.pull = self.pull(table, omega);
            self.speed += step * self.pull;
            self.position += step * self.speed;
        }
        self.time = table.time;
        self.pull
    }
}

const fn shape(
    name: &'static str,
    measure: Measure,
    nature: Nature,
    typical: f64,
) -> EffectParameter {
    EffectParameter {
        name,
        measure,
        nature,
        typical,
        bounds: [-1e6, 1e6],
    }
}

const fn size(name: &'static str, measure: Measure, typical: f64) -> EffectParameter {
    let nature = Nature::Size { either_sign: false };
    shape(name, measure, nature, typical)
}

/// A place, from a motion's start on.
const fn place(name: &'static str, typical: f64) -> EffectParameter {
    shape(name, Measure::Way, Nature::Place([0.0, 1.0]), typical)
}

const fn outside(
    name: &'static str,
    summary: &'static str,
    depends_on: &'static str,
    parameters: &'static [EffectParameter],
    install: fn(&[f64], &mut Changes<'_>) -> Result<(), SetupError>,
) -> Effect {
    Effect {
        name,
        summary,
        channel: EffectChannel::Torque,
        depends_on,
        parameters,
        needs: &[],
        install,
    }
}
