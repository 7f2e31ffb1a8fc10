//! Cases on which the search is set beside regressions over a library of terms.

use std::collections::BTreeMap;

use axis_sim::Axis;
use lhs::LhsError;

use super::case::Case;
use super::design::{MatrixPlan, cases};
use crate::matrix::CaseKind;

/// What a regression of the motor's torque on terms could say of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reach {
    /// Nothing is hidden: it should say nothing.
    Clean,
    /// What is hidden is a sum of terms with one coefficient each, of position, speed,
    /// acceleration and torque at the same instant ([`IN_TERMS`]).
    InTerms,
    /// What is hidden is no such sum: it acts between the channels, in the controller or in
    /// time, has a memory, or is a law outside the library.
    Beyond,
}

impl Reach {
    /// In files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Clean => "clean",
            Self::InTerms => "in terms",
            Self::Beyond => "beyond terms",
        }
    }

    /// Of a case with at most one thing hidden.
    pub fn of(case: &Case) -> Self {
        let in_terms = |name: &str| IN_TERMS.contains(&name);
        match case.hidden.as_slice() {
            [] => Self::Clean,
            all if all.iter().all(|h| in_terms(&h.name)) => Self::InTerms,
            _ => Self::Beyond,
        }
    }
}

/// Effects that are linear in terms which a regression can be given beforehand; of a bump and
/// of Stribeck's fall the place, the width and the speed stand on a grid.
pub const IN_TERMS: [&str; 18] = [
    "asymmetric-friction",
    "asymmetric-viscous-friction",
    "cogging-torque",
    "constant-load",
    "coulomb-friction",
    "current-sensor-gain",
    "current-sensor-offset",
    "force-ripple",
    "gravity-imbalance",
    "load-dependent-friction",
    "motor-inertia",
    "payload-mass",
    "position-dependent-friction",
    "spring-force",
    "stribeck-friction",
    "torque-constant",
    "torque-ripple",
    "viscous-friction",
];

/// Cases of a plot: a clean one, two in terms, one beyond.
const EACH: usize = 4;

/// Single effects drawn a plot, to choose from.
const DRAWN: usize = 16;

/// At least so many cases, in whole plots of four: one is clean, two hide an effect that terms
/// can say, one hides what they cannot, by turns an effect of the library and a law of none.
/// Among what the matrix draws, the effect that was taken least often is taken, the first
/// drawn of these; nothing is chosen by its size, form or noise.
///
/// # Errors
/// [`LhsError`] never for sizes above zero.
pub fn peer_cases(machines: &[Axis], count: usize, seed: u64) -> Result<Vec<Case>, LhsError> {
    let plots = count.div_ceil(EACH);
    let plan = MatrixPlan {
        plots,
        each: vec![
            (CaseKind::Clean, 1),
            (CaseKind::Single, DRAWN),
            (CaseKind::Outside, 1),
        ],
    };
    let all = cases(machines, &plan, seed)?;
    let mut taken = BTreeMap::new();
    let chosen = all.chunk_by(|a, b| a.plot == b.plot).flat_map(|plot| {
        let turn = plot[0].plot / machines.len().max(1);
        chosen(plot, turn % 2 == 1, &mut taken)
    });
    Ok(chosen.collect())
}

/// Those of a plot.
fn chosen(plot: &[Case], law: bool, taken: &mut BTreeMap<String, usize>) -> Vec<Case> {
    let mut chosen: Vec<Case> = of_kind(plot, CaseKind::Clean).take(1).cloned().collect();
    let mut rare = |reach: Reach, chosen: &[Case]| {
        let free = of_kind(plot, CaseKind::Single).filter(|c| Reach::of(c) == reach);
        let free = free.filter(|c| chosen.iter().all(|o| o.hidden != c.hidden));
        let times = |c: &&Case| taken.get(&c.hidden[0].name).copied().unwrap_or(0);
        let case = free.min_by_key(times)?;
        *taken.entry(case.hidden[0].name.clone()).or_default() += 1;
        Some(case.clone())
    };
    for _ in 0..EACH - 2 {
        chosen.extend(rare(Reach::InTerms, &chosen));
    }
    match law {
        true => chosen.extend(of_kind(plot, CaseKind::Outside).take(1).cloned()),
        false => chosen.extend(rare(Reach::Beyond, &chosen)),
    }
    chosen
}

fn of_kind(plot: &[Case], kind: CaseKind) -> impl Iterator<Item = &Case> {
    plot.iter().filter(move |c| c.kind == kind)
}

#[cfg(test)]
mod tests {
    use axis_sim::effects::Effect;

    use super::*;

    fn machines() -> Vec<Axis> {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/axes/");
        let files = ["liu2025.toml", "joint.toml", "linear-motor.toml"];
        let read = |file: &str| Axis::read((root.to_owned() + file).as_ref()).unwrap();
        files.map(read).to_vec()
    }

    #[test]
    fn effects_in_terms_are_of_the_library() {
        for name in IN_TERMS {
            assert!(Effect::named(name).is_some(), "{name}");
        }
    }

    /// Or shares of right names would be of another mixture than the page says.
    #[test]
    fn each_plot_asks_every_kind_of_question() {
        let all = peer_cases(&machines(), 40, 5).unwrap();
        assert_eq!(all.len(), 40);
        for (k, plot) in all.chunk_by(|a, b| a.plot == b.plot).enumerate() {
            let reach: Vec<Reach> = plot.iter().map(Reach::of).collect();
            let terms = Reach::InTerms;
            assert_eq!(reach, [Reach::Clean, terms, terms, Reach::Beyond]);
            assert_ne!(plot[1].hidden, plot[2].hidden);
            let law = (k / 3) % 2 == 1;
            assert_eq!(plot[3].law.is_some(), law, "{k}");
        }
    }

    #[test]
    fn effects_come_up_before_any_is_taken_thrice() {
        let all = peer_cases(&machines(), 40, 5).unwrap();
        let hides = |case: &&Case, name: &str| case.hidden.iter().any(|h| h.name == name);
        let count = |name: &&str| all.iter().filter(|c| hides(c, name)).count();
        let most = IN_TERMS.iter().map(&count).max();
        assert!(most <= Some(3), "{most:?}");
        let kinds = IN_TERMS.iter().filter(|name| count(name) > 0).count();
        assert!(kinds >= 12, "{kinds}");
    }

    #[test]
    fn a_seed_gives_the_same_cases_again() {
        let cases = |seed| peer_cases(&machines(), 8, seed).unwrap();
        assert_eq!(cases(5), cases(5));
        assert_ne!(cases(5), cases(6));
    }
}
