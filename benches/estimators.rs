//! The state estimators on the Van der Pol oscillator: a whole run of 101 samples each.
//!
//! `cargo bench --bench estimators -- --quick` gives a first impression.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use infopart::{
    bayes::unscented::MeasuredPoints,
    experiments::van_der_pol::{Filter, MeasurementNoise, NoiseShape, Setup, truth},
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

fn runs(c: &mut Criterion) {
    let setup =
        Setup { mu: 1.0, process_variance: 1e-3, measurement_variance: 2e-3, noise: NoiseShape::Gauss };
    let noise = MeasurementNoise::new(setup.noise, setup.measurement_variance);
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let measured: Vec<f64> = truth(setup.mu).iter().map(|state| state[0] + noise.sample(&mut rng)).collect();
    for filter in [
        Filter::Extended,
        Filter::Unscented(MeasuredPoints::Redrawn),
        Filter::Unscented(MeasuredPoints::Reused),
        Filter::Particle(500),
        Filter::Particle(10_000),
    ] {
        c.bench_function(&format!("Van der Pol, 101 samples, {filter}"), |b| {
            b.iter(|| filter.track(&setup, black_box(&measured), 1, 0, 0));
        });
    }
}

criterion_group!(estimators, runs);
criterion_main!(estimators);
