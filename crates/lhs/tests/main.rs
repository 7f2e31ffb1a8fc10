//! One test program: designs, marginals, criteria and their optimisation.

mod criteria;
mod latin;
mod limits;
mod marginals;
mod optimise;
