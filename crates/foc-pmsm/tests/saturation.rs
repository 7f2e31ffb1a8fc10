//! Flux maps: inverse, symmetry, tables; the saturated motor against the linear one.

use crate::axis::{drawn_motor, log_uniform, motor};
use foc_pmsm::saturation::{
    AlgebraicSaturation, AlgebraicSaturationParameters, FluxMap, FluxTable, FluxTableParts,
    SaturatedMotor,
};
use foc_pmsm::{Dq, FocError};
use proptest::prelude::*;

fn dq(d: f64, q: f64) -> Dq {
    Dq { d, q }
}

fn length(x: Dq) -> f64 {
    x.d.hypot(x.q)
}

/// The 6.7 kW synchronous reluctance motor of motulator's examples.
fn reluctance() -> AlgebraicSaturationParameters {
    AlgebraicSaturationParameters {
        self_d: [17.4, 373.0],
        self_q: [52.1, 658.0],
        cross: 1120.0,
        exponents_self: [5, 1],
        exponents_cross: [1, 0],
        magnets: 0.0,
    }
}

/// Any exponents and coefficients; in units in which the fluxes are about 1.
fn drawn_model() -> impl Strategy<Value = AlgebraicSaturation> {
    let coefficient = || log_uniform(0.1, 10.0);
    (
        prop::array::uniform4(coefficient()),
        prop::array::uniform4(0u8..=6),
        0.0..1.0,
        -3.0..3.0,
    )
        .prop_map(|([d0, dd, q0, qq], [s, t, u, v], share, magnets)| {
            // Convex up to fluxes of 1: the cross term's own part of ∂i/∂λ is below that
            // of the constants there.
            let cross = share * d0.min(q0) / 2.0;
            AlgebraicSaturation::new(AlgebraicSaturationParameters {
                self_d: [d0, dd],
                self_q: [q0, qq],
                cross,
                exponents_self: [s, t],
                exponents_cross: [u, v],
                magnets,
            })
            .unwrap()
        })
}

