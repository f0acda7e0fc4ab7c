//! The report's page, read as text.

mod report_model;

use otb_eval::{plots::success_plot, report::*};
use report_model::{TRACKERS, report};

fn count(html: &str, part: &str) -> usize {
    html.matches(part).count()
}

#[test]
fn every_tracker_is_in_every_part() {
    let report = report();
    let html = report.html().unwrap();
    let plots: usize = report.plots.iter().map(|group| group.plots.len()).sum();
    for place in 0..TRACKERS.len() {
        assert_eq!(count(&html, &format!("<g class=\"curve s{place}\"")), plots, "curves of {place}");
        assert_eq!(count(&html, &format!("<g class=\"row s{place}\"")), plots, "legends of {place}");
        assert_eq!(
            count(&html, &format!("<tr class=\"s{place}\"")),
            3,
            "overall rows, and one of the map, of {place}"
        );
        assert_eq!(count(&html, &format!("<th class=\"s{place}\"")), 2, "columns of {place}");
        let frames = if place == 7 { 6 } else { 12 };
        assert_eq!(count(&html, &format!("<rect class=\"box s{place}\"")), frames, "boxes of {place}");
        assert_eq!(count(&html, &format!("value=\"{place}\"")), 1, "switch of {place}");
    }
}

#[test]
fn the_page_fetches_nothing() {
    let html = report().html().unwrap();
    let rest = html.replace("http://www.w3.org/2000/svg", "");
    for foreign in ["http://", "https://", "src=\"", "@import", "url(", "<link"] {
        assert!(!rest.contains(foreign), "{foreign} in the page");
    }
    let inner = count(&html, "href=\"data:image/jpeg;base64,") + count(&html, "href=\"#sequence-");
    assert_eq!(count(&html, "href=\""), inner);
}

#[test]
fn each_picture_is_stored_once() {
    let html = report().html().unwrap();
    assert_eq!(count(&html, "data:image/jpeg;base64,"), 12);
    assert_eq!(count(&html, "<rect class=\"truth\""), 12);
}

#[test]
fn texts_cannot_become_markup() {
    let mut report = report();
    let evil = "</script><script>alert('x')</script><b a=\"&\">";
    report.title = evil.into();
    report.subtitle = evil.into();
    report.made = Some(evil.into());
    report.versions = vec![(evil.into(), evil.into())];
    report.trackers[0] = Tracker { label: evil.into(), parameters: vec![(evil.into(), evil.into())] };
    report.commands = vec![evil.into()];
    report.notes = vec![evil.into()];
    report.failures = vec![Failure { job: evil.into(), reason: evil.into() }];
    report.overall[0].title = evil.into();
    report.overall[0].metrics[0] = evil.into();
    report.plots[0].title = evil.into();
    let plot = &mut report.plots[0].plots[0];
    (plot.title, plot.x_label, plot.y_label) = (evil.into(), evil.into(), evil.into());
    plot.curves[0].label = evil.into();
    report.attributes[0].title = evil.into();
    report.attributes[0].source = evil.into();
    report.attributes[0].attributes[0].attribute = evil.into();
    report.sequences[0].metric = evil.into();
    report.sequences[0].rows[0].sequence = evil.into();
    report.strips[0].sequence = evil.into();
    let html = report.html().unwrap();
    assert_eq!(count(&html, "<script"), 2, "the page's own two");
    assert!(!html.contains("<b a="));
    assert!(count(&html, "&lt;/script&gt;&lt;script&gt;") > 20);
}

