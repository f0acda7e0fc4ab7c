//! The order a person expects of numbered files: 2.jpg before 10.jpg.

use std::cmp::Ordering;

/// Compares names piece by piece, runs of digits by their value; names that differ only in leading zeros are
/// ordered as text.
pub(super) fn natural_order(a: &str, b: &str) -> Ordering {
    let (mut rest_a, mut rest_b) = (a, b);
    while !rest_a.is_empty() && !rest_b.is_empty() {
        let (piece_a, after_a) = first_piece(rest_a);
        let (piece_b, after_b) = first_piece(rest_b);
        let order = compare_pieces(piece_a, piece_b);
        if order != Ordering::Equal {
            return order;
        }
        (rest_a, rest_b) = (after_a, after_b);
    }
    rest_a.len().cmp(&rest_b.len()).then_with(|| a.cmp(b))
}

/// The last run of digits in a file's stem, if it has one that fits.
pub(super) fn number_in_name(stem: &str) -> Option<usize> {
    let end = stem.rfind(|c: char| c.is_ascii_digit())? + 1;
    let start =
        stem[..end].rfind(|c: char| !c.is_ascii_digit()).map_or(0, |at| at + last_char_len(&stem[..end], at));
    stem[start..end].parse().ok()
}

fn last_char_len(text: &str, at: usize) -> usize {
    text[at..].chars().next().map_or(1, char::len_utf8)
}

fn first_piece(text: &str) -> (&str, &str) {
    let digits = text.starts_with(|c: char| c.is_ascii_digit());
    let end = text.find(|c: char| c.is_ascii_digit() != digits).unwrap_or(text.len());
    text.split_at(end)
}

fn compare_pieces(a: &str, b: &str) -> Ordering {
    if !(a.starts_with(|c: char| c.is_ascii_digit()) && b.starts_with(|c: char| c.is_ascii_digit())) {
        return a.cmp(b);
    }
    // Compared as text, numbers of any length have a value.
    let (a, b) = (a.trim_start_matches('0'), b.trim_start_matches('0'));
    a.len().cmp(&b.len()).then_with(|| a.cmp(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_ordered_by_value_and_the_rest_as_text() {
        let mut names =
            ["f10.jpg", "f2.jpg", "f002b.jpg", "e99999999999999999999999.png", "f02.jpg", "f1.png", "f1.jpg"];
        names.sort_by(|a, b| natural_order(a, b));
        assert_eq!(
            names,
            ["e99999999999999999999999.png", "f1.jpg", "f1.png", "f02.jpg", "f2.jpg", "f002b.jpg", "f10.jpg"]
        );
    }

    #[test]
    fn a_name_equals_only_itself() {
        assert_eq!(natural_order("a01", "a01"), Ordering::Equal);
        assert_ne!(natural_order("a01", "a1"), Ordering::Equal);
        assert_eq!(natural_order("a", "a1"), Ordering::Less);
    }

    #[test]
    fn the_number_of_a_frame_is_the_last_in_its_name() {
        assert_eq!(number_in_name("0300"), Some(300));
        assert_eq!(number_in_name("cam2_é0017x"), Some(17));
        assert_eq!(number_in_name("frame"), None);
    }
}
