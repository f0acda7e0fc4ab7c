//! A plot as SVG, PNG and PDF.

use std::{fmt::Write as _, io::Cursor};

use image::{ImageFormat, RgbImage, imageops};
use plotters::prelude::*;

use super::{
    Appearance, Plot, PlotError,
    draw::{Canvas, Layer, Pen, layers, register_font},
    layout::{HEIGHT, Layout, WIDTH},
};

/// The library draws at whole pixels: SVG is drawn larger for tenths of a unit.
const SVG_SCALE: u32 = 10;
/// Points are the unit of a PDF.
const POINTS_AN_INCH: f32 = 72.0;
/// The PNG's pixels across unless a width is asked for, and an inch if one is.
const PNG_WIDTH: f64 = 1440.0;
const PNG_PIXELS_AN_INCH: f64 = 300.0;
/// Pixels that are drawn for each of the PNG's each way, for smooth edges.
const PNG_SAMPLES: u32 = 3;

impl Plot {
    /// The plot as one `<svg>` element, which is also a whole file.
    ///
    /// Each curve is a group of the classes `curve` and `sN`, N being its style's number, each row of the legend one
    /// of the classes `row` and `sN`, so that a page can restyle them.
    ///
    /// # Errors
    /// If a curve cannot be drawn.
    pub fn svg(&self) -> Result<String, PlotError> {
        self.svg_as(&Appearance::default())
    }

