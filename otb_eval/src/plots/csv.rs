//! Curves as a table: a row a threshold, a column a tracker.

use super::{Curve, PlotError};

/// The curves as CSV (RFC 4180, lines end in LF): the first column is `threshold`, then a column for each tracker in
/// the order given. Numbers have every digit that tells them from their neighbours.
///
/// # Errors
/// If curves have different thresholds.
pub fn curves_csv(curves: &[Curve]) -> Result<String, PlotError> {
    for curve in curves {
        curve.check("CSV")?;
        if curve.x != curves[0].x {
            let problem =
                format!("has other thresholds than `{}`; write them to separate files", curves[0].label);
            return Err(PlotError::Curve { plot: "CSV".into(), label: curve.label.clone(), problem });
        }
    }
    let header =
        std::iter::once("threshold".to_owned()).chain(curves.iter().map(|curve| quoted(&curve.label)));
    let mut csv = header.collect::<Vec<_>>().join(",") + "\n";
    let thresholds = curves.first().map_or(&[][..], |curve| &curve.x);
    for (row, threshold) in thresholds.iter().enumerate() {
        csv.push_str(&threshold.to_string());
        for curve in curves {
            csv.push(',');
            csv.push_str(&curve.y[row].to_string());
        }
        csv.push('\n');
    }
    Ok(csv)
}

/// Curves of different thresholds as CSV: a row a point, with the tracker, x and y.
pub fn points_csv(curves: &[Curve]) -> String {
    let point = |curve: &Curve, (x, y): (&f64, &f64)| format!("{},{x},{y}\n", quoted(&curve.label));
    let of_curve =
        |curve: &Curve| curve.x.iter().zip(&curve.y).map(|xy| point(curve, xy)).collect::<String>();
    "tracker,x,y\n".to_owned() + &curves.iter().map(of_curve).collect::<String>()
}

/// A field in quotes if it needs them, the quotes in it doubled.
fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}
