//! A lattice of cells over a box of the frame: means of oriented gradients and colours, read from integral images between
//! whose entries it interpolates. What lies outside their region is nothing.

use crate::{
    features::blocks::{BlockIntegrals, LANES},
    geometry::Rect,
};

/// Scratch for reading a lattice of a number of columns and rows.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Lattice {
    columns: Vec<Line>,
    rows: Vec<Line>,
    corners: [Vec<[f64; LANES]>; 2],
}

/// A line of the lattice between two of the integral images'.
#[derive(Debug, Clone, Copy, Default)]
#[cfg_attr(feature = "save", derive(serde::Serialize, serde::Deserialize))]
struct Line {
    before: usize,
    after: usize,
    share: f64,
}

impl Line {
    fn at(&self) -> f64 {
        self.before as f64 + self.share
    }
}

impl Lattice {
    /// A lattice of `columns` x `rows` cells, >= 1 each.
    pub fn new(columns: usize, rows: usize) -> Self {
        Self {
            columns: vec![Line::default(); columns + 1],
            rows: vec![Line::default(); rows + 1],
            corners: [vec![[0.0; LANES]; columns + 1], vec![[0.0; LANES]; columns + 1]],
        }
    }

    /// Hands each cell of the lattice over `target`, a box of the frame, to `take`: its number, row by row, and its means a
    /// pixel of the region, gradients by orientation and then the colours.
    pub fn read(
        &mut self,
        integrals: &BlockIntegrals,
        target: Rect,
        mut take: impl FnMut(usize, &[f32; LANES]),
    ) {
        self.set_lines(integrals, target);
        let Self { columns, rows, corners: [above, below] } = self;
        let per_cell = 1.0 / (integrals.block() * integrals.block()) as f64;
        load_corners(integrals, rows[0], columns, above);
        let mut cell = 0;
        for lines in rows.windows(2) {
            load_corners(integrals, lines[1], columns, below);
            let height = lines[1].at() - lines[0].at();
            for (column, lines) in columns.windows(2).enumerate() {
                let area = height * (lines[1].at() - lines[0].at());
                let per_area = if area > 1e-6 { per_cell / area } else { 0.0 };
                let (a, b) = (&above[column], &above[column + 1]);
                let (c, d) = (&below[column], &below[column + 1]);
                take(cell, &std::array::from_fn(|k| ((d[k] - c[k] - b[k] + a[k]) * per_area) as f32));
                cell += 1;
            }
            std::mem::swap(above, below);
        }
    }

    fn set_lines(&mut self, integrals: &BlockIntegrals, target: Rect) {
        let region = integrals.region();
        let per_pixel = 1.0 / (region.step * integrals.block()) as f64;
        let set = |lines: &mut [Line], from: f64, length: f64, blocks: usize| {
            let last = (lines.len() - 1) as f64;
            for (i, line) in lines.iter_mut().enumerate() {
                let at = ((from + length * (i as f64 / last)) * per_pixel).clamp(0.0, blocks as f64);
                let before = (at as usize).min(blocks);
                *line = Line { before, after: (before + 1).min(blocks), share: at - before as f64 };
            }
        };
        let (columns, rows) = integrals.size();
        set(&mut self.columns, target.x - region.x as f64, target.w, columns);
        set(&mut self.rows, target.y - region.y as f64, target.h, rows);
    }
}

fn load_corners(integrals: &BlockIntegrals, row: Line, columns: &[Line], corners: &mut [[f64; LANES]]) {
    for (column, out) in columns.iter().zip(corners) {
        let nearest = [
            (row.before, column.before, (1.0 - row.share) * (1.0 - column.share)),
            (row.before, column.after, (1.0 - row.share) * column.share),
            (row.after, column.before, row.share * (1.0 - column.share)),
            (row.after, column.after, row.share * column.share),
        ];
        *out = [0.0; LANES];
        for (row, column, weight) in nearest {
            for (out, value) in out.iter_mut().zip(integrals.entry(row, column)) {
                *out += weight * f64::from(*value);
            }
        }
    }
}
