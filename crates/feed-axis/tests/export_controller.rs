//! `export c`, `linuxcnc` and `onnx` as a user runs them, with a network that was trained.

use std::path::{Path, PathBuf};

use crate::common::{refuse, root, run, succeed, text};
use crate::support;
use crate::support::program::{Course, compare, compilers, write_course};
use crate::support::samples::{Event, Random};
use axis_pipeline::strategies::{NETWORK_LUGRE, Predictors};
use axis_sim::ClosedLoop;
use compensator::{Compensator, Correction, GuardLimits, Sample};
use controller_export::ExportedController;
use controller_export::c::{self, Precision};
use feed_axis::commands::{identify, train};
use feed_axis::context::{Common, Context};
use prost::Message;
use serde_json::Value;

const AXIS: &str = "data/axes/linear-stage.toml";

/// The results of `train` and `identify`, small.
fn trained(run: &str) -> (Context, Predictors) {
    for stage in ["sample", "train", "identify"] {
        succeed(&[stage, "--quick", "--axis", AXIS, "--out", run]);
    }
    let common = Common {
        axis: root().join(AXIS),
        set: Vec::new(),
        machine: None,
        out: Some(PathBuf::from(run)),
        seed: 1,
        threads: 0,
        quick: true,
    };
    let context = common.open().unwrap();
    let mut predictors = Predictors::of(&context.axis);
    predictors.network = Some(train::load_network(&context).unwrap());
    predictors.identified = Some(identify::load_friction(&context).unwrap().1);
    (context, predictors)
}

