//! A part of the second matrix: its design, and a few cases of one plot, searched blind.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use axis_sim::Axis;
use axis_sim::effects::{Effect, Scales};
use discover_matrix::hidden::{Exercise, Form, Rough, Truth};
use discover_matrix::matrix::{CaseKind, HiddenEffect, NamedEffect};
use discover_matrix::matrix2::{
    Bench, Case, CaseOutcome, CaseSetting, Channels, MatrixPlan, TARGETS, TOLERANCES, VERSION,
    cases,
};
use discrepancy::Verdict;
use trajectories::{Limits, Program, Step};

use crate::machines::named as axis;

fn machines() -> Vec<Axis> {
    ["liu2025", "joint", "linear-motor"].map(axis).to_vec()
}

#[test]
fn the_whole_matrix_spans_every_factor() {
    let all = cases(&machines(), &MatrixPlan::full(), 3).unwrap();
    let clean = all.iter().filter(|c| c.kind == CaseKind::Clean).count();
    assert!(all.len() >= 600 && clean >= 300, "{} {clean}", all.len());
    let ids: BTreeSet<&String> = all.iter().map(|c| &c.id).collect();
    assert_eq!(ids.len(), all.len());
    let least = |of: fn(&Case) -> String, n: usize| {
        let parts: BTreeSet<String> = all.iter().map(of).collect();
        assert_eq!(parts.len(), n, "{parts:?}");
        for part in parts {
            let share = all.iter().filter(|c| of(c) == part).count();
            assert!(share >= 20, "{part}: {share}");
        }
    };
    least(|c| c.setting.machine.clone(), 3);
    least(|c| format!("{}", c.setting.tolerance), TOLERANCES.len());
    least(|c| c.setting.channels.name().to_owned(), 3);
    least(|c| c.noise.name().to_owned(), 7);
    least(|c| c.form.name().to_owned(), 1 + Form::ALL.len());
    // Motions fit their machine wherever they start.
    for case in &all {
        let axis = machines()
            .into_iter()
            .find(|a| a.name == case.setting.machine);
        let stroke = axis.unwrap().stroke;
        assert!((stroke.minimum..stroke.maximum).contains(&case.setting.start));
    }
}

#[test]
fn another_seed_has_other_laws() {
    let laws = |seed| -> BTreeSet<String> {
        let all = cases(&machines(), &MatrixPlan::full(), seed).unwrap();
        let laws = all.iter().filter_map(|c| c.law.clone());
        laws.map(|law| format!("{law:?}")).collect()
    };
    assert_eq!(laws(3), laws(3));
    assert!(laws(3).len() >= 180);
    assert!(laws(3).is_disjoint(&laws(4)));
}

/// Where it slides, friction that comes on with speed is that of a bristle; where it turns
/// back, it is not.
#[test]
fn an_onset_of_another_form_leaves_the_level_of_sliding() {
    let axis = axis("joint");
    let to = |to: f64| Step::Move {
        to,
        limits: Limits::new(0.3, 1.0, 10.0).unwrap(),
    };
    let start = axis.stroke.start;
    let rest = Step::Dwell { duration: 0.2 };
    let motion = Program::new(start, vec![rest, to(start + 0.3), rest, to(start), rest]).unwrap();
    let log = |form: Form| {
        let truth = Truth {
            effects: form.on(&axis, &[], [0.5; 3]).unwrap(),
            shares: Vec::new(),
            noise: Rough::white(0.0),
            wound: 0.0,
            seed: 1,
        };
        let log = truth.log(&axis, &motion, 4).unwrap();
        log.channel("torque_ref_n_m").unwrap().to_vec()
    };
    let (bristle, tanh) = (log(Form::Same), log(Form::Onset));
    let off = |k: usize| (bristle[k] - tanh[k]).abs();
    // Friction at the motor, N·m.
    let friction = 6.0 / 100.0;
    // Some 0.2 s into cruising, and at rest before the way back, where a bristle holds.
    let cruising = 200 + 800;
    assert!(off(cruising) < 0.02 * friction, "{}", off(cruising));
    let most = (0..bristle.len()).map(off).fold(0.0, f64::max);
    assert!(most > 0.2 * friction, "{most}");
}

fn case(kind: CaseKind, hidden: Vec<HiddenEffect>) -> Case {
    Case {
        version: VERSION,
        id: kind.name().to_owned(),
        plot: 0,
        setting: CaseSetting {
            machine: "joint".to_owned(),
            exercise: Exercise::ThereAndBack,
            start: -0.5,
            tolerance: 0.01,
            channels: Channels::All,
        },
        kind,
        visible: vec![3000.0; hidden.len()],
        hidden,
        law: None,
        form: Form::Same,
        form_at: [0.5; 3],
        noise: Rough::white(1.0),
        wound: 0.0,
        rejected: Vec::new(),
        seed: 9,
    }
}

