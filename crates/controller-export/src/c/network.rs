//! The network strategy.

use cfnn::Real;

use super::data::{constant, counts, table};
use super::draft::{Draft, State};
use super::{Input, part};
use crate::NetworkLaw;

pub(super) fn add<T: Real>(draft: &mut Draft, law: &NetworkLaw<T>) {
    estimator(draft, law);
    network(draft, law);
    draft.part(&part::ESTIMATOR);
    draft.position = Some("network_error(&x->estimator, in)");
    draft.inputs.extend([
        Input::NextReferencePosition,
        Input::Position,
        Input::MotorSpeed,
        Input::EffortCommand,
    ]);
    draft.states.push(State {
        name: "estimator",
        declaration: include_str!("runtime/estimator.h").to_owned(),
        reals: 5,
        integers: 1,
    });
}

fn estimator<T: Real>(draft: &mut Draft, law: &NetworkLaw<T>) {
    let (e, gains) = (&law.estimator, law.estimator.gains());
    let period = e.period();
    let drift = gains.drift / period;
    let rest = T::ONE - gains.position;
    draft.data += &[
        constant("TRAVEL_PER_RADIAN", e.travel_per_radian(), "@L@/rad"),
        constant("PERIOD", period, "s"),
        constant("ONE_LESS_POSITION_GAIN", rest, "1 - alpha"),
        constant("DRIFT_PER_PERIOD", drift, "1/s: beta/T"),
        constant("ACCELERATION_GAIN", gains.acceleration, "gamma"),
    ]
    .concat();
    draft.constants += 5;
}

fn network<T: Real>(draft: &mut Draft, law: &NetworkLaw<T>) {
    let mut layers = law.hidden.clone();
    layers.push(1);
    let activations = 5 + law.hidden.iter().sum::<usize>();
    let least = law.input.map(|range| range.minimum());
    let gain = law.input.map(|range| range.gain());
    let output = &law.output;
    draft.data += &format!(
        "#define LAYERS {}u /* the output layer among them */\n#define ACTIVATIONS {activations}u /* 1, inputs, hidden neurons */\n",
        layers.len()
    );
    draft.data += &[
        counts("NEURONS", &layers, "Neurons of each layer."),
        table("INPUT_MINIMUM", &least, "Position (@L@), speed (@L@/s), acceleration (@L@/s^2), command (@E@) that are scaled to -1."),
        table("INPUT_GAIN", &gain, "Scaled units per unit of them."),
        constant("OUTPUT_MINIMUM", output.minimum(), "@L@: increment of the scaled output -1"),
        constant("OUTPUT_HALF_WIDTH", output.half_width(), "@L@ per scaled unit"),
        table("WEIGHTS", &law.packed, "Layer after layer, the bias of a neuron first."),
    ]
    .concat();
    draft.constants += law.packed.len() + 10;
    draft.counts += layers.len();
    draft.stack = draft.stack.max(activations);
}
