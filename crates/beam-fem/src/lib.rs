//! Timoshenko beam finite elements: element matrices, assembly, moving-node mesh, natural modes
