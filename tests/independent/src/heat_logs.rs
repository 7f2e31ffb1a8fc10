//! Logs of hours of growth, as a user would write them down, and the duties in them as motion programs.

use std::fmt::Write;
use std::path::Path;

use crate::heat::HeatedScrew;
use crate::heat_cases::{HOURS_TO_CHECK, HOURS_TO_FIT, HeatHours, Stroke};
use crate::random::Random;

/// Time for the probe at each place, s.
const PROBING: f64 = 10.0;
/// Places, m.
const PLACES: [f64; 2] = [0.5, 1.1];

/// Writes `probed.csv` (four hours of another machine than `HeatNumbers::ASSUMED`, probed each ten minutes at two places
/// with a noise of 0.5 µm), `probed-check.csv` (three hours of other duties in other air) and `duty-1.toml` to
/// `duty-9.toml`, by whose numbers the logs name the duties.
///
/// The power of friction is the mean of the time since the probing before; 0 in rows without it.
///
/// # Errors
/// If the folder cannot be written.
pub fn write_heat(folder: &Path, seed: u64) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    let strokes = HOURS_TO_FIT
        .iter()
        .chain(&HOURS_TO_CHECK)
        .filter_map(|(stroke, _)| *stroke);
    let strokes: Vec<Stroke> = strokes.collect();
    for (number, stroke) in (1..).zip(&strokes) {
        std::fs::write(folder.join(format!("duty-{number}.toml")), program(*stroke))?;
    }
    let hours = [
        ("probed.csv", HeatHours::to_fit(), HOURS_TO_FIT.to_vec()),
        (
            "probed-check.csv",
            HeatHours::to_check(),
            HOURS_TO_CHECK.to_vec(),
        ),
    ];
    for (stream, (name, hours, of)) in (0..).zip(hours) {
        let numbers: Vec<usize> = of
            .iter()
            .map(|(stroke, _)| number(*stroke, &strokes))
            .collect();
        let text = log(&hours, &numbers, Random::new(seed, stream));
        std::fs::write(folder.join(name), text)?;
    }
    Ok(())
}

fn number(stroke: Option<Stroke>, strokes: &[Stroke]) -> usize {
    let found = stroke.and_then(|stroke| strokes.iter().position(|other| *other == stroke));
    found.map_or(0, |index| index + 1)
}

fn log(hours: &HeatHours, numbers: &[usize], mut random: Random) -> String {
    let air = hours.air;
    let mut machine = HeatedScrew::other(air(0.0));
    let mut text = String::from("t_s,duty_1,air_degc,place_mm,growth_um,friction_w\n");
    let mut row = |machine: &HeatedScrew, duty: usize, place: f64, growth: f64, power: f64| {
        let (t, air) = (machine.time, air(machine.time));
        let _ = writeln!(
            text,
            "{t:.1},{duty},{air:.2},{:.0},{growth:.2},{power:.1}",
            1e3 * place
        );
    };
    row(&machine, 0, PLACES[0], 0.0, 0.0);
    for ((motion, count), duty) in hours.duties.iter().zip(numbers) {
        // Stretches of ten minutes, and one of five minutes at the end if the number of periods is odd.
        let mut left = 300.0 * f64::from(*count);
        while left > 0.0 {
            let whole = left.min(600.0);
            left -= whole;
            for (place, seconds) in PLACES.into_iter().zip([whole - PROBING, PROBING]) {
                let spent = machine.friction_heat;
                machine.run(motion.as_ref(), seconds, air);
                let growth = 1e6 * machine.growth(air(0.0), place) + 0.5 * random.normal();
                let power = (machine.friction_heat - spent) / seconds;
                // Ten seconds are not a whole number of strokes.
                let power = match seconds > PROBING {
                    true => power * (1.0 + 0.005 * random.normal()),
                    false => 0.0,
                };
                row(&machine, *duty, place, growth, power);
            }
        }
    }
    text
}

fn program([from, to, speed, rest]: Stroke) -> String {
    let step = |to: f64| {
        format!(
            "\n[[steps]]\nmove = {{ to_mm = {:.0}, velocity_mm_s = {:.0}, acceleration_mm_s2 = 1000, jerk_mm_s3 = 10000 }}\n\n\
             [[steps]]\ndwell = {{ duration_s = {rest} }}\n",
            1e3 * to,
            1e3 * speed
        )
    };
    format!("start_mm = {:.0}\n{}{}", 1e3 * from, step(to), step(from))
}
