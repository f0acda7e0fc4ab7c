//! Step 1: the tables of a [`Table`] of scores.

use super::{Cell, Column, Ranked, ScoreTable, Scored};
use crate::{
    catalogue::Attribute,
    scoring::{LongTermPoint, LongTermScores, Measure, Spread, Table, TrackerScores, against, certainty},
    statistics::Interval,
};

/// What the table over all sequences shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OverallOptions {
    /// The measures.
    pub measures: Vec<Measure>,
    /// Whether each score has its 95 % interval.
    pub intervals: bool,
    /// The tracker, by its place in the table, that all others are tested against, and in which measure.
    pub against: Option<(usize, Measure)>,
}

/// Trackers over all sequences, the best by the first measure first.
pub fn overall(table: &Table, options: &OverallOptions) -> ScoreTable {
    let measures = &options.measures;
    let intervals =
        if options.intervals { certainty(table) } else { vec![Default::default(); table.trackers.len()] };
    let tested = options.against.map(|(chosen, measure)| (chosen, measure, against(table, chosen, measure)));
    let mut columns =
        vec![column("tracker", "tracker"), column("seeds", "seeds"), column("sequences", "sequences")];
    columns.extend(measures.iter().map(|measure| column(measure.title(), measure.key())));
    columns.push(column("frames/s", "frames_per_second"));
    if let Some((chosen, measure, _)) = &tested {
        let name = &table.trackers[*chosen].tracker;
        columns.push(column(
            &format!("{} less that of {name}", measure.title()),
            &format!("{}_difference", measure.key()),
        ));
        columns.push(column("p", "p"));
        columns.push(column("p, Holm", "p_holm"));
    }
    let row = |place: usize| {
        let one = &table.trackers[place];
        let seeds = if one.seeds == [0] || one.seeds.is_empty() { None } else { Some(one.seeds.len()) };
        let mut cells =
            vec![Cell::Text(one.tracker.clone()), Cell::Count(seeds), Cell::Count(Some(one.scored))];
        cells.extend(measures.iter().map(|measure| {
            let interval = intervals[place][*measure as usize];
            Cell::Score(
                one.overall.and_then(|scores| measure.of(&scores)).map(|spread| scored(spread, interval)),
            )
        }));
        cells.push(Cell::Speed(one.frames_per_second));
        if let Some((_, _, tested)) = &tested {
            let against = tested[place].as_ref();
            cells.push(Cell::Difference(against.map(|one| Scored {
                value: one.comparison.difference,
                deviation: None,
                interval: Some(one.comparison.interval()),
            })));
            cells.push(Cell::Probability(against.map(|one| one.comparison.p_value)));
            cells.push(Cell::Probability(against.map(|one| one.corrected_p)));
        }
        cells
    };
    let rows = order(table, measures.first().copied().unwrap_or(Measure::Auc)).into_iter().map(row).collect();
    let title = format!(
        "{} on {} sequences, rules of {}",
        table.protocol.title(),
        table.sequences.len(),
        table.toolkit
    );
    ScoreTable { title, columns, rows, ranked: Ranked::Columns }
}

/// Trackers by attribute; `None` where the rules have no attributes, or no sequence is known to have one.
pub fn by_attribute(table: &Table, measure: Measure) -> Option<ScoreTable> {
    let source = table.attributes?;
    let order = order(table, Measure::Auc);
    let of = |one: &TrackerScores, attribute| {
        one.attributes.iter().find(|scores| scores.attribute == attribute).cloned()
    };
    let row = |attribute: Attribute| {
        let trackers = || order.iter().map(|place| &table.trackers[*place]);
        let sequences =
            trackers().filter_map(|one| of(one, attribute)).map(|scores| scores.sequences).max()?;
        let cells = trackers()
            .map(|one| Cell::Score(mean_of(of(one, attribute).and_then(|all| measure.of(&all.scores)))));
        Some(
            [Cell::Text(attribute.code().to_owned()), Cell::Count(Some(sequences))]
                .into_iter()
                .chain(cells)
                .collect(),
        )
    };
    let mut columns = vec![column("attribute", "attribute"), column("sequences", "sequences")];
    columns.extend(names(table, &order));
    let title = format!("{} by attribute, as {source} has them", measure.title());
    let rows: Vec<Vec<Cell>> = Attribute::ALL.into_iter().filter_map(row).collect();
    (!rows.is_empty()).then_some(ScoreTable { title, columns, rows, ranked: Ranked::Rows })
}

