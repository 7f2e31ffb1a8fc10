use trajectories::*;
#[test]
fn replanning() {
    let mut seed = 1u64;
    let mut r = move |lo: f64, hi: f64| {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        lo + (hi - lo) * ((seed >> 11) as f64 / (1u64 << 53) as f64)
    };
    let (mut worst, mut bad, mut all) = (0.0f64, 0, 0);
    for _ in 0..2000 {
        let limits = TransferLimits::new(-r(0.2, 3.), r(0.2, 3.), VelocityLimits::new(-r(0.5, 6.), r(0.5, 6.), 10f64.powf(r(0., 3.))).unwrap()).unwrap();
        let kind = r(0.0, 3.0);
        let s = Setpoint { position: r(-1., 1.), velocity: r(-1., 1.), acceleration: r(-1., 1.), jerk: 0.0 };
        let e = Setpoint { position: r(-1., 1.), velocity: if kind < 1.0 { 0.0 } else { r(-1., 1.) }, acceleration: if kind < 2.0 { 0. } else { r(-1., 1.) }, jerk: 0.0 };
        let Ok(t) = Transfer::plan(&s, &e, &limits) else { continue };
        let d = t.duration();
        let mut x = s;
        for i in 1..200 {
            let at = d * f64::from(i) / 200.0;
            // Chained: from the replanned motion.
            x = Transfer::plan(&x, &e, &limits).unwrap().at(d / 200.0);
            let left = Transfer::plan(&x, &e, &limits).unwrap().duration();
            let off = (at + left - d).abs() / d;
            all += 1;
            if off > 1e-9 { bad += 1; if bad < 20 { println!("{i} {off:e} kind {kind:.0} left {left} of {d} {x:?} {e:?} {limits:?}"); } }
            worst = worst.max(off);
            if off > 1e-9 { break; }
        }
    }
    println!("worst {worst:e} bad {bad} of {all}");
}
