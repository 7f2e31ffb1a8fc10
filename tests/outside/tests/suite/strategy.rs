//! The outside strategy beside those of the library.

use axis_pipeline::PipelineError;
use axis_pipeline::compensation::{compensate, compensate_with, find, runs};
use axis_pipeline::sampling::{SamplePlan, Sampler, SpeedDensity, ranges};
use axis_pipeline::strategies::{NONE, Need, Predictors, ReportTable, STRATEGIES, of_table};
use axis_pipeline::summary::{self, Compensated};
use axis_pipeline::training::{NetworkPlan, train};
use axis_pipeline::validation::validate;
use compensator::TransferFunctionModel;
use outside::ACCELERATION_FEEDFORWARD;

use crate::read;

/// Alone it needs nothing but the axis file.
#[test]
fn it_takes_the_error_of_the_known_inertia_away() {
    let axis = read(outside::HOIST);
    let predictors = Predictors::of(&axis);
    let strategies = [&NONE, &ACCELERATION_FEEDFORWARD];
    let runs = compensate_with(&axis, &axis, &predictors, &strategies, || ()).unwrap();
    let most = |name: &str| find(&runs, 1, name).unwrap().figures.max;
    let (without, with) = (most("none"), most("acceleration_feedforward"));
    assert!(with < 0.2 * without, "{with} {without} µm");
}

/// Through all that the library does with its own: run, summed up, sorted into tables.
#[test]
fn it_appears_in_summary_and_tables_beside_the_others() {
    let axis = read(outside::HOIST);
    let plan = SamplePlan {
        count: 200,
        seed: 1,
        density: SpeedDensity::Uniform,
    };
    let samples = Sampler::new(&axis, &plan).unwrap().all().unwrap();
    let plan = NetworkPlan {
        hidden: vec![2],
        epochs: 3,
        initial_damping: 1.0,
        seed: 1,
        threads: 1,
    };
    let network = train(&ranges(&axis).unwrap(), &samples, &plan, None, |_, _| ()).unwrap();
    let none = TransferFunctionModel::new(axis.period, 0.0, &[], &[]).unwrap();
    let predictors = Predictors::new(&axis, network.network, [none; 2], axis.friction.law);

    let strategies = outside::strategies();
    let compensated = compensate_with(&axis, &axis, &predictors, &strategies, || ()).unwrap();
    assert_eq!(compensated.len(), runs(&axis, &strategies));
    let validation = validate(&axis, &axis, &predictors, || ()).unwrap();
    let trajectories = summary::trajectories(&validation, &compensated);

    let all = &trajectories[0].errors.compensated;
    let names: Vec<&str> = all.iter().map(|(name, _)| name).collect();
    let expected: Vec<&str> = strategies.iter().map(|kind| kind.name).collect();
    assert_eq!(names, expected);
    assert_eq!(expected.len(), STRATEGIES.len() + 1);
    let json = serde_json::to_string(&trajectories).unwrap();
    assert!(
        json.contains("\"acceleration_feedforward\":{\"max\":"),
        "{json}"
    );
    let again: Compensated = serde_json::from_str(&serde_json::to_string(all).unwrap()).unwrap();
    assert_eq!(&again, all);
    let more: Vec<_> = of_table(&strategies, ReportTable::More);
    assert_eq!(more.last().unwrap().label, "acceleration feed-forward");
}

#[test]
fn what_is_missing_or_twice_is_refused_by_name() {
    let axis = read(outside::HOIST);
    let predictors = Predictors::of(&axis);
    let error = compensate(&axis, &axis, &predictors, || ()).unwrap_err();
    let need = |error: &PipelineError| {
        matches!(
            error,
            PipelineError::Missing {
                need: Need::Network,
                ..
            }
        )
    };
    assert!(need(&error), "{error}");
    assert!(
        error.to_string().contains("the strategy \"network\""),
        "{error}"
    );
    let error = validate(&axis, &axis, &predictors, || ()).unwrap_err();
    assert!(
        need(&error) && error.to_string().contains("the validation"),
        "{error}"
    );

    let own = &ACCELERATION_FEEDFORWARD;
    let error = compensate_with(&axis, &axis, &predictors, &[own, own], || ()).unwrap_err();
    assert!(matches!(
        error,
        PipelineError::SameName("acceleration_feedforward")
    ));
}
