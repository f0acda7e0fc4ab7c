//! Draws a plot in layers, on any backend.
//!
//! 1. Background, grid and the mark of the threshold that scores are read at.
//! 2. Curves, the best ranked last, so that it lies on top, or the highlighted one.
//! 3. Axes, title and labels.
//! 4. The legend, a row a curve.

use std::sync::OnceLock;

use plotters::{
    coord::Shift,
    prelude::*,
    style::text_anchor::{HPos, Pos, VPos},
};

use super::{
    Plot, PlotError, Style,
    layout::{HEIGHT, Layout, WIDTH, ticks},
    style::{FONTS, HIGHLIGHT, Rgb, cut, grey},
};

const WHITE_PAPER: Rgb = (0xff, 0xff, 0xff);
const GRID: Rgb = (0xe3, 0xe3, 0xe3);
const MARK: Rgb = (0x99, 0x99, 0x99);
const INK: Rgb = (0x22, 0x22, 0x22);

const CURVE_WIDTH: f64 = 2.6;
const HIGHLIGHTED_WIDTH: f64 = 4.2;
/// The library takes a height of letters that is this much more than the size that SVG calls for.
const LETTERS_PER_SIZE: f64 = 1.24;

/// A part of a plot that can be told apart in an SVG.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Layer {
    Background,
    Grid,
    Mark,
    Curve(usize),
    Axes,
    LegendBox,
    LegendRow { rank: usize, curve: usize },
}

/// All layers of a plot, the lowest first.
pub(super) fn layers(plot: &Plot, layout: &Layout) -> Vec<Layer> {
    let ranking = plot.ranking();
    let mut layers = vec![Layer::Background, Layer::Grid, Layer::Mark];
    let is_in_front = |curve: usize| layout.highlight == Some(curve);
    layers
        .extend(ranking.iter().rev().filter(|curve| !is_in_front(**curve)).map(|&curve| Layer::Curve(curve)));
    layers.extend(layout.highlight.map(Layer::Curve));
    layers.push(Layer::Axes);
    if layout.legend.is_some() {
        layers.push(Layer::LegendBox);
        layers.extend(ranking.iter().enumerate().map(|(rank, &curve)| Layer::LegendRow { rank, curve }));
    }
    layers
}

/// Makes the font known to the drawing library, once.
pub(super) fn register_font() -> Result<(), &'static str> {
    static REGISTERED: OnceLock<bool> = OnceLock::new();
    let font = epaint_default_fonts::UBUNTU_LIGHT;
    let done =
        REGISTERED.get_or_init(|| plotters::style::register_font(FONTS, FontStyle::Normal, font).is_ok());
    if *done { Ok(()) } else { Err("the built-in font cannot be read") }
}

/// A backend's area with the plot's own units.
pub(super) struct Canvas<'a, B: DrawingBackend> {
    /// What is drawn on.
    pub(super) area: &'a DrawingArea<B, Shift>,
    /// The backend's pixels a unit.
    pub(super) scale: f64,
    /// Whether to cut lines into their dashes here, or to leave that to whoever shows them.
    pub(super) cuts_dashes: bool,
}

type Point = (f64, f64);

/// How a curve is drawn.
pub(super) struct Pen {
    colour: Rgb,
    width: f64,
    /// Lengths of dash, gap, dash, ...; none for a solid line.
    pub(super) dashes: &'static [f64],
}

impl Pen {
    /// In the tracker's own style; where one is highlighted, that one alone in colour.
    pub(super) fn of(plot: &Plot, layout: &Layout, curve: usize) -> Self {
        let style = Style::of(plot.curves[curve].style);
        match layout.highlight {
            None => Self { colour: style.on_light(), width: CURVE_WIDTH, dashes: style.dashes() },
            Some(highlighted) if highlighted == curve => {
                Self { colour: HIGHLIGHT, width: HIGHLIGHTED_WIDTH, dashes: &[] }
            }
            Some(_) => {
                let rank = plot.ranking().iter().position(|one| *one == curve).unwrap_or_default();
                Self { colour: grey(rank, plot.curves.len()), width: CURVE_WIDTH, dashes: style.dashes() }
            }
        }
    }
}

