//! What several test programs need. Each of them uses only a part.
#![allow(dead_code)]

use std::path::{Path, PathBuf};

/// A folder of the real data: below INFOPART_DATA, or below `shared/data` beside the project. Without it it says aloud
/// that the test is skipped.
pub fn data(folder: &str) -> Option<PathBuf> {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let beside = || package.ancestors().map(|up| up.join("shared/data")).find(|data| data.is_dir());
    let found =
        std::env::var_os("INFOPART_DATA").map(PathBuf::from).or_else(beside).map(|data| data.join(folder));
    match found {
        Some(found) if found.is_dir() => Some(found),
        _ => {
            skipped(&format!("no {folder}/ in the folder that INFOPART_DATA names"));
            None
        }
    }
}

/// Whether the ffmpeg program runs here. Without it it says aloud that the test is skipped.
pub fn has_ffmpeg() -> bool {
    let runs = std::process::Command::new("ffmpeg").arg("-version").output().is_ok();
    if !runs {
        skipped("the ffmpeg program is not installed");
    }
    runs
}

/// The program with these words after it: exit code, standard output, standard error.
pub fn mot(words: &[&str]) -> (i32, String, String) {
    let done = assert_cmd::Command::cargo_bin("mot").unwrap().args(words).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (done.status.code().unwrap(), text(done.stdout), text(done.stderr))
}

/// Written past the test harness, which would hide it in a test that passes.
fn skipped(why: &str) {
    use std::io::Write;
    let _ = writeln!(std::io::stderr(), "SKIPPED: {why}");
}
