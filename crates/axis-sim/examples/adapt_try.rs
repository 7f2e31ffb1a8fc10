//! Adaptation between moves on the simulated machine (throw-away).
use axis_sim::effects::*;
use axis_sim::*;
use compensator::*;
use lugre::{LuGre, Parameters};
use rand::{RngExt, SeedableRng, seq::SliceRandom};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use trajectories::{Limits, Motion, Program, SCurve, Step};

struct Logging<C> {
    inner: C,
    log: Vec<Sample>,
}
impl<C: Compensator> Compensator for Logging<C> {
    fn reset(&mut self) {
        self.inner.reset();
        self.log.clear();
    }
    fn correct(&mut self, s: &Sample) -> Correction {
        self.log.push(*s);
        self.inner.correct(s)
    }
}
fn none(cl: &ClosedLoop, motion: &(impl Motion + ?Sized)) -> f64 {
    let mut e = 0.0f64;
    cl.run(motion, &mut NoCompensation, |c| e = e.max(c.error().abs()))
        .completed()
        .unwrap();
    e
}
fn run(
    cl: &ClosedLoop,
    model: &DriveModel,
    motion: &(impl Motion + ?Sized),
    noise: bool,
    seed: u64,
) -> (f64, f64, f64, Vec<Sample>) {
    let period = cl.axis().period;
    let at = |k: usize| {
        let s = motion.at(k as f64 * period);
        Target::of(Reference {
            position: s.position,
            velocity: s.velocity,
            acceleration: s.acceleration,
        })
    };
    let plan = Plan::new(model, &PlanSettings::default(), at).unwrap();
    let mut c = Logging {
        inner: plan,
        log: vec![],
    };
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (mut e, mut sum, mut n, mut when) = (0.0f64, 0.0, 0, 0.0);
    let o = cl.run_sensed(
        motion,
        &mut c,
        |m| {
            if noise {
                let mut g = || -> f64 { StandardNormal.sample(&mut rng) };
                m.position += 1e-8 * g();
                m.motor_angle += 2e-6 * g();
                m.motor_speed += 0.01 * g();
                m.current.q += 5e-3 * g();
                m.current.d += 5e-3 * g();
            }
        },
        |c| {
            if c.error().abs() > e {
                e = c.error().abs();
                when = c.time;
            }
            sum += c.error().abs();
            n += 1;
        },
    );
    if let Err(x) = o.completed() {
        println!("STOPPED {x}");
    }
    (e, sum / n as f64, when, c.log)
}
fn wrong(model: &DriveModel, f: &[f64; 5]) -> DriveModel {
    let mut m = *model;
    let p = m.friction.parameters();
    m.friction = LuGre::new(Parameters {
        coulomb: p.coulomb * f[0],
        stiction: p.stiction * f[0],
        viscous: p.viscous * f[1],
        stiffness: p.stiffness * f[2],
        damping: p.damping * f[3],
        ..p
    })
    .unwrap();
    m.load_inertia *= f[4];
    m
}
fn draw(rng: &mut ChaCha8Rng) -> [f64; 5] {
    let mut u = |s: f64| 1.0 + s * (2.0 * rng.random::<f64>() - 1.0);
    [u(0.2), u(0.2), u(0.2), u(0.2), u(0.1)]
}
fn quantiles(mut v: Vec<f64>) -> (f64, f64) {
    v.sort_by(f64::total_cmp);
    (v[0], v[v.len() / 2])
}
fn random_program(rng: &mut ChaCha8Rng) -> Program {
    let mut x = 0.6;
    let mut steps = vec![];
    for _ in 0..5 {
        let to: f64 = loop {
            let to = 0.2 + 1.0 * rng.random::<f64>();
            if (to - x as f64).abs() > 0.02 {
                break to;
            }
        };
        let limits = Limits::new(
            0.03 + 0.27 * rng.random::<f64>(),
            0.1 + 0.9 * rng.random::<f64>(),
            1.0 + 9.0 * rng.random::<f64>(),
        )
        .unwrap();
        steps.push(Step::Move { to, limits });
        steps.push(Step::Dwell { duration: 0.2 });
        x = to;
    }
    Program::new(0.6, steps).unwrap()
}
fn show(l: &Learned) {
    println!(
        "   rms {:.2e} -> {:.2e} of {:.2e}",
        l.torque_before, l.torque_after, l.torque
    );
    for p in &l.parameters {
        println!(
            "   {:18} {:+8.4} ± {:.4} % = {:.5e}{}",
            p.parameter.name(),
            100.0 * p.relative,
            100.0 * p.standard_error,
            p.value,
            if p.at_bound { " BOUND" } else { "" }
        );
    }
}
fn a_model(a: &Axis) -> DriveModel {
    let mut m = a.drive_model().unwrap();
    m.along = m.along.with_compliance(1.2127);
    m
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let mode = args[1].as_str();
    let seed: u64 = args.get(2).map_or(1, |s| s.parse().unwrap());
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/");
    let file = args.get(3).map_or("liu2025-machine", |s| s.as_str());
    let axis = Axis::read(format!("{root}{file}.toml").as_ref()).unwrap();
    let nominal = axis.drive_model().unwrap();
    let prior = AdaptPrior::default();
    match mode {
        "draws" => {
            let draws: usize = args.get(4).map_or(50, |s| s.parse().unwrap());
            let cl = ClosedLoop::new(&axis).unwrap();
            let motions: Vec<SCurve> = axis
                .trajectories
                .iter()
                .map(|t| axis.plan(t).unwrap())
                .collect();
            let base: Vec<f64> = motions.iter().map(|m| none(&cl, m)).collect();
            let mut out = vec![vec![]; 4];
            let mut um = vec![vec![]; 4];
            let mut covered = [[0usize; 2]; 9];
            let jobs: Vec<u64> = (0..draws as u64).collect();
            let results: Vec<_> = std::thread::scope(|s| {
                let hs: Vec<_> = jobs
                    .chunks(draws.div_ceil(2))
                    .map(|c| {
                        let (cl, motions, base, nominal, prior) =
                            (&cl, &motions, &base, &nominal, &prior);
                        s.spawn(move || {
                            c.iter()
                                .map(|d| {
                                    let mut rng = ChaCha8Rng::seed_from_u64(1000 * seed + d);
                                    let f = draw(&mut rng);
                                    let mut order: Vec<usize> = (0..motions.len()).collect();
                                    order.shuffle(&mut rng);
                                    let mut a =
                                        Adaptation::new(&wrong(nominal, &f), prior).unwrap();
                                    let mut v = vec![];
                                    for m in 0..4.min(motions.len()) {
                                        let (e, mean, when, log) = run(
                                            cl,
                                            &a.model(),
                                            &motions[order[m]],
                                            true,
                                            rng.random(),
                                        );
                                        let l = a.learn(&log).unwrap();
                                        v.push((1.0 - e / base[order[m]], e, mean, when, l));
                                    }
                                    (f, v)
                                })
                                .collect::<Vec<_>>()
                        })
                    })
                    .collect();
                hs.into_iter().flat_map(|h| h.join().unwrap()).collect()
            });
            for (d, (f, v)) in results.iter().enumerate() {
                for (m, x) in v.iter().enumerate() {
                    out[m].push(x.0);
                    um[m].push(-x.1);
                    if m == 0 {
                        for p in &x.4.parameters {
                            use compensator::AdaptParameter::*;
                            let t = match p.parameter {
                                FrictionLevel => 1.0 / f[0],
                                Viscosity => 1.0 / f[1],
                                BristleStiffness => 1.0 / f[2],
                                BristleDamping => 1.0 / f[3],
                                LoadInertia => 1.0 / f[4],
                                _ => 1.0,
                            } - if p.parameter == StandingLoad {
                                1.0
                            } else {
                                1.0
                            };
                            let t = if p.parameter == StandingLoad { 0.0 } else { t };
                            let i = p.parameter as usize;
                            covered[i][1] += 1;
                            if (p.relative - t).abs() < 1.96 * p.standard_error {
                                covered[i][0] += 1;
                            }
                            if d < 2 {
                                println!(
                                    "   {:18} {:+8.4} ± {:.4} % true {:+8.4} {}",
                                    p.parameter.name(),
                                    100.0 * p.relative,
                                    100.0 * p.standard_error,
                                    100.0 * t,
                                    p.at_bound
                                );
                            }
                        }
                        if d < 2 {
                            println!(
                                "rms {:.2e} -> {:.2e} of {:.2e}",
                                x.4.torque_before, x.4.torque_after, x.4.torque
                            );
                        }
                    }
                    if d < 2 {
                        println!(
                            "draw {d} move {m}: {:.2} % {:.4} µm mean {:.4} at {:.3} s",
                            100.0 * x.0,
                            1e6 * x.1,
                            1e6 * x.2,
                            x.3
                        );
                    }
                }
            }
            for m in 0..out.len() {
                if out[m].is_empty() {
                    continue;
                }
                let (w, med) = quantiles(out[m].clone());
                let (uw, umed) = quantiles(um[m].clone());
                println!(
                    "move {}: worst {:.2} % median {:.2} %; worst {:.4} µm median {:.4}",
                    m + 1,
                    100.0 * w,
                    100.0 * med,
                    -1e6 * uw,
                    -1e6 * umed
                );
            }
            for (i, c) in covered.iter().enumerate() {
                println!(
                    "95 % covers {} {}/{}",
                    AdaptParameter::ALL[i].name(),
                    c[0],
                    c[1]
                );
            }
        }
        "other" => {
            let effect = |name: &str, values: Vec<f64>| ActiveEffect {
                effect: Effect::named(name).unwrap(),
                values,
            };
            let mut cases: Vec<(&str, Axis)> = vec![("nominal", axis.clone())];
            let mut a = axis.clone();
            a.effects.push(effect("transmission-stiffness", vec![-0.2]));
            cases.push(("stiffness -20 %", a));
            let mut a = axis.clone();
            a.effects.push(effect("payload-mass", vec![200.0]));
            cases.push(("200 kg", a));
            let mut a = axis.clone();
            a.effects.push(effect("backlash", vec![3e-6]));
            cases.push(("backlash 3 um", a));
            let mut a = axis.clone();
            a.friction
                .change(|v| {
                    v.scale("stribeck_speed", 1.2);
                    v.scale("stiction", 1.05);
                })
                .unwrap();
            cases.push(("Stribeck +20, break-away +5", a));
            for (name, machine) in &cases {
                let cl = ClosedLoop::new(machine).unwrap();
                let motions: Vec<SCurve> = axis
                    .trajectories
                    .iter()
                    .map(|t| axis.plan(t).unwrap())
                    .collect();
                let base: Vec<f64> = motions.iter().map(|m| none(&cl, m)).collect();
                for sub in 0..2u64 {
                    let mut rng = ChaCha8Rng::seed_from_u64(7000 * seed + sub);
                    let f = if sub == 0 { [1.0; 5] } else { draw(&mut rng) };
                    let mut order: Vec<usize> = (0..6).collect();
                    order.shuffle(&mut rng);
                    let mut ad = Adaptation::new(&wrong(&nominal, &f), &prior).unwrap();
                    print!(
                        "{name} (belief {}): ",
                        if sub == 0 { "else true" } else { "wrong" }
                    );
                    let mut last = None;
                    for m in 0..6 {
                        let (e, _, when, log) =
                            run(&cl, &ad.model(), &motions[order[m]], true, rng.random());
                        print!(
                            "{:.3} µm ({:.2} %, {when:.3} s) ",
                            1e6 * e,
                            100.0 * (1.0 - e / base[order[m]])
                        );
                        if m < 3 {
                            last = Some(ad.learn(&log).unwrap());
                        }
                    }
                    println!();
                    show(&last.unwrap());
                    // Random programs on what was learned.
                    let mut rng = ChaCha8Rng::seed_from_u64(90 + seed);
                    for i in 0..5 {
                        let p = random_program(&mut rng);
                        let b = none(&cl, &p);
                        let (e, mean, when, log) = run(&cl, &ad.model(), &p, true, rng.random());
                        println!(
                            "   program: none {:.1} µm; {:.3} mean {:.4} at {when:.3} of {:.1} s",
                            1e6 * b,
                            1e6 * e,
                            1e6 * mean,
                            p.duration()
                        );
                        match ad.learn(&log) {
                            Ok(l) => {
                                if i == 0 && sub == 0 {
                                    show(&l)
                                }
                            }
                            Err(e) => println!("      {e}"),
                        }
                    }
                }
            }
        }
        "dump" => {
            let mut rng = ChaCha8Rng::seed_from_u64(90 + seed);
            let mut a = axis.clone();
            if args.len() > 4 {
                a.effects.push(ActiveEffect {
                    effect: Effect::named("transmission-stiffness").unwrap(),
                    values: vec![-0.2],
                });
            }
            let cl = ClosedLoop::new(&a).unwrap();
            let mut model = nominal;
            if args.len() > 4 {
                model = a_model(&a);
            }
            let p = random_program(&mut rng);
            let (e, _, w, log) = run(&cl, &model, &p, false, 0);
            println!("{:.3} at {w}", 1e6 * e);
            let mut ad = Adaptation::new(&model, &prior).unwrap();
            show(&ad.learn(&log).unwrap());
            let (e, _, w, _) = run(&cl, &ad.model(), &p, false, 0);
            println!("{:.3} at {w}", 1e6 * e);
        }
        "bias" => {
            let cl = ClosedLoop::new(&axis).unwrap();
            let m = axis.plan(&axis.trajectories[0]).unwrap();
            for noise in [false, true] {
                let (_, _, _, log) = run(&cl, &nominal, &m, noise, 0);
                let mut ad = Adaptation::new(&nominal, &prior).unwrap();
                show(&ad.learn(&log).unwrap());
            }
        }
        "axes" => {
            for name in [
                "screw-datasheet",
                "rack",
                "belt",
                "joint",
                "linear-motor",
                "linear-stage",
                "rotary-table",
                "emps",
            ] {
                let axis = Axis::read(format!("{root}{name}.toml").as_ref()).unwrap();
                let cl = ClosedLoop::new(&axis).unwrap();
                let nominal = match axis.drive_model() {
                    Ok(m) => m,
                    Err(e) => {
                        println!("{name}: {e}");
                        continue;
                    }
                };
                let motions: Vec<SCurve> = axis
                    .trajectories
                    .iter()
                    .map(|t| axis.plan(t).unwrap())
                    .collect();
                if motions.is_empty() {
                    println!("{name}: no motions");
                    continue;
                }
                let mut rng = ChaCha8Rng::seed_from_u64(seed);
                let f = draw(&mut rng);
                let mut ad = match Adaptation::new(&wrong(&nominal, &f), &prior) {
                    Ok(a) => a,
                    Err(e) => {
                        println!("{name}: {e}");
                        continue;
                    }
                };
                print!("{name}: true ");
                for m in &motions {
                    print!(
                        "{:.3} of {:.1} ",
                        1e6 * run(&cl, &nominal, m, false, 0).0,
                        1e6 * none(&cl, m)
                    );
                }
                print!("| wrong ");
                for m in &motions {
                    print!("{:.3} ", 1e6 * run(&cl, &ad.model(), m, false, 0).0);
                }
                println!();
                for r in 0..3 {
                    let m = &motions[r % motions.len()];
                    let (_, _, _, log) = run(&cl, &ad.model(), m, false, 0);
                    match ad.learn(&log) {
                        Ok(l) => {
                            if r == 2 {
                                show(&l)
                            }
                        }
                        Err(e) => println!("  {e}"),
                    }
                    print!("  after {}: ", r + 1);
                    for m in &motions {
                        print!("{:.3} ", 1e6 * run(&cl, &ad.model(), m, false, 0).0);
                    }
                    println!();
                }
                println!(
                    "  true: {:?} (level, visc, s0, s1, m)",
                    f.map(|f| 100.0 * (1.0 / f - 1.0))
                );
            }
        }
        _ => panic!(),
    }
}
