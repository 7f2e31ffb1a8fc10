//! The butterfly at three feeds: durations, the greatest velocity, acceleration and jerk of an axis
//! over their limits, and the time that planning took.

use std::time::Instant;

use toolpath::{FeedLimits, FeedProfile, ToolpathError, named};

fn main() -> Result<(), ToolpathError> {
    let path = named::butterfly()?;
    println!("length {:.3} mm", 1e3 * path.length());
    for feed in [1.0, 3.0, 6.0] {
        let limits = FeedLimits::equal(feed / 60.0, 1.0, 1.0, 20.0);
        let begin = Instant::now();
        let profile = FeedProfile::plan(&path, &limits)?;
        let planned = begin.elapsed().as_secs_f64();
        let mut most = [0.0f64; 3];
        for i in 0..300_000 {
            let axes = profile.axes(profile.duration() * f64::from(i) / 3e5);
            for k in 0..2 {
                most[0] = most[0].max(axes.velocity[k].abs());
                most[1] = most[1].max(axes.acceleration[k].abs());
                most[2] = most[2].max(axes.jerk[k].abs() / 20.0);
            }
        }
        println!(
            "{feed} m/min: {:.3} s; of the limits {:.4}, {:.4}, {:.4}; planned in {planned:.2} s",
            profile.duration(),
            most[0],
            most[1],
            most[2]
        );
    }
    Ok(())
}
