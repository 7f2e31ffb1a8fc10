//! Figures of motulator 0.5.0, an independent program, on the machines of
//! `examples/operating_points.rs`. What makes them: `docs/peers/foc/run --figures`.

#![allow(clippy::approx_constant)] // figures of the other program, as printed

use foc_pmsm::sensorless::{FluxObserver, FluxObserverParameters};
use foc_pmsm::{Dq, MotorParameters, OperatingLimits, Pmsm};

fn machine(name: &str) -> Pmsm {
    let [pairs, resistance, d, q, flux] = match name {
        "salient" => [3.0, 3.6, 0.036, 0.051, 0.545],
        "servo" => [4.0, 0.75, 4.11e-3, 13.2e-3, 0.2735],
        "surface" => [4.0, 0.75, 4.11e-3, 4.11e-3, 0.2735],
        "inverse" => [2.0, 0.54, 37e-3, 6.2e-3, 0.3],
        _ => [2.0, 0.54, 37e-3, 6.2e-3, 0.0],
    };
    let parameters = MotorParameters {
        pole_pairs: pairs as u32,
        resistance,
        inductance_d: d,
        inductance_q: q,
        flux_linkage: flux,
    };
    Pmsm::new(parameters).unwrap_or_else(|_| Pmsm::reluctance(parameters).unwrap())
}

fn near(m: &Pmsm, i: Dq, [d, q, torque]: [f64; 3]) {
    let size = d.hypot(q);
    // 4.0e-16 of the largest of each locus measured (docs/peers/foc/run).
    assert!((i.d - d).hypot(i.q - q) < 2e-15 * size, "{i:?} {d} {q}");
    assert!(
        (m.torque(i) - torque).abs() < 1e-14 * torque,
        "{i:?} {torque}"
    );
}

/// Maximum torque per ampere: the length of the current, i_d, i_q, torque.
#[test]
fn torque_per_ampere() {
    for (name, [current, d, q, torque]) in MTPA {
        let m = machine(name);
        near(&m, m.mtpa(current), [d, q, torque]);
        near(&m, m.mtpa_for_torque(torque), [d, q, torque]);
    }
}

/// Maximum torque per volt: the length of the flux linkage, i_d, i_q, torque.
#[test]
fn torque_per_volt() {
    for (name, [flux, d, q, torque]) in MTPV {
        let m = machine(name);
        near(&m, m.mtpv(flux), [d, q, torque]);
    }
}

/// The most torque: the limit of the current, of the flux linkage, the torque, which is
/// interpolated. Without resistance, as there.
#[test]
fn torque_within_the_limits() {
    for (name, [current, flux, torque]) in MOST {
        let p = MotorParameters {
            resistance: 0.0,
            ..*machine(name).parameters()
        };
        let m = Pmsm::new(p).unwrap_or_else(|_| Pmsm::reluctance(p).unwrap());
        let voltage = 300.0;
        let speed = voltage / flux / f64::from(p.pole_pairs);
        let limits = OperatingLimits { current, voltage };
        let found = m.operating_currents(1e3, speed, &limits);
        // 7.9e-10 measured.
        assert!(
            (found.torque - torque).abs() < 4e-9 * torque,
            "{name} {found:?}"
        );
    }
}

