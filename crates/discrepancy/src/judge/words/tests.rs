//! What a first screen says of made discoveries.

use super::RIGHT;
use crate::controller::OwnController;
use crate::judge::assess::remedies;
use crate::judge::assessment::{Confidence, Level};
use crate::judge::sentence::sentence;
use crate::judge::{
    Assessment, Cost, Discovery, EffectFound, EffortCost, FigureLogs, FormFound, Gaps,
    ParameterFound, Recalibrated, RefusedEffects, Size, TrackingCost, Verdict,
};
use crate::judge::{Curve, Unknown};
use crate::name::gap::{ChannelGap, Gap};

fn discovery(verdict: Verdict, effects: Vec<EffectFound>, known: Vec<Recalibrated>) -> Discovery {
    let gap = Gap {
        channels: vec![ChannelGap {
            channel: "position_m".to_owned(),
            before: 4e-6,
            after: 1.6e-8,
            floor: 1e-8,
            floor_most: 1.1e-8,
            floor_is_least: false,
        }],
        reduction: 0.997,
    };
    Discovery {
        schema: 1,
        axis: "made".to_owned(),
        answer: "closed-loop-replay".to_owned(),
        notes: Vec::new(),
        verdict,
        sentence: String::new(),
        assessment: Assessment {
            cost: cost(),
            each: Vec::new(),
            confidence: Confidence::new(verdict, &effects, &known, false),
            remedies: remedies(&effects),
            controller: None,
        },
        effects,
        own_form: None,
        replaced: Vec::new(),
        refused: None,
        not_added: Vec::new(),
        unknown: None,
        gap: Gaps {
            fit: gap.clone(),
            check: gap,
        },
        figures: FigureLogs::default(),
        recalibrated: known,
        likenesses: Vec::new(),
        next_experiment: None,
    }
}

fn cost() -> Cost {
    let size = |rms: f64, peak: f64| Size { rms, peak };
    Cost {
        tracking: Some(TrackingCost {
            unit: "m".to_owned(),
            measured: size(6.1e-6, 55e-6),
            with: size(6.0e-6, 54e-6),
            without: size(4.2e-6, 50e-6),
        }),
        effort: Some(EffortCost {
            channel: "iq_a".to_owned(),
            unit: "A".to_owned(),
            measured: size(0.5, 1.5),
            taken: size(0.1, 0.2),
            force_unit: "N".to_owned(),
            force: size(103.0, 206.0),
        }),
    }
}

fn viscous() -> EffectFound {
    EffectFound {
        name: "viscous-friction".to_owned(),
        summary: "friction proportional to speed".to_owned(),
        indistinguishable_from: Vec::new(),
        parameters: vec![ParameterFound {
            name: "coefficient".to_owned(),
            value: 1.0632e4,
            unit: "N*s/m".to_owned(),
            ci95: [1.062e4, 1.0644e4],
            when_named: 1.0632e4,
            at_screw: None,
        }],
        channel: "torque balance".to_owned(),
        depends_on: "speed".to_owned(),
        share_of_gap: 0.99,
        size_on_check: Some([0.998, 1.0, 1.002]),
        evidence: [1e5, 1e5],
        runners_up: Vec::new(),
        form: None,
    }
}

fn known(share: f64) -> Recalibrated {
    Recalibrated {
        name: "nut-stiffness".to_owned(),
        share,
        tolerance: 0.1,
        is_angle: false,
        by_logs: None,
    }
}

/// The lines under a question; none if it is not there.
fn lines(discovery: &Discovery, question: &str) -> Vec<String> {
    let all = discovery.first_screen();
    let found = all.into_iter().find(|a| a.question.starts_with(question));
    found.map_or(Vec::new(), |a| a.lines)
}

