//! What the cues that look over a window share: cells of gradients and colours, and which pixels are likely the target's own.
//!
//! Steps, each frame:
//! 1. integral images of blocks over the window around where the target was,
//! 2. the foreground probability over it, by colour,
//! 3. the window's cells, the foreground probability being one number of each, and the spectra of their planes.
//! 4. before learning, once the foreground model has learnt: steps 2 and 3 around where the target is, and which cells are its
//!    own.

use crate::{
    correlation::{
        grid::{CHANNELS, Grid},
        spectrum::PlaneSpectra,
        window::Window,
    },
    features::{
        blocks::BlockIntegrals,
        foreground::{ForegroundMap, ForegroundModel},
        region::SearchRegion,
    },
    frame::FrameView,
    geometry::Rect,
};

use super::parameters::Parameters;

/// Pixels along the side of a grid's cell from which on they are averaged, so that none is of more than this.
const PIXELS_PER_CELL: f64 = 10.0;
/// Entries that the integral images have along a grid's cell at least, where it has as many pixels.
const BLOCKS_PER_CELL: f64 = 3.0;
/// Side of the foreground map over that of the window: particles leave the window's middle, and boxes have rings.
const MAP_SCALE: f64 = 1.1;
/// The prior probability that the middle of the box is the target's own, and how it falls towards the corners.
const PRIOR: (f32, f32) = (0.9, 2.5);
const PRIOR_RANGE: (f32, f32) = (0.05, 0.9);
/// Below the first posterior a cell is not the target's own, from the second on it is.
const OWN: (f32, f32) = (0.3, 0.7);
/// What is left to a filter of a cell that is not the target's own.
const NOT_OWN: f32 = 0.2;
/// Cells are told apart where that share of the box's area is the target's own and the colours differ by so much.
const LEAST_OWN: f32 = 0.25;
const LEAST_SEPARATION: f32 = 0.15;

/// A window around the target, as the cues see it.
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct WindowView {
    #[cfg_attr(feature = "save", serde(skip))]
    integrals: BlockIntegrals,
    grid: Grid,
    spectra: PlaneSpectra,
    window: Window,
    /// Window side / sqrt(area of the whole box).
    scale: f64,
    foreground_model: ForegroundModel,
    foreground: ForegroundMap,
    /// The foreground probability of each cell.
    probabilities: Vec<f32>,
    /// How much of each cell a filter may learn.
    own: Vec<f32>,
}

impl WindowView {
    /// A view for a target with that whole box; it has seen nothing yet.
    pub fn new(parameters: &Parameters, full: Rect) -> Self {
        let side = Self::cells(parameters);
        Self {
            integrals: BlockIntegrals::default(),
            grid: Grid::new(side),
            spectra: PlaneSpectra::new(side, CHANNELS),
            window: Window::around(&full, parameters.correlation_window),
            scale: parameters.correlation_window,
            foreground_model: ForegroundModel::new(parameters.colour_rate as f32),
            foreground: ForegroundMap::default(),
            probabilities: vec![0.5; side * side],
            own: vec![1.0; side * side],
        }
    }

    /// Cells along the window's side that the parameters ask for.
    pub fn cells(parameters: &Parameters) -> usize {
        2 * parameters.correlation_cells.div_ceil(2)
    }

    /// Steps 1 to 3, around a whole box.
    pub fn see(&mut self, frame: &FrameView<'_>, full: Rect) {
        self.window = Window::around(&full, self.scale);
        let cell = self.window.side / self.grid.side() as f64;
        let step = (cell / PIXELS_PER_CELL).ceil().max(1.0);
        let block = (cell / step / BLOCKS_PER_CELL).floor().max(1.0) as usize;
        self.integrals.compute(frame, SearchRegion::around(self.window.to_rect(), step as usize), block);
        self.describe(frame);
    }

    /// Step 4: learns the colours of that whole box in the frame last seen, and turns to it. What its window has outside that of
    /// the last look counts as flat.
    pub fn learn(&mut self, frame: &FrameView<'_>, full: Rect) {
        self.window = Window::around(&full, self.scale);
        self.foreground_model.learn(frame, full);
        self.describe(frame);
        self.find_own_cells(&full);
    }

    /// Steps 2 and 3.
    fn describe(&mut self, frame: &FrameView<'_>) {
        let Window { x, y, side } = self.window;
        let map = MAP_SCALE * side;
        self.foreground.compute(
            &self.foreground_model,
            frame,
            Rect::new(x - map / 2.0, y - map / 2.0, map, map),
        );
        for (cell, probability) in self.probabilities.iter_mut().enumerate() {
            *probability = self.foreground.mean(cell_of(self.window, self.grid.side(), cell)).unwrap_or(0.5);
        }
        self.grid.describe(&self.integrals, self.window, &self.probabilities);
        self.spectra.compute(self.grid.planes());
    }

