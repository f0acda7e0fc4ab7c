//! A table of numbers, such as costs or overlaps.

/// A table of numbers, stored row by row.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Grid {
    values: Vec<f64>,
    columns: usize,
    rows: usize,
}

impl Grid {
    /// A table whose entry in row `r` and column `c` is `value(r, c)`.
    pub fn from_fn(rows: usize, columns: usize, value: impl FnMut(usize, usize) -> f64) -> Self {
        let mut grid = Self::default();
        grid.fill(rows, columns, value);
        grid
    }

    /// Makes this the table of `value`, in the memory that it has.
    pub fn fill(&mut self, rows: usize, columns: usize, mut value: impl FnMut(usize, usize) -> f64) {
        (self.rows, self.columns) = (rows, columns);
        self.values.clear();
        for row in 0..rows {
            self.values.extend((0..columns).map(|column| value(row, column)));
        }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The entry in `row` and `column`, both counted from 0.
    ///
    /// # Panics
    /// If there is no such entry.
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.row(row)[column]
    }

    /// The entry in `row` and `column`, to be changed.
    ///
    /// # Panics
    /// If there is no such entry.
    pub fn at_mut(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.values[row * self.columns..][..self.columns][column]
    }

    /// One row.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.columns..][..self.columns]
    }

    /// The sum of each row.
    pub fn row_sums(&self) -> Vec<f64> {
        (0..self.rows).map(|row| self.row(row).iter().sum()).collect()
    }

    /// The sum of each column.
    pub fn column_sums(&self) -> Vec<f64> {
        (0..self.columns).map(|column| (0..self.rows).map(|row| self.at(row, column)).sum()).collect()
    }
}