impl<B: DrawingBackend> Canvas<'_, B> {
    /// Draws one layer of a plot.
    pub(super) fn layer(&self, plot: &Plot, layout: &Layout, layer: Layer) -> Result<(), PlotError> {
        let drawn = match layer {
            Layer::Background => self.rectangle((0.0, 0.0), (WIDTH, HEIGHT), WHITE_PAPER, 1.0),
            Layer::Grid => self.grid(plot, layout),
            Layer::Mark => self.mark(plot, layout),
            Layer::Curve(curve) => {
                let points = plot.points(layout.area, &plot.curves[curve]);
                self.curve(&points, &Pen::of(plot, layout, curve))
            }
            Layer::Axes => self.axes(plot, layout),
            Layer::LegendBox => self.legend_box(layout),
            Layer::LegendRow { rank, curve } => self.legend_row(plot, layout, rank, curve),
        };
        drawn.map_err(|error| PlotError::Drawing { plot: plot.title.clone(), reason: error.to_string() })
    }

    fn grid(&self, plot: &Plot, layout: &Layout) -> Drawn<B> {
        let area = layout.area;
        for x in ticks(plot.x_max).0 {
            self.line(&[area.at(x / plot.x_max, 0.0), area.at(x / plot.x_max, 1.0)], GRID, 1.0)?;
        }
        for y in ticks(1.0).0 {
            self.line(&[area.at(0.0, y), area.at(1.0, y)], GRID, 1.0)?;
        }
        Ok(())
    }

    fn mark(&self, plot: &Plot, layout: &Layout) -> Drawn<B> {
        let area = layout.area;
        if let Some(mark) = plot.mark.map(|mark| mark / plot.x_max).filter(|mark| (0.0..=1.0).contains(mark))
        {
            for piece in cut(&[area.at(mark, 0.0), area.at(mark, 1.0)], &[2.0, 4.0]) {
                self.line(&piece, MARK, 1.5)?;
            }
        }
        Ok(())
    }

    fn curve(&self, points: &[Point], pen: &Pen) -> Drawn<B> {
        let dashes = if self.cuts_dashes { pen.dashes } else { &[] };
        cut(points, dashes).iter().try_for_each(|piece| self.line(piece, pen.colour, pen.width))
    }

    fn axes(&self, plot: &Plot, layout: &Layout) -> Drawn<B> {
        let area = layout.area;
        let (middle, centre) = ((area.left + area.right) / 2.0, (area.top + area.bottom) / 2.0);
        let corners = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)];
        self.line(&corners.map(|(x, y)| area.at(x, y)), INK, 1.0)?;
        let text = layout.text;
        let (marks, decimals) = ticks(plot.x_max);
        for x in marks {
            let (x_at, y_at) = area.at(x / plot.x_max, 0.0);
            let at = (x_at, y_at + 7.0 * text);
            self.text(&format!("{x:.decimals$}"), at, 13.0 * text, (HPos::Center, VPos::Top))?;
        }
        for y in ticks(1.0).0 {
            let (x_at, y_at) = area.at(0.0, y);
            self.text(
                &format!("{y:.1}"),
                (x_at - 7.0 * text, y_at),
                13.0 * text,
                (HPos::Right, VPos::Center),
            )?;
        }
        if layout.has_title {
            self.text(&plot.title, (middle, 12.0 * text), 19.0 * text, (HPos::Center, VPos::Top))?;
        }
        self.text(&plot.x_label, (middle, HEIGHT - 28.0 * text), 16.0 * text, (HPos::Center, VPos::Top))?;
        let upwards = self.style(16.0 * text, (HPos::Center, VPos::Top)).transform(FontTransform::Rotate270);
        self.area.draw_text(&plot.y_label, &upwards, self.pixel((12.0 * text, centre)))
    }

    fn legend_box(&self, layout: &Layout) -> Drawn<B> {
        let Some(legend) = layout.legend.filter(|legend| legend.inside) else { return Ok(()) };
        let place = legend.place;
        self.rectangle((place.left, place.top), (place.right, place.bottom), WHITE_PAPER, 0.9)?;
        let (left, right, top, bottom) = (place.left, place.right, place.top, place.bottom);
        self.line(&[(left, top), (right, top), (right, bottom), (left, bottom), (left, top)], GRID, 1.0)
    }

    fn legend_row(&self, plot: &Plot, layout: &Layout, rank: usize, curve: usize) -> Drawn<B> {
        let Some(legend) = layout.legend else { return Ok(()) };
        let (left, right, text, middle) = legend.row(rank);
        self.curve(&[(left, middle), (right, middle)], &Pen::of(plot, layout, curve))?;
        let size = legend.letters / LETTERS_PER_SIZE;
        self.text(&plot.curves[curve].legend(), (text, middle), size, (HPos::Left, VPos::Center))
    }

    fn line(&self, points: &[Point], colour: Rgb, width: f64) -> Drawn<B> {
        let points: Vec<(i32, i32)> = points.iter().map(|&point| self.pixel(point)).collect();
        let width = (width * self.scale).round() as u32;
        self.area.draw(&PathElement::new(points, rgb(colour).stroke_width(width)))
    }

    fn rectangle(&self, from: Point, to: Point, colour: Rgb, opacity: f64) -> Drawn<B> {
        self.area.draw(&Rectangle::new([self.pixel(from), self.pixel(to)], rgb(colour).mix(opacity).filled()))
    }

    fn text(&self, text: &str, at: Point, size: f64, anchor: (HPos, VPos)) -> Drawn<B> {
        // Pixels are centred with the room for descenders, SVG without it.
        let drop = if self.cuts_dashes && matches!(anchor.1, VPos::Center) { 0.12 * size } else { 0.0 };
        self.area.draw_text(text, &self.style(size, anchor), self.pixel((at.0, at.1 + drop)))
    }

    fn style(&self, size: f64, (across, down): (HPos, VPos)) -> TextStyle<'static> {
        let font = (FONTS, size * LETTERS_PER_SIZE * self.scale).into_font();
        TextStyle { color: rgb(INK).to_backend_color(), ..TextStyle::from(font).pos(Pos::new(across, down)) }
    }

    fn pixel(&self, (x, y): Point) -> (i32, i32) {
        ((x * self.scale).round() as i32, (y * self.scale).round() as i32)
    }
}

type Drawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

fn rgb((red, green, blue): Rgb) -> RGBColor {
    RGBColor(red, green, blue)
}