proptest! {
    /// There and back.
    #[test]
    fn the_inverse_is_one(model in drawn_model(), d in -1.0..1.0, q in -1.0..1.0) {
        let flux = dq(d, q);
        let back = model.flux(model.current(flux));
        // 3.0e-15 measured.
        prop_assert!(length(back - flux) < 1e-13, "{:?} {:?}", back, flux);
    }

    /// The incremental inductances are what a small change of the flux shows, and those
    /// of one energy.
    #[test]
    fn inductances_are_slopes(model in drawn_model(), d in -1.0..1.0, q in -1.0..1.0) {
        let h = 1e-5;
        let slope = |step: Dq| {
            let (up, down) = (dq(d, q) + step, dq(d, q) - step);
            (model.current(up) - model.current(down)) * (0.5 / h)
        };
        let (by_d, by_q) = (slope(dq(h, 0.0)), slope(dq(0.0, h)));
        let l = model.inductances(model.current(dq(d, q)));
        prop_assert_eq!(l.dq, l.qd);
        // The inverse of the matrix of slopes, against l: their product is 1.
        let product = [
            by_d.d * l.dd + by_q.d * l.qd - 1.0,
            by_d.d * l.dq + by_q.d * l.qq,
            by_d.q * l.dd + by_q.q * l.qd,
            by_d.q * l.dq + by_q.q * l.qq - 1.0,
        ];
        let size = (by_d.d + by_q.q) * (l.dd + l.qq);
        let worst = product.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        // 8.2e-10 measured, of the differences.
        prop_assert!(worst < 1e-8 * size, "{}", worst);
        let scale = by_d.d.abs() + by_q.q.abs();
        prop_assert!((by_d.q - by_q.d).abs() < 1e-7 * scale);
    }

    /// Without powers it is the linear motor, whatever is asked of it.
    #[test]
    fn without_saturation_it_is_the_linear_motor(
        m in drawn_motor(), d in -50.0..50.0, q in -50.0..50.0, speed in -300.0..300.0,
    ) {
        let p = *m.parameters();
        let model = AlgebraicSaturation::new(AlgebraicSaturationParameters {
            self_d: [1.0 / p.inductance_d, 0.0],
            self_q: [1.0 / p.inductance_q, 0.0],
            cross: 0.0,
            exponents_self: [3, 0],
            exponents_cross: [1, 1],
            magnets: p.flux_linkage / p.inductance_d,
        })
        .unwrap();
        let saturated = SaturatedMotor::new(p.pole_pairs, p.resistance, model).unwrap();
        let linear = SaturatedMotor::new(p.pole_pairs, p.resistance, m).unwrap();
        let i = dq(d, q);
        let flux = length(m.flux(i)) + p.flux_linkage;
        let near = |a: f64, b: f64, size: f64| (a - b).abs() < 1e-12 * size;
        let size = f64::from(p.pole_pairs) * flux * (length(i) + p.flux_linkage / p.inductance_d);
        for motor_torque in [saturated.torque(i), linear.torque(i)] {
            prop_assert!(near(motor_torque, m.torque(i), 2.0 * size));
        }
        prop_assert!(near(saturated.torque_at_flux(m.flux(i)), m.torque(i), 2.0 * size));
        let u = m.steady_voltage(i, speed);
        let off = saturated.steady_voltage(i, speed) - u;
        let voltage = p.resistance * length(i) + m.electrical_speed(speed.abs()) * flux;
        prop_assert!(length(off) < 1e-12 * voltage + 1e-12);
        let l = saturated.map().inductances(i);
        prop_assert!(near(l.dd, p.inductance_d, p.inductance_d) && l.dq == 0.0);
        prop_assert!(near(l.qq, p.inductance_q, p.inductance_q));
    }

    /// A table of a linear motor is that motor, inside and beyond, both ways.
    #[test]
    fn a_table_of_a_linear_motor_is_exact(
        m in drawn_motor(), d in -40.0..40.0, q in -40.0..40.0,
    ) {
        let (id, iq) = ([-20.0, -3.0, 0.0, 11.0], [-15.0, 2.0, 20.0]);
        let (mut flux_d, mut flux_q) = (Vec::new(), Vec::new());
        for &d in &id {
            for &q in &iq {
                let flux = m.flux(dq(d, q));
                flux_d.push(flux.d);
                flux_q.push(flux.q);
            }
        }
        let parts = FluxTableParts { id: &id, iq: &iq, flux_d: &flux_d, flux_q: &flux_q };
        let table = FluxTable::new(parts).unwrap();
        let i = dq(d, q);
        let p = m.parameters();
        let size = p.flux_linkage + 80.0 * p.inductance_d.max(p.inductance_q);
        prop_assert!(length(table.flux(i) - m.flux(i)) < 1e-14 * size);
        let back = table.current(m.flux(i));
        let least = p.inductance_d.min(p.inductance_q);
        prop_assert!(length(back - i) < 1e-13 * size / least, "{:?}", back);
        let l = table.inductances(i);
        prop_assert!((l.dd - p.inductance_d).abs() < 1e-13 * size);
        prop_assert!(l.dq.abs() < 1e-13 * size && l.qd.abs() < 1e-13 * size);
    }

    /// A table of the saturated machine: there and back, wherever it is asked.
    #[test]
    fn a_table_is_invertible(d in -30.0..30.0, q in -30.0..30.0, nodes in 5usize..30) {
        let sampled = Sampled::new(nodes);
        let table = sampled.table();
        let i = dq(d, q);
        let back = table.current(table.flux(i));
        // 3.3e-14 A measured.
        prop_assert!(length(back - i) < 1e-12, "{:?} {:?}", back, i);
    }
}

/// The reluctance machine on a square grid of currents.
struct Sampled {
    grid: Vec<f64>,
    flux: [Vec<f64>; 2],
}

