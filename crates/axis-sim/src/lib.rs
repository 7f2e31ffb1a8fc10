//! Closed-loop simulation of a ball-screw axis: plant, servo and compensator to log
