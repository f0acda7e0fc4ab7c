//! The `otb_eval` program.

fn main() {}
