//! Parts that several sections of the page are made of.

use crate::plots::{Style, escape};

/// A short line in a tracker's colour and dashes.
pub(super) fn sample(place: usize) -> String {
    let dashes: Vec<String> = Style::of(place).dashes().iter().map(f64::to_string).collect();
    let dashes =
        if dashes.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{}\"", dashes.join(" ")) };
    format!(
        "<svg class=\"key s{place}\" viewBox=\"0 0 34 8\" aria-hidden=\"true\"><path d=\"M0 4H34\"{dashes}/></svg>"
    )
}

/// How one of several panels is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Choice {
    /// By a button each; paper has them all, one after another.
    Tabs,
    /// By a list with this label; paper has the one that is shown.
    Select(&'static str),
    /// By a list with this label; paper has them all.
    SelectOfAll(&'static str),
}

/// Panels of a title and a content that the script shows one at a time.
pub(super) fn panels<'a>(choice: Choice, panels: impl Iterator<Item = (&'a str, String)>) -> String {
    let panels: String = panels
        .map(|(title, content)| {
            format!("<div class=\"panel\">\n<h3>{}</h3>\n{content}</div>\n", escape(title))
        })
        .collect();
    if panels.is_empty() {
        return panels;
    }
    match choice {
        Choice::Tabs => format!("<div class=\"tabs\">\n{panels}</div>\n"),
        Choice::Select(label) => {
            format!("<div class=\"tabs one\" data-select=\"{label}\">\n{panels}</div>\n")
        }
        Choice::SelectOfAll(label) => {
            format!("<div class=\"tabs\" data-select=\"{label}\">\n{panels}</div>\n")
        }
    }
}
