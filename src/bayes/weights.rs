//! Log-weights of particles: normalisation that no likelihood can underflow, and the effective sample size.

/// Turns log-weights into weights that sum to 1 and returns ln(sum exp(log-weights)) of what came in.
///
/// The maximum is subtracted first, then `epsilon` is added to each, so `epsilon` is relative to the best
/// particle: weight_i = (weight_i + eps) / sum_j (weight_j + eps). NaN counts as zero weight. If every weight
/// is zero they become uniform and -inf is returned. On return `log_weights` holds the logarithms of `weights`.
///
/// # Panics
/// If the slices differ in length.
pub fn normalise(log_weights: &mut [f64], weights: &mut [f64], epsilon: f64) -> f64 {
    assert_eq!(log_weights.len(), weights.len(), "one weight for each log-weight");
    let best = log_weights.iter().copied().filter(|w| !w.is_nan()).fold(f64::NEG_INFINITY, f64::max);
    if best == f64::NEG_INFINITY {
        let uniform = 1.0 / weights.len() as f64;
        weights.fill(uniform);
        log_weights.fill(uniform.ln());
        return f64::NEG_INFINITY;
    }
    let mut sum = 0.0;
    for (weight, &log_weight) in weights.iter_mut().zip(log_weights.iter()) {
        let relative = if log_weight == best { 1.0 } else { (log_weight - best).exp() };
        *weight = if relative.is_nan() { 0.0 } else { relative };
        sum += *weight;
    }
    let total = sum + epsilon * weights.len() as f64;
    for (weight, log_weight) in weights.iter_mut().zip(log_weights) {
        *weight = (*weight + epsilon) / total;
        *log_weight = weight.ln();
    }
    best + sum.ln()
}

/// N_eff = 1 / sum(weight^2), in [1, N] for weights that sum to 1.
pub fn effective_sample_size(weights: &[f64]) -> f64 {
    1.0 / weights.iter().map(|w| w * w).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_to_one_and_keep_their_ratio() {
        let mut log_weights = [1.0f64.ln(), 3.0f64.ln()];
        let mut weights = [0.0; 2];
        let log_sum = normalise(&mut log_weights, &mut weights, 1e-20);
        assert!((log_sum - 4.0f64.ln()).abs() < 1e-15);
        assert!((weights[0] - 0.25).abs() < 1e-15 && (weights[1] - 0.75).abs() < 1e-15);
        assert!((log_weights[1] - 0.75f64.ln()).abs() < 1e-15);
    }

    #[test]
    fn likelihoods_far_below_the_smallest_float_keep_their_ratio() {
        let mut log_weights = [-100_000.0, -100_000.0 + 2.0f64.ln()];
        let mut weights = [0.0; 2];
        normalise(&mut log_weights, &mut weights, 1e-20);
        assert!((weights[1] / weights[0] - 2.0).abs() < 1e-9);
    }

    #[test]
    fn if_every_likelihood_is_zero_the_weights_are_uniform() {
        for zero in [f64::NEG_INFINITY, f64::NAN] {
            let mut log_weights = [zero; 4];
            let mut weights = [0.0; 4];
            assert_eq!(normalise(&mut log_weights, &mut weights, 1e-20), f64::NEG_INFINITY);
            assert_eq!(weights, [0.25; 4]);
        }
    }

    #[test]
    fn nan_and_infinite_likelihoods_leave_the_rest_whole() {
        let mut log_weights = [f64::NAN, 0.0, f64::NEG_INFINITY];
        let mut weights = [0.0; 3];
        normalise(&mut log_weights, &mut weights, 1e-20);
        assert!((weights[1] - 1.0).abs() < 1e-15 && weights[0] < 1e-19 && weights[2] < 1e-19);
        let mut certain = [f64::INFINITY, 0.0];
        normalise(&mut certain, &mut weights[..2], 1e-20);
        assert!((weights[0] - 1.0).abs() < 1e-15);
    }

    #[test]
    fn epsilon_is_the_share_of_a_hopeless_particle() {
        let mut log_weights = [0.0, f64::NEG_INFINITY];
        let mut weights = [0.0; 2];
        normalise(&mut log_weights, &mut weights, 0.5);
        assert_eq!(weights, [0.75, 0.25]);
    }

    #[test]
    fn effective_sample_size_runs_from_one_to_all() {
        assert_eq!(effective_sample_size(&[1.0, 0.0, 0.0, 0.0]), 1.0);
        assert_eq!(effective_sample_size(&[0.25; 4]), 4.0);
        assert_eq!(effective_sample_size(&[0.5, 0.5, 0.0, 0.0]), 2.0);
    }
}
