//! Who belongs to whom: the pairing of rows and columns with the least total cost.
//!
//! The method of shortest augmenting paths (Jonker and Volgenant 1987, without its starting heuristics; the Hungarian method in
//! O(r² c) for r <= c), which keeps a price of each row and column so that no pair costs less than its two prices, and
//! pairs that are chosen cost exactly that:
//!
//! 1. Take the next row and reach out from it: the cost of a column is what is left of the pair's cost after the prices.
//! 2. Go to the cheapest column not yet reached. If it is taken, go on from the row that has it; if not, stop.
//! 3. Raise the prices by what it took to get there.
//! 4. Walk back along the path, giving each column on it to the row that it was reached from.

use crate::grid::Grid;

/// Finds pairings of least total cost. It keeps its memory from one call to the next.
#[derive(Debug, Clone, Default)]
pub struct Assigner {
    /// The costs of the rows that are fewer than the columns.
    transposed: Grid,
    row_price: Vec<f64>,
    column_price: Vec<f64>,
    /// The row that has each column.
    row_of: Vec<Option<usize>>,
    /// What it costs to reach each column from the row at hand.
    distance: Vec<f64>,
    /// The column before each column on the way; `None` if it is reached from the row at hand.
    before: Vec<Option<usize>>,
    reached: Vec<bool>,
    pairs: Vec<(usize, usize)>,
}

impl Assigner {
    /// The pairs (row, column) that cost least together, by rows: as many as the shorter side has, no row or column
    /// twice. Costs must be finite.
    pub fn solve(&mut self, costs: &Grid) -> &[(usize, usize)] {
        let mut transposed = std::mem::take(&mut self.transposed);
        self.pairs.clear();
        if costs.rows() <= costs.columns() {
            self.run(costs);
            self.pairs.extend(taken(&self.row_of));
        } else {
            transposed.fill(costs.columns(), costs.rows(), |row, column| costs.at(column, row));
            self.run(&transposed);
            self.pairs.extend(taken(&self.row_of).map(|(row, column)| (column, row)));
        }
        self.transposed = transposed;
        self.pairs.sort_unstable();
        &self.pairs
    }

    /// The pairs that cost least together when every row and column left alone costs `unassigned`: a pair is only made
    /// where it costs less than two left alone. Costs must not be NaN; infinity means never.
    pub fn solve_with_unassigned(&mut self, costs: &Grid, unassigned: f64) -> &[(usize, usize)] {
        let gain = |row, column| (costs.at(row, column) - 2.0 * unassigned).min(0.0);
        let gains = Grid::from_fn(costs.rows(), costs.columns(), gain);
        self.solve(&gains);
        self.pairs.retain(|&(row, column)| gains.at(row, column) < 0.0);
        &self.pairs
    }

    fn run(&mut self, costs: &Grid) {
        self.row_price.clear();
        self.row_price.resize(costs.rows(), 0.0);
        self.column_price.clear();
        self.column_price.resize(costs.columns(), 0.0);
        self.row_of.clear();
        self.row_of.resize(costs.columns(), None);
        for row in 0..costs.rows() {
            let free = self.shortest_path(costs, row);
            self.walk_back(free, row);
        }
    }

    /// Steps 1 to 3; gives the free column that the path ends in.
    fn shortest_path(&mut self, costs: &Grid, start: usize) -> usize {
        self.distance.clear();
        self.distance.resize(costs.columns(), f64::INFINITY);
        self.before.clear();
        self.before.resize(costs.columns(), None);
        self.reached.clear();
        self.reached.resize(costs.columns(), false);
        let (mut row, mut column_of_row, mut length) = (start, None, 0.0);
        loop {
            let mut nearest: Option<usize> = None;
            for column in (0..costs.columns()).filter(|&column| !self.reached[column]) {
                let left = costs.at(row, column) - self.row_price[row] - self.column_price[column];
                if length + left < self.distance[column] {
                    self.distance[column] = length + left;
                    self.before[column] = column_of_row;
                }
                if nearest.is_none_or(|best| self.distance[column] < self.distance[best]) {
                    nearest = Some(column);
                }
            }
            // There are at least as many columns as rows, so that one is always left.
            let Some(column) = nearest else { unreachable!("a row without a column") };
            length = self.distance[column];
            self.reached[column] = true;
            match self.row_of[column] {
                Some(owner) => (row, column_of_row) = (owner, Some(column)),
                None => {
                    self.raise_prices(start, length);
                    return column;
                }
            }
        }
    }

