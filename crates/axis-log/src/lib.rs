//! Sampled, named channels of an axis: reading, writing, error metrics
