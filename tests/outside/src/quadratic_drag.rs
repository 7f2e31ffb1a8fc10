//! `quadratic-drag`: a force against motion that grows with the square of the speed.

use axis_sim::SetupError;
use axis_sim::effects::{
    Changes, Effect, EffectChannel, EffectParameter, EffectVariable, Measure, Nature,
};

/// Air or fluid that the load pushes aside, F = c v |v|.
pub static QUADRATIC_DRAG: Effect = Effect {
    name: "quadratic-drag",
    summary: "force against motion that grows with the square of the speed",
    channel: EffectChannel::Torque,
    depends_on: "speed",
    shown_over: EffectVariable::Speed,
    parameters: &[EffectParameter {
        name: "coefficient",
        measure: Measure::Other("N*s^2/m^2"),
        nature: Nature::Size { either_sign: false },
        typical: 500.0,
        bounds: [-1e5, 1e5],
    }],
    needs: &[],
    install,
};

fn install(values: &[f64], to: &mut Changes<'_>) -> Result<(), SetupError> {
    let coefficient = values.first().copied().unwrap_or(0.0);
    to.load(move |load| coefficient * load.speed * load.speed.abs());
    Ok(())
}
