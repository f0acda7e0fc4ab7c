//! The table of targets, `tb100.tsv`, read once.

use std::sync::LazyLock;

use super::{Attribute, AttributeSet, Known};

static TARGETS: LazyLock<Vec<Known>> =
    LazyLock::new(|| include_str!("tb100.tsv").lines().filter_map(target).collect());

/// The 100 targets, by name.
pub fn all() -> &'static [Known] {
    &TARGETS
}

/// A line of the table; `None` for a comment. That every other line gives a target is tested.
fn target(line: &'static str) -> Option<Known> {
    let columns: Vec<&str> = line.split('\t').collect();
    let [name, folder, target, first, last, rows, lists, tb100, json] = columns[..] else { return None };
    let in_list = |list: &str| lists.split(',').any(|one| one == list);
    let in_tb100_txt = attributes(tb100)?;
    Some(Known {
        name,
        folder,
        target: target.parse().ok(),
        first_frame: first.parse().ok()?,
        last_frame: last.parse().ok()?,
        digits: first.len(),
        rows: rows.parse().ok()?,
        in_tb50: in_list("tb50"),
        in_cvpr13: in_list("cvpr13"),
        is_person: in_list("person"),
        in_tb100_txt,
        in_json: if json == "=" { in_tb100_txt } else { attributes(json)? },
    })
}

fn attributes(codes: &str) -> Option<AttributeSet> {
    codes.split(' ').map(|code| code.parse::<Attribute>().ok()).collect()
}
