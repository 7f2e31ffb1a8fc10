//! Motion plans and beams.

use std::hint::black_box;

use beam_fem::{Beam, CrossSection, Dof, Material, Mesh, lowest_modes};
use miette::{IntoDiagnostic, Result};
use trajectories::{Limits, Motion, SCurve, Setpoint};

use super::timing::{least, least_of_calls};
use super::{Plan, Row};

pub fn rows(plan: &Plan) -> Result<Vec<Row>> {
    let mut rows = motions(plan)?;
    rows.extend(beams(plan)?);
    Ok(rows)
}

fn motions(plan: &Plan) -> Result<Vec<Row>> {
    let limits = Limits::new(0.1, 0.225, 1.2).into_diagnostic()?;
    let curve = SCurve::plan(0.6, 0.9, &limits).into_diagnostic()?;
    let instants = 1000;
    let [planned] = least_of_calls(
        plan.repetitions,
        plan.size(1000, 10),
        [&mut || {
            black_box(SCurve::plan(black_box(0.6), black_box(0.9), black_box(&limits)).is_ok());
        }],
    );
    // All phases of the motion, in order, as a controller asks for them.
    let step = curve.duration() / f64::from(instants);
    let [sampled] = least_of_calls(
        plan.repetitions,
        1,
        [&mut || {
            let mut total = 0.0;
            for i in 0..instants {
                let Setpoint {
                    position,
                    velocity,
                    acceleration,
                    ..
                } = black_box(&curve).at(f64::from(i) * step);
                total += position + velocity + acceleration;
            }
            black_box(total);
        }],
    );
    let row = |name: &str, value: f64| Row {
        name: name.into(),
        value,
        unit: "s",
        ratio: 1e-4 / value,
        against: "a control period of 100 µs",
    };
    Ok(vec![
        row("rest-to-rest S-curve, planned", planned),
        row("S-curve, one sample", sampled / f64::from(instants)),
    ])
}

fn beam(elements: usize) -> Result<Beam> {
    let steel = Material::new(206e9, 0.3, 7850.0).into_diagnostic()?;
    let section = CrossSection::solid_circle(0.04, &steel).into_diagnostic()?;
    let mesh = Mesh::uniform(1.5, elements).into_diagnostic()?;
    Ok(Beam::new(section, steel, mesh))
}

/// A beam and half of it: the cost of an element must not grow.
fn beams(plan: &Plan) -> Result<Vec<Row>> {
    let elements = plan.size(1000, 100);
    let (long, short) = (beam(elements)?, beam(elements / 2)?);
    let (mut into, mut into_short) = (long.assemble_banded(), short.assemble_banded());
    let [assembled, half_assembled] = least_of_calls(
        plan.repetitions.div_ceil(4),
        1,
        [
            &mut || {
                black_box(long.assemble_banded_into(black_box(&mut into)).is_ok());
            },
            &mut || {
                black_box(
                    short
                        .assemble_banded_into(black_box(&mut into_short))
                        .is_ok(),
                );
            },
        ],
    );
    let pinned = |beam: &Beam, elements: usize| {
        let near = [Dof::U, Dof::ThetaX, Dof::V, Dof::W].map(|dof| dof.at(0));
        let far = [Dof::V, Dof::W].map(|dof| dof.at(elements));
        let pins = [&near[..], &far[..]].concat();
        beam.assemble_banded().fixed(&pins).into_diagnostic()
    };
    let (whole, half) = (pinned(&long, elements)?, pinned(&short, elements / 2)?);
    let mut found = true;
    let mut failed = false;
    let [modes, half_modes] = least(
        plan.repetitions,
        [
            &mut || found &= lowest_modes(black_box(&whole), 6).is_ok(),
            &mut || failed |= lowest_modes(black_box(&half), 6).is_err(),
        ],
    );
    miette::ensure!(found && !failed, "the beam's modes were not found");
    let row = |name: String, value: f64, ratio: f64| Row {
        name,
        value,
        unit: "s",
        ratio,
        against: "cost in proportion to half as many elements",
    };
    let count = elements as f64;
    Ok(vec![
        row(
            format!("beam of {elements} elements, M and K, an element"),
            assembled / count,
            2.0 * half_assembled / assembled,
        ),
        row(
            format!("beam of {elements} elements, six modes"),
            modes,
            2.0 * half_modes / modes,
        ),
    ])
}
