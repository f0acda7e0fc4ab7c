use proptest::prelude::*;

use super::{
    layout::{Area, ticks},
    style::cut,
    *,
};

fn curve(label: &str, style: usize, score: f64) -> Curve {
    let x: Vec<f64> = (0..21).map(|i| f64::from(i) / 20.0).collect();
    let y = x.iter().map(|t| (1.0 - t.powf(1.0 + 3.0 * score)) * (0.4 + score / 2.0)).collect();
    Curve { label: label.into(), style, score, x, y }
}

fn trackers(count: usize) -> Vec<Curve> {
    (0..count).map(|i| curve(&format!("Tracker{i}"), i, 0.3 + 0.035 * i as f64)).collect()
}

#[test]
fn the_legend_is_ranked_by_score_with_unknown_scores_last() {
    let curves = vec![
        curve("a", 0, 0.5),
        Curve { score: f64::NAN, ..curve("b", 1, 0.4) },
        curve("c", 2, 0.678),
        curve("d", 3, 0.5),
    ];
    let plot = success_plot("Success plots of OPE", curves);
    assert_eq!(plot.ranking(), [2, 0, 3, 1]);
    let svg = plot.svg().unwrap();
    let places: Vec<usize> =
        ["c [0.678]", "a [0.500]", "d [0.500]", "b [n/a]"].iter().map(|row| svg.find(row).unwrap()).collect();
    assert!(places.windows(2).all(|pair| pair[0] < pair[1]), "{places:?}");
}

#[test]
fn every_tracker_has_a_curve_a_row_and_a_look_of_its_own() {
    let svg = success_plot("Success", trackers(14)).svg().unwrap();
    for style in 0..14 {
        assert_eq!(svg.matches(&format!("class=\"curve s{style}\"")).count(), 1);
        assert_eq!(svg.matches(&format!("class=\"row s{style}\"")).count(), 1);
    }
    for a in 0..144 {
        for b in 0..a {
            assert_ne!(Style::of(a), Style::of(b), "{a} and {b}");
            if a < 12 {
                assert_ne!(Style::of(a).dashes(), Style::of(b).dashes(), "{a} and {b} without colour");
            }
        }
    }
}

#[test]
fn texts_are_escaped_and_nothing_is_fetched() {
    let svg = success_plot("<b>&\"'", vec![curve("<script>alert(1)</script>", 0, 0.5)]).svg().unwrap();
    assert!(!svg.contains("<script") && !svg.contains("<b>"));
    assert!(svg.contains("&lt;script&gt;alert(1)&lt;/script&gt; [0.500]"));
    assert!(!svg.replace("http://www.w3.org/2000/svg", "").contains("://"));
}

#[test]
fn the_same_plot_gives_the_same_bytes() {
    let plot = precision_plot("Precision", trackers(3));
    assert_eq!(plot.svg().unwrap(), plot.svg().unwrap());
    assert_eq!(plot.png(&Appearance::default()).unwrap(), plot.png(&Appearance::default()).unwrap());
}

#[test]
fn a_png_shows_each_curve_in_its_colour_where_the_area_says() {
    let flat =
        |style, y| Curve { label: format!("{style}"), style, score: y, x: vec![0.0, 1.0], y: vec![y, y] };
    let plot = success_plot("Success", vec![flat(0, 0.35), flat(12, 0.65)]);
    let picture = image::load_from_memory(&plot.png(&Appearance::default()).unwrap()).unwrap().to_rgb8();
    assert_eq!(picture.dimensions(), (1440, 1000));
    let area = plot.area();
    let y = area.bottom - 0.35 * (area.bottom - area.top);
    let x = area.left + 0.25 * (area.right - area.left);
    let (red, green, blue) = Style::of(0).on_light();
    assert_eq!(picture.get_pixel((2.0 * x) as u32, (2.0 * y) as u32).0, [red, green, blue]);
    let beside = picture.get_pixel((2.0 * x) as u32 + 3, (2.0 * y) as u32 + 12).0;
    assert_eq!(beside, [255, 255, 255]);
}

#[test]
fn the_legend_never_lies_on_a_curve() {
    for count in [1, 4, 11, 20, 40] {
        for plot in [success_plot("s", trackers(count)), precision_plot("p", trackers(count))] {
            let layout = plot.layout(&Appearance::default());
            let place = layout.legend.unwrap().place;
            assert!(place.bottom <= layout::HEIGHT && place.right <= layout::WIDTH, "{count}: {place:?}");
            for curve in &plot.curves {
                for (x, y) in plot.points(layout.area, curve) {
                    let hidden = place.left < x && x < place.right && place.top < y && y < place.bottom;
                    assert!(!hidden, "{count} curves: {} is behind the legend", curve.label);
                }
            }
        }
    }
}

