//! Jerk-limited S-curves and motion programs, evaluated exactly at any time
