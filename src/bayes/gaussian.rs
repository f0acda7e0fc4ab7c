//! Gaussian beliefs and Gaussian noise, with covariances that are checked once and stay symmetric and positive
//! semi-definite.

use nalgebra::{Cholesky, Const, SMatrix};
use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

use super::{Covariance, FilterError, State};

/// How far a covariance may be from symmetric, and a variance below zero, relative to its largest element.
const TOLERANCE: f64 = 1e-9;

/// A belief N(mean, covariance) about a state of `N` components.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gaussian<const N: usize> {
    /// Mean.
    pub mean: State<N>,
    /// Covariance: symmetric, positive semi-definite.
    pub covariance: Covariance<N>,
}

impl<const N: usize> Gaussian<N> {
    /// A belief with a checked covariance; components that are known exactly have variance 0.
    ///
    /// # Errors
    /// [`FilterError`] if a number is not finite, or the covariance not symmetric or not positive semi-definite.
    pub fn new(mean: State<N>, covariance: Covariance<N>) -> Result<Self, FilterError> {
        check_finite(&mean, "the mean")?;
        check_covariance(&covariance, "the covariance")?;
        Ok(Self { mean, covariance: symmetric(&covariance) })
    }

    /// Squared Mahalanobis distance (x - mean)' P^-1 (x - mean) of `state`: the normalised estimation error squared
    /// (NEES) if that is the truth, then chi-square with `N` degrees of freedom under a matched model.
    ///
    /// # Errors
    /// [`FilterError::CholeskyFailed`] if the covariance is singular.
    pub fn nees(&self, state: &State<N>) -> Result<f64, FilterError> {
        let factor = cholesky(&self.covariance, "the covariance")?;
        Ok(squared_length(&factor, &(state - self.mean)))
    }

    /// The belief after x = F x + w, w ~ N(0, `noise`), whose mean has been moved to `mean`: P = F P F' + Q.
    pub(super) fn moved(
        &self,
        mean: State<N>,
        jacobian: &SMatrix<f64, N, N>,
        noise: &Covariance<N>,
    ) -> Result<Self, FilterError> {
        check_finite(&mean, "the predicted mean")?;
        let covariance = symmetric(&(jacobian * self.covariance * jacobian.transpose() + noise));
        check_finite(&covariance, "the predicted covariance")?;
        Ok(Self { mean, covariance })
    }

    /// The belief after a measurement that missed its prediction by `residual`, where H = `jacobian` and R = `noise`.
    /// P in Joseph's form (I - K H) P (I - K H)' + K R K', which stays positive semi-definite whatever rounding does to K.
    pub(super) fn corrected<const M: usize>(
        &self,
        residual: State<M>,
        jacobian: &SMatrix<f64, M, N>,
        noise: &Covariance<M>,
    ) -> Result<(Self, Innovation<M>), FilterError> {
        let cross = self.covariance * jacobian.transpose();
        let innovation = Innovation::new(residual, symmetric(&(jacobian * cross + noise)))?;
        let gain = innovation.gain(&cross);
        let kept = Covariance::<N>::identity() - gain * jacobian;
        let covariance =
            symmetric(&(kept * self.covariance * kept.transpose() + gain * noise * gain.transpose()));
        Ok((Self { mean: self.mean + gain * residual, covariance }, innovation))
    }
}

/// How a measurement met its prediction.
#[derive(Debug, Clone)]
pub struct Innovation<const M: usize> {
    /// z - h(x-): measured minus predicted.
    pub residual: State<M>,
    /// S: covariance of the residual.
    pub covariance: Covariance<M>,
    /// Normalised innovation squared, residual' S^-1 residual: chi-square with `M` degrees of freedom under a matched
    /// model, and the squared distance for gating.
    pub nis: f64,
    /// ln p(z | z_1:k-1) = ln N(residual; 0, S).
    pub log_likelihood: f64,
    factor: Cholesky<f64, Const<M>>,
}

impl<const M: usize> Innovation<M> {
    pub(super) fn new(residual: State<M>, covariance: Covariance<M>) -> Result<Self, FilterError> {
        check_finite(&residual, "the measurement, or its prediction,")?;
        check_finite(&covariance, "the innovation covariance")?;
        let factor = Cholesky::new(covariance).ok_or(FilterError::SingularInnovation)?;
        let lower = factor.l_dirty();
        // A pivot is what of a component's variance the components before it leave unexplained.
        let least = f64::EPSILON * (M as f64);
        if (0..M).any(|i| lower[(i, i)] * lower[(i, i)] <= least * covariance[(i, i)]) {
            return Err(FilterError::SingularInnovation);
        }
        let nis = squared_length(&factor, &residual);
        let log_determinant: f64 = (0..M).map(|i| 2.0 * lower[(i, i)].ln()).sum();
        let log_likelihood = -0.5 * (nis + log_determinant + M as f64 * std::f64::consts::TAU.ln());
        Ok(Self { residual, covariance, nis, log_likelihood, factor })
    }

