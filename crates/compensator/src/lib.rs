//! Correction strategies for a servo axis behind one trait
