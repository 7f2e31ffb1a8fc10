//! Feet of the contour error against brute force, and limits of a feed profile.

use miette::{IntoDiagnostic, Result};
use toolpath::named::butterfly;
use toolpath::{FeedLimits, FeedProfile, Follower};

use super::contour_bench::Bench;
use super::contour_measured::Measured;

/// Points beside the butterfly against brute force along the same branch.
pub fn foot(_: &Bench) -> Result<Measured> {
    let path = butterfly().into_diagnostic()?;
    let length = path.length();
    // A tool that swings about the path by up to 0.8 of the radius of curvature, and 5 µm at most.
    let mut follower = Follower::new(&path, 0.0);
    let (mut worst, mut tightest, mut compared) = (0.0_f64, f64::INFINITY, 0);
    let steps = 400_000_u32;
    for k in 0..=steps {
        let s = length * f64::from(k) / f64::from(steps);
        let at = path.at(s);
        let radius = 1.0 / at.curvature_size().max(1e-9);
        let swing = (0.8 * radius).min(5e-6) * (f64::from(k) * 0.05).sin();
        let [tx, ty] = at.tangent;
        let p = [at.position[0] - swing * ty, at.position[1] + swing * tx];
        let found = follower.follow(p);
        // Where the path is tight, and some places between.
        if radius > 1e-4 && k % 400 != 0 {
            continue;
        }
        tightest = tightest.min(radius);
        compared += 1;
        worst = worst.max((found.length() - brute(&path, p, s)).abs());
    }
    Ok(Measured {
        what: format!("foot of the contour error against brute force, {compared} points beside the butterfly, least radius {:.4} mm", 1e3 * tightest),
        goal: "1 nm at a radius of 0.02 mm".to_owned(),
        found: format!("{worst:.1e} m"),
        met: Some(worst <= 1e-9 && tightest < 2.5e-5),
        note: "brute force: the nearest of points every 25 nm within 20 µm along the path, then every 0.25 nm about it".to_owned(),
    })
}

/// Least distance of `p` from points of the path near `s`.
fn brute(path: &toolpath::Path<2>, p: [f64; 2], s: f64) -> f64 {
    let distance = |s: f64| {
        let [x, y] = path.at(s).position;
        (x - p[0]).hypot(y - p[1])
    };
    let search = |middle: f64, step: f64, count: i32| {
        let places = (-count..=count).map(|i| middle + step * f64::from(i));
        places.fold((middle, f64::INFINITY), |best, s| {
            let d = distance(s);
            if d < best.1 { (s, d) } else { best }
        })
    };
    // Beside `s`, so that no point of the search is the foot itself.
    let (near, _) = search(s + 9.3e-9, 25e-9, 800);
    search(near + 0.09e-9, 0.25e-9, 100).1
}

/// The butterfly at 3 m/min: time, and how far any limit is passed.
pub fn profile(_: &Bench) -> Result<Measured> {
    let path = butterfly().into_diagnostic()?;
    let limits = FeedLimits::equal(0.05, 0.05, 1.0, 20.0);
    let profile = FeedProfile::plan(&path, &limits).into_diagnostic()?;
    let duration = profile.duration();
    let mut over = 0.0_f64;
    let count = 2_000_000_u32;
    for k in 0..=count {
        let t = duration * f64::from(k) / f64::from(count);
        let axes = profile.axes(t);
        over = over.max(profile.at(t).feed / 0.05 - 1.0);
        for i in 0..2 {
            over = over.max(axes.velocity[i].abs() / 0.05 - 1.0);
            over = over.max(axes.acceleration[i].abs() - 1.0);
            over = over.max(axes.jerk[i].abs() / 20.0 - 1.0);
        }
    }
    Ok(Measured {
        what: "feed profile of the butterfly, 3 m/min, 1 m/s², 20 m/s³, at 2 million instants"
            .to_owned(),
        goal: "over no limit by more than 1e-9 of it; ≤ 9 s".to_owned(),
        found: match over > 0.0 {
            true => format!("over by {over:.1e}; {duration:.2} s"),
            false => format!("never over; {duration:.2} s"),
        },
        met: Some(over <= 1e-9 && duration <= 9.0),
        note: String::new(),
    })
}