/// The flux observer after so many microseconds, from 0.3 rad and 10 % of the speed off:
/// sine and cosine of the angle, flux linkage, speed. There by Euler's rule: at twice the
/// period the difference doubles.
#[test]
fn flux_observer() {
    const PERIOD: f64 = 1e-6;
    let (i, omega) = (Dq { d: 2.0, q: 4.0 }, 300.0);
    for (name, steps, [sin, cos, d, q, speed]) in OBSERVER {
        let m = machine(name);
        let law = FluxObserverParameters::of(&m, 80.0, PERIOD);
        let observer = FluxObserver::new(m, law).unwrap();
        let mut state = observer.begin(0.3, 0.9 * omega);
        let u = m.steady_voltage(i, omega / m.electrical_speed(1.0));
        for step in 0..steps {
            let angle = omega * PERIOD * f64::from(step);
            let estimate = observer.estimate(&state, i.inverse_park(angle));
            let middle = angle + 0.5 * omega * PERIOD;
            observer.advance(&mut state, &estimate, u.inverse_park(middle));
        }
        // 3.7e-4 measured, of the largest flux linkage.
        let (own_sin, own_cos) = state.angle.sin_cos();
        assert!(
            (own_sin - sin).hypot(own_cos - cos) < 5e-4,
            "{name} {state:?}"
        );
        let flux = (state.flux.d - d).hypot(state.flux.q - q) / d.hypot(q);
        assert!(flux < 5e-4, "{name} {state:?} {flux}");
        assert!((state.speed / speed - 1.0).abs() < 5e-4, "{name} {state:?}");
    }
}

const OBSERVER: [(&str, u32, [f64; 5]); 6] = [
    (
        "salient",
        10000,
        [
            0.17350869969741073,
            -0.9848323365575045,
            0.6449370891367368,
            0.2501035980884476,
            269.4929598674776,
        ],
    ),
    (
        "salient",
        30000,
        [
            0.5273644600524359,
            -0.8496391741637168,
            0.586580606027223,
            0.28371982483781827,
            284.7044962019236,
        ],
    ),
    (
        "inverse",
        10000,
        [
            0.12538492484149083,
            -0.9921081698194475,
            0.4241591388760397,
            -0.0003172420324727346,
            270.5573960430423,
        ],
    ),
    (
        "inverse",
        30000,
        [
            0.5195056721618455,
            -0.8544670014644621,
            0.3767690354677102,
            0.07009358226671332,
            284.8596492175338,
        ],
    ),
    (
        "reluctance",
        10000,
        [
            0.4006281931124961,
            -0.9162407166697061,
            0.0700410874823222,
            0.06669152455502171,
            262.8600931693623,
        ],
    ),
    (
        "reluctance",
        30000,
        [
            0.5493902767821471,
            -0.8355658703999558,
            0.06662449301465742,
            0.04002579117935752,
            285.73363926679485,
        ],
    ),
];