#[test]
fn a_papers_figure_has_the_width_and_the_letters_asked_for() {
    let plot = success_plot("Success plots of OPE", trackers(11));
    let paper = Appearance {
        width_points: Some(252.0),
        font_points: Some(8.0),
        has_title: false,
        highlight: Some("Tracker3".into()),
    };
    let svg = plot.svg_as(&paper).unwrap();
    assert!(svg.contains("width=\"252pt\" height=\"175pt\""));
    assert!(
        !svg.contains(">\nSuccess plots of OPE") && svg.matches("Success plots of OPE").count() == 1,
        "in aria-label alone"
    );
    // 8 points in units of the drawing, ten of which are one of 720 across.
    let label = svg.split("<text").find(|text| text.contains("Overlap threshold")).unwrap();
    let size: f64 = label.split("font-size=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
    assert!((size * 252.0 / 7200.0 - 8.0).abs() < 0.05, "{size}");
    let png = image::load_from_memory(&plot.png(&paper).unwrap()).unwrap();
    assert_eq!((png.width(), png.height()), (1050, 729));
    for count in [1, 4, 11, 20, 40] {
        for text in [0.5, 1.0, 1.5, 2.0, 3.0] {
            let appearance = Appearance { font_points: Some(12.0 * text), ..Appearance::default() };
            let plot = success_plot("s", trackers(count));
            let layout = plot.layout(&appearance);
            let place = layout.legend.unwrap().place;
            assert!(
                layout.area.right - layout.area.left > 100.0 && layout.area.bottom - layout.area.top > 100.0
            );
            assert!(
                place.right <= layout::WIDTH && place.bottom <= layout::HEIGHT,
                "{count} at {text}: {place:?}"
            );
        }
    }
}

#[test]
fn the_highlighted_curve_is_drawn_last_and_alone_in_colour() {
    let appearance = Appearance { highlight: Some("Tracker3".into()), ..Appearance::default() };
    let plot = success_plot("Success", trackers(11));
    let svg = plot.svg_as(&appearance).unwrap();
    let last = svg.rfind("class=\"curve ").unwrap();
    assert!(svg[last..].starts_with("class=\"curve s3\""));
    let colour_of = |style: usize| {
        let curve = svg.split(&format!("class=\"curve s{style}\"")).nth(1).unwrap();
        let stroke = curve.split("stroke=\"#").nth(1).unwrap();
        stroke[..6].to_owned()
    };
    let is_grey = |colour: &str| colour[..2] == colour[2..4] && colour[2..4] == colour[4..];
    for style in 0..11 {
        assert_eq!(is_grey(&colour_of(style)), style != 3, "{style}: {}", colour_of(style));
    }
    let nobody = Appearance { highlight: Some("Nobody".into()), ..Appearance::default() };
    assert_eq!(plot.svg_as(&nobody).unwrap(), plot.svg().unwrap());
}

#[test]
fn the_best_are_kept_and_the_one_that_is_wanted() {
    let labels = |plot: Plot| plot.curves.into_iter().map(|curve| curve.label).collect::<Vec<_>>();
    let plot = || success_plot("s", trackers(6));
    assert_eq!(labels(plot().top(2, None)), ["Tracker4", "Tracker5"]);
    assert_eq!(labels(plot().top(2, Some("Tracker1"))), ["Tracker1", "Tracker4", "Tracker5"]);
    assert_eq!(labels(plot().top(9, Some("Tracker1"))).len(), 6);
}

#[test]
fn a_pdf_is_one_page_of_the_width_with_its_font_in_it() {
    let plot = precision_plot("Precision", trackers(4));
    let pdf = plot.pdf(&Appearance { width_points: Some(252.0), ..Appearance::default() }).unwrap();
    let text = String::from_utf8_lossy(&pdf);
    assert!(text.starts_with("%PDF-") && text.contains("/MediaBox [0 0 252 175]"), "{}", &text[..200]);
    assert!(text.contains("/FontFile"), "the font is embedded");
    assert_eq!(pdf, plot.pdf(&Appearance { width_points: Some(252.0), ..Appearance::default() }).unwrap());
}

#[test]
fn curves_are_cut_off_where_the_axis_ends() {
    let mut plot = success_plot("s", vec![]);
    plot.x_max = 2.0;
    let curve =
        Curve { label: "a".into(), style: 0, score: 0.0, x: vec![0.0, 1.0, 3.0], y: vec![1.0, 1.0, 0.0] };
    let unit = Area { left: 0.0, top: 0.0, right: 1.0, bottom: 1.0 };
    assert_eq!(plot.points(unit, &curve), [(0.0, 0.0), (0.5, 0.0), (1.0, 0.5)]);
}

#[test]
fn axes_are_marked_in_round_steps() {
    let (marks, decimals) = ticks(1.0);
    assert_eq!((marks.len(), decimals), (11, 1));
    assert!((marks[10] - 1.0).abs() < 1e-12);
    assert_eq!(ticks(50.0), ((0..=10).map(|i| 5.0 * f64::from(i)).collect(), 0));
    assert_eq!((ticks(0.5).0.len(), ticks(0.5).1), (11, 2));
    assert_eq!(ticks(7.0).0, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
}

#[test]
fn dashes_run_on_around_a_corner() {
    let pieces = cut(&[(0.0, 0.0), (5.0, 0.0), (5.0, 5.0)], &[4.0, 2.0]);
    assert_eq!(pieces, [vec![(0.0, 0.0), (4.0, 0.0)], vec![(5.0, 1.0), (5.0, 5.0)]]);
    assert_eq!(cut(&[(0.0, 0.0), (1.0, 0.0)], &[]), [vec![(0.0, 0.0), (1.0, 0.0)]]);
}

proptest! {
    #[test]
    fn dashes_keep_their_share_of_a_line(length in 1.0..500.0f64, bend in 0.0..1.0f64) {
        let corner = (length * bend, 0.0);
        let end = (corner.0, length * (1.0 - bend));
        let drawn: f64 = cut(&[(0.0, 0.0), corner, end], &[6.0, 3.0]).iter().flat_map(|piece| {
            piece.windows(2).map(|p| (p[1].0 - p[0].0).hypot(p[1].1 - p[0].1)).collect::<Vec<_>>()
        }).sum();
        let whole = (length / 9.0).floor();
        let expected = whole * 6.0 + (length - whole * 9.0).min(6.0);
        prop_assert!((drawn - expected).abs() < 1e-6, "{drawn} of {length}, expected {expected}");
    }
}

#[test]
fn csv_has_every_digit_and_quotes_what_needs_it() {
    let curve =
        |label: &str, y: Vec<f64>| Curve { label: label.into(), style: 0, score: 0.0, x: vec![0.0, 0.05], y };
    let curves = [curve("KCF", vec![1.0, 0.1 + 0.2]), curve("a \"b\", c", vec![0.5, 1.0 / 3.0])];
    assert_eq!(
        curves_csv(&curves).unwrap(),
        "threshold,KCF,\"a \"\"b\"\", c\"\n0,1,0.5\n0.05,0.30000000000000004,0.3333333333333333\n"
    );
    assert_eq!(
        points_csv(&curves[1..]),
        "tracker,x,y\n\"a \"\"b\"\", c\",0,0.5\n\"a \"\"b\"\", c\",0.05,0.3333333333333333\n"
    );
    assert_eq!(curves_csv(&[]).unwrap(), "threshold\n");
    let other = Curve { x: vec![0.0, 0.1], ..curves[0].clone() };
    assert!(curves_csv(&[curves[0].clone(), other]).unwrap_err().to_string().contains("other thresholds"));
}

#[test]
fn what_cannot_be_drawn_is_named() {
    let broken = |x: Vec<f64>, y: Vec<f64>| {
        let curve = Curve { label: "KCF".into(), style: 0, score: 0.0, x, y };
        success_plot("OPE", vec![curve]).svg().unwrap_err().to_string()
    };
    assert!(broken(vec![0.0], vec![]).contains("`OPE`: the curve of `KCF` has 1 thresholds and 0 values"));
    assert!(broken(vec![], vec![]).contains("no points"));
    assert!(broken(vec![0.0, 1.0], vec![1.0, f64::NAN]).contains("not finite"));
    assert!(broken(vec![1.0, 0.0], vec![1.0, 1.0]).contains("do not ascend"));
    let mut plot = success_plot("OPE", vec![]);
    assert!(plot.svg().is_ok(), "an empty plot is drawn");
    plot.x_max = 0.0;
    assert!(plot.svg().unwrap_err().to_string().contains("above 0"));
}
