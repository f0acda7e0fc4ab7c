//! Kernels that a regularised particle filter draws its particles from after resampling, so that copies of one particle
//! do not stay copies (Musso, Oudjane, Le Gland 2001; Silverman 1986 for the bandwidths).

use rand::{Rng, RngExt};
use rand_distr::StandardNormal;
use serde::{Deserialize, Serialize};

use super::State;

/// The shape of a kernel over n components whose covariance is the identity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Kernel {
    /// Standard normal.
    Gaussian,
    /// Density proportional to 1 - |x|^2 in the unit ball: the least mean integrated squared error.
    Epanechnikov,
}

impl Kernel {
    /// The bandwidth that is best if `particles` equally weighted particles stand for a standard normal density over `n`
    /// components.
    pub fn bandwidth(self, n: usize, particles: usize) -> f64 {
        let n = n as f64;
        let shape = match self {
            Self::Gaussian => 4.0 / (n + 2.0),
            Self::Epanechnikov => {
                8.0 / unit_ball_volume(n as usize) * (n + 4.0) * (2.0 * std::f64::consts::PI.sqrt()).powf(n)
            }
        };
        (shape / particles as f64).powf(1.0 / (n + 4.0))
    }

    /// A draw at bandwidth 1.
    pub fn sample<const N: usize, R: Rng + ?Sized>(self, rng: &mut R) -> State<N> {
        let draw = State::<N>::from_fn(|_, _| rng.sample(StandardNormal));
        match self {
            Self::Gaussian => draw,
            // The first n of the n + 4 coordinates of a point on the unit sphere have the density 1 - |x|^2.
            Self::Epanechnikov => {
                let rest: f64 = (0..4).map(|_| rng.sample::<f64, _>(StandardNormal).powi(2)).sum();
                draw / (draw.norm_squared() + rest).sqrt()
            }
        }
    }
}

/// V_n = V_n-2 * 2 pi / n.
fn unit_ball_volume(n: usize) -> f64 {
    match n {
        0 => 1.0,
        1 => 2.0,
        _ => unit_ball_volume(n - 2) * std::f64::consts::TAU / n as f64,
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;

    #[test]
    fn bandwidths_are_the_published_ones() {
        // Silverman 1986: 1.06 N^(-1/5) in one dimension, N^(-1/6) in two; Epanechnikov 2.345 N^(-1/5) and
        // 2.40 * N^(-1/6).
        assert!((Kernel::Gaussian.bandwidth(1, 1) - 1.0592).abs() < 1e-4);
        assert!((Kernel::Gaussian.bandwidth(2, 64) - 0.5).abs() < 1e-12);
        let one = Kernel::Epanechnikov.bandwidth(1, 1);
        assert!((one - 2.345).abs() < 1e-3, "{one}");
        let two = Kernel::Epanechnikov.bandwidth(2, 1);
        assert!((two - 2.40).abs() < 5e-3, "{two}");
    }

    #[test]
    fn the_epanechnikov_kernel_has_its_moments_and_stays_in_the_ball() {
        // E |x|^2 = n / (n + 4); in one dimension the variance is 1/5 and the fourth moment 3/35.
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let runs = 200_000;
        let (mut second, mut fourth, mut of_three) = (0.0, 0.0, 0.0);
        for _ in 0..runs {
            let x: State<1> = Kernel::Epanechnikov.sample(&mut rng);
            assert!(x.norm() <= 1.0);
            second += x[0].powi(2);
            fourth += x[0].powi(4);
            let y: State<3> = Kernel::Epanechnikov.sample(&mut rng);
            of_three += y.norm_squared();
        }
        let mean = |sum: f64| sum / f64::from(runs);
        assert!((mean(second) - 0.2).abs() < 2e-3, "{}", mean(second));
        assert!((mean(fourth) - 3.0 / 35.0).abs() < 2e-3, "{}", mean(fourth));
        assert!((mean(of_three) - 3.0 / 7.0).abs() < 3e-3, "{}", mean(of_three));
    }
}
