//! The report in a browser: headless Chromium loads the page with a script of the test's own behind it, which acts as
//! a user and writes what it saw into the page.

mod report_model;

use std::{io::Write as _, path::Path, process::Command};

const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Acts on the page; `note` leaves a line that the test reads.
const USER: &str = r#"<script>
const lines = [];
const note = (what, value) => lines.push(`${what}=${value}`);
const one = (selector) => document.querySelector(selector);
const every = (selector) => [...document.querySelectorAll(selector)];
const column = (n) => every('#sequences .panel.on tbody tr').map((row) => row.cells[n].textContent);
const click = (element) => element.dispatchEvent(new MouseEvent('click', { bubbles: true }));
const point = (svg, x, y) => new DOMPoint(x, y).matrixTransform(svg.getScreenCTM());
const shown = (selector) => every(selector).filter((e) => getComputedStyle(e).display !== 'none').length;
addEventListener('load', () => {
  note('ready', document.body.dataset.ready);
  note('tabs', every('#plots .panel').filter((panel) => panel.offsetParent).length);

  const button = one('#sequences .panel.on th:nth-child(2) button');
  click(button);
  note('falling', column(1).join(' '));
  click(button);
  note('rising', column(1).join(' '));
  click(one('#sequences .panel.on th:nth-child(9) button'));
  note('missing last', column(8).pop());

  const svg = one('#plots svg');
  const area = JSON.parse(one('#numbers').textContent).plots[0].area;
  const at = point(svg, area[0] + 0.52 * (area[2] - area[0]), 0.5 * (area[1] + area[3]));
  const move = () => svg.dispatchEvent(new MouseEvent('mousemove', { bubbles: true, clientX: at.x, clientY: at.y }));
  move();
  note('tip', one('#tip').hidden ? 'hidden' : one('#tip').innerText.replace(/\s+/g, ' '));
  note('cross', every('#plots .cross').length);

  const row = one('#plots svg .row.s2');
  row.dispatchEvent(new MouseEvent('mouseenter'));
  note('highlighted', every('#plots .curve.on').map((curve) => curve.getAttribute('class')).join(','));
  row.dispatchEvent(new MouseEvent('mouseleave'));
  note('highlighted after', every('#plots .curve.on').length);

  const box = one('#trackers input[value="2"]');
  box.click();
  const parts = ['.curve.s2', '#overall tr.s2', '#sequences td.s2', '#attributes i.s2', '.strip .box.s2'];
  note('off', parts.map((part) => shown(part)).join(','));
  move();
  note('tip without', one('#tip').innerText.includes('KCF'));
  click(row);
  note('on', parts.map((part) => shown(part) > 0).join(','));
  click(one('#trackers button[data-all=""]'));
  note('none', shown('.curve'));
  click(one('#trackers button[data-all="1"]'));

  click(every('#plots .tablist button')[1]);
  note('second tab', one('#plots .panel.on h3').textContent);
  note('error', document.body.dataset.error);
  document.body.dataset.seen = lines.join('|');
});
</script>"#;

/// What `USER` noted, or `None` without a browser.
fn visit(page: &Path) -> Option<Vec<(String, String)>> {
    let profile = tempfile::tempdir().unwrap();
    let run = |browser: &&str| {
        Command::new(browser)
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"])
            .args(["--disable-background-networking", "--disable-component-update", "--disable-sync"])
            .args(["--window-size=1400,1000", "--virtual-time-budget=5000", "--dump-dom"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg(format!("file://{}", page.display()))
            .output()
            .ok()
    };
    let output = BROWSERS.iter().find_map(run)?;
    let dom = String::from_utf8_lossy(&output.stdout);
    let seen = dom.split_once("data-seen=\"").map(|(_, rest)| rest.split('"').next().unwrap_or_default());
    let seen = seen.unwrap_or_else(|| {
        panic!("the browser did not finish: {}\n{}", output.status, String::from_utf8_lossy(&output.stderr))
    });
    let pair = |line: &str| line.split_once('=').map(|(what, value)| (what.to_owned(), value.to_owned()));
    Some(seen.split('|').filter_map(pair).collect())
}

#[test]
fn a_user_can_sort_point_switch_and_turn_to_another_tab() {
    let model = report_model::report();
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("report.html");
    let html = model.html().unwrap().replace("</body>", &format!("{USER}</body>"));
    std::fs::write(&page, html).unwrap();
    let Some(seen) = visit(&page) else {
        let _ = writeln!(std::io::stderr(), "SKIPPED: no Chromium; looked for {}", BROWSERS.join(", "));
        return;
    };
    let noted = |what: &str| {
        let found = seen.iter().find(|(key, _)| key == what);
        found.map(|(_, value)| value.as_str()).unwrap_or_else(|| panic!("`{what}` is not in {seen:?}"))
    };
    assert_eq!((noted("ready"), noted("error"), noted("tabs")), ("yes", "undefined", "1"));

    let mut scores: Vec<f64> = model.sequences[0].rows.iter().filter_map(|row| row.scores[0]).collect();
    scores.sort_by(f64::total_cmp);
    let text = |scores: &[f64]| scores.iter().map(|s| format!("{s:.3}")).collect::<Vec<_>>().join(" ");
    assert_eq!(noted("rising"), text(&scores));
    scores.reverse();
    assert_eq!(noted("falling"), text(&scores));
    assert_eq!(noted("missing last"), "–");

    let curves = &model.plots[0].plots[0].curves;
    assert!(noted("tip").starts_with("Overlap threshold: 0.5 "), "{}", noted("tip"));
    for curve in curves.iter().filter(|curve| !curve.label.contains('<')) {
        let line = format!("{} {:.3}", curve.label, curve.y[10]);
        assert!(noted("tip").contains(&line), "{line} is not in {}", noted("tip"));
    }
    assert_eq!(noted("cross"), "1");
    assert_eq!((noted("highlighted"), noted("highlighted after")), ("curve s2 on", "0"));

    assert_eq!((noted("off"), noted("tip without")), ("0,0,0,0,0", "false"));
    assert_eq!((noted("on"), noted("none")), ("true,true,true,true,true", "0"));
    assert_eq!(noted("second tab"), "TRE");
}
