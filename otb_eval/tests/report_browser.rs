//! The report in a browser: headless Chromium loads the page with a script of the test's own behind it, which acts as
//! a user and writes what it saw into the page.

mod report_model;

use std::{io::Write as _, path::Path, process::Command};

const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Acts on the page; `note` leaves a line that the test reads.
const USER: &str = r##"<script>
const lines = [];
const note = (what, value) => lines.push(`${what}=${value}`);
const one = (selector) => document.querySelector(selector);
const every = (selector) => [...document.querySelectorAll(selector)];
const column = (n) => every('#sequences .panel.on tbody tr').map((row) => row.cells[n].textContent);
const click = (element) => element.dispatchEvent(new MouseEvent('click', { bubbles: true }));
const point = (svg, x, y) => new DOMPoint(x, y).matrixTransform(svg.getScreenCTM());
const shown = (selector) => every(selector).filter((e) => getComputedStyle(e).display !== 'none').length;
const files = [];
URL.createObjectURL = (blob) => { files.push(blob); return 'blob:none'; };
HTMLAnchorElement.prototype.click = function () { if (!this.download) this.dispatchEvent(new MouseEvent('click', { bubbles: true, cancelable: true })); else files.push(this.download); };
const move = (element, at) => {
  for (const name of ['mousemove', 'pointermove']) {
    element.dispatchEvent(new PointerEvent(name, { bubbles: true, clientX: at.x, clientY: at.y }));
  }
};
addEventListener('load', async () => {
  note('ready', document.body.dataset.ready);
  note('tabs', every('#plots .panel').filter((panel) => panel.offsetParent).length);

  const button = one('#sequences .panel.on th:nth-child(2) button');
  click(button);
  note('falling', column(1).join(' '));
  click(button);
  note('rising', column(1).join(' '));
  click(one('#sequences .panel.on th:nth-child(9) button'));
  note('missing last', column(8).pop());

  const measure = one('#sequences select');
  measure.value = '1';
  measure.dispatchEvent(new Event('change'));
  note('measure', one('#sequences .panel.on h3').textContent);
  const filter = one('#filter');
  filter.value = 'NCE2';
  filter.dispatchEvent(new Event('input'));
  note('filtered', one('#filtered').textContent);
  click(one('#sequences .panel.on .download'));
  note('csv', files.pop());
  note('csv lines', (await files.pop().text()).trim().split('\n').map((line) => line.split(',')[0]).join(' '));
  filter.value = '';
  filter.dispatchEvent(new Event('input'));
  note('all rows', every('#sequences .panel.on tbody tr').filter((row) => !row.hidden).length);

  const svg = one('#plots svg');
  const area = JSON.parse(one('#numbers').textContent).plots[0].area;
  const at = point(svg, area[0] + 0.52 * (area[2] - area[0]), 0.5 * (area[1] + area[3]));
  move(svg, at);
  note('tip', one('#tip').hidden ? 'hidden' : one('#tip').innerText.replace(/\s+/g, ' '));
  note('cross', every('#plots .cross').length);
  click(one('#plots .download'));
  note('svg', files.pop());
  const saved = new DOMParser().parseFromString(await files.pop().text(), 'image/svg+xml');
  note('svg curves', saved.querySelectorAll('.curve').length + ' ' + saved.querySelectorAll('.cross,parsererror').length);

  const row = one('#plots svg .row.s2');
  row.dispatchEvent(new MouseEvent('mouseenter'));
  note('highlighted', every('#plots .curve.on').map((curve) => curve.getAttribute('class')).join(','));
  row.dispatchEvent(new MouseEvent('mouseleave'));
  note('highlighted after', every('#plots .curve.on').length);

  click(one('#sequences .panel.on a[href="#sequence-1"]'));
  note('sequence', one('#time .panel.on h3').textContent);
  const overs = every('#time .panel.on .timeline svg');
  note('timelines', overs.length + ' ' + overs[0].querySelectorAll('.over').length);
  const box = overs[0].getBoundingClientRect();
  move(overs[0], { x: box.left + (46 + 844 * 40 / 120) / 900 * box.width, y: box.top + box.height / 2 });
  note('over', one('#tip').innerText.replace(/\s+/g, ' '));
  note('preview', every('#tip .preview image').length + ' ' + every('figure.near').map((figure) => figure.dataset.frame));
  click(one('#time .panel.on .download'));
  files.pop();
  note('over time', (await files.pop().text()).split('\n')[41].split(',').slice(0, 3).join(' '));

  const tracker = one('#trackers input[value="2"]');
  tracker.click();
  const parts = ['.curve.s2', '#overall tr.s2', '#sequences td.s2', '#attributes tr.s2', 'main .strip .box.s2', '.over.s2'];
  note('off', parts.map((part) => shown(part)).join(','));
  svg.scrollIntoView();
  move(svg, point(svg, area[0] + 0.52 * (area[2] - area[0]), 0.5 * (area[1] + area[3])));
  note('tip without', one('#tip').innerText.includes('KCF'));
  click(row);
  note('on', parts.map((part) => shown(part) > 0).join(','));
  click(one('#trackers button[data-all=""]'));
  note('none', shown('.curve'));
  click(one('#trackers button[data-all="1"]'));

  click(every('#plots .tablist button')[1]);
  note('second tab', one('#plots .panel.on h3').textContent);
  note('wider than the window', document.documentElement.scrollWidth - document.documentElement.clientWidth);
  note('width', innerWidth);
  note('error', document.body.dataset.error);
  document.body.dataset.seen = lines.join('|');
});
</script>"##;