#[test]
fn a_clean_machine_and_one_effect_are_told_and_counted() {
    let axis = axis("joint");
    let viscous = Effect::named("viscous-friction").unwrap();
    let hidden = HiddenEffect {
        name: viscous.name.to_owned(),
        values: viscous.typical(&Scales::of(&axis)),
    };
    let both = [
        case(CaseKind::Clean, vec![]),
        case(CaseKind::Single, vec![hidden]),
    ];
    let bench = Bench::new(&axis, &both[0].setting).unwrap();
    let outcomes: Vec<CaseOutcome> = both.iter().map(|c| bench.try_case(c)).collect();
    for o in &outcomes {
        println!("{:?} {:?} {:?}", o.case.id, o.verdict, o.named);
    }
    // Alone, from what is kept of it, a case gives the same to the bit.
    assert_eq!(bench.try_case(&outcomes[0].case), outcomes[0]);
    let single = &outcomes[1];
    assert!(single.is_seen(), "{:?}", single.predicted);
    let rate = |start: &str| {
        let target = TARGETS.iter().find(|t| t.name.starts_with(start));
        target.unwrap().rate(&outcomes)
    };
    assert_eq!((rate("clean").hits, rate("clean").of), (0, 1));
    assert_eq!((rate("all cases").hits, rate("all cases").of), (0, 2));
    assert!(single.is_first());
    // Sizes are where they are to be, known parameters fitted out. So large, as the joint's
    // noise lies at high frequencies: at thirty times the fall of D that naming takes, the
    // effect is below the part of a channel's noise that is asked as well.
    let gain = single.predicted[0].gain;
    let mut less = both[1].clone();
    less.visible = vec![300.0];
    let smaller = bench.try_case(&less).predicted[0].gain;
    assert!(
        (gain / smaller / 10.0 - 1.0).abs() < 0.2,
        "{gain} {smaller}"
    );
}

/// Cases of a seed, and the benches of their plots, each set up once.
struct Trial {
    all: Vec<Case>,
    benches: RefCell<BTreeMap<usize, Bench>>,
}

impl Trial {
    fn new(seed: u64) -> Self {
        Self::on(&machines(), 600, seed)
    }

    fn on(machines: &[Axis], size: usize, seed: u64) -> Self {
        Self {
            all: cases(machines, &MatrixPlan::of(size), seed).unwrap(),
            benches: RefCell::default(),
        }
    }

    fn of(&self, id: &str) -> CaseOutcome {
        let case = self.all.iter().find(|c| c.id == id).unwrap();
        let setting = &case.setting;
        let bench = || Bench::new(&axis(&setting.machine), setting).unwrap();
        let mut benches = self.benches.borrow_mut();
        let bench = benches.entry(case.plot).or_insert_with(bench);
        let outcome = bench.try_case(case);
        println!("{id} {:?} {:?}", outcome.verdict, outcome.named);
        outcome
    }
}

/// Cases of seed 404 on a robot joint. From a file that is off by up to 20 % a fit of D alone
/// ended 10 600 above the truth, and a gravity imbalance was named; asymmetric friction beneath
/// noise that only the logger has was refused, as its gap stands out of nothing; and of a
/// quantised command the mean over a rest is not what the drive held.
#[test]
#[ignore = "slow: .ci/release.d/05-slow-tests.sh"]
fn fits_reach_the_truth_from_files_that_are_far_off() {
    let trial = Trial::new(404);
    let tried = |id: &str| {
        let outcome = trial.of(id);
        let d = outcome.deviance.unwrap();
        // As many numbers as are fitted bring that by chance.
        assert!(d.found - d.truth < 25.0, "{id}: {d:?}");
        outcome
    };
    let clean = tried("p01-clean-1");
    assert_eq!(clean.verdict, Some(Verdict::NothingMissing));
    let d = clean.deviance.unwrap();
    assert!(d.as_filed - d.truth > 20_000.0, "{d:?}");
    assert!(tried("p01-single-0").is_first());
    assert!(tried("p04-clean-2").wrong_names().is_empty());
}

