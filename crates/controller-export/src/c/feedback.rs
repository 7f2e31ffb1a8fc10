//! The feedback around a plan.

use std::fmt::Write;

use axis_scalar::Scalar;
use compensator::{Feedback, FeedbackGains, FeedbackNode};

use super::data::{constant, literal, table};
use super::draft::{Draft, State};
use super::{Input, part};

pub(super) fn add<T: Scalar>(draft: &mut Draft, feedback: &Feedback<T>) {
    let gains = feedback.gains();
    let (states, measured) = (gains.states, gains.measured);
    draft.data += &format!(
        "#define STATES {states}u\n#define MEASURED {measured}u\n#define NODES {}u\n#define SPEED_BY_DIFFERENCES {}\n",
        gains.nodes.len(),
        u8::from(gains.differences)
    );
    draft.data += &[
        constant(
            "FEEDBACK_LIMIT",
            gains.limit,
            "@E@: greatest command, its unit inside",
        ),
        table(
            "STICKING",
            &gains.sticking,
            "Share of sticking bristles at each node.",
        ),
        tables(gains),
    ]
    .concat();
    let node = states * states + 2 * states + measured * (states + 1);
    draft.constants += 1 + gains.nodes.len() * (1 + node) + measured * states;
    draft.stack = draft.stack.max(3 * states);
    draft.part(&part::FEEDBACK);
    draft.plan = draft.plan.map(|(ahead, _)| (ahead, true));
    draft
        .inputs
        .extend([Input::Position, Input::MotorSpeed, Input::Current]);
    draft.states.push(State {
        name: "feedback",
        declaration: include_str!("runtime/feedback.h").replace("@STATES@", &states.to_string()),
        reals: 2 * states + 8,
        integers: 1,
    });
}

/// Model and gains of each node, and the rows of the measurements.
fn tables<T: Scalar>(gains: &FeedbackGains<T>) -> String {
    let (states, measured) = (gains.states, gains.measured);
    let nodes: Vec<String> = gains
        .nodes
        .iter()
        .map(|n| node(n, states, measured))
        .collect();
    let outputs: Vec<String> = gains.c[..measured]
        .iter()
        .map(|row| list(&row[..states]))
        .collect();
    format!(
        "/* x(k+1) = A x + b u, columns of A; gains of the observer, a column a measurement, and of the\n * feedback; what the measurements deviate by while the model is right. */\n\
         typedef struct {{\n    real a[STATES][STATES], b[STATES], l[MEASURED][STATES], k[STATES], expected[MEASURED];\n}} feedback_node;\n\
         static const feedback_node FEEDBACK[NODES] = {{\n{}}};\n\
         /* Rows of the measurements: position (@L@), motor speed (rad/s), current (A). */\n\
         static const real OUTPUTS[MEASURED][STATES] = {{\n    {},\n}};\n",
        nodes.concat(),
        outputs.join(",\n    ")
    )
}

fn node<T: Scalar>(node: &FeedbackNode<T>, states: usize, measured: usize) -> String {
    let columns = |all: &[[T; compensator::MOST_STATES]]| {
        let lists: Vec<String> = all.iter().map(|column| list(&column[..states])).collect();
        format!("{{{}}}", lists.join(",\n      "))
    };
    let mut text = String::from("    {");
    for part in [
        columns(&node.a[..states]),
        list(&node.b[..states]),
        columns(&node.l[..measured]),
        list(&node.k[..states]),
        list(&node.expected[..measured]),
    ] {
        let _ = write!(text, "{part},\n     ");
    }
    text.truncate(text.trim_end().len());
    text + "},\n"
}

fn list<T: Scalar>(values: &[T]) -> String {
    let items: Vec<String> = values.iter().map(|&value| literal(value)).collect();
    format!("{{{}}}", items.join(", "))
}