    fn raise_prices(&mut self, start: usize, length: f64) {
        self.row_price[start] += length;
        for column in 0..self.reached.len() {
            if let Some(owner) = self.row_of[column].filter(|_| self.reached[column]) {
                self.row_price[owner] += length - self.distance[column];
                self.column_price[column] -= length - self.distance[column];
            }
        }
    }

    /// Step 4.
    fn walk_back(&mut self, free: usize, start: usize) {
        let mut column = free;
        while let Some(before) = self.before[column] {
            self.row_of[column] = self.row_of[before];
            column = before;
        }
        self.row_of[column] = Some(start);
    }
}

fn taken(row_of: &[Option<usize>]) -> impl Iterator<Item = (usize, usize)> {
    row_of.iter().enumerate().filter_map(|(column, row)| row.map(|row| (row, column)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn grid(rows: &[&[f64]]) -> Grid {
        Grid::from_fn(rows.len(), rows.first().map_or(0, |row| row.len()), |r, c| rows[r][c])
    }

    /// The least total over all ways to give each row of the shorter side a column of its own.
    fn brute_force(costs: &Grid, row: usize, used: &mut Vec<bool>, skips: usize) -> f64 {
        if row == costs.rows() {
            return 0.0;
        }
        let mut best = f64::INFINITY;
        if skips > 0 {
            best = brute_force(costs, row + 1, used, skips - 1);
        }
        for column in 0..costs.columns() {
            if !used[column] {
                used[column] = true;
                best = best.min(costs.at(row, column) + brute_force(costs, row + 1, used, skips));
                used[column] = false;
            }
        }
        best
    }

    #[test]
    fn the_best_total_wins_over_the_best_pair() {
        // The cheapest single pair (0, 0) would force 9 on the second row.
        let costs = grid(&[&[1.0, 2.0], &[2.0, 9.0]]);
        assert_eq!(Assigner::default().solve(&costs), [(0, 1), (1, 0)]);
    }

    #[test]
    fn the_longer_side_keeps_some_alone_and_nothing_pairs_with_nothing() {
        let tall = grid(&[&[5.0], &[3.0], &[4.0]]);
        assert_eq!(Assigner::default().solve(&tall), [(1, 0)]);
        assert_eq!(Assigner::default().solve(&Grid::default()), []);
        assert_eq!(Assigner::default().solve(&Grid::from_fn(0, 3, |_, _| 0.0)), []);
        assert_eq!(Assigner::default().solve(&Grid::from_fn(3, 0, |_, _| 0.0)), []);
    }

    #[test]
    fn a_pair_dearer_than_two_left_alone_is_not_made() {
        let costs = grid(&[&[39.0, f64::INFINITY], &[f64::INFINITY, 41.0]]);
        assert_eq!(Assigner::default().solve_with_unassigned(&costs, 20.0), [(0, 0)]);
        let all_dear = grid(&[&[50.0]]);
        assert_eq!(Assigner::default().solve_with_unassigned(&all_dear, 20.0), []);
    }

    proptest! {
        #[test]
        fn totals_equal_those_of_trying_everything(
            (rows, columns, values) in (0usize..6, 0usize..6).prop_flat_map(|(rows, columns)| {
                let values = prop::collection::vec(-10.0f64..10.0, rows * columns);
                (Just(rows), Just(columns), values)
            }),
            coarse in any::<bool>(),
        ) {
            // Coarse costs make ties.
            let value = |r: usize, c: usize| values[r * columns + c];
            let costs = Grid::from_fn(rows, columns, |r, c| if coarse { value(r, c).round() } else { value(r, c) });
            let mut assigner = Assigner::default();
            // Leftovers of an earlier call must not matter.
            assigner.solve(&Grid::from_fn(4, 5, |r, c| (r * c) as f64));
            let pairs = assigner.solve(&costs).to_vec();
            prop_assert_eq!(pairs.len(), rows.min(columns));
            for (index, &(row, column)) in pairs.iter().enumerate() {
                prop_assert!(pairs[..index].iter().all(|&(r, c)| r != row && c != column));
            }
            let total: f64 = pairs.iter().map(|&(row, column)| costs.at(row, column)).sum();
            let least = brute_force(&costs, 0, &mut vec![false; columns], rows.saturating_sub(columns));
            prop_assert!((total - least).abs() < 1e-9, "{} against {}", total, least);
        }
    }
}
