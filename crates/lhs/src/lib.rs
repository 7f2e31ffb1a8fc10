//! Latin hypercube designs from a seed: plain, centred, optimised; any
//! marginal.
//!
//! # The problem
//! Given m input variables v₁ … v_m with distribution functions Gⱼ, choose n
//! points so that each variable alone is covered evenly: each of the n
//! intervals of probability 1/n of each variable holds exactly one point
//! (McKay, Beckman and Conover 1979, doi 10.1080/00401706.1979.10489755; the
//! steps and equations are numbered as in Liu, Guo, Liu and Niu, Machines
//! 2025, 13(5), 433, doi 10.3390/machines13050433, Section 4.2):
//!
//! 1. Each range Rⱼ is cut into n disjoint strata of probability 1/n
//!    (Eqs. 21 and 22).
//! 2. Stratum k of variable j gets the cumulative probability
//!    P_kj = (k − 1)/n + u_jk/n with u_jk uniform on (0, 1), or u_jk = ½
//!    (Eq. 23). All of them form the n × m matrix Q.
//! 3. v_kj = Gⱼ⁻¹(P_kj) (Eqs. 24 and 25).
//! 4. The values of each column are combined at random: row i takes stratum
//!    πⱼ(i) of variable j, πⱼ a random permutation of 0 … n − 1 (Eq. 26).
//!
//! The combination can also be chosen, so that the points are spread well in
//! all variables together: low centred discrepancy or a large minimum
//! distance ([`LatinHypercube::optimised`]), even in every two variables
//! ([`OrthogonalArray`]), Latin in parts as well ([`SlicedHypercube`]), with
//! given rank correlations ([`rank_correlated`]), or around points that are
//! there already ([`Augmentation`]). Sequences go on without end: [`Sobol`] and [`Halton`], plain
//! or scrambled, for means over the points. [`criteria`] has the figures to judge
//! designs by, [`map`] and [`map_balanced`] bring them to physical values,
//! integers and categories among them.
//!
//! # Symbols, shapes and units
//! n points of m variables; j counts variables, k strata, i points. A [`Design`] is n × m, one row
//! a point. Designs of probabilities have no unit and lie in (0, 1); [`map`] gives column j the
//! unit of marginal j.
//!
//! # One seed, one design
//! πⱼ is a keyed bijection and u a hash of (seed, column, row): any row is
//! computed alone by [`LatinHypercube::row`], in memory that does not grow
//! with n, and shards made on different machines fit together. The bits
//! depend on the arguments alone, not on threads.
//!
//! # Example
//! Five of 5000 states of a feed axis, by position, velocity, acceleration and current:
//! ```
//! use lhs::{LatinHypercube, Uniform, map};
//!
//! let position = Uniform::new(0.0, 1.5)?; // m
//! let velocity = Uniform::new(-0.333, 0.333)?; // m/s
//! let acceleration = Uniform::new(-1.0, 1.0)?; // m/s²
//! let current = Uniform::new(-15.0, 15.0)?; // A
//!
//! let hypercube = LatinHypercube::new(5000, 4, 2025)?;
//! let shard = hypercube.shard(100..105)?;
//! let points = map(&shard, &[&position, &velocity, &acceleration, &current])?;
//! assert_eq!((points.len(), points.dims()), (5, 4));
//! assert!(points.column(0).all(|x| (0.0..=1.5).contains(&x)));
//!
//! // The same row alone, without the others.
//! let mut row = [0.0; 4];
//! hypercube.row(102, &mut row)?;
//! assert_eq!(shard.row(2), Some(&row[..]));
//! # Ok::<(), lhs::LhsError>(())
//! ```
//! A better combination of the same strata:
//! ```
//! use lhs::{Budget, Criterion, LatinHypercube, criteria};
//!
//! let hypercube = LatinHypercube::new(100, 4, 7)?;
//! let budget = Budget { iterations: 2000 };
//! let (even, history) = hypercube.optimised(Criterion::CentredDiscrepancy, budget)?;
//! assert!(criteria::centred_discrepancy(&even) < 0.2 * criteria::centred_discrepancy(&hypercube.design()?));
//! assert_eq!(history.best, criteria::centred_discrepancy(&even));
//! # Ok::<(), lhs::LhsError>(())
//! ```
//!
//! # Features
//! `simd` (on by default) makes designs with the vector instructions that the processor has,
//! the same bits somewhat faster. `serde` writes and reads designs and the options that they
//! are made from.
//!
//! # What it knows nothing of
//! What the variables mean, the model that is run at the points, constraints
//! between variables.

#![cfg_attr(test, allow(clippy::disallowed_methods))]

mod augment;
mod correlation;
mod coverage;
pub mod criteria;
mod design;
mod discrepancies;
mod distance;
mod error;
mod halton;
mod hypercube;
mod kernel;
mod lattice;
mod marginals;
mod optimise;
mod orthogonal;
mod permutation;
mod power;
mod sequence;
mod sliced;
mod sobol;
#[cfg(feature = "serde")]
mod stored;
mod stratum;

pub use augment::{Augmentation, Augmented};
pub use correlation::{CorrelationMatrix, RankCorrelated, rank_correlated, rank_correlation};
pub use design::{Design, MAX_DIMS};
pub use error::LhsError;
pub use halton::Halton;
pub use hypercube::{LatinHypercube, Placement};
pub use marginals::{
    Cumulative, DesignVariable, Integers, Levels, LogUniform, Marginal, Mixture, Normal, Tabulated,
    Triangular, Truncated, Uniform, map, map_balanced,
};
pub use optimise::{Budget, Criterion, MAXIMIN_P, OptimisationHistory, optimise};
pub use orthogonal::{MAX_PRIME, OrthogonalArray};
pub use sliced::{Sliced, SlicedHypercube};
pub use sobol::{Scrambling, Sobol};

/// The README's example, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
