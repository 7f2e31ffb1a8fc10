use axis_sim::*;
use compensator::*;
use lugre::{LuGre, Parameters};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use trajectories::Motion;

fn wrong(model: &DriveModel, level: f64, viscous: f64, s0: f64, s1: f64, mass: f64) -> DriveModel {
    let p = model.friction.parameters();
    DriveModel {
        friction: LuGre::new(Parameters { coulomb: p.coulomb * level, stiction: p.stiction * level, viscous: p.viscous * viscous, stiffness: p.stiffness * s0, damping: p.damping * s1, ..p }).unwrap(),
        load_inertia: model.load_inertia * mass,
        ..*model
    }
}

/// Noise "N" in the axis' own units: position, angle, speed, current.
fn noise(seed: u64, scale: f64) -> impl FnMut(&mut Measured) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    move |m| {
        let mut n = |s: f64| { let x: f64 = StandardNormal.sample(&mut rng); s * scale * x };
        m.position += n(10e-9);
        m.motor_angle += n(2e-6);
        m.motor_speed += n(0.01);
        m.current.d += n(5e-3);
        m.current.q += n(5e-3);
    }
}

fn fig(e: &[f64]) -> (f64, f64) {
    (1e6 * e.iter().fold(0.0f64, |a, b| a.max(b.abs())), 1e6 * e.iter().map(|x| x.abs()).sum::<f64>() / e.len() as f64)
}

fn targets<M: Motion + Clone>(m: &M, period: f64) -> impl FnMut(usize) -> Target + use<M> {
    let m = m.clone();
    move |k| { let s = m.at(k as f64 * period); Target::of(Reference { position: s.position, velocity: s.velocity, acceleration: s.acceleration }) }
}

fn run<M: Motion + Clone>(cl: &ClosedLoop, c: &mut impl Compensator, m: &M, seed: u64, n: f64, skip: f64) -> (f64, f64, bool) {
    let mut e = vec![];
    let o = cl.run_sensed(m, c, noise(seed, n), |c| if c.time >= skip { e.push(c.error()) });
    let (p, q) = fig(&e);
    (p, q, matches!(o, Outcome::Completed))
}

