//! Which frames are worth learning from (after Wang, Liu, Huang 2017): those whose evidence makes the estimate likely and where
//! the place filter answers nearly as well as it has lately. Somebody who walks before the target lowers the answer at once.

use super::parameters::Parameters;

/// How fast the running mean follows.
const RATE: f64 = 0.05;

/// Remembers how well the filter answered.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct LearningGate {
    least_trust: f64,
    /// The response must be above this share of its running mean.
    least_share: f64,
    mean_response: Option<f64>,
}

impl LearningGate {
    /// A gate that has seen no response.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            least_trust: parameters.update_confidence,
            least_share: parameters.update_response,
            mean_response: None,
        }
    }

    /// Whether a frame may be learnt: `trust` is the probability of its estimate from its evidence alone, `response` the
    /// filters' at the estimate.
    pub fn opens(&mut self, trust: f64, response: Option<f64>) -> bool {
        let is_trusted = trust > self.least_trust;
        let Some(response) = response else { return is_trusted };
        let mean = self.mean_response.get_or_insert(response);
        let is_steady = response >= self.least_share * *mean;
        *mean += RATE * (response - *mean);
        is_trusted && is_steady
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gate() -> LearningGate {
        LearningGate::new(&Parameters::default())
    }

    #[test]
    fn a_sudden_drop_of_the_response_closes_the_gate_until_it_comes_back_or_lasts() {
        let mut gate = gate();
        assert!((0..20).all(|_| gate.opens(0.9, Some(0.8))));
        assert!(!gate.opens(0.9, Some(0.5)));
        assert!(gate.opens(0.9, Some(0.75)));
        let shut = (0..100).take_while(|_| !gate.opens(0.9, Some(0.4))).count();
        assert!((5..40).contains(&shut), "{shut}");
    }

    #[test]
    fn trust_is_asked_for_with_and_without_a_filter() {
        let mut gate = gate();
        assert!(gate.opens(0.6, None) && !gate.opens(0.4, None));
        assert!(!gate.opens(0.4, Some(1.0)) && gate.opens(0.6, Some(1.0)));
    }
}
