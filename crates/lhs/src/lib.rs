//! Latin hypercube designs from a seed: plain, centred, optimised; any marginal
