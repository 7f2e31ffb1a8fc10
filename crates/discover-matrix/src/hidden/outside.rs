//! Effects that are outside the library: what a search must not give a wrong name.

use axis_sim::effects::{
    Changes, Effect, EffectChannel, EffectParameter, EffectVariable, Measure, MemoryLaw, Nature,
    Steepness, TableStep,
};
use axis_sim::{SetupError, Start};

/// All of them.
pub const OUTSIDE: [&Effect; 8] = [
    &ROOT_FRICTION,
    &QUADRATIC_DRAG,
    &POSITION_DAMPING,
    &FADING_FRICTION,
    &END_CUSHION,
    &WAVE_LOAD,
    &SATURATING_TORQUE,
    &CREEPING_LOAD,
];

const ROOT_FRICTION: Effect = outside(
    "root-friction",
    "friction with the root of speed",
    ("speed", EffectVariable::Speed),
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
    ("speed", EffectVariable::Speed),
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
    ("position and speed", EffectVariable::Speed),
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
    ("time", EffectVariable::Time),
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

const END_CUSHION: Effect = outside(
    "end-cushion",
    "a cushion that the table runs into, with the square of its depth",
    ("position", EffectVariable::Position),
    &[
        size("stiffness", Measure::Other("N/m^2"), 1e4),
        place("begin", 0.65),
    ],
    |v, to| {
        let (k, begin) = (v[0], v[1]);
        to.load(move |t| k * (t.position - begin).max(0.0).powi(2) * t.loaded);
        Ok(())
    },
);

const WAVE_LOAD: Effect = outside(
    "wave-load",
    "a load that repeats along the stroke, as of a cable chain",
    ("position", EffectVariable::Position),
    &[
        size("amplitude", Measure::Force, 30.0),
        shape(
            "pitch",
            Measure::Displacement,
            Nature::Width([0.15, 0.4]),
            0.045,
        ),
    ],
    |v, to| {
        let (amplitude, pitch) = (v[0], v[1]);
        to.load(move |t| amplitude * (std::f64::consts::TAU * t.position / pitch).sin() * t.loaded);
        Ok(())
    },
);

const SATURATING_TORQUE: Effect = outside(
    "saturating-torque",
    "a motor whose torque falls behind its current",
    ("current", EffectVariable::Current),
    &[size("cubic", Measure::Other("1/(N*m)^2"), 2e-3)],
    |v, to| {
        let c = v[0];
        to.torque(move |_, torque| -c * torque.powi(3));
        Ok(())
    },
);

const CREEPING_LOAD: Effect = outside(
    "creeping-load",
    "a spring that creeps after the table, as of a hose or a seal",
    ("time", EffectVariable::Time),
    &[
        size("stiffness", Measure::SpringRate, 3e3),
        shape(
            "time",
            Measure::Time,
            Nature::Time([0.2, 0.2], [0.1, 0.5]),
            0.2,
        ),
    ],
    |v, to| {
        let [stiffness, time] = [v[0], v[1]];
        let steepness = Steepness {
            position: stiffness.abs(),
            ..Steepness::default()
        };
        to.load_with_memory(steepness, Creep { stiffness, time });
        Ok(())
    },
);

/// A spring and a damper in a row (Maxwell's body), k z with ż = v − z / τ; remembers z.
struct Creep {
    /// k, N/m.
    stiffness: f64,
    /// τ, s.
    time: f64,
}

impl MemoryLaw for Creep {
    fn size(&self) -> usize {
        1
    }

    fn settle(&self, start: &Start, memory: &mut [f64]) -> f64 {
        memory[0] = start.speed * self.time;
        self.stiffness * memory[0]
    }

    fn step(&self, step: &TableStep, memory: &mut [f64]) -> f64 {
        memory[0] = (memory[0] + step.travel) / (1.0 + step.length / self.time);
        self.stiffness * memory[0]
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
    shape(
        name,
        Measure::Displacement,
        Nature::Place([0.0, 1.0]),
        typical,
    )
}

const fn outside(
    name: &'static str,
    summary: &'static str,
    (depends_on, shown_over): (&'static str, EffectVariable),
    parameters: &'static [EffectParameter],
    install: fn(&[f64], &mut Changes<'_>) -> Result<(), SetupError>,
) -> Effect {
    Effect {
        name,
        summary,
        channel: EffectChannel::Torque,
        depends_on,
        shown_over,
        parameters,
        needs: &[],
        install,
    }
}