/// What the command tells of an export.
fn exported(what: &str, folder: &str, more: &[&str]) -> Value {
    let of = [
        "--quick", "--axis", AXIS, "--run", folder, "--format", "json",
    ];
    let output = run(&[&["export", what], &of[..], more].concat());
    assert!(output.status.success(), "{}", text(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The guard that an export told of.
fn limits(guard: &Value) -> GuardLimits {
    let number = |key: &str| guard[key].as_f64().unwrap();
    GuardLimits {
        position: number("position"),
        effort: number("effort"),
        surprise: number("surprise"),
        patience: number("patience_cycles") as u32,
        fade: number("fade_cycles") as u32,
    }
}

/// The samples of a move that is simulated under network and LuGre.
fn simulated(context: &Context, predictors: &Predictors) -> Vec<Sample> {
    let axis = &context.axis;
    let motion = axis.plan(&axis.trajectories[0]).unwrap();
    let law = NETWORK_LUGRE.compensator(predictors, std::sync::Arc::new(motion));
    let mut kept = Kept(law.unwrap(), Vec::new());
    let closed_loop = ClosedLoop::new(&context.machine).unwrap();
    let outcome = closed_loop.run(&motion, &mut kept, |_| {});
    outcome.completed().unwrap();
    kept.1
}

struct Kept(Box<dyn Compensator>, Vec<Sample>);

impl Compensator for Kept {
    fn reset(&mut self) {
        self.0.reset();
    }

    fn correct(&mut self, sample: &Sample) -> Correction {
        self.1.push(*sample);
        self.0.correct(sample)
    }

    fn surprise(&self) -> f64 {
        self.0.surprise()
    }
}

/// One small training serves all: the C code over a simulated move, the component, the graph,
/// and what is refused.
#[test]
fn a_trained_network_leaves_as_c_as_a_component_and_as_onnx() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    let run = run.to_str().unwrap();
    let missing = ["--strategy", "network-lugre", "--run", run, "--out", run];
    let message = refuse(&[&["export", "c"][..], &missing].concat());
    let hint = format!("run `feed-axis sample --out {run}`, then `feed-axis train --out {run}`");
    assert!(message.contains(&hint), "{message}");

    let (context, predictors) = trained(run);
    let samples = simulated(&context, &predictors);
    for (option, precision) in [("f64", Precision::F64), ("f32", Precision::F32)] {
        let out = folder.path().join(option);
        let to = [
            "--strategy",
            "network-lugre",
            "--precision",
            option,
            "--out",
        ];
        let told = exported("c", run, &[&to[..], &[out.to_str().unwrap()]].concat());
        let limits = limits(&told["guard"]);
        let controller = ExportedController::of(&predictors, "network_lugre", limits).unwrap();
        let code = c::export(&controller, precision, None).unwrap();
        for made in [&code.header, &code.source] {
            let file = std::fs::read_to_string(out.join(&made.name)).unwrap();
            assert!(file == made.text, "{}", made.name);
        }
        same_bits(&out, &predictors, &controller, precision, &samples);
    }

    let out = folder.path().join("hal");
    let to = ["--strategy", "network", "--out", out.to_str().unwrap()];
    exported("linuxcnc", run, &to);
    let component = std::fs::read_to_string(out.join("network.comp")).unwrap();
    assert!(component.starts_with("component network"), "{component}");
    assert!(out.join("network.hal").is_file());

    let file = folder.path().join("network.onnx");
    exported("onnx", run, &["--out", file.to_str().unwrap()]);
    same_network(&file, &predictors);

    // Results of another machine are not taken for these.
    let other = "data/axes/liu2025.toml";
    let fresh = folder.path().join("other.onnx");
    let fresh = fresh.to_str().unwrap();
    let of = ["--quick", "--run", run, "--axis", other, "--out", fresh];
    let message = refuse(&[&["export", "onnx"][..], &of].concat());
    assert!(message.contains("another axis file"), "{message}");
}

/// What the C code corrects along the samples has the bits of what Rust corrects.
fn same_bits(
    folder: &Path,
    predictors: &Predictors,
    controller: &ExportedController,
    precision: Precision,
    samples: &[Sample],
) {
    let course = Course {
        samples,
        happens: &|k, _| if k == 0 { Event::On } else { Event::None },
        strict: false,
    };
    write_course(folder, predictors, controller, precision, &course).unwrap();
    for compiler in compilers() {
        let c = compare(folder, compiler, "network_lugre", &[]).unwrap();
        println!("{compiler} {c:?}");
        assert_eq!((c.cycles, c.statuses), (samples.len(), 0), "{c:?}");
        assert_eq!(c.equal, samples.len(), "{c:?}");
    }
}

/// The file's graph gives what the network gives, over its ranges.
fn same_network(file: &Path, predictors: &Predictors) {
    let network = predictors.network.as_ref().unwrap();
    let bytes = std::fs::read(file).unwrap();
    let model = controller_export::onnx::proto::Model::decode(&*bytes).unwrap();
    let (mut random, mut scratch) = (Random(5), network.scratch());
    let (mut x, mut expected) = (Vec::new(), Vec::new());
    for _ in 0..500 {
        let ranges = network.scaling().input().iter();
        let row: Vec<f64> = ranges
            .map(|range| {
                let (a, b) = (range.minimum(), range.maximum());
                0.5 * (a + b) + 0.5 * (b - a) * random.next()
            })
            .collect();
        expected.push(network.predict_one(&row, &mut scratch).unwrap());
        x.extend(row);
    }
    let (_, y) = support::onnx::evaluate(model.graph.as_ref().unwrap(), (4, x));
    let most = expected.iter().fold(0.0_f64, |most, e| most.max(e.abs()));
    assert_eq!(y.len(), expected.len());
    for (y, expected) in y.iter().zip(&expected) {
        assert!((y - expected).abs() <= 1e-12 * most, "{y} {expected}");
    }
}

/// Plans need no results; what no controller can run is refused with what can.
#[test]
fn plans_are_of_the_axis_file_and_others_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("plan");
    let out = out.to_str().unwrap();
    let c = |axis: &str, more: &[&str]| {
        let all = [&["export", "c", "--out", out, "--axis", axis], more].concat();
        all.into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    let refused = |axis: &str, more: &[&str]| {
        let all = c(axis, more);
        refuse(&all.iter().map(String::as_str).collect::<Vec<_>>())
    };
    for (strategy, reason) in [
        ("adaptive", "learns between moves"),
        ("drive-terms", "export drive"),
        ("none", "no strategy \"none\" that a controller can run"),
    ] {
        let message = refused(AXIS, &["--strategy", strategy]);
        assert!(message.contains(reason), "{message}");
        assert!(message.contains("network-lugre, "), "{message}");
    }
    let message = refused("data/axes/joint.toml", &["--strategy", "plan"]);
    assert!(message.contains("kinematic error"), "{message}");
    // Names that C cannot have.
    for name in ["x-axis", "int", "X"] {
        let message = refused(AXIS, &["--strategy", "plan", "--name", name]);
        assert!(
            message.contains("--name") && message.contains("lower-case letters"),
            "{message}"
        );
    }
    assert!(!Path::new(out).exists());
    let given = [
        "--strategy",
        "plan",
        "--limit-position",
        "0.002",
        "--limit-effort",
        "50",
    ];
    let all = c("data/axes/emps.toml", &given);
    let said = succeed(&all.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(said.contains("at most 2000 µm and 50"), "{said}");
    assert!(said.contains("control cycles ahead"), "{said}");
    // Not given, they are those of the axis file, whatever its trajectories.
    let all = c(AXIS, &["--strategy", "plan", "--name", "x_axis"]);
    let said = succeed(&all.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(said.contains("x_axis.h, x_axis.c"), "{said}");
    // following_error_limit_mm = 2, force_limit_n = 250.
    assert!(said.contains("at most 2000 µm and 250 N"), "{said}");
    let message = refused(AXIS, &["--strategy", "plan", "--limit-effort", "-1"]);
    assert!(message.contains("above 0"), "{message}");
}