const MTPA: [(&str, [f64; 4]); 15] = [
    (
        "salient",
        [
            2.0,
            -0.10943254231282402,
            1.9970038854952066,
            4.912403291000381,
        ],
    ),
    (
        "salient",
        [
            10.0,
            -2.4278327433265114,
            9.700805542347071,
            25.380981092540054,
        ],
    ),
    (
        "salient",
        [
            50.0,
            -27.42018628388227,
            41.8106850476908,
            179.92653723430954,
        ],
    ),
    (
        "servo",
        [
            2.0,
            -0.131788827768321,
            1.99565320255686,
            3.2892111869803955,
        ],
    ),
    (
        "servo",
        [
            10.0,
            -2.8017818492511233,
            9.599480114527399,
            17.21963557242393,
        ],
    ),
    (
        "servo",
        [
            50.0,
            -28.62465071675301,
            40.9954798891767,
            131.27525220708856,
        ],
    ),
    ("surface", [2.0, 1.2246467991473532e-16, 2.0, 3.282]),
    (
        "surface",
        [10.0, 6.123233995736766e-16, 10.0, 16.410000000000004],
    ),
    (
        "surface",
        [50.0, 3.061616997868383e-15, 50.0, 82.05000000000001],
    ),
    (
        "inverse",
        [
            2.0,
            0.3808791762381988,
            1.9633978336313074,
            1.836156373362102,
        ],
    ),
    (
        "inverse",
        [
            10.0,
            5.043540632685163,
            8.634969478026761,
            11.79556824504088,
        ],
    ),
    (
        "inverse",
        [
            50.0,
            33.00403128983875,
            37.559737999876205,
            148.3449079802805,
        ],
    ),
    (
        "reluctance",
        [
            2.0,
            1.4142135623730951,
            1.414213562373095,
            0.18479999999999996,
        ],
    ),
    (
        "reluctance",
        [10.0, 7.0710678118654755, 7.071067811865475, 4.62],
    ),
    (
        "reluctance",
        [
            50.0,
            35.35533905932738,
            35.35533905932737,
            115.49999999999997,
        ],
    ),
];
const MTPV: [(&str, [f64; 4]); 15] = [
    (
        "salient",
        [
            0.072,
            -15.21636745830725,
            1.410704967775103,
            4.908695782100907,
        ],
    ),
    (
        "salient",
        [
            0.36,
            -16.953709542743542,
            6.941606502926519,
            24.968093626145215,
        ],
    ),
    (
        "salient",
        [
            1.7999999999999998,
            -39.895118758851574,
            30.664305178889816,
            157.78074498316695,
        ],
    ),
    (
        "servo",
        [
            0.00822,
            -66.58637048105999,
            0.6225941108153916,
            3.2827025627862887,
        ],
    ),
    (
        "servo",
        [
            0.0411,
            -67.55859230227117,
            3.097601184190071,
            16.496726191992867,
        ],
    ),
    (
        "servo",
        [
            0.2055,
            -85.20756140390333,
            14.443075606577112,
            90.82124265312814,
        ],
    ),
    ("surface", [0.00822, -66.54501216545013, 2.0, 3.282]),
    (
        "surface",
        [0.0411, -66.54501216545013, 10.0, 16.410000000000004],
    ),
    (
        "surface",
        [0.2055, -66.54501216545013, 50.0, 82.05000000000001],
    ),
    (
        "inverse",
        [
            0.074,
            -7.044244207465848,
            10.106813827057978,
            2.517726940787927,
        ],
    ),
    (
        "inverse",
        [
            0.37,
            -1.4333150189813963,
            44.437498007905184,
            34.10852117013124,
        ],
    ),
    (
        "inverse",
        [
            1.8499999999999999,
            26.841547558723878,
            213.38508689261212,
            721.2755207364548,
        ],
    ),
    (
        "reluctance",
        [
            0.074,
            1.4142135623730951,
            8.439661581903954,
            1.1028387096774193,
        ],
    ),
    (
        "reluctance",
        [
            0.37,
            7.071067811865476,
            42.19830790951977,
            27.570967741935487,
        ],
    ),
    (
        "reluctance",
        [
            1.8499999999999999,
            35.35533905932738,
            210.99153954759885,
            689.2741935483871,
        ],
    ),
];
const MOST: [(&str, [f64; 3]); 16] = [
    ("salient", [15.0, 1.0, 39.45844467283692]),
    ("salient", [15.0, 0.3333333333333333, 21.67904098824952]),
    ("salient", [15.0, 0.25, 16.561907992831788]),
    ("salient", [15.0, 0.1111111111111111, 7.491044206290055]),
    ("servo", [15.0, 0.75, 27.086827295987817]),
    ("servo", [15.0, 0.25, 19.825599084332776]),
    ("surface", [15.0, 0.75, 24.615000000000002]),
    ("surface", [15.0, 0.25, 21.62734003187543]),
    ("inverse", [15.0, 1.5, 20.830656952929946]),
    ("inverse", [15.0, 0.5, 19.421636844681817]),
    ("inverse", [15.0, 0.375, 15.772384429849131]),
    ("inverse", [15.0, 0.16666666666666666, 7.221915992102066]),
    ("reluctance", [15.0, 1.5, 10.394999999999996]),
    ("reluctance", [15.0, 0.5, 10.394999999999996]),
    ("reluctance", [15.0, 0.375, 10.3219729202426]),
    ("reluctance", [15.0, 0.16666666666666666, 5.084541271644938]),
];
