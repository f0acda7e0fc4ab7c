//! Frames per second.

/// Updates a second, from the seconds of each frame, `init` first, which does not count; `None` without an update.
/// Toolkits that count `init` give smaller numbers.
pub fn frames_per_second(seconds: &[f64]) -> Option<f64> {
    let updates = seconds.get(1..)?;
    let total: f64 = updates.iter().sum();
    (total > 0.0).then(|| updates.len() as f64 / total)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_updates_count() {
        assert_eq!(frames_per_second(&[9.0, 0.25, 0.75]), Some(2.0));
        assert_eq!(frames_per_second(&[9.0]), None);
        assert_eq!(frames_per_second(&[]), None);
    }
}
