//! Cascade-forward neural networks: evaluation, analytic Jacobian, Levenberg-Marquardt training
