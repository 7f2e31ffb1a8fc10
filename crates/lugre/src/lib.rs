//! LuGre friction: the law, its steady-state curve, its exact stiff step, and its identification
