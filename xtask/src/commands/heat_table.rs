//! What `heat-proof` found, as the page `data/outcomes/heat.md`.

use std::fmt::Write;

use super::heat_both::{AFTER, Compensated};
use super::heat_found::Found;

/// Goals of the rows, in µm after 60 minutes.
const GOALS: [(&str, f64); 4] = [
    ("both; each", 6.0),
    ("both; a machine of", 3.0),
    ("plan, friction scheduled", 1.5),
    ("feedback, friction of the cold", 0.8),
];

/// What sets the limits.
const NOTES: &str = "\n## Notes\n\
     - \"The machine's own friction\": the model of the strategy has the friction that the machine has at that time. It is what a schedule without error would leave.\n\
     - The machine's friction in the loop is the mean over the stroke: dry friction is greater in the middle, where the screw is warmest.\n\
     - The plan's error follows the dry friction, which strokes at 200 mm/s hardly show: most of their power is viscous. The power of strokes at 20 mm/s is mostly dry.\n";

/// The page.
pub fn page(found: &Found) -> String {
    let mut text = String::from(
        "# An hour of heat\n\n\
         Written by `cargo xtask heat-proof`. All simulated, nothing measured. The truth is a second simulator that shares no code: the screw as a rod of 5 mm cells, the \
         nut where it is, losses of each instant, steps of 40 ms. Duty: 0.45 to 0.95 m there and back at 200 mm/s, 1 m/s², 10 m/s³, standstills of 1 s, air of 20 °C.\n\n\
         ## Growth at 950 mm against brute force, µm\n\n\
         | losses | hours | greatest error | in the end | growth | goal |\n|---|---|---|---|---|---|\n",
    );
    for row in &found.against_brute_force {
        let goal = match row.what.starts_with("losses") && row.hours == 1 {
            true => met(row.greatest_um, 1.5),
            false => "–".to_owned(),
        };
        let _ = writeln!(
            text,
            "| {} | {} | {:.2} | {:.2} | {:.1} | {goal} |",
            row.what, row.hours, row.greatest_um, row.in_the_end_um, row.growth_um
        );
    }
    text.push_str(
        "\n## Models of another machine\n\n\
         Its shares, conductances and capacities differ by 10 to 60 %, its laws of viscosity, preload and free convection are others. Fitted to 4 h of five duties, checked \
         on 3 h of others in other air, at five places, before each probing. In µm:\n\n\
         | fitted to | greatest error | RMS | of |\n|---|---|---|---|\n",
    );
    for row in &found.identified {
        let _ = writeln!(
            text,
            "| {} | {:.1} | {:.2} | {:.0} |",
            row.log, row.greatest_um, row.rms_um, row.of_um
        );
    }
    let both = [
        (
            "Both corrections, the position from the motor",
            "Greatest error of the table, growth included, on two strokes there and back on end, homed once before the first",
            &found.motor,
        ),
        (
            "The position from a scale",
            "Dynamic part of the table's error on the same strokes; of the adaptive strategy on the second one",
            &found.scale,
        ),
    ];
    for (title, what, rows) in both {
        let _ = write!(text, "\n## {title}\n\n{what}, in µm:\n\n| after, min |");
        for minutes in AFTER {
            let _ = write!(text, " {minutes} |");
        }
        text.push_str(" goal after 60 |\n|---|---|---|---|---|---|\n");
        for row in rows {
            line(&mut text, row);
        }
    }
    text.push_str(NOTES);
    text
}

fn line(text: &mut String, row: &Compensated) {
    let _ = write!(text, "| {} |", row.what);
    for peak in row.peaks_um {
        let _ = write!(text, " {peak:.1} |");
    }
    let goal = GOALS.iter().find(|(begin, _)| row.what.starts_with(begin));
    let goal = goal.map_or("–".to_owned(), |(_, goal)| met(row.peaks_um[3], *goal));
    let _ = writeln!(text, " {goal} |");
}

fn met(found: f64, goal: f64) -> String {
    let is_met = if found <= goal { "met" } else { "**missed**" };
    format!("≤ {goal}: {is_met}")
}
