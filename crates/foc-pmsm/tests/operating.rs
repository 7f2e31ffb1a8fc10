//! Operating points: loci of most torque, limits of current and voltage.

use crate::axis::{drawn_motor, log_uniform, motor};
use foc_pmsm::{
    Decoupling, DecouplingCurrent, Dq, FocError, MotorParameters, OperatingLimits, OperatingRegion,
    Pmsm, ServoState,
};
use proptest::prelude::*;

fn length(x: Dq) -> f64 {
    x.d.hypot(x.q)
}

fn with_flux(m: &Pmsm, flux_linkage: f64) -> MotorParameters {
    MotorParameters {
        flux_linkage,
        ..*m.parameters()
    }
}

/// Magnets weaker and stronger than the current's flux, none, and surface machines.
fn any_motor() -> impl Strategy<Value = Pmsm> {
    (drawn_motor(), 0..6).prop_map(|(m, kind)| {
        let p = *m.parameters();
        match kind {
            0 if p.inductance_d != p.inductance_q => Pmsm::reluctance(with_flux(&m, 0.0)).unwrap(),
            1 => Pmsm::new(MotorParameters {
                inductance_q: p.inductance_d,
                ..p
            })
            .unwrap(),
            _ => m,
        }
    })
}

/// A current that saliency and magnets both matter at: 0.05 to 20 times ψ/|Δ|, or of
/// some amperes where one of them is missing.
fn scale(m: &Pmsm) -> f64 {
    let p = m.parameters();
    let own = p.flux_linkage / (p.inductance_q - p.inductance_d).abs();
    if own.is_finite() && own > 0.0 {
        own
    } else {
        5.0
    }
}

