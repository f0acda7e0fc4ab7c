//! A report of eleven invented trackers, with everything a report can hold.

use image::{ExtendedColorType, ImageEncoder, Rgb, RgbImage, codecs::jpeg::JpegEncoder};
use infopart::geometry::Rect;
use otb_eval::{
    plots::{Curve, normalised_precision_plot, precision_plot, success_plot},
    report::*,
    statistics::Interval,
};

/// A tracker and its quality in [0, 1].
pub const TRACKERS: [(&str, f64); 11] = [
    ("InfoPart", 0.62),
    ("MDNet", 0.68),
    ("KCF", 0.48),
    ("DSST", 0.51),
    ("Staple", 0.58),
    ("SRDCF", 0.60),
    ("STRUCK", 0.46),
    ("TLD <2012> & \"co\"", 0.36),
    ("SiamFC", 0.59),
    ("SiamRPN++", 0.70),
    ("CSRDCF", 0.592),
];
const ATTRIBUTES: [&str; 11] = ["IV", "SV", "OCC", "DEF", "MB", "FM", "IPR", "OPR", "OV", "BC", "LR"];

/// A wobble in [-1, 1] that differs from tracker to tracker and from place to place.
fn wobble(tracker: usize, place: usize) -> f64 {
    ((tracker * 7 + place * 13) as f64 * 1.7).sin()
}

fn curves(points: usize, step: f64, headline: Option<usize>, y: impl Fn(f64, f64) -> f64) -> Vec<Curve> {
    let curve = |(style, &(label, quality)): (usize, &(&str, f64))| {
        let x: Vec<f64> = (0..points).map(|i| i as f64 * step).collect();
        let y: Vec<f64> = x.iter().map(|&x| y(x, quality)).collect();
        let score = headline.map_or(y.iter().sum::<f64>() / points as f64, |i| y[i]);
        Curve { label: label.into(), style, score, x, y }
    };
    TRACKERS.iter().enumerate().map(curve).collect()
}

fn success(shift: f64) -> Vec<Curve> {
    curves(21, 0.05, None, move |t, q| {
        (0.35 + 0.9 * (q - shift)).min(1.0) * (1.0 - t.powf(1.0 + 6.0 * q * q))
    })
}

fn plots(protocol: &str, shift: f64) -> PlotGroup {
    let precision = |t: f64, q: f64| (0.4 + 0.75 * (q - shift)) * (1.0 - (-t * (0.05 + 0.2 * q)).exp());
    let plots = vec![
        success_plot(format!("Success plots of {protocol}"), success(shift)),
        precision_plot(format!("Precision plots of {protocol}"), curves(51, 1.0, Some(20), precision)),
        normalised_precision_plot(
            format!("Normalised precision plots of {protocol}"),
            curves(51, 0.01, None, |t, q| precision(t * 100.0, q)),
        ),
    ];
    PlotGroup { title: protocol.into(), plots }
}

fn picture(frame: usize) -> Vec<u8> {
    let picture = RgbImage::from_fn(320, 240, |x, y| {
        let inside = (x as i32 - 100 - 15 * frame as i32).abs() < 20 && (y as i32 - 120).abs() < 45;
        if inside { Rgb([190, 120, 80]) } else { Rgb([60 + (x / 4) as u8, 90 + (y / 4) as u8, 110]) }
    });
    let mut jpeg = Vec::new();
    JpegEncoder::new_with_quality(&mut jpeg, 70)
        .write_image(picture.as_raw(), 320, 240, ExtendedColorType::Rgb8)
        .expect("a small picture can be encoded");
    jpeg
}

fn strip(sequence: &str) -> Strip {
    let frame = |i: usize| {
        let truth = Rect::new(80.0 + 15.0 * i as f64, 75.0, 40.0, 90.0);
        let off = |t: usize, axis: usize| (1.0 - TRACKERS[t].1) * 12.0 * i as f64 * wobble(t, axis);
        let found = |t: usize| Rect::new(truth.x + off(t, 1), truth.y + off(t, 2), truth.w, truth.h);
        StripFrame {
            number: 1 + 20 * i,
            jpeg: picture(i),
            width: 320,
            height: 240,
            truth: Some(truth),
            boxes: (0..TRACKERS.len()).map(|t| (t != 7 || i < 3).then(|| found(t))).collect(),
        }
    };
    Strip { sequence: sequence.into(), frames: (0..6).map(frame).collect() }
}

