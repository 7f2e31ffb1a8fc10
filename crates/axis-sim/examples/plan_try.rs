use axis_sim::*;
use compensator::*;
use trajectories::Motion;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let axis = Axis::read(std::path::Path::new(&args[1])).unwrap();
    let machine = Axis::read(std::path::Path::new(args.get(2).unwrap_or(&args[1]))).unwrap();
    let sigma: f64 = args.get(3).map_or(2e-3, |s| s.parse().unwrap());
    let cl = ClosedLoop::new(&machine).unwrap();
    let model = axis.drive_model().unwrap();
    for (i, spec) in axis.trajectories.iter().enumerate() {
        let motion = axis.plan(spec).unwrap();
        let m = motion.clone();
        let period = axis.period;
        let at = move |k: usize| {
            let s = m.at(k as f64 * period);
            Target::of(Reference {
                position: s.position,
                velocity: s.velocity,
                acceleration: s.acceleration,
            })
        };
        let mut plan = Plan::new(&model, &PlanSettings { smoothing: sigma }, at).unwrap();
        let mut e = vec![];
        let mut dw = 0.0f64;
        let mut di = 0.0f64;
        let mut none = vec![];
        cl.run(&motion, &mut NoCompensation, |c| none.push(c.error()));
        let o = cl.run(&motion, &mut plan, |c| {
            e.push((c.time, c.error()));
            dw = dw.max((c.command.speed_ref - c.motor_speed).abs());
            di = di.max((c.command.effort - c.correction.iq).abs())
        });
        let f = |e: &[f64]| {
            let m = e.iter().fold(0.0f64, |a, b| a.max(b.abs()));
            let s = e.iter().map(|x| x.abs()).sum::<f64>() / e.len() as f64;
            (1e6 * m, 1e6 * s)
        };
        let ee: Vec<f64> = e.iter().map(|x| x.1).collect();
        let at = e.iter().fold((0.0, 0.0f64), |a, b| {
            if b.1.abs() > a.1 { (b.0, b.1.abs()) } else { a }
        });
        let (a, b) = (f(&none), f(&ee));
        println!(
            "{} {:?} none {:.3}/{:.4} plan {:.4}/{:.5} at {:.4}s -> {:.3}% / {:.3}%  dw {dw:.2e} di {di:.2e}",
            i + 1,
            o,
            a.0,
            a.1,
            b.0,
            b.1,
            at.0,
            100.0 * (1.0 - b.0 / a.0),
            100.0 * (1.0 - b.1 / a.1)
        );
    }
}