proptest! {
    /// No current of the same length makes more torque, and the torque's own point is
    /// the same one.
    #[test]
    fn mtpa_is_the_most_per_ampere(
        m in any_motor(), relative in log_uniform(0.05, 20.0), angle in 0.0..3.15,
    ) {
        let size = relative * scale(&m);
        let best = m.mtpa(size);
        prop_assert!((length(best) - size).abs() < 4.0 * f64::EPSILON * size);
        let torque = m.torque(best);
        let (sin, cos) = f64::sin_cos(angle);
        let other = m.torque(Dq { d: size * cos, q: size * sin });
        prop_assert!(other <= torque * (1.0 + 1e-12), "{} {}", other, torque);
        // 5.5e-16 of the length and 8.2e-16 of the torque measured.
        let back = m.mtpa_for_torque(torque);
        prop_assert!(length(back - best) < 4e-15 * size, "{}", length(back - best) / size);
        let mirrored = m.mtpa_for_torque(-torque);
        prop_assert_eq!((mirrored.d, mirrored.q), (back.d, -back.q));
        let made = m.torque(back);
        prop_assert!((made - torque).abs() < 4e-15 * torque);
    }

    /// No flux of the same length makes more torque.
    #[test]
    fn mtpv_is_the_most_per_volt(
        m in any_motor(), relative in log_uniform(0.05, 20.0), angle in 0.0..3.15,
    ) {
        let p = m.parameters();
        let size = relative * (p.flux_linkage + p.inductance_d * scale(&m));
        let best = m.mtpv(size);
        let flux = m.flux(best);
        prop_assert!((length(flux) - size).abs() < 1e-13 * size);
        let (sin, cos) = f64::sin_cos(angle);
        let other = m.current_of_flux(Dq { d: size * cos, q: size * sin });
        let torque = m.torque(best);
        let rounding = 1e-12 * (torque + size * (length(other) + length(best)));
        prop_assert!(m.torque(other) <= torque + rounding);
    }

    /// Both limits hold, the torque asked for is made or named as less, and what the
    /// region says is so.
    #[test]
    fn the_limits_hold(
        m in any_motor(), relative in log_uniform(0.05, 20.0), share in -2.0..2.0,
        base in log_uniform(0.1, 10.0), backwards in any::<bool>(),
    ) {
        let case = Case::new(&m, relative, base, backwards);
        let asked = share * case.torque;
        let found = m.operating_currents(asked, case.speed, &case.limits);
        let (i, u) = (found.current, m.steady_voltage(found.current, case.speed));
        prop_assert!(length(i) <= case.limits.current * (1.0 + 1e-14));
        let spare = 1.0 - length(u) / case.limits.voltage;
        if found.region != OperatingRegion::Unreachable {
            // Of sums whose parts are that much larger than the voltage: 1.5e-16 measured.
            prop_assert!(spare > -2e-15 * case.parts(&m), "{}", spare);
        }
        prop_assert_eq!(found.torque, m.torque(i));
        let missing = asked.abs() - found.torque * asked.signum();
        match found.region {
            OperatingRegion::Mtpa => {
                prop_assert!(missing.abs() < 1e-12 * asked.abs());
                prop_assert_eq!(i, m.mtpa_for_torque(asked));
            }
            OperatingRegion::FieldWeakening => {
                prop_assert!(missing.abs() < 1e-12 * case.torque || missing > 0.0);
                let least = m.mtpa_for_torque(found.torque);
                prop_assert!(length(i) >= length(least) * (1.0 - 1e-12));
            }
            OperatingRegion::CurrentLimit => prop_assert!(missing > 0.0),
            _ => prop_assert!(missing >= -1e-12 * case.torque),
        }
    }

    /// Against all currents within both limits, on a grid of angle and length: none makes
    /// the torque with less, none makes more where it is not made.
    #[test]
    fn no_current_does_better(
        m in any_motor(), relative in log_uniform(0.05, 20.0), share in 0.0..2.0,
        base in log_uniform(0.1, 10.0), backwards in any::<bool>(),
    ) {
        let case = Case::new(&m, relative, base, backwards);
        let asked = share * case.torque;
        let found = m.operating_currents(asked, case.speed, &case.limits);
        prop_assume!(found.region != OperatingRegion::Unreachable);
        let whole = found.torque > asked * (1.0 - 1e-9) - 1e-9 * case.torque;
        for i in case.allowed(&m) {
            let torque = m.torque(i);
            if whole {
                let shorter = length(i) < length(found.current) * (1.0 - 1e-9) - 1e-9;
                prop_assert!(!(shorter && torque >= asked), "{:?} {:?}", i, found);
            } else {
                prop_assert!(torque <= found.torque + 1e-9 * case.torque, "{:?} {:?}", i, found);
            }
        }
    }

    /// More speed never leaves more torque to a motor, more limits never less.
    #[test]
    fn the_most_torque_is_monotonic(
        m in any_motor(), relative in log_uniform(0.05, 20.0), base in log_uniform(0.1, 10.0),
        more in 1.0..2.0,
    ) {
        let case = Case::new(&m, relative, base, false);
        let most = |speed: f64, limits: &OperatingLimits| {
            let found = m.operating_currents(1e3 * case.torque, speed, limits);
            let out = found.region == OperatingRegion::Unreachable;
            if out { 0.0 } else { found.torque }
        };
        let here = most(case.speed, &case.limits);
        let rounding = 1e-9 * case.torque;
        prop_assert!(most(more * case.speed, &case.limits) <= here + rounding);
        let OperatingLimits { current, voltage } = case.limits;
        let wider = OperatingLimits { current: more * current, voltage };
        prop_assert!(most(case.speed, &wider) >= here - rounding);
        let wider = OperatingLimits { current, voltage: more * voltage };
        prop_assert!(most(case.speed, &wider) >= here - rounding);
    }

    /// `f32` finds the torque and keeps the limits to its own rounding.
    #[test]
    fn in_single_precision(
        m in any_motor(), relative in log_uniform(0.05, 20.0), share in -2.0..2.0,
        base in log_uniform(0.1, 10.0),
    ) {
        let case = Case::new(&m, relative, base, false);
        let asked = share * case.torque;
        let double = m.operating_currents(asked, case.speed, &case.limits);
        let single = narrowed(&m);
        let limits = OperatingLimits {
            current: case.limits.current as f32,
            voltage: case.limits.voltage as f32,
        };
        let found = single.operating_currents(asked as f32, case.speed as f32, &limits);
        let i = found.current;
        prop_assert!(i.d.hypot(i.q) <= limits.current * (1.0 + 4.0 * f32::EPSILON));
        let one = [double.region, found.region];
        // A limit that is met exactly may be met on the other side.
        prop_assume!(!one.contains(&OperatingRegion::Unreachable));
        let apart = (f64::from(found.torque) - double.torque).abs();
        // 1.3e-5 measured, and up to 7.2e-4 (a root of the rounding) where the voltage
        // leaves hardly any i_d.
        prop_assert!(apart < 5e-3 * case.torque, "{} {:?} {:?}", apart / case.torque, found, double);
    }
}