    /// K = C S^-1 for the cross-covariance C of state and measurement.
    pub(super) fn gain<const N: usize>(&self, cross: &SMatrix<f64, N, M>) -> SMatrix<f64, N, M> {
        self.factor.solve(&cross.transpose()).transpose()
    }
}

/// Zero-mean Gaussian noise of `N` components, its covariance checked and factored once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaussianNoise<const N: usize> {
    covariance: Covariance<N>,
    /// Lower triangular; a column of zeros for each direction without noise.
    factor: Covariance<N>,
}

impl<const N: usize> GaussianNoise<N> {
    /// Noise of a covariance, which may be singular.
    ///
    /// # Errors
    /// [`FilterError`] if a number is not finite, or the covariance not symmetric or not positive semi-definite.
    pub fn new(covariance: Covariance<N>) -> Result<Self, FilterError> {
        check_covariance(&covariance, "the noise covariance")?;
        let covariance = symmetric(&covariance);
        Ok(Self { covariance, factor: semidefinite_factor(&covariance) })
    }

    /// Independent components of the given variances, each >= 0.
    ///
    /// # Errors
    /// [`FilterError`] if a variance is negative or not finite.
    pub fn diagonal(variances: &State<N>) -> Result<Self, FilterError> {
        Self::new(Covariance::from_diagonal(variances))
    }

    /// The covariance.
    pub fn covariance(&self) -> &Covariance<N> {
        &self.covariance
    }

    /// Lower triangular L with L L' = covariance.
    pub fn factor(&self) -> &Covariance<N> {
        &self.factor
    }

    /// A draw.
    pub fn sample<R: Rng + ?Sized>(&self, rng: &mut R) -> State<N> {
        self.factor * State::<N>::from_fn(|_, _| rng.sample(StandardNormal))
    }

    /// ln N(`deviation`; 0, covariance). Where the covariance is singular: the density over the directions that have
    /// noise, and -inf for a deviation in another.
    pub fn log_density(&self, deviation: &State<N>) -> f64 {
        let mut whitened = *deviation;
        let mut sum = 0.0;
        for i in 0..N {
            let pivot = self.factor[(i, i)];
            let rest = whitened[i];
            if pivot > 0.0 {
                let z = rest / pivot;
                sum -= 0.5 * (z * z + std::f64::consts::TAU.ln()) + pivot.ln();
                for j in i + 1..N {
                    whitened[j] -= self.factor[(j, i)] * z;
                }
            } else if rest.abs() > TOLERANCE * (1.0 + deviation.amax()) {
                return f64::NEG_INFINITY;
            }
        }
        sum
    }
}

/// (A + A') / 2.
pub(super) fn symmetric<const N: usize>(matrix: &Covariance<N>) -> Covariance<N> {
    matrix * 0.5 + matrix.transpose() * 0.5
}

/// The Cholesky factor of a positive definite matrix.
pub(super) fn cholesky<const N: usize>(
    matrix: &Covariance<N>,
    what: &'static str,
) -> Result<Cholesky<f64, Const<N>>, FilterError> {
    Cholesky::new(*matrix).ok_or(FilterError::CholeskyFailed { what })
}

/// An error that names `what` unless every number is finite.
pub(super) fn check_finite<const R: usize, const C: usize>(
    matrix: &SMatrix<f64, R, C>,
    what: &'static str,
) -> Result<(), FilterError> {
    if matrix.iter().all(|value| value.is_finite()) { Ok(()) } else { Err(FilterError::NotFinite { what }) }
}

fn check_covariance<const N: usize>(matrix: &Covariance<N>, what: &'static str) -> Result<(), FilterError> {
    check_finite(matrix, what)?;
    let scale = matrix.amax();
    for row in 0..N {
        for column in 0..row {
            let gap = (matrix[(row, column)] - matrix[(column, row)]).abs();
            if gap > TOLERANCE * scale {
                return Err(FilterError::NotSymmetric { what, row, column });
            }
        }
    }
    let lifted = symmetric(matrix) + Covariance::<N>::identity() * (TOLERANCE * scale);
    if scale > 0.0 && Cholesky::new(lifted).is_none() {
        return Err(FilterError::Indefinite { what });
    }
    Ok(())
}