impl Sampled {
    fn new(nodes: usize) -> Self {
        let model = AlgebraicSaturation::new(reluctance()).unwrap();
        let grid: Vec<f64> = (0..nodes)
            .map(|k| -30.0 + 60.0 * k as f64 / (nodes - 1) as f64)
            .collect();
        let mut flux = [Vec::new(), Vec::new()];
        for &d in &grid {
            for &q in &grid {
                let node = model.flux(dq(d, q));
                flux[0].push(node.d);
                flux[1].push(node.q);
            }
        }
        Self { grid, flux }
    }

    fn table(&self) -> FluxTable<'_> {
        FluxTable::new(FluxTableParts {
            id: &self.grid,
            iq: &self.grid,
            flux_d: &self.flux[0],
            flux_q: &self.flux[1],
        })
        .unwrap()
    }
}

/// Half the spacing leaves a quarter of the error.
#[test]
fn tables_converge() {
    let model = AlgebraicSaturation::new(reluctance()).unwrap();
    let error = |nodes: usize| {
        let sampled = Sampled::new(nodes);
        let table = sampled.table();
        let points = (0..400).map(|k| {
            let x = f64::from(k) * 0.618_033_988_749_895;
            dq(4.0 + 24.0 * x.fract(), 4.0 + 24.0 * f64::from(k) / 400.0)
        });
        points
            .map(|i| length(table.flux(i) - model.flux(i)))
            .fold(0.0, f64::max)
    };
    // 3.89 measured.
    let ratio = error(121) / error(241);
    assert!((3.5..4.5).contains(&ratio), "{ratio}");
}

/// Fourth order, against the exact step of the linear motor.
#[test]
fn the_step_is_of_fourth_order() {
    let m = motor();
    let p = m.parameters();
    let with_map = SaturatedMotor::new(p.pole_pairs, p.resistance, m).unwrap();
    let (i0, u, speed, t) = (dq(1.0, -2.0), dq(20.0, 120.0), 150.0, 4e-3);
    let exact = m.step_exact(i0, u, speed, t);
    let error = |n: i32| {
        let h = t / f64::from(n);
        let end = (0..n).fold(m.flux(i0), |flux, _| with_map.step(flux, u, speed, h));
        length(m.current_of_flux(end) - exact)
    };
    for n in [20, 40] {
        let order = (error(n) / error(2 * n)).log2();
        // 4.08 and 4.03 measured.
        assert!((order - 4.0).abs() < 0.1, "{n}: {order}");
    }
}

/// Without resistance and voltage the saturated flux stands still in the stator.
#[test]
fn the_flux_of_a_short_circuit_stands() {
    let model = AlgebraicSaturation::new(reluctance()).unwrap();
    let free = SaturatedMotor::new(2, 0.0, model).unwrap();
    let (start, speed, h) = (dq(0.5, 0.2), 150.0, 1e-5);
    let end = (0..1000).fold(start, |flux, _| free.step(flux, Dq::ZERO, speed, h));
    let expected = start.inverse_park(0.0).park(2.0 * speed * h * 1000.0);
    // Of the rule: 1000 (ω h)⁵/120 of the flux, 1e-12.
    assert!(
        length(end - expected) < 3e-12,
        "{:e}",
        length(end - expected)
    );
}

#[test]
fn bad_parameters_are_named() {
    let good = reluctance();
    let field = |p| match AlgebraicSaturation::new(p) {
        Err(FocError::OutOfRange { field, .. }) => field,
        other => panic!("{other:?}"),
    };
    let bad = AlgebraicSaturationParameters {
        self_d: [0.0, 1.0],
        ..good
    };
    assert_eq!(field(bad), "self_d[0]");
    let bad = AlgebraicSaturationParameters {
        self_q: [1.0, -1.0],
        ..good
    };
    assert_eq!(field(bad), "self_q[1]");
    let bad = AlgebraicSaturationParameters {
        cross: f64::NAN,
        ..good
    };
    assert_eq!(field(bad), "cross");
    let bad = AlgebraicSaturationParameters {
        exponents_cross: [1, 21],
        ..good
    };
    assert_eq!(field(bad), "exponents_cross[1]");
    let bad = AlgebraicSaturationParameters {
        magnets: f64::INFINITY,
        ..good
    };
    assert_eq!(field(bad), "magnets");
    let map = AlgebraicSaturation::new(good).unwrap();
    assert_eq!(SaturatedMotor::new(0, 1.0, map), Err(FocError::NoPolePairs));
    assert!(SaturatedMotor::new(1, -1.0, map).is_err());
}