/// Trackers by sequence.
pub fn by_sequence(table: &Table, measure: Measure) -> ScoreTable {
    let order = order(table, Measure::Auc);
    let row = |(index, sequence): (usize, &String)| {
        let score =
            |place: &usize| table.trackers[*place].sequences[index].scores.and_then(|all| measure.of(&all));
        let cells = order.iter().map(|place| Cell::Score(mean_of(score(place))));
        [Cell::Text(sequence.clone())].into_iter().chain(cells).collect()
    };
    let columns = [column("sequence", "sequence")].into_iter().chain(names(table, &order)).collect();
    let rows = table.sequences.iter().enumerate().map(row).collect();
    ScoreTable { title: format!("{} by sequence", measure.title()), columns, rows, ranked: Ranked::Rows }
}

/// Long-term scores, the best F first.
pub fn long_term(scores: &[LongTermScores]) -> ScoreTable {
    let mut order: Vec<&LongTermScores> = scores.iter().collect();
    let f = |one: &LongTermScores| one.f.map_or(f64::NEG_INFINITY, |f| f.mean);
    order.sort_by(|a, b| f(b).total_cmp(&f(a)));
    let row = |one: &&LongTermScores| {
        let part = |of: fn(&LongTermPoint) -> f64| {
            Cell::Score(one.best.as_ref().map(|point| Scored {
                value: of(point),
                deviation: None,
                interval: None,
            }))
        };
        let threshold = one.best.filter(|_| one.has_confidence).map(|point| point.threshold);
        vec![
            Cell::Text(one.tracker.clone()),
            Cell::Count(Some(one.sequences.len())),
            Cell::Score(one.f.map(|spread| scored(spread, None))),
            part(|point| point.precision),
            part(|point| point.recall),
            Cell::Text(threshold.map_or_else(|| "-".to_owned(), |threshold| format!("{threshold:.4}"))),
        ]
    };
    let columns = vec![
        column("tracker", "tracker"),
        column("sequences", "sequences"),
        column("F", "f"),
        column("precision", "precision"),
        column("recall", "recall"),
        column("at confidence", "confidence"),
    ];
    let title = "Long term: the best F over confidence thresholds".to_owned();
    ScoreTable { title, columns, rows: order.iter().map(row).collect(), ranked: Ranked::Columns }
}

/// The best F of each sequence.
pub fn long_term_by_sequence(scores: &[LongTermScores]) -> ScoreTable {
    let mut sequences: Vec<&str> = Vec::new();
    for one in scores.iter().flat_map(|one| &one.sequences) {
        if !sequences.contains(&one.sequence.as_str()) {
            sequences.push(&one.sequence);
        }
    }
    let row = |sequence: &&str| {
        let f = |one: &LongTermScores| {
            let found = one.sequences.iter().find(|found| found.sequence == *sequence);
            Cell::Score(found.map(|found| Scored { value: found.f, deviation: None, interval: None }))
        };
        [Cell::Text((*sequence).to_owned())].into_iter().chain(scores.iter().map(f)).collect()
    };
    let names = scores.iter().map(|one| column(&one.tracker, &one.tracker));
    let columns = [column("sequence", "sequence")].into_iter().chain(names).collect();
    let rows = sequences.iter().map(row).collect();
    ScoreTable { title: "Long term: F by sequence".to_owned(), columns, rows, ranked: Ranked::Rows }
}

/// Places of the trackers, the best first; those without scores last.
fn order(table: &Table, measure: Measure) -> Vec<usize> {
    let score = |place: usize| {
        let value = table.trackers[place].overall.and_then(|scores| measure.of(&scores));
        value.map_or(f64::NEG_INFINITY, |value| value.mean)
    };
    let mut order: Vec<usize> = (0..table.trackers.len()).collect();
    order.sort_by(|&a, &b| score(b).total_cmp(&score(a)));
    order
}

fn names(table: &Table, order: &[usize]) -> Vec<Column> {
    order
        .iter()
        .map(|place| column(&table.trackers[*place].tracker, &table.trackers[*place].tracker))
        .collect()
}

fn column(title: &str, key: &str) -> Column {
    Column { title: title.to_owned(), key: key.to_owned() }
}

fn scored(spread: Spread, interval: Option<Interval>) -> Scored {
    Scored { value: spread.mean, deviation: spread.deviation, interval }
}

/// Without its spread, which would make wide tables wider.
fn mean_of(spread: Option<Spread>) -> Option<Scored> {
    spread.map(|spread| Scored { value: spread.mean, deviation: None, interval: None })
}