/// A clean robot joint of seed 1919 with a quantised command (which served). Far from the truth, what follows
/// the machine made the fit a little worse, and what the drive held at the start was then not fitted either: a
/// force over the whole log was named that made up for it.
#[test]
#[ignore = "slow: .ci/release.d/05-slow-tests.sh"]
fn starts_are_fitted_where_the_known_parameters_are_far_off() {
    let outcome = Trial::new(1919).of("p01-clean-3");
    assert_eq!(outcome.verdict, Some(Verdict::NothingMissing));
    let d = outcome.deviance.unwrap();
    assert!(d.calibrated - d.truth < 25.0, "{d:?}");
}

/// A clean linear motor of seed 1717 (which served). Noise in the loop is slow noise and a line, which is
/// taken out as a hum and was named as a load that repeats; what both do to friction below 25 Hz looked
/// like something that is missing.
#[test]
#[ignore = "slow: .ci/release.d/05-slow-tests.sh"]
fn coloured_noise_in_the_loop_is_noise() {
    let outcome = Trial::new(1717).of("p35-clean-2");
    assert_eq!(outcome.verdict, Some(Verdict::NothingMissing));
    assert!(outcome.named.is_empty(), "{:?}", outcome.named);
}

/// A linear motor of seed 909 (which served). Noise of a low corner leaves more than four times the floor that
/// high frequencies show, and follows no motion: the right effect was refused, as it takes away a small part of
/// that.
#[test]
#[ignore = "slow: .ci/release.d/05-slow-tests.sh"]
fn slow_noise_in_the_loop_hides_no_effect() {
    let single = Trial::new(909).of("p08-single-0");
    assert!(single.is_first() && single.wrong_names().is_empty());
}

/// A clean joint of seed 2626 (which served) whose friction falls from break-away by another exponent: what the
/// knots of the onset left of that was named as cogging.
#[test]
fn another_exponent_of_the_fall_is_a_form_and_no_cogging() {
    let outcome = Trial::new(2626).of("p49-clean-3");
    assert_eq!(outcome.verdict, Some(Verdict::OtherForm));
    assert!(outcome.named.is_empty(), "{:?}", outcome.named);
}

/// A joint of seed 2828 (which served) on which a torque grows with the square of the motor's current, replayed from a
/// quantised log: a load that repeats and a friction by position imitate it.
#[test]
fn a_law_outside_the_library_is_not_named_by_effects_that_imitate_it() {
    let outcome = Trial::on(&[axis("joint")], 240, 2828).of("p01-outside-0");
    assert_eq!(outcome.verdict, Some(Verdict::Unknown));
    assert!(outcome.named.is_empty(), "{:?}", outcome.named);
    let depends_on = outcome.unknown.unwrap().depends_on;
    assert_eq!(depends_on, "force or torque of the drive");
}

/// Torque balances of seeds 1010 and 1111 in which no channel stands out of its noise. Both were refused
/// as there is no gap to share out.
#[test]
fn balances_name_what_lies_beneath_their_noise() {
    let tried = |seed: u64, id: &str| {
        let outcome = Trial::new(seed).of(id);
        assert!(outcome.is_first(), "{id}: {:?}", outcome.named);
        outcome
    };
    let swings = tried(1111, "p38-single-1");
    let (hidden, named) = (&swings.case.hidden[0].values, &swings.named[0].values);
    assert!((named[1] / hidden[1] - 1.0).abs() < 0.01, "{named:?}");
    tried(1010, "p05-single-2");
}

/// Torque balances of seed 808. Slow noise of a controller that nobody knows, up to four times the
/// least noise, is nothing that is missing; friction that comes on with speed is a form of the
/// axis' own, no Stribeck friction of the other sign; a load that repeats is found at a period that
/// the library does not start at; and a current's sensor shows its gain as a torque constant does.
#[test]
fn balances_name_what_is_there_and_nothing_else() {
    let trial = Trial::new(808);
    let tried = |id: &str| {
        let outcome = trial.of(id);
        assert!(outcome.wrong_names().is_empty(), "{id}");
        outcome
    };
    let clean = tried("p36-clean-0");
    assert_eq!(clean.verdict, Some(Verdict::NothingMissing));
    assert!(tried("p20-clean-2").named.is_empty());
    let repeats = tried("p06-single-0");
    let (hidden, named) = (&repeats.case.hidden[0].values, &repeats.named[0].values);
    assert!(repeats.is_first());
    assert!((named[1] / hidden[1] - 1.0).abs() < 0.01, "{named:?}");
    let gain = tried("p02-single-2");
    let is_gain = |n: &NamedEffect| n.name == "current-sensor-gain";
    let mut named = gain.named.iter().filter(|n| is_gain(n));
    let alike = named.any(|n| n.alike.iter().any(|a| a == "torque-constant"));
    assert!(alike, "{:?}", gain.named);
}
