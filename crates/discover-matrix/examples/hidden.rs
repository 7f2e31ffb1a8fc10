//! Hides each effect of the library in turn, and looks for it.
//!
//! `cargo run --release --example hidden [NAME…]`

use axis_sim::Axis;
use axis_sim::effects::{ActiveEffect, EFFECTS, Effect, Scales};
use discover_matrix::hidden::{Exercise, Hidden, Noise, exercise};
use discrepancy::{LogSet, Settings, search};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/liu2025.toml");
    let axis = Axis::read(file.as_ref())?;
    let machine = axis.clone();
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let mut effects: Vec<Option<&'static Effect>> = vec![None];
    effects.extend(EFFECTS.iter().map(|e| Some(*e)));
    for (seed, effect) in effects.into_iter().enumerate() {
        let name = effect.map_or("none", |e| e.name);
        if !asked.is_empty() && !asked.iter().any(|a| a == name) {
            continue;
        }
        let hidden = Hidden {
            effects: effect
                .map(|effect| ActiveEffect {
                    effect,
                    values: effect.typical(&Scales::of(&axis)),
                })
                .into_iter()
                .collect(),
            shares: Vec::new(),
            noise: Noise::GOOD,
            seed: 100 + seed as u64,
        }
        .with_known_off_by(&axis, 0.01);
        let start = std::time::Instant::now();
        let logs = |check| -> Result<LogSet, Box<dyn std::error::Error>> {
            let motion = exercise(&axis, Exercise::ThereAndBack, check)?;
            let mut hidden = hidden.clone();
            hidden.seed += if check { 1000 } else { 0 };
            let log = hidden.log(&axis, &motion, 1)?;
            Ok(LogSet::new(
                vec![(name.to_owned(), log, axis.period)],
                &machine,
            )?)
        };
        let (fit, check) = match (logs(false), logs(true)) {
            (Ok(fit), Ok(check)) => (fit, check),
            (a, b) => {
                println!(
                    "{name}: {:?} {:?}",
                    a.err().map(|e| e.to_string()),
                    b.err().map(|e| e.to_string())
                );
                continue;
            }
        };
        let made = start.elapsed();
        let found = search(&machine, &fit, &check, &Settings::default(), |_| ())?;
        println!(
            "{name} ({made:.1?} + {:.1?}): D {:.0} -> {:.0}",
            start.elapsed() - made,
            found.base.deviance,
            found.fit.deviance
        );
        for (named, active) in found.named.iter().zip(&found.fit.state.effects) {
            println!(
                "   {} {:?} evidence {:.0} held out {:.0} alike {:?}; then {:?}",
                named.name,
                active.values,
                named.evidence,
                named.held_out,
                named.alike,
                named
                    .runners_up
                    .iter()
                    .take(3)
                    .map(|r| (r.name, r.gain as i64))
                    .collect::<Vec<_>>()
            );
        }
        println!(
            "   left: {:?}",
            found
                .leftover
                .iter()
                .take(3)
                .map(|r| (r.name, r.gain as i64))
                .collect::<Vec<_>>()
        );
    }
    Ok(())
}