#[test]
fn overall_rows_are_ranked_and_the_best_stands_out() {
    let html = report().html().unwrap();
    let body = &html[html.find("<section id=\"overall\"").unwrap()..];
    let places: Vec<usize> =
        [9, 1, 0, 5].iter().map(|t| body.find(&format!("<tr class=\"s{t}\"")).unwrap()).collect();
    assert!(places.windows(2).all(|pair| pair[0] < pair[1]), "{places:?}");
    assert!(body.contains("<td class=\"best\">0.700 <small>[0.660, 0.750]</small></td>"));
    assert!(body.contains("<td>0.620 <small>± 0.004 [0.580, 0.670]</small></td>"));
    assert!(body.contains("<td class=\"second\">0.680 <small>[0.640, 0.730]</small></td>"));
    let tested = "<td class=\"clear\">+0.080 <small>[+0.040, +0.120]</small></td><td>&lt; 0.001</td>";
    assert!(body.contains(tested));
}

#[test]
fn a_map_of_attributes_goes_from_the_least_to_the_most() {
    let html = report().html().unwrap();
    let map = &html[html.find("<table class=\"heat\"").unwrap()..];
    let map = &map[..map.find("</table>").unwrap()];
    assert_eq!((count(map, "<tr"), count(map, "--v:1.00")), (12, 1));
    assert!(map.contains("--v:0.00") && map.contains("--v:0.5"));
}

#[test]
fn what_scoring_met_stands_apart_from_failed_jobs_and_rows_lead_to_their_sequences() {
    let html = report().html().unwrap();
    let section = |id: &str| {
        let from = &html[html.find(&format!("<section id=\"{id}\"")).unwrap()..];
        from[..from.find("</section>").unwrap()].to_owned()
    };
    assert!(section("scoring").contains("Sequence3: the result has 5 rows &lt;and the truth 6&gt;"));
    assert!(
        !section("failures").contains("Sequence3: the result")
            && section("failures").contains("TLD on Sequence4")
    );
    assert!(section("sequences").contains("<a href=\"#sequence-1\">Sequence1</a>"));
    assert!(
        section("time").contains("id=\"sequence-1\"") && !section("sequences").contains(">Sequence7</a>")
    );
}

#[test]
fn what_is_empty_is_left_out() {
    let html = Report { title: "Nothing".into(), ..Report::default() }.html().unwrap();
    assert_eq!((count(&html, "<section"), count(&html, "<table"), count(&html, "<img")), (0, 0, 0));
    let without = Report { strips: vec![], timelines: vec![], ..report() }.html().unwrap();
    assert!(!without.contains("data:image") && !without.contains("id=\"time\""));
    assert!(!without.contains("href=\"#sequence-"), "no way to what is not shown");
}

#[test]
fn the_same_report_gives_the_same_bytes() {
    assert_eq!(report().html().unwrap(), report().html().unwrap());
}

#[test]
fn a_page_without_pictures_stays_small() {
    let html = Report { strips: vec![], ..report() }.html().unwrap();
    assert!(html.len() < 600_000, "{} bytes", html.len());
}

#[test]
fn what_does_not_fit_is_named() {
    let refused = |change: fn(&mut Report)| {
        let mut report = report();
        change(&mut report);
        report.html().unwrap_err().to_string()
    };
    let short = refused(|report| report.sequences[0].rows[3].scores.truncate(10));
    assert!(
        short.contains("`Sequence3` in table `AUC` has 10 values") && short.contains("11 trackers"),
        "{short}"
    );
    let metric = refused(|report| report.overall[1].rows[0].scores.truncate(3));
    assert!(metric.contains("table `TRE`") && metric.contains("4 metrics"), "{metric}");
    let unknown = refused(|report| report.plots[0].plots[0].curves[0].style = 11);
    assert!(unknown.contains("names tracker 11, but there are 11"), "{unknown}");
    let picture = refused(|report| report.strips[1].frames[2].jpeg = b"GIF89a".to_vec());
    assert!(picture.contains("frame 41 of `David3` is not a JPEG"), "{picture}");
    let curve = refused(|report| {
        let mut plot = success_plot("S", report.plots[0].plots[0].curves.clone());
        plot.curves[2].y.pop();
        report.plots[0].plots[0] = plot;
    });
    assert!(curve.contains("the curve of `KCF` has 21 thresholds and 20 values"), "{curve}");
}
