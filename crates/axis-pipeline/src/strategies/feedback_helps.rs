//! What would give an axis a feedback that it cannot have as it is: each change tried, the
//! feedback designed again with it.

use axis_sim::SixDigits;
use compensator::{Drive, DriveModel, FeedbackDesign, FeedbackSettings, Mode};

/// Shares of a gain that are tried, the nearest first.
const SHARES: [f64; 4] = [0.7, 0.5, 0.35, 0.25];

/// A change in words, and the drive with it.
type Change = (String, DriveModel);

/// The first change with which a feedback is within its margins, of several sizes of it the least;
/// none where none does.
pub(super) fn helps(
    model: &DriveModel,
    middle: &[Mode],
    elsewhere: &[&[Mode]],
    settings: &FeedbackSettings,
) -> Vec<String> {
    let works = |(_, changed): &Change| {
        FeedbackDesign::within_margins(changed, middle, elsewhere, settings).is_ok()
    };
    let least = |sizes: Vec<Change>| sizes.into_iter().find(works).map(|(words, _)| words);
    // One is enough: a search that fails takes long.
    changes(model)
        .into_iter()
        .find_map(least)
        .into_iter()
        .collect()
}

/// All changes that this drive can have, each in its sizes.
fn changes(model: &DriveModel) -> Vec<Vec<Change>> {
    let with = |words: String, change: &dyn Fn(&mut DriveModel)| {
        let mut changed = *model;
        change(&mut changed);
        (words, changed)
    };
    let mut all = Vec::new();
    let every = model.cascade.signal_path.position_every;
    if every > 1 {
        let rate = SixDigits(1e-3 / model.period);
        all.push(vec![with(
            format!("the position controller at the rate of the control ({rate} kHz)"),
            &|m| m.cascade.signal_path.position_every = 1,
        )]);
    }
    if model.cascade.signal_path.speed_every > 1 {
        let rate = SixDigits(1e-3 / model.period);
        all.push(vec![with(
            format!("both controllers at the rate of the control ({rate} kHz)"),
            &|m| {
                m.cascade.signal_path.speed_every = 1;
                m.cascade.signal_path.position_every = 1;
            },
        )]);
    }
    let late = model.delay + model.drive.late();
    if late > 0.0 {
        let share = |share: f64| {
            let words = format!(
                "a delay of the command of {} ms at most",
                SixDigits(1e3 * share * late)
            );
            with(words, &|m| {
                m.delay *= share;
                if let Drive::FieldOriented { late, .. } = &mut m.drive {
                    *late *= share;
                }
            })
        };
        all.push([0.5, 0.25, 0.0].map(share).to_vec());
    }
    let position = |share: f64| {
        with(format!("a position gain of {share} of the file's"), &|m| {
            m.cascade.position *= share
        })
    };
    all.push(SHARES.map(position).to_vec());
    let speed = |share: f64| {
        with(
            format!("a speed gain of {share} of the file's, its integral time as it is"),
            &|m| {
                m.cascade.speed *= share;
                m.cascade.speed_integral *= share;
            },
        )
    };
    all.push(SHARES.map(speed).to_vec());
    let quicker = |times: f64| {
        with(
            format!(
                "a control of {} kHz",
                SixDigits(1e-3 * times / model.period)
            ),
            &|m| m.period /= times,
        )
    };
    all.push([2.0, 4.0].map(quicker).to_vec());
    all
}