fn settings(axis: &Axis) -> FeedbackSettings {
    let mut s = FeedbackSettings { speed_by_differences: axis.derives_speed(), ..FeedbackSettings::default() };
    let get = |name: &str, to: &mut f64| if let Ok(v) = std::env::var(name) { *to = v.parse().unwrap() };
    get("STIFF", &mut s.stiffness); get("DAMP", &mut s.damping); get("BRIST", &mut s.bristles); get("STRIB", &mut s.stribeck);
    get("WANDER", &mut s.wandering); get("COMMAND", &mut s.command); get("POS", &mut s.position);
    get("SPEED", &mut s.speed); get("CURRENT", &mut s.current);
    get("MS", &mut s.sensitivity); get("MSL", &mut s.sensitivity_late);
    if let Ok(v) = std::env::var("MODES") { s.modes = v.parse().unwrap(); }
    s
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let axis = Axis::read(std::path::Path::new(&args[1])).unwrap();
    let what = args.get(2).map_or("all", |s| s.as_str());
    let draws: usize = args.get(3).map_or(0, |s| s.parse().unwrap());
    let n: f64 = std::env::var("NOISE").map_or(1.0, |s| s.parse().unwrap());
    let cl = ClosedLoop::new(&axis).unwrap();
    let model = axis.drive_model().unwrap();
    let (lo, hi) = axis.mechanism.reach().map_or((axis.stroke.minimum, axis.stroke.maximum), |r| (r.least.max(axis.stroke.minimum), r.most.min(axis.stroke.maximum)));
    let at = |s: f64| axis.mechanism.participation(lo + s * (hi - lo)).unwrap();
    let modes = at(0.5);
    for m in modes.iter().take(5) { println!("mode {:.1} Hz, motor {:.4} load {:.5}", m.frequency / 6.2832, m.motor, m.load); }
    let t0 = std::time::Instant::now();
    let design = match FeedbackDesign::within_margins(&model, &modes, &[&at(0.02), &at(0.25), &at(0.75), &at(0.98)], &settings(&axis)) {
        Ok(d) => { println!("{:?}", d.settings()); d }
        Err(e) => {
            println!("REFUSED: {e}");
            let s = FeedbackSettings { sensitivity: f64::INFINITY, sensitivity_late: f64::INFINITY, ..settings(&axis) };
            match FeedbackDesign::new(&model, &modes, &s) { Ok(d) => d, Err(e) => { println!("REFUSED: {e}"); return; } }
        }
    };
    println!("designed in {:?}, residual {:.1e}", t0.elapsed(), design.residual());
    if what == "all" || what == "margins" {
        for s in [0.02, 0.25, 0.5, 0.75, 0.98] {
            let modes = at(s);
            let mut w = (0.0f64, 0.0f64, f64::INFINITY);
            for mass in [0.9, 1.0, 1.4] { for friction in [0.5, 1.0, 2.0] { for sticking in [0.5, 1.0, 2.0] { for stribeck in [0.0, 1.0] {
                let m = design.margins(&Variation { modes: &modes, mass, friction, sticking, stribeck }).unwrap();
                if mass == 1.0 && friction == 1.0 && sticking == 1.0 { println!("at {s}: {m:.4?}"); }
                if s == 0.5 { println!("   mass {mass} friction {friction} sticking {sticking} stribeck {stribeck}: {:.3} at {} late {:.3} at {} delay {:.2} r {:.4}", m.sensitivity, m.sticking, m.sensitivity_late, m.sticking_late, m.delay / model.period, m.radius); }
                w = (w.0.max(m.sensitivity), w.1.max(m.sensitivity_late), w.2.min(m.delay));
            }}}}
            println!("   worst Ms {:.3} late {:.3} delay {:.2} cycles", w.0, w.1, w.2 / model.period);
        }
    }
    let motions: Vec<_> = axis.trajectories.iter().map(|s| axis.plan(s).unwrap()).collect();
    let with = |model: &DriveModel, m: &trajectories::SCurve| {
        let design_of = FeedbackDesign::new(model, &modes, &FeedbackSettings { sensitivity: f64::INFINITY, sensitivity_late: f64::INFINITY, ..*design.settings() }).unwrap();
        PlanWithFeedback::new(Plan::new(model, &PlanSettings::default(), targets(m, model.period)).unwrap(), design_of.feedback())
    };
    let mut none = vec![];
    for (i, m) in motions.iter().enumerate() {
        let a = run(&cl, &mut NoCompensation, m, 1 + i as u64, n, 0.0);
        none.push((a.0, a.1));
        if what == "all" || what == "six" {
            let mut plan = Plan::new(&model, &PlanSettings::default(), targets(m, model.period)).unwrap();
            let p = run(&cl, &mut plan, m, 1 + i as u64, n, 0.0);
            let f = run(&cl, &mut with(&model, m), m, 1 + i as u64, n, 0.0);
            println!("{} none {:.3}/{:.4} plan {:.4}/{:.5} {} feedback {:.4}/{:.5} {} -> {:.3}% / {:.3}%", i + 1, a.0, a.1, p.0, p.1, p.2, f.0, f.1, f.2, 100.0 * (1.0 - f.0 / a.0), 100.0 * (1.0 - f.1 / a.1));
        }
    }
    if what == "trace" {
        let m = &motions[0];
        let mut plan = Plan::new(&model, &PlanSettings::default(), targets(m, model.period)).unwrap();
        let mut k = 0;
        cl.run(m, &mut plan, |c| { if k % (motions[0].duration() / model.period / 20.0) as usize == 0 { println!("{:.4} err {:.1} v {:.3} torque {:.4} effort {:.4} r*th-x {:.1} corr {:.3e} speed ref-m {:.4}", c.time, 1e6 * c.error(), c.reference.velocity, c.torque, c.command.effort, 1e6 * (c.motor_angle * model.travel - c.position), c.correction.position, c.command.speed_ref - c.motor_speed); } k += 1; });
        let mut f = with(&model, m);
        let mut k = 0;
        struct Spy<'a, C>(&'a mut C, Vec<(Deviations, Planned)>);
        impl<F: FnMut(usize) -> Target> Compensator for Spy<'_, PlanWithFeedback<F>> { fn reset(&mut self) { self.0.reset() } fn correct(&mut self, s: &Sample) -> Correction { let c = self.0.correct(s); self.1.push((*self.0.deviations(), *self.0.planned())); c } }
        let mut spy = Spy(&mut f, vec![]);
        let mut rows = vec![];
        cl.run_sensed(m, &mut spy, noise(1, n), |c| { if k % (motions[0].duration() / model.period / 20.0) as usize == 0 { rows.push((k, *c)); } k += 1; });
        for (k, c) in rows { let (d, p) = &spy.1[k]; println!("{:.4} err {:.3} dev load {:.3} force {:.3} effort {:.4} innov {:.2e} {:.2e} planned {:.4} wind {:.2}", c.time, 1e6 * c.error(), 1e6 * d.load, d.force, d.effort, d.innovation[0], d.innovation[1], p.effort, 1e6 * model.travel * p.wind_up); }
    }
    if what == "all" || what == "slow" {
        for v in [0.002, 0.003, 0.004, 0.005, 0.006, 0.007, 0.008] {
            let limits = trajectories::Limits::new(v, 0.12, 1.0).unwrap();
            let m = trajectories::SCurve::plan(0.5 * (lo + hi), 0.5 * (lo + hi) + 1.5 * v, &limits).unwrap();
            let a = run(&cl, &mut NoCompensation, &m, 7, n, 0.0);
            let p = run(&cl, &mut Plan::new(&model, &PlanSettings::default(), targets(&m, model.period)).unwrap(), &m, 7, n, 0.0);
            let f = |model: &DriveModel| run(&cl, &mut PlanWithFeedback::new(Plan::new(model, &PlanSettings::default(), targets(&m, model.period)).unwrap(), design.feedback()), &m, 7, n, 0.0);
            let (g, w) = (f(&model), f(&wrong(&model, 0.8, 1.2, 0.8, 1.2, 1.1)));
            println!("{:.0} mm/s: none {:.3} plan {:.4} feedback {:.4}/{:.5} wrong {:.4}/{:.5}", 1e3 * v, a.0, p.0, g.0, g.1, w.0, w.1);
        }
    }
    if draws > 0 {
        let mut rng = ChaCha8Rng::seed_from_u64(42);
        let mut worst = vec![];
        let believed: Vec<_> = (0..draws).map(|_| { let mut r = |b: f64| 1.0 + b * (2.0 * rng.random::<f64>() - 1.0); wrong(&model, r(0.2), r(0.2), r(0.2), r(0.2), r(0.1)) }).collect();
        let (cl, motions, none, with) = (&cl, &motions, &none, &with);
        let results: Vec<_> = std::thread::scope(|s| {
            let handles: Vec<_> = (0..2).map(|t| { let believed = &believed; s.spawn(move || {
                let mut out = vec![];
                for (d, b) in believed.iter().enumerate().filter(|(d, _)| d % 2 == t) {
                    let (mut p, mut q) = (f64::INFINITY, f64::INFINITY);
                    for (i, m) in motions.iter().enumerate() {
                        let f = run(cl, &mut with(b, m), m, (100 + 10 * d + i) as u64, n, 0.0);
                        p = p.min(if f.2 { 1.0 - f.0 / none[i].0 } else { -9.9 });
                        q = q.min(1.0 - f.1 / none[i].1);
                    }
                    out.push((p, q, *b));
                }
                out }) }).collect();
            handles.into_iter().flat_map(|h| h.join().unwrap()).collect()
        });
        worst.extend(results);
        worst.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut mean: Vec<_> = worst.iter().map(|w| w.1).collect();
        mean.sort_by(f64::total_cmp);
        let p = worst[0].2.friction.parameters(); let p0 = model.friction.parameters();
        println!("draws {draws}: peak worst {:.3}% median {:.3}%; mean worst {:.3}% median {:.3}%  worst belief level {:.2} visc {:.2} s0 {:.2} s1 {:.2} mass {:.2}", 100.0 * worst[0].0, 100.0 * worst[draws / 2].0, 100.0 * mean[0], 100.0 * mean[draws / 2],
           p.coulomb / p0.coulomb, p.viscous / p0.viscous, p.stiffness / p0.stiffness, p.damping / p0.damping, worst[0].2.load_inertia / model.load_inertia);
    }
}