/// Sequence `place`, of `frames` frames, on which tracker t fails after its own share of them.
fn timeline(place: usize, frames: usize) -> Timeline {
    let overlap = |t: usize, i: usize| {
        let is_lost = i as f64 > TRACKERS[t].1 * frames as f64 * 1.3;
        (i != 5).then(|| if is_lost { 0.0 } else { 0.8 + 0.1 * wobble(t, i) })
    };
    let error = |t: usize, i: usize| overlap(t, i).map(|overlap| 100.0 * (1.0 - overlap));
    let of = |value: &dyn Fn(usize, usize) -> Option<f64>| {
        (0..TRACKERS.len()).map(|t| (0..frames).map(|i| value(t, i)).collect()).collect()
    };
    Timeline {
        sequence: format!("Sequence{place}"),
        frames,
        every: 1,
        overlaps: of(&overlap),
        errors: of(&error),
    }
}

fn overall(title: &str) -> OverallTable {
    let row = |(tracker, &(_, quality)): (usize, &(&str, f64))| OverallRow {
        tracker,
        seeds: if tracker == 0 { 5 } else { 1 },
        scores: [1.0, 1.32, 1.25, 1.1]
            .map(|k| {
                let mean = k * quality;
                let interval = Some(Interval { low: mean - 0.04, high: mean + 0.05 });
                Some(Score { mean, spread: (tracker == 0).then_some(0.004), interval })
            })
            .to_vec(),
        against: (tracker != 0).then(|| Tested {
            difference: quality - TRACKERS[0].1,
            interval: Interval { low: quality - 0.66, high: quality - 0.58 },
            p: if tracker == 9 { 0.0001 } else { 0.25 },
        }),
        fps: (tracker != 7).then(|| 20.0 + 30.0 * (1.0 + wobble(tracker, 2))),
    };
    OverallTable {
        title: title.into(),
        metrics: ["AUC", "precision at 20 px", "success at 0.5", "normalised precision"]
            .map(String::from)
            .to_vec(),
        rows: TRACKERS.iter().enumerate().map(row).collect(),
        against: Some("AUC less that of InfoPart".into()),
    }
}

fn scores(place: usize) -> Vec<Option<f64>> {
    let score = |t: usize| (TRACKERS[t].1 + 0.2 * wobble(t, place)).clamp(0.0, 1.0);
    (0..TRACKERS.len()).map(|t| (t != 7 || place != 4).then(|| score(t))).collect()
}

/// The report.
pub fn report() -> Report {
    let attribute_plots = ATTRIBUTES
        .iter()
        .enumerate()
        .map(|(i, name)| success_plot(*name, success(0.1 * wobble(1, i))))
        .collect();
    let sequences = |metric: &str, first: usize| SequenceTable {
        metric: metric.into(),
        rows: (0..30)
            .map(|i| SequenceRow { sequence: format!("Sequence{i}"), scores: scores(first + i) })
            .collect(),
    };
    let attribute = |(i, name): (usize, &&str)| AttributeScores {
        attribute: (*name).into(),
        sequences: 10 + 3 * i,
        scores: scores(50 + i),
    };
    Report {
        title: "InfoPart and ten trackers on TB-100".into(),
        subtitle: "One-pass, temporal and spatial robustness evaluation by the rules of the MATLAB toolkit"
            .into(),
        made: Some("2020-01-02 03:04 UTC".into()),
        versions: vec![("otb_eval".into(), "0.1.0".into()), ("data".into(), "TB-100, 100 sequences".into())],
        trackers: TRACKERS
            .map(|(label, quality)| Tracker {
                label: label.into(),
                parameters: vec![("quality".into(), quality.to_string()), ("threads".into(), "1".into())],
            })
            .to_vec(),
        commands: vec!["otb_eval report --results results --out report.html".into()],
        overall: vec![overall("OPE"), overall("TRE")],
        plots: vec![
            plots("OPE", 0.0),
            plots("TRE", 0.03),
            PlotGroup { title: "OPE by attribute".into(), plots: attribute_plots },
        ],
        attributes: vec![AttributeChart {
            title: "AUC, OPE".into(),
            source: "tb_100.txt".into(),
            attributes: ATTRIBUTES.iter().enumerate().map(attribute).collect(),
        }],
        sequences: vec![sequences("AUC", 0), sequences("precision at 20 px", 100)],
        strips: vec![strip("Sequence1"), strip("David3")],
        timelines: vec![timeline(0, 60), timeline(1, 121), timeline(2, 90)],
        scoring: vec!["KCF, Sequence3: the result has 5 rows <and the truth 6>".into()],
        failures: vec![Failure {
            job: "TLD on Sequence4, seed 1".into(),
            reason: "no box in row 17 <eof>".into(),
        }],
        notes: vec!["Other toolkits leave the first frame as it is, so their scores may be lower.".into()],
    }
}