#[test]
fn bad_tables_are_named() {
    let (grid, flux) = ([0.0, 1.0], [0.0, 0.0, 1.0, 1.0]);
    let other = [0.0, 1.0, 0.0, 1.0];
    let parts = FluxTableParts {
        id: &grid,
        iq: &grid,
        flux_d: &flux,
        flux_q: &other,
    };
    assert!(FluxTable::new(parts).is_ok());
    let folded = FluxTable::new(FluxTableParts {
        flux_q: &flux,
        ..parts
    });
    assert_eq!(folded, Err(FocError::FoldedCell { row: 0, column: 0 }));
    let message = folded.unwrap_err().to_string();
    assert!(message.contains("rows 0 and 0 + 1"), "{message}");
    let short = FluxTable::new(FluxTableParts {
        flux_d: &grid,
        ..parts
    })
    .unwrap_err();
    assert_eq!(
        short.to_string(),
        "flux_d has 2 entries, which is not valid: must be rows times columns"
    );
    let single = FluxTable::new(FluxTableParts {
        id: &grid[..1],
        ..parts
    });
    assert!(matches!(
        single,
        Err(FocError::TableShape {
            field: "id",
            length: 1,
            ..
        })
    ));
    let back = FluxTable::new(FluxTableParts {
        iq: &[1.0, 1.0],
        ..parts
    });
    assert!(matches!(
        back,
        Err(FocError::OutOfRange { field: "iq", .. })
    ));
    let nan = [0.0, f64::NAN, 1.0, 1.0];
    let holes = FluxTable::new(FluxTableParts {
        flux_d: &nan,
        ..parts
    });
    assert!(matches!(
        holes,
        Err(FocError::OutOfRange {
            field: "flux_d",
            ..
        })
    ));
}

/// What is not a number comes back so, both ways.
#[test]
fn no_numbers() {
    let model = AlgebraicSaturation::new(reluctance()).unwrap();
    let sampled = Sampled::new(7);
    let table = sampled.table();
    for bad in [f64::NAN, f64::INFINITY] {
        for x in [dq(bad, 1.0), dq(1.0, bad)] {
            for out in [
                model.flux(x),
                model.current(x),
                table.flux(x),
                table.current(x),
            ] {
                assert!(!(out.d.is_finite() && out.q.is_finite()), "{x:?} {out:?}");
            }
        }
    }
    assert_eq!(model.flux(Dq::ZERO), Dq::ZERO);
}

/// In `f32` as far as its last place goes.
#[test]
fn in_single_precision() {
    let p = reluctance();
    let single = AlgebraicSaturation::new(AlgebraicSaturationParameters {
        self_d: p.self_d.map(|x| x as f32),
        self_q: p.self_q.map(|x| x as f32),
        cross: p.cross as f32,
        exponents_self: p.exponents_self,
        exponents_cross: p.exponents_cross,
        magnets: 0.0,
    })
    .unwrap();
    let double = AlgebraicSaturation::new(p).unwrap();
    for k in 0..200 {
        let x = f64::from(k) * 0.618_033_988_749_895;
        let (d, q) = (40.0 * x.fract() - 20.0, 40.0 * f64::from(k) / 200.0 - 20.0);
        let a = single.flux(Dq {
            d: d as f32,
            q: q as f32,
        });
        let b = double.flux(dq(d, q));
        let apart = length(dq(f64::from(a.d), f64::from(a.q)) - b);
        // 3.9e-8 V·s of 0.6 measured.
        assert!(apart < 1e-6, "{d} {q} {apart}");
    }
}
