//! States as bytes.

use axis_fmu::{FmiMode, Unit, UnitKind, VariableKind};

use crate::{get, ready, set, text, unit};

/// Values of all variables, as bits.
fn shown(unit: &mut Unit) -> Vec<u64> {
    let all = unit.variables().clone();
    all.iter()
        .map(|v| unit.get(v.reference).unwrap().to_bits())
        .collect()
}

/// Steps of mixed lengths under inputs that change, some of them not.
fn go_on(unit: &mut Unit, from: u32, to: u32) {
    let period = unit.axes()[0].period;
    let inputs: Vec<_> = (unit.variables().iter())
        .filter(|v| matches!(v.kind, VariableKind::Input(_)))
        .map(|v| (v.reference, v.start.unwrap()))
        .collect();
    for k in from..to {
        let wave = f64::from(k / 3 % 50) * 1e-6;
        for (reference, start) in &inputs {
            unit.set(*reference, start + wave).unwrap();
        }
        let time = unit.time();
        let step = [1.0, 0.4, 1.0, 2.6][(k % 4) as usize];
        unit.step(time, step * period).unwrap();
    }
}

/// An axis whose sensor is noisy and whose friction remembers its reversals.
fn noisy() -> String {
    let text = text("linear-motor.toml");
    let resolution = "resolution_um = 0.005";
    assert!(text.contains(resolution));
    let noisy = text.replace(resolution, &format!("{resolution}\nnoise_um = 0.1"));
    noisy
        + "\n[[effects]]\nname = \"maxwell-slip-hysteresis\"\nforce = 20\npresliding_distance = 1e-5\n"
}

#[test]
fn a_state_of_bytes_goes_on_to_the_bit() {
    for name in [
        "noisy",
        "liu2025.toml",
        "liu2025-machine.toml",
        "belt.toml",
        "rotary-table.toml",
        "linear-motor.toml",
        "rack.toml",
        "joint.toml",
    ] {
        for kind in [UnitKind::ClosedLoop, UnitKind::Plant] {
            let text = if name == "noisy" { noisy() } else { text(name) };
            let fresh = Unit::of(kind, name, &text).unwrap();
            let mut one = fresh.clone();
            let mass = (one.variables().iter())
                .find(|v| v.name.contains("mass") || v.name.contains("inertia"))
                .map(|v| (v.name.clone(), v.start.unwrap()));
            let (mass, before) = mass.unwrap();
            set(&mut one, &mass, 0.9 * before);
            one.enter_initialization(1.0, Some(100.0)).unwrap();
            one.exit_initialization().unwrap();
            go_on(&mut one, 0, 700);
            let bytes = one.to_bytes().unwrap();
            // In another instance, which knows nothing of the first.
            let mut other = fresh.from_bytes(&bytes).unwrap();
            assert_eq!(other.to_bytes().unwrap(), bytes, "{name}");
            assert_eq!(other.time().to_bits(), one.time().to_bits());
            assert_eq!(shown(&mut other), shown(&mut one), "{name}");
            let start = shown(&mut one);
            for unit in [&mut one, &mut other] {
                go_on(unit, 700, 1000);
            }
            assert_eq!(shown(&mut other), shown(&mut one), "{name}");
            assert_ne!(shown(&mut one), start, "{name}: it did not move");
        }
    }
}

/// Before the simulation, in its initialisation with outputs read, and after its end.
#[test]
fn states_of_all_modes_are_bytes() {
    let mut one = unit("liu2025.toml");
    let mut states = vec![one.clone()];
    set(&mut one, "position_ref_m", 0.5);
    one.enter_initialization(0.0, None).unwrap();
    states.push(one.clone());
    let _ = get(&mut one, "machine.position_m");
    states.push(one.clone());
    set(&mut one, "position_ref_m", 0.4);
    states.push(one.clone());
    one.exit_initialization().unwrap();
    set(&mut one, "position_ref_m", 0.4001);
    states.push(one.clone());
    one.step(0.0, 0.1).unwrap();
    one.terminate().unwrap();
    states.push(one);
    let fresh = unit("liu2025.toml");
    for state in states {
        let bytes = state.to_bytes().unwrap();
        let mut again = fresh.from_bytes(&bytes).unwrap();
        assert_eq!(again.mode(), state.mode());
        assert_eq!(again.to_bytes().unwrap(), bytes);
        assert_eq!(
            get(&mut again, "position_ref_m"),
            get(&mut state.clone(), "position_ref_m")
        );
        if state.mode() != FmiMode::Instantiated {
            assert_eq!(shown(&mut again), shown(&mut state.clone()));
        }
    }
}

#[test]
fn other_bytes_are_refused() {
    let mut one = ready("liu2025.toml");
    one.step(0.0, 0.01).unwrap();
    let bytes = one.to_bytes().unwrap();
    let refused = |unit: &Unit, bytes: &[u8]| unit.from_bytes(bytes).unwrap_err().to_string();
    assert!(refused(&unit("belt.toml"), &bytes).contains("another unit"));
    for length in [
        0,
        1,
        7,
        8,
        16,
        bytes.len() / 2,
        bytes.len() - 8,
        bytes.len() - 1,
    ] {
        let said = refused(&one, &bytes[..length]);
        assert!(
            said.contains("damaged") && said.contains("valid:"),
            "{said}"
        );
    }
    for at in (0..bytes.len()).step_by(5) {
        let mut bytes = bytes.clone();
        bytes[at] ^= 1 << (at % 8);
        assert!(refused(&one, &bytes).contains("damaged"));
    }
    // What had to be given up is not worth bytes.
    set(&mut one, "position_ref_m", 1.2);
    let time = one.time();
    one.step(time, 0.01).unwrap_err();
    let said = one.to_bytes().unwrap_err().to_string();
    assert!(said.contains("stopped by an error"), "{said}");
}
