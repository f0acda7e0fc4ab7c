//! Experiments of the papers that the project builds on, to be run again.

pub mod van_der_pol;
