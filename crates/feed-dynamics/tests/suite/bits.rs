//! A drive whose shaft is rigid along its axis computes what it did before there
//! was a choice, to the last bit.

use feed_dynamics::{ImplicitStepper, ModalStepper, NutCoupling, NutErrors, Settled, TimeStepper};

use crate::drive;

/// Motor angle and speed, displacement, speed and nut force as bits.
type Bits = [u64; 5];

/// The end of 2000 steps over a node of the mesh, through a gap of `gap`, under
/// a torque and a load without transcendental functions, which differ by platform.
fn end<S: TimeStepper>(stepper: &S, gap: f64) -> Bits {
    let motion = Settled {
        speed: 0.2,
        acceleration: 0.5,
        load: 300.0,
    };
    let mut state = stepper.settled(0.58, &motion).unwrap();
    for i in 0..2000 {
        let part = f64::from(i % 500) / 500.0;
        let torque = 2.0 + 60.0 * part * (1.0 - part) * (0.5 - part);
        let errors = NutErrors::new(1e-6 * part, 2e-5, gap).unwrap();
        let load = |m: feed_dynamics::TableMotion| 300.0 + 800.0 * m.speed;
        let report = stepper.step_through(&mut state, torque, &errors, load);
        assert!(report.load.converged && report.on_screw);
    }
    let o = stepper.observe(&state);
    let seen = [
        o.motor_angle,
        o.motor_speed,
        o.displacement,
        o.speed,
        o.transmission_force,
    ];
    seen.map(f64::to_bits)
}

fn both<S: TimeStepper>(name: &str, stepper: &S, expected: [Bits; 2]) {
    let found = [0.0, 2e-6].map(|gap| end(stepper, gap));
    assert_eq!(found, expected, "{name}");
}

#[test]
fn a_rigid_shaft_keeps_every_bit_of_the_implicit_stepper() {
    let of = |coupling| ImplicitStepper::new(&drive(), coupling, 1e-4).unwrap();
    let expected = [
        [
            0x403c3c1c30e46f0e,
            0x4062f71850107b60,
            0x3fa700d0c74ba9e3,
            0x3fce7489b10dd913,
            0x40832c252694f855,
        ],
        [
            0x403c3c1f07c6e484,
            0x4062f73eb193d211,
            0x3fa700bad5ebd7b8,
            0x3fce729f6ae7ae23,
            0x408301232e52145a,
        ],
    ];
    both("fixed mesh", &of(NutCoupling::ShapeFunctions), expected);
    let expected = [
        [
            0x403c3c1c238cb41d,
            0x4062f71951288220,
            0x3fa700d128838a88,
            0x3fce74794d88b845,
            0x40832437e8f7d168,
        ],
        [
            0x403c3c1efbc32fe5,
            0x4062f73edb8f697b,
            0x3fa700bb354cc76d,
            0x3fce728d0a5324dd,
            0x4082f9321e6376c3,
        ],
    ];
    both("moving node", &of(NutCoupling::MovingNode), expected);
}

// The chain's modes come from matrix products that use fused multiplications where
// the processor has them, as the one did on which these bits were found.
#[cfg(target_arch = "x86_64")]
#[test]
fn a_rigid_shaft_keeps_every_bit_of_the_modal_stepper() {
    let modal = ModalStepper::new(&drive(), 1e-4).unwrap();
    let expected = [
        [
            0x403c3c1cb5b61610,
            0x4062f6f33dd3de69,
            0x3fa700d0525e3d0c,
            0x3fce748d9c62852b,
            0x40832b003b230dc1,
        ],
        [
            0x403c3c1fe3e2f881,
            0x4062f71f0540bef0,
            0x3fa700b984db701e,
            0x3fce72c0c31cd247,
            0x40830d1af92dd0a5,
        ],
    ];
    if std::arch::is_x86_feature_detected!("fma") {
        both("modal", &modal, expected);
    }
}