fn narrowed(m: &Pmsm) -> Pmsm<f32> {
    let p = m.parameters();
    let narrow = MotorParameters {
        pole_pairs: p.pole_pairs,
        resistance: p.resistance as f32,
        inductance_d: p.inductance_d as f32,
        inductance_q: p.inductance_q as f32,
        flux_linkage: p.flux_linkage as f32,
    };
    if p.flux_linkage > 0.0 {
        Pmsm::new(narrow).unwrap()
    } else {
        Pmsm::reluctance(narrow).unwrap()
    }
}

/// A current limit, and a voltage limit that the current limit's most torque meets at
/// `base` of the speed.
struct Case {
    limits: OperatingLimits,
    speed: f64,
    torque: f64,
}

impl Case {
    fn new(m: &Pmsm, relative: f64, base: f64, backwards: bool) -> Self {
        let current = relative * scale(m);
        let strongest = m.mtpa(current);
        let flux = length(m.flux(strongest));
        let p = m.parameters();
        // The resistance's share of the voltage is a tenth.
        let omega = base * 10.0 * p.resistance * current / flux;
        let voltage = 1.1 * 10.0 * p.resistance * current;
        let speed = omega / m.electrical_speed(1.0);
        Self {
            limits: OperatingLimits { current, voltage },
            speed: if backwards { -speed } else { speed },
            torque: m.torque(strongest),
        }
    }

    /// What the voltage is the sum of, over the limit.
    fn parts(&self, m: &Pmsm) -> f64 {
        let p = m.parameters();
        let omega = m.electrical_speed(self.speed).abs();
        let inductance = p.inductance_d.max(p.inductance_q);
        let flux = inductance * self.limits.current + p.flux_linkage;
        let largest = omega * flux + p.resistance * self.limits.current;
        // The voltage's square is a difference of theirs.
        (largest / self.limits.voltage).powi(2)
    }

    fn allowed<'a>(&'a self, m: &'a Pmsm) -> impl Iterator<Item = Dq> + 'a {
        let grid = (0..=60).flat_map(|a| (0..=40).map(move |r| (a, r)));
        grid.filter_map(move |(a, r)| {
            let (sin, cos) = f64::sin_cos(std::f64::consts::PI * f64::from(a) / 60.0);
            let size = self.limits.current * f64::from(r) / 40.0;
            let i = Dq {
                d: size * cos,
                q: size * sin,
            };
            let u = length(m.steady_voltage(i, self.speed));
            // The torque must be one that can be taken off (see the documentation).
            let off = Dq { d: i.d, q: 0.0 };
            let without = length(m.steady_voltage(off, self.speed));
            let inside = u <= self.limits.voltage && without <= self.limits.voltage;
            (inside && m.torque(i) >= 0.0).then_some(i)
        })
    }
}