#[test]
fn an_effect_is_told_with_its_cost_confidence_and_remedy() {
    let made = discovery(Verdict::Explained, vec![viscous()], vec![known(0.01)]);
    assert_eq!(
        lines(&made, "What is missing"),
        [
            "Friction proportional to speed (viscous-friction): coefficient 10.632 N/(mm/s) (95 %: 10.620 to 10.644)."
        ]
    );
    assert_eq!(
        lines(&made, "What it costs"),
        [
            "Tracking error: 6.10 µm RMS, 55.0 µm peak as measured. Model: 6.00 µm RMS, 54.0 µm peak with it; 4.20 µm RMS, 50.0 µm peak without it.",
            "It takes 103 N RMS (206 N peak) at the load: 100 mA RMS of the 500 mA in iq_a.",
        ]
    );
    let sure = lines(&made, "How sure");
    assert_eq!(sure[0], "Confidence: high (the gap is explained).");
    assert!(sure[1].starts_with("99.7 % of the gap"));
    let said = "Size on motion not used in the fit, relative to that above: viscous-friction 1.00.";
    assert_eq!(sure[2], said);
    let mut wide = made.clone();
    wide.effects[0].size_on_check = Some([0.8, 0.9, 1.0]);
    let of_wide = lines(&wide, "How sure");
    assert!(of_wide[2].ends_with("viscous-friction 0.90 (95 %: 0.80 to 1.00)."));
    let mut small = made.clone();
    small.gap.check.channels[0].before = 1.1e-8;
    assert!(lines(&small, "How sure")[1].starts_with("No channel exceeded"));
    assert!(lines(&made, "What else").is_empty());
    let next = lines(&made, "What to do next");
    assert!(
        next[0].contains("speed-proportional torque feed-forward"),
        "{next:?}"
    );
}

/// The figures are those of the pages that `docs/laws/score.py` made.
#[test]
fn names_of_a_torque_balance_are_said_with_how_often_such_names_were_right() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/outcomes");
    let pages = [17, 18]
        .map(|seed| std::fs::read_to_string(format!("{folder}/laws-seed-{seed}.md")).unwrap());
    for (level, counted) in [Level::Low, Level::Medium, Level::High]
        .into_iter()
        .zip(RIGHT)
    {
        let line = format!("names given with {} confidence: ", level.word());
        let numbers = |page: &String| -> [usize; 2] {
            let (_, rest) = page.split_once(&line).unwrap();
            let (right, rest) = rest.split_once(" of ").unwrap();
            let (of, _) = rest.split_once(' ').unwrap();
            [right, of].map(|n| n.parse().unwrap())
        };
        let [a, b] = [numbers(&pages[0]), numbers(&pages[1])];
        assert_eq!(counted, [a[0] + b[0], a[1] + b[1]], "{line}");
    }
    let mut made = discovery(Verdict::Explained, vec![viscous()], Vec::new());
    let says = |made: &Discovery| {
        let sure = lines(made, "How sure");
        sure.iter()
            .any(|line| line.starts_with("Names with this confidence were right in "))
    };
    assert!(!says(&made));
    made.answer = "torque-balance".to_owned();
    assert!(says(&made));
    made.effects.clear();
    assert!(!says(&made));
}

#[test]
fn every_doubt_lowers_the_confidence_by_a_step() {
    let level = |verdict, effect: EffectFound, share: f64| {
        Confidence::new(verdict, &[effect], &[known(share)], false).level
    };
    let alike = EffectFound {
        indistinguishable_from: vec!["payload-mass".to_owned()],
        ..viscous()
    };
    let mut wide = viscous();
    wide.parameters[0].ci95 = [0.5e4, 1.6e4];
    assert_eq!(level(Verdict::Explained, viscous(), 0.05), Level::High);
    assert_eq!(level(Verdict::Explained, viscous(), -0.1), Level::Medium);
    assert_eq!(level(Verdict::Explained, wide.clone(), 0.05), Level::Medium);
    assert_eq!(level(Verdict::Explained, alike, 0.1), Level::Low);
    assert_eq!(
        level(Verdict::PartlyExplained, viscous(), 0.0),
        Level::Medium
    );
    assert_eq!(level(Verdict::PartlyExplained, wide, 0.1), Level::Low);
}

#[test]
fn a_parameter_without_tolerance_has_no_edge() {
    let held = Recalibrated {
        tolerance: 0.0,
        ..known(0.0)
    };
    assert!(!held.is_at_edge());
    assert!(known(-0.1).is_at_edge() && !known(0.09).is_at_edge());
}

/// A motor's inertia that is 13 % off was taken up by a parameter at 9.76 % of 10 %, without a word.
#[test]
fn a_parameter_whose_own_interval_reaches_beyond_its_tolerance_is_at_its_edge() {
    let by_logs = |share: f64, own: [f64; 2]| Recalibrated {
        by_logs: Some(own),
        ..known(share)
    };
    assert!(by_logs(0.0976, [0.0978, 0.006]).is_at_edge());
    assert!(by_logs(-0.09, [-0.13, 0.06]).is_at_edge());
    assert!(!by_logs(0.0976, [0.0978, 0.001]).is_at_edge());
    // Hardly known, an interval reaches beyond it from anywhere.
    assert!(!by_logs(0.05, [0.06, 0.06]).is_at_edge());
    assert!(!known(0.0976).is_at_edge());
}

