//! Whirl speeds, critical speeds and unbalance response of rotors from the literature,
//! as CSV on standard output: `rotor,quantity,spin_rad_s,index,value`.
//!
//! - `frequency` and `ratio`: damped frequency (rad/s) and damping ratio of mode `index`
//!   at the spin speed, the six lowest.
//! - `critical`: undamped synchronous critical speed `index`, rad/s.
//! - `unbalance`: half of the long axis of the orbit of node `index`, m, with 1 g·m on
//!   node 2.
//!
//! `docs/peers/beam/run` compares them with the same of ROSS.

#[path = "../tests/rotors.rs"]
mod rotors;

use beam_fem::{BeamError, Unbalance, WhirlAnalysis};

const SPINS: [f64; 4] = [0.0, 200.0, 418.879_020_478_639_1, 800.0];

fn main() -> Result<(), BeamError> {
    println!("rotor,quantity,spin_rad_s,index,value");
    for (name, rotor) in rotors::all()? {
        let system = rotor.matrices()?;
        let whirl = WhirlAnalysis::new(&system)?;
        for spectrum in whirl.campbell(&SPINS, 6)? {
            for (index, mode) in spectrum.modes.iter().enumerate() {
                let spin = spectrum.spin;
                println!(
                    "{name},frequency,{spin},{index},{:e}",
                    mode.frequency_rad_s()
                );
                println!("{name},ratio,{spin},{index},{:e}", mode.damping_ratio());
            }
        }
        // Asymmetric bearings have no undamped critical speeds, damped ones others.
        if !["cross_coupled", "damped"].contains(&name) && !name.starts_with("tapered") {
            for (index, critical) in whirl.critical_speeds(1.0, 4)?.iter().enumerate() {
                println!("{name},critical,0,{index},{:e}", critical.spin);
            }
        }
        let unbalance = Unbalance {
            node: 2,
            moment: 1e-3,
            phase: 0.0,
        };
        for response in system.unbalance_response(&[unbalance], &SPINS[1..])? {
            for node in 0..rotor.nodes() {
                let size = response.orbit(node).major();
                println!("{name},unbalance,{},{node},{size:e}", response.spin);
            }
        }
    }
    Ok(())
}