/// Lower triangular L with L L' = `matrix`, which is positive semi-definite; pivots of zero give columns of zeros.
pub(super) fn semidefinite_factor<const N: usize>(matrix: &Covariance<N>) -> Covariance<N> {
    let mut rest = *matrix;
    let mut factor = Covariance::<N>::zeros();
    for i in 0..N {
        let pivot = rest[(i, i)];
        // What rounding leaves of a variance that the components before explain whole.
        if pivot <= f64::EPSILON * N as f64 * matrix[(i, i)] {
            continue;
        }
        let column = rest.column(i) / pivot.sqrt();
        for row in i..N {
            factor[(row, i)] = column[row];
        }
        rest -= column * column.transpose();
    }
    factor
}

fn squared_length<const N: usize>(factor: &Cholesky<f64, Const<N>>, deviation: &State<N>) -> f64 {
    deviation.dot(&factor.solve(deviation))
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, Vector2};
    use proptest::prelude::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::*;

    #[test]
    fn bad_covariances_are_told_apart_and_say_what_to_do() {
        let mean = Vector2::zeros();
        let skew = Gaussian::new(mean, Matrix2::new(1.0, 0.5, 0.2, 1.0)).unwrap_err();
        assert_eq!(skew, FilterError::NotSymmetric { what: "the covariance", row: 1, column: 0 });
        let indefinite = Gaussian::new(mean, Matrix2::new(1.0, 2.0, 2.0, 1.0)).unwrap_err();
        assert_eq!(indefinite, FilterError::Indefinite { what: "the covariance" });
        assert!(indefinite.to_string().contains("correlations within"), "{indefinite}");
        let nan = GaussianNoise::new(Matrix2::new(f64::NAN, 0.0, 0.0, 1.0)).unwrap_err();
        assert_eq!(nan, FilterError::NotFinite { what: "the noise covariance" });
        assert!(GaussianNoise::diagonal(&Vector2::new(1.0, -1e-3)).is_err());
    }

    #[test]
    fn singular_covariances_are_fine_as_noise_and_as_a_belief_but_have_no_nees() {
        let known = Gaussian::new(Vector2::zeros(), Matrix2::zeros()).unwrap();
        assert!(known.nees(&Vector2::zeros()).is_err());
        assert_eq!(GaussianNoise::<2>::new(Matrix2::zeros()).unwrap().factor(), &Matrix2::zeros());
        let line = GaussianNoise::new(Matrix2::new(4.0, 2.0, 2.0, 1.0)).unwrap();
        assert_eq!(line.factor(), &Matrix2::new(2.0, 0.0, 1.0, 0.0));
        let on_it = line.log_density(&Vector2::new(2.0, 1.0));
        let standard = -0.5 - 0.5 * std::f64::consts::TAU.ln();
        assert!((on_it - (standard - 2.0f64.ln())).abs() < 1e-14);
        assert_eq!(line.log_density(&Vector2::new(2.0, 1.1)), f64::NEG_INFINITY);
    }

    #[test]
    fn nees_is_the_squared_mahalanobis_distance() {
        let belief = Gaussian::new(Vector2::new(1.0, 0.0), Matrix2::new(4.0, 0.0, 0.0, 0.25)).unwrap();
        assert!((belief.nees(&Vector2::new(3.0, 1.0)).unwrap() - 5.0).abs() < 1e-14);
    }

    #[test]
    fn draws_have_the_covariance() {
        let covariance = Matrix2::new(2.0, -0.6, -0.6, 0.5);
        let noise = GaussianNoise::new(covariance).unwrap();
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let n = 100_000;
        let sum = (0..n).fold(Matrix2::zeros(), |sum, _| {
            let draw = noise.sample(&mut rng);
            sum + draw * draw.transpose()
        });
        assert!((sum / f64::from(n) - covariance).amax() < 0.03);
    }

    proptest! {
        #[test]
        fn a_factor_squared_is_the_matrix_also_if_that_is_singular(
            entries in prop::array::uniform9(-3.0..3.0f64), rank in 0..=3usize,
        ) {
            let mut root = nalgebra::Matrix3::from_row_slice(&entries);
            (rank..3).for_each(|column| root.column_mut(column).fill(0.0));
            let matrix = symmetric(&(root * root.transpose()));
            let factor = semidefinite_factor(&matrix);
            prop_assert!((factor * factor.transpose() - matrix).amax() <= 1e-6 * (1.0 + matrix.amax()));
            prop_assert!(check_covariance(&matrix, "it").is_ok());
        }
    }
}
