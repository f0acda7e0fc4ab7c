use super::*;

const SIDE: usize = 16;

fn options() -> FilterOptions {
    FilterOptions { side: SIDE, label_sigma: 0.1, temporal: 30.0, rounds: 2, support: 1.2 }
}

fn window() -> Window {
    Window { x: 100.0, y: 60.0, side: 32.0 }
}

/// Planes of noise around zero, the same every time.
fn noise(channels: usize, seed: u32) -> Vec<f32> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32 - 0.5
    };
    (0..channels * SIDE * SIDE).map(|_| next()).collect()
}

/// The spectra of planes.
fn spectra(planes: &[f32]) -> PlaneSpectra {
    let mut spectra = PlaneSpectra::new(SIDE, planes.len() / (SIDE * SIDE));
    spectra.compute(planes);
    spectra
}

/// Planes moved around by whole cells.
fn rolled(planes: &[f32], right: usize, down: usize) -> Vec<f32> {
    let at = |i: usize| {
        let (plane, row, column) = (i / (SIDE * SIDE), i / SIDE % SIDE, i % SIDE);
        (plane * SIDE + (row + SIDE - down) % SIDE) * SIDE + (column + SIDE - right) % SIDE
    };
    (0..planes.len()).map(|i| planes[at(i)]).collect()
}

#[test]
fn what_was_learnt_answers_one_at_its_own_place() {
    let planes = noise(3, 1);
    let mut filter = CorrelationFilter::new(options(), 3, 0.3, 0.5);
    filter.learn(&spectra(&planes), None);
    let peak = filter.respond(&spectra(&planes), window()).peak();
    assert!((peak.value - 1.0).abs() < 0.02, "{peak:?}");
    assert!((peak.x - 100.0).abs() < 0.5 && (peak.y - 60.0).abs() < 0.5, "{peak:?}");
}

#[test]
fn the_peak_moves_as_the_target_does() {
    let planes = noise(3, 2);
    let mut filter = CorrelationFilter::new(options(), 3, 0.3, 0.5);
    filter.learn(&spectra(&planes), None);
    for (right, down) in [(3, 0), (0, 2), (SIDE - 4, SIDE - 1)] {
        let peak = filter.respond(&spectra(&rolled(&planes, right, down)), window()).peak();
        let signed = |cells: usize| if cells > SIDE / 2 { cells as f64 - SIDE as f64 } else { cells as f64 };
        // A cell is two pixels wide.
        assert!((peak.x - (100.0 + 2.0 * signed(right))).abs() < 0.5, "{right} {down} {peak:?}");
        assert!((peak.y - (60.0 + 2.0 * signed(down))).abs() < 0.5, "{right} {down} {peak:?}");
    }
}

#[test]
fn the_filter_vanishes_outside_the_target() {
    let mut filter = CorrelationFilter::new(options(), 2, 0.25, 0.25);
    filter.learn(&spectra(&noise(2, 3)), None);
    let mut image = vec![0.0; SIDE * SIDE];
    for channel in &filter.channels {
        filter.fourier.inverse(&channel.filter, &mut image, &mut filter.scratch);
        for (i, value) in image.iter().enumerate() {
            let (row, column) = (i / SIDE, i % SIDE);
            // 0.25 * 1.2 * 16 = 4.8 cells in the middle, and half a cell more.
            let inside = (5..=10).contains(&row) && (5..=10).contains(&column);
            assert!(inside || value.abs() < 1e-6, "{row} {column} {value}");
        }
        assert!(image.iter().any(|value| value.abs() > 1e-4));
    }
}

#[test]
fn cells_that_are_not_the_targets_own_hold_nothing_of_the_filter() {
    let own: Vec<f32> = (0..SIDE * SIDE).map(|i| if i % SIDE < SIDE / 2 { 0.0 } else { 1.0 }).collect();
    let mut filter = CorrelationFilter::new(options(), 2, 0.5, 0.5);
    filter.learn(&spectra(&noise(2, 3)), Some(&own));
    let mut image = vec![0.0; SIDE * SIDE];
    for channel in &filter.channels {
        filter.fourier.inverse(&channel.filter, &mut image, &mut filter.scratch);
        let half = |right: bool| {
            let cells = image.iter().enumerate().filter(move |(i, _)| (i % SIDE >= SIDE / 2) == right);
            cells.map(|(_, value)| value.abs()).fold(0.0, f32::max)
        };
        assert!(half(false) < 1e-6 && half(true) > 1e-4);
    }
}

/// With support everywhere and one round, f minimises the objective with the penalty rho ||f||^2: its gradient is zero.
#[test]
fn the_closed_form_solves_each_frequencys_linear_system() {
    let whole = FilterOptions { rounds: 1, support: 100.0, ..options() };
    let mut filter = CorrelationFilter::new(whole, 3, 1.0, 1.0);
    let planes = spectra(&noise(3, 4));
    filter.learn(&planes, None);
    let area = (SIDE * SIDE) as f32;
    for k in 0..filter.label.len() {
        let projected: Complex32 =
            filter.channels.iter().zip(planes.each()).map(|(channel, x)| x[k].conj() * channel.f[k]).sum();
        for (channel, x) in filter.channels.iter().zip(planes.each()) {
            let gradient = x[k] * (projected - filter.label[k].conj()) / area + channel.f[k] * RHO;
            assert!(gradient.norm() < 1e-3, "{k} {gradient}");
        }
    }
}

#[test]
fn a_stiffer_filter_stays_nearer_to_the_one_before() {
    let distance = |temporal: f32| {
        let mut filter = CorrelationFilter::new(FilterOptions { temporal, ..options() }, 2, 0.3, 0.5);
        filter.learn(&spectra(&noise(2, 5)), None);
        let before: Vec<Vec<Complex32>> =
            filter.channels.iter().map(|channel| channel.filter.clone()).collect();
        filter.learn(&spectra(&noise(2, 6)), None);
        let squared = |(channel, before): (&Channel, &Vec<Complex32>)| {
            channel.filter.iter().zip(before).map(|(a, b)| (a - b).norm_sqr()).sum::<f32>()
        };
        filter.channels.iter().zip(&before).map(squared).sum::<f32>()
    };
    assert!(distance(100.0) < 0.5 * distance(1.0));
}

#[test]
fn flat_planes_are_learnt_without_a_number_that_is_none() {
    let mut filter = CorrelationFilter::new(options(), 2, 0.3, 0.5);
    let flat = vec![0.0; 2 * SIDE * SIDE];
    filter.learn(&spectra(&flat), None);
    assert!(filter.respond(&spectra(&flat), window()).values().iter().all(|value| value.is_finite()));
}
