//! Frames per second.

/// Updates a second, from the seconds of each frame, `init` first, which does not count; `None` without an update.
/// Toolkits that count `init` give smaller numbers.
pub fn frames_per_second(seconds: &[f64]) -> Option<f64> {
    let updates = seconds.get(1..)?;
    let total: f64 = updates.iter().sum();
    (total > 0.0).then(|| updates.len() as f64 / total)
}

/// The mean over frames of each one's own frames a second, as the GOT-10k toolkit has it: the first frame, which is
/// `init`, counts, and frames of no time do not.
pub fn mean_of_rates(seconds: &[f64]) -> Option<f64> {
    let rates: Vec<f64> =
        seconds.iter().filter(|second| **second > 0.0).map(|second| second.recip()).collect();
    (!rates.is_empty()).then(|| rates.iter().sum::<f64>() / rates.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn got10k_takes_the_mean_of_the_frames_rates() {
        assert_eq!(mean_of_rates(&[0.5, 0.25, 0.0, 0.125]), Some((2.0 + 4.0 + 8.0) / 3.0));
        assert_eq!(mean_of_rates(&[0.0]), None);
    }

    #[test]
    fn only_updates_count() {
        assert_eq!(frames_per_second(&[9.0, 0.25, 0.75]), Some(2.0));
        assert_eq!(frames_per_second(&[9.0]), None);
        assert_eq!(frames_per_second(&[]), None);
    }
}