/// What `USER` noted, or `None` without a browser.
fn visit(page: &Path, width: usize) -> Option<Vec<(String, String)>> {
    let profile = tempfile::tempdir().unwrap();
    let run = |browser: &&str| {
        Command::new(browser)
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"])
            .args(["--disable-background-networking", "--disable-component-update", "--disable-sync"])
            .arg(format!("--window-size={width},1000"))
            .args(["--virtual-time-budget=5000", "--dump-dom"])
            .arg("--allow-file-access-from-files")
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
fn a_user_can_sort_filter_point_download_switch_and_hold_it_in_one_hand() {
    let model = report_model::report();
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("report.html");
    let html = model.html().unwrap().replace("</body>", &format!("{USER}</body>"));
    std::fs::write(&page, html).unwrap();
    let Some(seen) = visit(&page, 1400) else {
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

    assert_eq!(
        (noted("measure"), noted("filtered"), noted("all rows")),
        ("precision at 20 px", "11 of 30", "30")
    );
    assert_eq!(noted("csv"), "precision_at_20_px.csv");
    let names: Vec<&str> = noted("csv lines").split(' ').collect();
    assert_eq!((names.len(), names[0]), (12, "Sequence"));
    assert!(names[1..].iter().all(|name| name.starts_with("Sequence2")), "{names:?}");
    assert_eq!((noted("svg"), noted("svg curves")), ("Success_plots_of_OPE.svg", "11 0"));
    assert_eq!((noted("sequence"), noted("timelines")), ("Sequence1", "2 11"));
    let overlap = model.timelines[1].overlaps[1][40].unwrap();
    let told = "frame 41 #41 overlap";
    assert!(noted("over").contains(told), "{}", noted("over"));
    assert!(noted("over").contains(&format!("MDNet {overlap:.2}")), "{overlap} in {}", noted("over"));
    assert_eq!(noted("preview"), "1 41");
    assert!(noted("over time").starts_with("41 0."), "{}", noted("over time"));
    assert_eq!((noted("off"), noted("tip without")), ("0,0,0,0,0,0", "false"));
    assert_eq!((noted("on"), noted("none")), ("true,true,true,true,true,true", "0"));
    assert_eq!(noted("second tab"), "TRE");
    assert_eq!(noted("wider than the window"), "0");
    // A browser's window is no narrower than 500 pixels, so a frame in the page stands for a phone.
    let narrow = folder.path().join("phone.html");
    let frame = "<iframe src=\"report.html\" style=\"width:390px;height:800px\"></iframe><script>
        addEventListener('message', () => 0);
        const ready = setInterval(() => {
            const seen = document.querySelector('iframe').contentDocument?.body?.dataset.seen;
            if (seen) { clearInterval(ready); document.body.dataset.seen = seen; }
        }, 20);</script>";
    std::fs::write(&narrow, format!("<!DOCTYPE html><body>{frame}</body>")).unwrap();
    let seen = visit(&narrow, 1400).unwrap();
    let of_phone = |what: &str| seen.iter().find(|(key, _)| key == what).map(|(_, value)| value.as_str());
    assert_eq!(of_phone("width"), Some("390"));
    assert_eq!(of_phone("wider than the window"), Some("0"), "nothing is cut off");
    assert_eq!((of_phone("error"), of_phone("filtered")), (Some("undefined"), Some("11 of 30")));
}
