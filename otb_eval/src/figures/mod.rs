//! From scores to plots and to the report: which curves are drawn, and what the page shows.

mod page;
mod strips;
mod timelines;

use crate::{
    catalogue::Attribute,
    plots::{Curve, Plot, normalised_precision_plot, precision_plot, precision_recall_plot, success_plot},
    scoring::{LongTermScores, Table, TrackerScores},
    toolkits::Curves,
};

pub use page::{PageOptions, missing_protocols, page};
pub use strips::{StripProblem, strips};
pub use timelines::timelines;

/// A plot and the name of its files.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPlot {
    /// Such as `success_ope` or `precision_tre_OCC`.
    pub name: String,
    /// The plot.
    pub plot: Plot,
}

/// Success, precision and, where the toolkit has it, normalised precision over all sequences, and then success and
/// precision over the sequences of each attribute. The legends rank trackers by AUC, by precision at 20 pixels and by
/// normalised precision at 0.2.
pub fn plots(table: &Table) -> Vec<NamedPlot> {
    let protocol = table.protocol;
    let all = |one: &TrackerScores| one.curves.clone();
    let mut named = Vec::new();
    for plot in [success(table, protocol.title(), all), precision(table, protocol.title(), all)] {
        named.extend(plot.map(|(kind, plot)| NamedPlot { name: format!("{kind}_{protocol}"), plot }));
    }
    let normalised = normalised(table, protocol.title(), all);
    named.extend(normalised.map(|plot| NamedPlot { name: format!("normalised_precision_{protocol}"), plot }));
    for attribute in Attribute::ALL {
        let of = |one: &TrackerScores| {
            let scores = one.attributes.iter().find(|scores| scores.attribute == attribute)?;
            Some(scores.curves.clone())
        };
        let Some(sequences) = sequences_with(table, attribute) else { continue };
        let title = format!("{}, {} ({sequences})", protocol.title(), attribute.title());
        for plot in [success(table, &title, of), precision(table, &title, of)] {
            let name = |kind: &str| format!("{kind}_{protocol}_{attribute}");
            named.extend(plot.map(|(kind, plot)| NamedPlot { name: name(kind), plot }));
        }
    }
    named
}

/// Precision over recall of one-pass results, ranked by F; `None` without scores. A tracker that tells no confidence has one point,
/// which is drawn as a short dash.
pub fn long_term_plot(scores: &[LongTermScores]) -> Option<NamedPlot> {
    const HALF_A_DASH: f64 = 0.008;
    let curve = |(style, one): (usize, &LongTermScores)| {
        let (mut x, mut y): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
        for point in &one.curve {
            // Where recall stands still, the first of the points is the most precise.
            if x.last().is_none_or(|last| point.recall > *last) {
                x.push(point.recall);
                y.push(point.precision);
            }
        }
        if let ([recall], [precision]) = (&x[..], &y[..]) {
            (x, y) = (vec![recall - HALF_A_DASH, recall + HALF_A_DASH], vec![*precision; 2]);
        }
        let score = one.f?.mean;
        (!x.is_empty()).then(|| Curve { label: one.tracker.clone(), style, score, x, y })
    };
    let curves: Vec<Curve> = scores.iter().enumerate().filter_map(curve).collect();
    let plot = precision_recall_plot("Precision and recall of OPE, long term", curves);
    (!plot.curves.is_empty()).then(|| NamedPlot { name: "long_term_ope".to_owned(), plot })
}

/// How many scored sequences have an attribute; `None` if no tracker has scores for it.
fn sequences_with(table: &Table, attribute: Attribute) -> Option<usize> {
    let attributes = table.trackers.iter().flat_map(|one| &one.attributes);
    attributes.filter(|scores| scores.attribute == attribute).map(|scores| scores.sequences).max()
}

type NamedKind = Option<(&'static str, Plot)>;

fn success(table: &Table, title: &str, of: impl Fn(&TrackerScores) -> Option<Curves>) -> NamedKind {
    let y = |curves: &Curves| Some((curves.auc(), curves.success.to_vec()));
    let curves = curves(table, of, |index| index as f64 / 20.0, y);
    (!curves.is_empty()).then(|| ("success", success_plot(format!("Success plots of {title}"), curves)))
}

fn precision(table: &Table, title: &str, of: impl Fn(&TrackerScores) -> Option<Curves>) -> NamedKind {
    let y = |curves: &Curves| Some((curves.precision_at_20(), curves.precision.to_vec()));
    let curves = curves(table, of, |index| index as f64, y);
    (!curves.is_empty()).then(|| ("precision", precision_plot(format!("Precision plots of {title}"), curves)))
}

fn normalised(table: &Table, title: &str, of: impl Fn(&TrackerScores) -> Option<Curves>) -> Option<Plot> {
    let y = |curves: &Curves| Some((curves.normalised_precision_at_02()?, curves.normalised?.to_vec()));
    let curves = curves(table, of, |index| index as f64 / 100.0, y);
    let title = format!("Normalised precision plots of {title}");
    (!curves.is_empty()).then(|| normalised_precision_plot(title, curves))
}

/// A curve a tracker that has scores; its style is the tracker's place in the table.
fn curves(
    table: &Table,
    of: impl Fn(&TrackerScores) -> Option<Curves>,
    x: impl Fn(usize) -> f64,
    y: impl Fn(&Curves) -> Option<(f64, Vec<f64>)>,
) -> Vec<Curve> {
    let curve = |(style, one): (usize, &TrackerScores)| {
        let (score, y) = y(&of(one)?)?;
        let x = (0..y.len()).map(&x).collect();
        Some(Curve { label: one.tracker.clone(), style, score, x, y })
    };
    table.trackers.iter().enumerate().filter_map(curve).collect()
}