/// What is not a number comes back so, and any number comes back as something.
#[test]
fn numbers_and_none() {
    let m = motor();
    let limits = OperatingLimits {
        current: 15.0,
        voltage: 312.0,
    };
    for (t, v, i, u) in [
        (f64::NAN, 1.0, 15.0, 312.0),
        (1.0, f64::NAN, 15.0, 312.0),
        (1.0, 1.0, f64::NAN, 312.0),
        (1.0, 1.0, 15.0, f64::NAN),
    ] {
        let limits = OperatingLimits {
            current: i,
            voltage: u,
        };
        let found = m.operating_currents(t, v, &limits);
        assert!(found.current.d.is_nan() && found.current.q.is_nan() && found.torque.is_nan());
        assert_eq!(found.region, OperatingRegion::Unreachable);
    }
    assert!(m.mtpa(f64::NAN).d.is_nan() && m.mtpa_for_torque(f64::NAN).q.is_nan());
    assert!(m.mtpv(f64::NAN).d.is_nan());
    assert_eq!(m.mtpa(0.0), Dq::ZERO);
    assert_eq!(m.mtpa_for_torque(0.0), Dq::ZERO);
    // All the torque that there is: at standstill the current limit decides.
    let all = m.operating_currents(f64::INFINITY, 0.0, &limits);
    assert_eq!(all.region, OperatingRegion::CurrentLimit);
    assert_eq!(all.current, m.mtpa(15.0));
    // Without limits a drive has any torque at any speed.
    let none = OperatingLimits {
        current: f64::INFINITY,
        voltage: f64::INFINITY,
    };
    let free = m.operating_currents(500.0, 900.0, &none);
    assert_eq!(free.region, OperatingRegion::Mtpa);
    // Too fast for 15 A to hold the magnets' flux down.
    let fast = m.operating_currents(1.0, 2000.0, &limits);
    assert_eq!(fast.region, OperatingRegion::Unreachable);
    assert_eq!((fast.current.d, fast.current.q), (-15.0, 0.0));
    let nothing = OperatingLimits {
        current: -1.0,
        voltage: -1.0,
    };
    assert_eq!(m.operating_currents(1.0, 10.0, &nothing).current, Dq::ZERO);
}

/// With magnets only [`Pmsm::new`], without them only [`Pmsm::reluctance`].
#[test]
fn reluctance_motors() {
    let p = with_flux(&motor(), 0.0);
    assert!(Pmsm::new(p).is_err());
    let m = Pmsm::reluctance(p).unwrap();
    let i = m.mtpa(10.0);
    // The larger inductance is that of q: i_d is against the flux of no magnet.
    assert!((i.d + i.q).abs() < 1e-14 && i.q > 0.0 && m.torque(i) > 0.0);
    assert_eq!(m.torque(Dq { d: 0.0, q: 10.0 }), 0.0);
    assert!(m.q_current(1.0).is_infinite());
    let field = |p| match Pmsm::reluctance(p) {
        Err(FocError::OutOfRange { field, .. }) => field,
        other => panic!("{other:?}"),
    };
    assert_eq!(field(with_flux(&motor(), 0.1)), "flux_linkage");
    assert_eq!(field(with_flux(&motor(), f64::NAN)), "flux_linkage");
    let round = MotorParameters {
        inductance_q: p.inductance_d,
        ..p
    };
    assert_eq!(field(round), "inductance_q");
    let none = MotorParameters { pole_pairs: 0, ..p };
    assert_eq!(Pmsm::reluctance(none), Err(FocError::NoPolePairs));
}

/// In the closed loop the currents settle from 1 A away at the operating point beyond base speed, at the
/// predicted voltage, within the voltage that is left to the limit.
#[test]
fn the_controllers_reach_the_point() {
    let m = motor();
    let limits = OperatingLimits {
        current: 15.0,
        voltage: 300.0,
    };
    let speed = 320.0;
    let point = m.operating_currents(6.0, speed, &limits);
    assert_eq!(point.region, OperatingRegion::FieldWeakening);
    let servo = crate::axis::servo();
    let added = Decoupling::new(m, DecouplingCurrent::Measured);
    let mut state = ServoState::default();
    let mut i = point.current + Dq { d: 1.0, q: -1.0 };
    let mut u = Dq::ZERO;
    for _ in 0..20_000 {
        let induced = added.voltage(i, point.current, speed);
        (u, _, _) = servo.current_loop(&mut state, point.current - i, induced);
        i = m.step(i, u, speed, servo.period());
    }
    // 1.3e-14 A and 1.1e-13 V measured.
    assert!(length(i - point.current) < 1e-13 && (m.torque(i) - 6.0).abs() < 1e-12);
    assert!((length(u) - 300.0).abs() < 1e-12);
}
