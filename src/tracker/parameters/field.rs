//! What the table of parameters needs of one field: its check and its line of TOML.

use std::fmt::{Display, Write};

use serde::Serialize;

use super::ParameterError;

/// First lines of a documented configuration.
pub(super) const HEADER: &str =
    "# InfoPart's parameters. Pass this file, or any of its lines, with --config FILE.toml.\n";

/// A value with a range.
pub(super) trait Limited: PartialOrd + Display + Sized {
    /// Refuses what is not inside [low, high]; NaN is not.
    fn check(&self, key: &'static str, low: Self, high: Self) -> Result<(), ParameterError> {
        if *self >= low && *self <= high {
            return Ok(());
        }
        Err(ParameterError::OutOfRange { key, given: show(self), low: show(&low), high: show(&high) })
    }
}

impl Limited for f64 {}
impl Limited for u64 {}
impl Limited for usize {}

/// A limit as a reader would write it.
pub(super) fn show(limit: &impl Display) -> String {
    limit.to_string()
}

/// Appends the comment of a field.
pub(super) fn document(text: &mut String, doc: &str, unit: &str, limits: &[String]) {
    let range = match limits {
        [low, high] if low != high => format!(", from {low} to {high}"),
        _ => String::new(),
    };
    // Writing to a String cannot fail.
    let _ = writeln!(text, "\n# {doc}\n# Unit: {unit}{range}.");
}

/// Appends the assignment of a field, with the default where it differs.
pub(super) fn assign<T: Serialize + PartialEq>(text: &mut String, key: &str, value: &T, default: &T) {
    let literal = |value: &T| toml::Value::try_from(value).map_or_else(|e| e.to_string(), |v| v.to_string());
    let note = if value == default { String::new() } else { format!("  # default: {}", literal(default)) };
    let _ = writeln!(text, "{key} = {}{note}", literal(value));
}
