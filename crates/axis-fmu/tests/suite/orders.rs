//! Hostile orders and values are refused, and leave the unit as it was.

use axis_fmu::{FmiMode, Unit, UnitError};

use crate::{at, get, ready, set, unit};

const PERIOD: f64 = 1e-4;

fn words(result: Result<impl Sized, UnitError>) -> String {
    match result {
        Ok(_) => panic!("it was accepted"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn the_order_is_that_of_the_standard() {
    let mut unit = unit("liu2025.toml");
    for refused in [
        words(unit.step(0.0, PERIOD)),
        words(unit.exit_initialization()),
        words(unit.terminate()),
    ] {
        assert!(
            refused.contains("instantiated") && refused.contains("valid:"),
            "{refused}"
        );
    }
    let position = at(&unit, "machine.position_m");
    assert!(words(unit.get(position)).contains("initialization"));
    unit.enter_initialization(0.0, None).unwrap();
    assert!(words(unit.enter_initialization(0.0, None)).contains("initialization mode"));
    assert!(words(unit.step(0.0, PERIOD)).contains("initialization mode"));
    unit.exit_initialization().unwrap();
    assert!(words(unit.exit_initialization()).contains("step mode"));
    unit.terminate().unwrap();
    for refused in [
        words(unit.terminate()),
        words(unit.step(0.0, PERIOD)),
        words(unit.set(1, 0.6)),
    ] {
        assert!(refused.contains("terminated"), "{refused}");
    }
    assert_eq!(unit.get(position).unwrap(), 0.6);
    unit.reset();
    assert_eq!(unit.mode(), FmiMode::Instantiated);
}

#[test]
fn steps_begin_where_the_unit_is_and_go_on() {
    let mut unit = ready("liu2025.toml");
    for step in [0.0, -PERIOD, f64::NAN, f64::INFINITY, 1e300] {
        let refused = words(unit.step(0.0, step));
        assert!(refused.contains("above 0 and at most"), "{refused}");
    }
    for point in [PERIOD, -PERIOD, f64::NAN] {
        assert!(words(unit.step(point, PERIOD)).contains("where the unit is, 0 s"));
    }
    // Nothing was done, and times may be rounded.
    assert_eq!((unit.time(), unit.mode()), (0.0, FmiMode::Step));
    let mut time = 0.0;
    for _ in 0..1000 {
        unit.step(time, (time + PERIOD) - time).unwrap();
        time += PERIOD;
    }
    assert!((unit.time() - 0.1).abs() < 1e-12);
    assert_eq!(get(&mut unit, "drive.t_s"), 999.0 * PERIOD);
    // Between two samples, too.
    unit.step(time, 0.3 * PERIOD).unwrap();
    assert!((unit.time() - (0.1 + 0.3 * PERIOD)).abs() < 1e-12);
    assert!(words(unit.step(time, PERIOD)).contains("where the unit is, 0.1"));
}

/// Importers that add up their steps, or cut the last one, end at the stop time to rounding.
#[test]
fn every_stop_time_can_be_reached() {
    for stop in [3.0, 2.5, 3.632, 1.0 / 3.0, 0.00305, 0.7] {
        for step in [0.0032, 0.001, 0.01, 1.0 / 300.0, stop / 7.0] {
            let mut unit = unit("liu2025.toml");
            unit.enter_initialization(0.0, Some(stop)).unwrap();
            unit.exit_initialization().unwrap();
            let mut time = 0.0;
            while time < stop * (1.0 - 1e-9) {
                let next = time + step;
                // As far as a comparison to nine digits lets it be beyond.
                let next = if next > stop * (1.0 + 1e-9) {
                    stop
                } else {
                    next
                };
                unit.step(time, next - time).unwrap();
                time = next;
            }
            assert!((unit.time() - stop).abs() < 1e-8, "{stop} by {step}");
        }
    }
}

#[test]
fn a_simulation_has_a_start_and_an_end() {
    let mut unit = unit("liu2025.toml");
    assert!(words(unit.enter_initialization(f64::NAN, None)).contains("start time"));
    assert!(words(unit.enter_initialization(5.0, Some(4.0))).contains("stop time"));
    unit.enter_initialization(5.0, Some(5.0 + 2.0 * PERIOD))
        .unwrap();
    unit.exit_initialization().unwrap();
    assert_eq!(get(&mut unit, "time"), 5.0);
    assert!(words(unit.step(5.0, 3.0 * PERIOD)).contains("stop time"));
    unit.step(5.0, 2.0 * PERIOD).unwrap();
    assert!(words(unit.step(unit.time(), PERIOD)).contains("stop time"));
}

/// FMI 2.0 sets the experiment up in a call of its own, which may come twice or not at all.
#[test]
fn an_experiment_is_set_up_before_the_initialization() {
    let mut unit = unit("liu2025.toml");
    unit.set_up(1.0, None).unwrap();
    unit.set_up(5.0, Some(5.0 + PERIOD)).unwrap();
    assert!(words(unit.set_up(0.0, Some(-1.0))).contains("stop time"));
    unit.begin_initialization().unwrap();
    assert!(words(unit.set_up(0.0, None)).contains("initialization mode"));
    assert!(words(unit.begin_initialization()).contains("initialization mode"));
    unit.exit_initialization().unwrap();
    unit.step(5.0, PERIOD).unwrap();
    assert!(words(unit.step(unit.time(), PERIOD)).contains("stop time"));
    unit.reset();
    unit.begin_initialization().unwrap();
    unit.exit_initialization().unwrap();
    unit.step(0.0, 1.0).unwrap();
}

#[test]
fn values_are_set_where_they_can_be() {
    let mut unit = ready("liu2025.toml");
    let last = unit.variables().iter().count() as u32 - 1;
    for reference in [last + 1, u32::MAX] {
        assert!(words(unit.set(reference, 0.0)).contains(&format!("0 to {last}")));
        assert!(words(unit.get(reference)).contains("value reference"));
    }
    let fixed = at(&unit, "mechanism.table_mass_kg");
    assert!(words(unit.set(fixed, 500.0)).contains("fixed"));
    assert!(words(unit.set(at(&unit, "machine.position_m"), 0.5)).contains("output"));
    assert!(words(unit.set(0, 1.0)).contains("time"));
    let exact = at(&unit, "unit.exact_between_samples");
    assert!(words(unit.set(exact, 1.0)).contains("fixed"));
    unit.reset();
    assert!(words(unit.set(exact, 0.5)).contains("0 or 1"));
    for value in [f64::NAN, f64::INFINITY] {
        assert!(words(unit.set(1, value)).contains("position_ref_m"));
    }
}

/// A run that is given up tells the library's words; a reset or a saved state leads back.
#[test]
fn a_run_that_stopped_can_be_taken_back() {
    let mut unit = ready("liu2025.toml");
    let saved = unit.clone();
    set(&mut unit, "position_ref_m", 1.2);
    let refused = words(unit.step(0.0, PERIOD));
    assert!(refused.contains("following_error_limit"), "{refused}");
    assert_eq!(unit.mode(), FmiMode::Failed);
    assert!(words(unit.step(0.0, PERIOD)).contains("stopped by an error"));
    unit = saved;
    unit.step(0.0, PERIOD).unwrap();
    unit.fail();
    unit.reset();
    unit.enter_initialization(0.0, None).unwrap();
    unit.exit_initialization().unwrap();
}

/// Under a force that no drive can bear the load leaves its stroke.
#[test]
fn a_load_that_leaves_the_stroke_is_told() {
    let mut unit: Unit = ready("liu2025.toml");
    set(&mut unit, "load_force_n", 1e6);
    let refused = words(unit.step(0.0, 1.0));
    assert!(
        refused.contains("the simulation stopped at t ="),
        "{refused}"
    );
    assert!(unit.time() < 1.0);
}

#[test]
fn an_axis_begins_within_its_stroke() {
    let mut unit = unit("liu2025.toml");
    unit.enter_initialization(0.0, None).unwrap();
    set(&mut unit, "position_ref_m", 7.0);
    let refused = words(unit.exit_initialization());
    assert!(
        refused.contains("stroke") || refused.contains("screw"),
        "{refused}"
    );
    set(&mut unit, "position_ref_m", 0.3);
    unit.exit_initialization().unwrap();
    assert_eq!(get(&mut unit, "machine.position_m"), 0.3);
}
