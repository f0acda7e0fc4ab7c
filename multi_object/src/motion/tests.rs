//! The filters against each other and against exact paths.

use infopart::bayes::{State, model::Dynamics};

use super::{
    CentreModel, CentreNoise, ConstantTurn, ConstantVelocity, FilterKind, FilterOptions, MotionModel,
    StateFilter,
};

/// The centres of an object that walks, stops, turns and runs, with a gap.
fn path() -> Vec<Option<State<2>>> {
    (0..60)
        .map(|frame| {
            let t = f64::from(frame);
            let wobble = (t * 12.9898).sin() * 3.0;
            let along = if frame < 20 { 4.0 * t } else { 80.0 + 60.0 * ((t - 20.0) / 15.0).sin() };
            let seen = !(30..34).contains(&frame);
            seen.then(|| State::from([100.0 + along + wobble, 50.0 + 0.05 * t * t - wobble]))
        })
        .collect()
}

/// The estimates before and after each measurement.
fn estimates<D: CentreModel<N> + MotionModel<N, 2>, const N: usize>(kind: FilterKind) -> Vec<State<N>> {
    let model = D::under(CentreNoise::ATRIUM).unwrap();
    let belief = D::first_belief((100.0, 50.0), CentreNoise::ATRIUM).unwrap();
    let mut filter = StateFilter::new(kind, model, belief, FilterOptions::default()).unwrap();
    let mut estimates = Vec::new();
    for seen in path() {
        filter.predict().unwrap();
        estimates.push(filter.belief().mean);
        if let Some(seen) = seen {
            filter.update(&seen).unwrap();
            estimates.push(filter.belief().mean);
        }
    }
    estimates
}

fn greatest_gap<const N: usize>(a: &[State<N>], b: &[State<N>]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max)
}

#[test]
fn under_constant_velocity_the_three_kalman_filters_are_one() {
    let linear = estimates::<ConstantVelocity, 4>(FilterKind::Kalman);
    for other in [FilterKind::Ekf, FilterKind::Ukf] {
        let gap = greatest_gap(&linear, &estimates::<ConstantVelocity, 4>(other));
        assert!(gap < 1e-6, "{other:?}: {gap}");
    }
    // Particles come near, but are not the same.
    let particles = greatest_gap(&linear, &estimates::<ConstantVelocity, 4>(FilterKind::Pf));
    assert!(particles > 1e-3 && particles < 60.0, "{particles}");
}

#[test]
fn under_constant_turn_they_are_not() {
    let [ekf, ukf, pf] = [FilterKind::Ekf, FilterKind::Ukf, FilterKind::Pf].map(estimates::<ConstantTurn, 5>);
    assert!(greatest_gap(&ekf, &ukf) > 1e-3);
    assert!(greatest_gap(&ekf, &pf) > 1e-3);
}

#[test]
fn a_turn_runs_on_its_circle_and_without_turn_it_is_a_line() {
    let model = ConstantTurn::under(CentreNoise::ATRIUM).unwrap();
    // A quarter circle of radius 10 about (0, 10), in ten steps from the origin.
    let turn = std::f64::consts::FRAC_PI_2 / 10.0;
    let mut state = State::from([0.0, 0.0, 10.0 * turn, 0.0, turn]);
    for _ in 0..10 {
        state = model.propagate(&state);
    }
    assert!((state[0] - 10.0).abs() < 1e-12 && (state[1] - 10.0).abs() < 1e-12, "{state}");
    let straight = model.propagate(&State::from([1.0, 2.0, 5.0, 0.6435011087932844, 0.0]));
    assert!((straight[0] - 5.0).abs() < 1e-12 && (straight[1] - 5.0).abs() < 1e-12, "{straight}");
    let nearly = model.propagate(&State::from([1.0, 2.0, 5.0, 0.6435011087932844, 2e-6]));
    assert!((straight - nearly).amax() < 1e-4);
}

#[test]
fn the_same_seed_gives_the_same_bits_and_tracks_have_draws_of_their_own() {
    let run = || estimates::<ConstantTurn, 5>(FilterKind::Pf);
    assert_eq!(run(), run());
    let options = FilterOptions::default();
    assert_ne!(options.for_track(1).seed, options.for_track(2).seed);
}

#[test]
fn the_cost_of_an_assignment_is_a_distance_and_the_logarithm_of_its_spread() {
    let belief = ConstantVelocity::first_belief((0.0, 0.0), CentreNoise::ATRIUM).unwrap();
    let model = ConstantVelocity::under(CentreNoise::ATRIUM).unwrap();
    let filter = StateFilter::new(FilterKind::Kalman, model, belief, FilterOptions::default()).unwrap();
    // S = (200 + 100) I.
    let cost = filter.assignment_cost(&State::from([30.0, 0.0]));
    assert!((cost - (900.0 / 300.0 + 2.0 * 300.0f64.ln())).abs() < 1e-12, "{cost}");
    assert_eq!(filter.assignment_cost(&State::from([f64::NAN, 0.0])), f64::INFINITY);
}
