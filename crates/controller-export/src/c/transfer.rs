//! The linear model of the tracking error.

use axis_scalar::Scalar;
use compensator::TransferFunction;

use super::data::{constant, table};
use super::draft::{Draft, State};
use super::{Input, part};

pub(super) fn add<T: Scalar>(draft: &mut Draft, filter: &TransferFunction<T>) {
    let model = filter.model();
    let mut poles = model.poles().to_vec();
    let mut weights: Vec<T> = model.weights().collect();
    if poles.is_empty() {
        // C has no empty arrays: a section that counts nothing.
        (poles, weights) = (vec![T::ZERO], vec![T::ZERO]);
    }
    let order = poles.len();
    let lead = filter.lead_time() / model.period();
    draft.data += &format!("#define ORDER {order}u\n");
    draft.data += &[
        table("POLES", &poles, "Of z."),
        table("SECTION_WEIGHTS", &weights, "s^2, of each section's value."),
        constant("DIRECT", model.direct(), "s^2: direct feed-through"),
        constant("LEAD_PER_PERIOD", lead, "lead time over control period"),
    ]
    .concat();
    draft.constants += 2 * order + 2;
    draft.part(&part::TRANSFER);
    draft.position = Some("filter_error(&x->filter, in)");
    let inputs = [
        Input::ReferenceAcceleration,
        Input::NextReferenceAcceleration,
    ];
    draft.inputs.extend(inputs);
    draft.states.push(State {
        name: "filter",
        declaration: include_str!("runtime/transfer.h").replace("@ORDER@", &order.to_string()),
        reals: order + 1,
        integers: 1,
    });
}