    /// The end of step 4: the posterior of each cell from its colours and a prior that is highest in the box's middle.
    fn find_own_cells(&mut self, full: &Rect) {
        let side = self.grid.side();
        let (x, y) = full.centre();
        for (cell, (own, probability)) in self.own.iter_mut().zip(&self.probabilities).enumerate() {
            let (cell_x, cell_y) = cell_of(self.window, side, cell).centre();
            let (u, v) = (2.0 * (cell_x - x) / full.w, 2.0 * (cell_y - y) / full.h);
            let prior = PRIOR.0 * (1.0 - (u * u + v * v) as f32 / PRIOR.1);
            let prior = prior.clamp(PRIOR_RANGE.0, PRIOR_RANGE.1);
            let colour = probability.clamp(0.01, 0.99);
            let both = colour * prior;
            let posterior = both / (both + (1.0 - colour) * (1.0 - prior));
            *own = ((posterior - OWN.0) / (OWN.1 - OWN.0)).clamp(0.0, 1.0);
        }
        let cell_area = (self.window.side / side as f64).powi(2);
        let share = self.own.iter().sum::<f32>() * (cell_area / full.area()) as f32;
        if share < LEAST_OWN || self.foreground_model.separation() < LEAST_SEPARATION {
            self.own.fill(1.0);
        } else {
            self.own.iter_mut().for_each(|own| *own = NOT_OWN + (1.0 - NOT_OWN) * *own);
        }
    }

    /// Cells along the window's side.
    pub fn side(&self) -> usize {
        self.grid.side()
    }

    /// Where the view looks.
    pub fn window(&self) -> Window {
        self.window
    }

    /// The spectra of the window's cells, a plane a channel.
    pub fn spectra(&self) -> &PlaneSpectra {
        &self.spectra
    }

    /// How much of each of the window's cells is the target's own, in [0, 1].
    pub fn own_cells(&self) -> &[f32] {
        &self.own
    }

    /// Sums over blocks of the frame last seen.
    pub fn integrals(&self) -> &BlockIntegrals {
        &self.integrals
    }

    /// The colours of the target and of what surrounds it.
    pub fn foreground_model(&self) -> &ForegroundModel {
        &self.foreground_model
    }

    /// Foreground probabilities over the window and a little more.
    pub fn foreground(&self) -> &ForegroundMap {
        &self.foreground
    }
}

/// A cell of a window of `side` x `side` cells, by its number, as a box of the frame.
fn cell_of(window: Window, side: usize, cell: usize) -> Rect {
    let length = window.side / side as f64;
    let Rect { x, y, .. } = window.to_rect();
    Rect::new(x + (cell % side) as f64 * length, y + (cell / side) as f64 * length, length, length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Frame, PixelFormat};

    const FULL: Rect = Rect { x: 60.0, y: 40.0, w: 40.0, h: 80.0 };

    /// A figure in the left half of the box, before a background of another colour or of its own.
    fn learnt(figure: [u8; 3], background: [u8; 3]) -> WindowView {
        let is_figure = |x: usize, y: usize| (60..84).contains(&x) && (40..120).contains(&y);
        let pixels =
            (0..160 * 160).flat_map(|i| if is_figure(i % 160, i / 160) { figure } else { background });
        let frame = Frame::new(pixels.collect(), 160, 160, PixelFormat::Rgb).unwrap();
        let mut view = WindowView::new(&Parameters::default(), FULL);
        view.see(&frame.view(), FULL);
        view.learn(&frame.view(), FULL);
        view
    }

    fn own_at(view: &WindowView, x: f64, y: f64) -> f32 {
        let inside = |cell: &Rect| x >= cell.x && x < cell.right() && y >= cell.y && y < cell.bottom();
        let side = view.side();
        let cell = (0..side * side).find(|&cell| inside(&cell_of(view.window(), side, cell))).unwrap();
        view.own_cells()[cell]
    }

    #[test]
    fn cells_of_the_backgrounds_colour_are_not_the_targets_own_even_inside_the_box() {
        let view = learnt([200, 30, 30], [30, 60, 200]);
        assert_eq!(own_at(&view, 76.0, 80.0), 1.0);
        for (x, y) in [(98.0, 44.0), (30.0, 80.0), (76.0, 20.0)] {
            assert!((own_at(&view, x, y) - NOT_OWN).abs() < 1e-6, "{x} {y}: {}", own_at(&view, x, y));
        }
    }

    #[test]
    fn where_the_colours_tell_nothing_apart_every_cell_is_its_own() {
        assert!(learnt([90, 90, 90], [90, 90, 90]).own_cells().iter().all(|own| *own == 1.0));
    }
}
