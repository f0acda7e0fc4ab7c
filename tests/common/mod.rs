//! What several test programs need. Each of them uses only a part.
#![allow(dead_code)]

use std::path::{Path, PathBuf};

/// Where the real sequences are: INFOPART_DATA, or `shared/data` beside the project (or beside a
/// folder that it is in). Without them it says aloud that
/// the test is skipped.
pub fn data_dir() -> Option<PathBuf> {
    let beside = |folder: &Path| folder.join("shared/data");
    let found = std::env::var_os("INFOPART_DATA").map(PathBuf::from).unwrap_or_else(|| {
        let package = Path::new(env!("CARGO_MANIFEST_DIR"));
        let found = package.ancestors().map(beside).find(|data| data.join("otb").is_dir());
        found.unwrap_or_else(|| beside(package.parent().unwrap_or(package)))
    });
    if found.join("otb").is_dir() {
        return Some(found);
    }
    skipped(&format!("no data at {}; set INFOPART_DATA to the folder that has otb/", found.display()));
    None
}

/// Whether the ffmpeg program runs here. Without it it says aloud that the test is skipped.
pub fn has_ffmpeg() -> bool {
    let runs = std::process::Command::new("ffmpeg").arg("-version").output().is_ok();
    if !runs {
        skipped("the ffmpeg program is not installed");
    }
    runs
}

/// Written past the test harness, which would hide it in a test that passes.
fn skipped(why: &str) {
    use std::io::Write;
    let _ = writeln!(std::io::stderr(), "SKIPPED: {why}");
}
