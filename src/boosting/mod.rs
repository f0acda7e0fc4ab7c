//! Gentle AdaBoost over regression stumps, and the memory of samples it is trained on.

mod gentle;
mod memory;
mod stump;

pub use gentle::{BoostingOptions, GentleAdaBoost, StrongClassifier};
pub use memory::{Label, SampleMemory};
pub use stump::Stump;