#[test]
fn an_angle_is_said_in_degrees_and_a_whole_turn_has_no_edge() {
    let angle = |share: f64, tolerance: f64| Recalibrated {
        name: "hanging-angle".to_owned(),
        share,
        tolerance,
        is_angle: true,
        by_logs: None,
    };
    let edge = angle(-0.01, 0.01);
    assert!(edge.is_at_edge());
    assert_eq!(edge.moved(), "-0.573°");
    assert_eq!(edge.within(), "0.573°");
    assert_eq!(known(-0.1).moved(), "-10.00 %");
    assert!(!angle(3.13, std::f64::consts::PI).is_at_edge());
}

#[test]
fn all_parameters_at_their_edge_are_listed() {
    let second = Recalibrated {
        name: "table-mass".to_owned(),
        ..known(-0.1)
    };
    let made = discovery(
        Verdict::Explained,
        vec![viscous()],
        vec![known(0.1), second],
    );
    let sure = lines(&made, "How sure");
    let at_edge: Vec<&String> = sure.iter().filter(|l| l.contains("edge")).collect();
    assert_eq!(at_edge.len(), 2);
    assert!(at_edge[0].contains("+10.00 % of ±10.00 %"), "{sure:?}");
    assert!(at_edge[1].starts_with("table-mass"));
}

#[test]
fn what_is_named_twice_is_told_apart_by_its_order() {
    let cogging = |order: f64| {
        let mut one = viscous();
        one.name = "cogging-torque".to_owned();
        one.parameters[0].name = "order".to_owned();
        one.parameters[0].value = order;
        one
    };
    let said = |effects: &[EffectFound]| {
        let gap = discovery(Verdict::Explained, Vec::new(), Vec::new())
            .gap
            .check;
        sentence(Verdict::Explained, effects, &gap, None, None, None)
    };
    let two = said(&[cogging(72.0), viscous(), cogging(12.0)]);
    let names =
        "cogging-torque of order 72; viscous-friction; cogging-torque of order 12. With them";
    assert!(two.contains(names), "{two}");
    assert!(said(&[cogging(72.0)]).contains("lacks cogging-torque. With it"));
    let mut made = discovery(Verdict::Explained, Vec::new(), Vec::new());
    made.effects = vec![cogging(72.0), viscous(), cogging(12.0)];
    made.effects[2].indistinguishable_from = vec!["structural-resonance".to_owned()];
    let names = made.effects.iter().map(|e| e.name.clone());
    made.assessment.each = names.map(|name| (name, Cost::default())).collect();
    let shares = lines(&made, "What it costs");
    let of = |k: usize| shares[shares.len() - 3 + k].split(" alone").next().unwrap();
    assert_eq!(
        [of(0), of(1), of(2)],
        [
            "cogging-torque of order 72",
            "viscous-friction",
            "cogging-torque of order 12"
        ]
    );
    let alike = lines(&made, "What else");
    assert!(alike[0].starts_with("These logs cannot tell cogging-torque of order 12 from"));
}

/// A gap without a name ends with what would show more of it.
#[test]
fn what_to_do_next_is_said_of_a_gap_that_nothing_explains() {
    let mut made = discovery(Verdict::Unknown, Vec::new(), Vec::new());
    made.answer = "closed-loop-replay".to_owned();
    let next = lines(&made, "What to do next");
    assert!(next[0].contains("--balance"), "{next:?}");
    made.answer = "torque-balance".to_owned();
    let next = lines(&made, "What to do next");
    assert!(
        next.iter().all(|line| !line.contains("--balance")),
        "{next:?}"
    );
    assert!(next[0].contains("constant speeds"), "{next:?}");
}

