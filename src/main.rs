//! The `infopart` program.
fn main() {}