    /// The plot as [`svg`](Self::svg) gives it, with another look.
    ///
    /// # Errors
    /// If a curve cannot be drawn.
    pub fn svg_as(&self, appearance: &Appearance) -> Result<String, PlotError> {
        let layout = self.prepare(appearance)?;
        let title = escape(&self.title);
        let (width, height) = match appearance.width_points {
            None => (WIDTH.to_string(), HEIGHT.to_string()),
            Some(width) => (format!("{width}pt"), format!("{}pt", width * HEIGHT / WIDTH)),
        };
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{title}\">\n\
             <g transform=\"scale({})\">\n",
            1.0 / f64::from(SVG_SCALE)
        );
        for layer in layers(self, &layout) {
            let drawn = self.svg_layer(&layout, layer)?;
            if drawn.is_empty() {
                continue;
            }
            let attributes = self.svg_attributes(&layout, layer);
            let hit = hit_area(&layout, layer);
            let _ = writeln!(svg, "<g {attributes}>{hit}{drawn}</g>");
        }
        svg.push_str("</g>\n</svg>\n");
        Ok(svg)
    }

    /// The plot as a PNG file's bytes: 1440 pixels across, or 300 an inch of the width asked for.
    ///
    /// # Errors
    /// If a curve cannot be drawn.
    pub fn png(&self, appearance: &Appearance) -> Result<Vec<u8>, PlotError> {
        let layout = self.prepare(appearance)?;
        let across = appearance.width_points.map_or(PNG_WIDTH, |points| points / 72.0 * PNG_PIXELS_AN_INCH);
        let width = (across.round() as u32).max(1);
        let height = ((across * HEIGHT / WIDTH).round() as u32).max(1);
        let (drawn_width, drawn_height) = (width * PNG_SAMPLES, height * PNG_SAMPLES);
        let mut large = RgbImage::new(drawn_width, drawn_height);
        {
            let area =
                BitMapBackend::with_buffer(&mut large, (drawn_width, drawn_height)).into_drawing_area();
            let scale = f64::from(drawn_width) / WIDTH;
            let canvas = Canvas { area: &area, scale, cuts_dashes: true };
            layers(self, &layout).into_iter().try_for_each(|layer| canvas.layer(self, &layout, layer))?;
            area.present().map_err(|error| self.drawing_error(&error))?;
        }
        let picture = imageops::thumbnail(&large, width, height);
        let mut png = Cursor::new(Vec::new());
        picture
            .write_to(&mut png, ImageFormat::Png)
            .map_err(|source| PlotError::Png { plot: self.title.clone(), source })?;
        Ok(png.into_inner())
    }

    /// The plot as a PDF file's bytes, its font embedded: 540 points wide, or as wide as asked for.
    ///
    /// # Errors
    /// If a curve cannot be drawn.
    pub fn pdf(&self, appearance: &Appearance) -> Result<Vec<u8>, PlotError> {
        let width_points = Some(appearance.width_points.unwrap_or(super::USUAL_POINTS));
        let svg = self.svg_as(&Appearance { width_points, ..appearance.clone() })?;
        let mut options = svg2pdf::usvg::Options { dpi: POINTS_AN_INCH, ..svg2pdf::usvg::Options::default() };
        options.fontdb_mut().load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
        let tree =
            svg2pdf::usvg::Tree::from_str(&svg, &options).map_err(|error| self.drawing_error(&error))?;
        let page = svg2pdf::PageOptions { dpi: POINTS_AN_INCH };
        svg2pdf::to_pdf(&tree, svg2pdf::ConversionOptions::default(), page)
            .map_err(|error| self.drawing_error(&error))
    }

    fn prepare(&self, appearance: &Appearance) -> Result<Layout, PlotError> {
        self.check()?;
        register_font().map_err(|reason| self.drawing_error(&reason))?;
        Ok(self.layout(appearance))
    }

    /// A layer's elements, without the library's own `<svg>` around them.
    fn svg_layer(&self, layout: &Layout, layer: Layer) -> Result<String, PlotError> {
        let mut drawn = String::new();
        {
            let size = (WIDTH as u32 * SVG_SCALE, HEIGHT as u32 * SVG_SCALE);
            let area = SVGBackend::with_string(&mut drawn, size).into_drawing_area();
            let canvas = Canvas { area: &area, scale: f64::from(SVG_SCALE), cuts_dashes: false };
            canvas.layer(self, layout, layer)?;
            area.present().map_err(|error| self.drawing_error(&error))?;
        }
        let elements = drawn.lines().filter(|line| !line.starts_with("<svg") && !line.starts_with("</svg"));
        Ok(elements.map(|line| line.replace(" opacity=\"1\"", "").replace(" \"/>", "\"/>")).collect())
    }

    /// What tells a layer apart, and the dashes of its lines.
    fn svg_attributes(&self, layout: &Layout, layer: Layer) -> String {
        let dashes = |curve: usize| dash_array(&Pen::of(self, layout, curve));
        match layer {
            Layer::Background => "class=\"paper\"".into(),
            Layer::Grid => "class=\"grid\"".into(),
            Layer::Mark => "class=\"mark\"".into(),
            Layer::Axes => "class=\"axes\"".into(),
            Layer::LegendBox => "class=\"legend\"".into(),
            Layer::Curve(curve) => {
                let style = self.curves[curve].style;
                format!("class=\"curve s{style}\" stroke-linejoin=\"round\"{}", dashes(curve))
            }
            Layer::LegendRow { curve, .. } => {
                let style = self.curves[curve].style;
                format!("class=\"row s{style}\"{}", dashes(curve))
            }
        }
    }

    fn drawing_error(&self, reason: &dyn std::fmt::Display) -> PlotError {
        PlotError::Drawing { plot: self.title.clone(), reason: reason.to_string() }
    }
}

fn dash_array(pen: &Pen) -> String {
    let dashes: Vec<String> =
        pen.dashes.iter().map(|dash| (dash * f64::from(SVG_SCALE)).to_string()).collect();
    if dashes.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{}\"", dashes.join(" ")) }
}

/// An invisible rectangle under a row of the legend, so that a pointer finds all of the row.
fn hit_area(layout: &Layout, layer: Layer) -> String {
    let (Layer::LegendRow { rank, .. }, Some(legend)) = (layer, layout.legend) else { return String::new() };
    let scaled = |v: f64| (v * f64::from(SVG_SCALE)).round();
    let (_, _, _, middle) = legend.row(rank);
    let half = legend.half_row();
    format!(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" pointer-events=\"all\"/>",
        scaled(legend.place.left),
        scaled(middle - half),
        scaled(legend.place.right - legend.place.left),
        scaled(2.0 * half)
    )
}

/// A text as the content or an attribute's value of XML or HTML.
pub(crate) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            other => escaped.push(other),
        }
    }
    escaped
}