#[test]
fn nothing_and_the_unknown_are_said_so() {
    let nothing = discovery(Verdict::NothingMissing, Vec::new(), Vec::new());
    assert!(lines(&nothing, "What is missing")[0].starts_with("Nothing:"));
    assert_eq!(lines(&nothing, "What it costs").len(), 1);
    // A gap that a form of the axis' own friction takes away was there.
    let mut bent = discovery(Verdict::OtherForm, Vec::new(), Vec::new());
    bent.own_form = Some(FormFound {
        of: "dry friction of the axis".to_owned(),
        differs_in: "onset".to_owned(),
        below: 2e-4,
        unit: "m/s".to_owned(),
        with_speed: 1.0,
        speed: vec![1e-5, 1e-3],
        ratio: vec![0.1, 1.0],
        evidence: [100.0, 100.0],
    });
    let said = lines(&bent, "What is missing");
    assert!(said[0].starts_with("No effect, but"), "{said:?}");
    assert!(said[1].contains("below 0.20 mm/s differs"), "{said:?}");
    let mut unknown = discovery(Verdict::Unknown, Vec::new(), Vec::new());
    assert!(lines(&unknown, "What is missing")[0].starts_with("Unknown:"));
    unknown.unknown = Some(Unknown {
        channel: "torque balance".to_owned(),
        depends_on: "speed".to_owned(),
        formula: Some("force = 3 N·s²/m² · |v|·v".to_owned()),
        curve: Curve {
            variable: "speed, m/s".to_owned(),
            unit: "N".to_owned(),
            at: vec![0.0, 0.1],
            value: vec![0.0, -35.2],
            within: vec![0.0, 0.0],
        },
        evidence: [100.0, 100.0],
    });
    assert_eq!(
        lines(&unknown, "What is missing"),
        [
            "Unknown: something that is not in the library, up to 35.2 N. It acts in the torque balance and depends on speed: force = 3 N·s²/m² · |v|·v."
        ]
    );
    assert_eq!(
        lines(&unknown, "How sure")[0].split(' ').nth(1),
        Some("low")
    );
    assert!(lines(&unknown, "What to do next")[0].contains("(friction over speed)"));
}

#[test]
fn effects_that_imitate_a_law_are_said_beside_what_is_named() {
    let refused = |effects: &[&str]| RefusedEffects {
        effects: effects.iter().map(|name| (*name).to_owned()).collect(),
        law: Some("|v|·v".to_owned()),
        ..RefusedEffects::default()
    };
    let mut made = discovery(Verdict::PartlyExplained, vec![viscous()], Vec::new());
    made.refused = Some(refused(&["coulomb-friction", "stribeck-friction"]));
    assert_eq!(
        lines(&made, "What is missing")[1],
        "A force in proportion to |v|·v explains and predicts these logs better than coulomb-friction with stribeck-friction, so they are not named."
    );
    made.refused = Some(refused(&["coulomb-friction"]));
    assert!(lines(&made, "What is missing")[1].ends_with("so it is not named."));
    // Where only the friction's own form was another, no name stands there.
    let form = lines(&discovery_refusing(&[]), "What is missing")[1].clone();
    assert!(
        form.starts_with("Another form of the friction would explain"),
        "{form}"
    );
}

fn discovery_refusing(effects: &[&str]) -> Discovery {
    let mut made = discovery(Verdict::Unknown, Vec::new(), Vec::new());
    made.refused = Some(RefusedEffects {
        effects: effects.iter().map(|name| (*name).to_owned()).collect(),
        channels: vec!["force_ref_n".to_owned()],
        ..RefusedEffects::default()
    });
    made
}

#[test]
fn effects_that_look_alike_are_named_in_plain_words() {
    let effect = EffectFound {
        indistinguishable_from: vec!["payload-mass".to_owned()],
        ..viscous()
    };
    let made = discovery(Verdict::Explained, vec![effect], Vec::new());
    assert_eq!(
        lines(&made, "What else"),
        [
            "These logs cannot tell viscous-friction from payload-mass (payload that moves with the load)."
        ]
    );
}

#[test]
fn a_torque_balance_has_no_tracking_error() {
    let mut made = discovery(Verdict::Explained, vec![viscous()], Vec::new());
    made.answer = "torque-balance".to_owned();
    made.assessment.cost.tracking = None;
    assert!(lines(&made, "What it costs")[0].starts_with("The tracking error is not known"));
    let sure = lines(&made, "How sure");
    let says = |line: &String| line.starts_with("Compared by torque balance");
    assert!(sure.iter().any(says), "{sure:?}");
}

#[test]
fn another_controller_is_told_before_remedies() {
    let mut found = discovery(Verdict::PartlyExplained, vec![viscous()], vec![]);
    found.assessment.controller = Some(OwnController {
        left: 2.083,
        better: "p-pi, speed_lowpass".to_owned(),
        better_left: 1.512e-6,
    });
    let said = lines(&found, "What to do next");
    assert_eq!(
        said[0],
        "The controller of the file does not reproduce the logged command: it leaves 208 % of it unexplained (mean square), while p-pi, speed_lowpass leaves 0.00015 %. Estimate it (identify-control) and search with the file that this writes; or leave the controller out (--balance), which compares forces."
    );
    assert_eq!(said.len(), 2);
}
