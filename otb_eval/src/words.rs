//! Words of messages: without what a terminal would obey, and without flags of another program.

use infopart::sequence::SequenceError;

/// With control characters of files and names escaped.
pub(crate) fn printable(text: &str) -> String {
    let escaped = |letter: char| {
        if letter.is_control() { letter.escape_default().to_string() } else { letter.to_string() }
    };
    text.chars().map(escaped).collect()
}

/// What is wrong with a sequence, without the flags that only `infopart track` has.
pub(crate) fn of_sequence(error: &SequenceError) -> String {
    match error {
        SequenceError::StartBeyondEnd { input, frames, .. } => {
            let input = printable(input);
            format!(
                "{input} has only {frames} frames, fewer than its ground truth has rows; run `otb_eval check {input}`"
            )
        }
        _ => without_flags(&error.to_string()),
    }
}

/// A message of the tracking library's, without the flags that only `infopart track` has.
pub(crate) fn without_flags(text: &str) -> String {
    printable(text).replace(", or leave it out with --start and --end", "").replace(
        "check --start and --end, and that the input holds frames",
        "check that the folder holds frames",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_a_terminal_obeys_and_no_flag_of_another_program_is_left() {
        assert_eq!(printable("a\u{1b}[2J\tb\u{7f}é"), "a\\u{1b}[2J\\tb\\u{7f}é");
        let path = std::path::PathBuf::from("img/0003.jpg");
        let image = of_sequence(&SequenceError::BadImage { path, reason: "it is cut".into() });
        assert_eq!(image, "img/0003.jpg: cannot be decoded: it is cut; replace the file");
        let input = "otb/Deer".to_owned();
        let short = of_sequence(&SequenceError::StartBeyondEnd { input, start: 9, frames: 5 });
        assert!(short.contains("has only 5 frames") && !short.contains("--"), "{short}");
        assert!(
            !without_flags("no frame: check --start and --end, and that the input holds frames")
                .contains("--")
        );
    }
}
