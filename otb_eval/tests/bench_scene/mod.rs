//! Tiny data for whole-program tests of `otb_eval`, and the program run on it.
#![allow(dead_code)]

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

use infopart::sequence::{Walker, WalkerOptions};
use tempfile::TempDir;

/// A temporary folder with what a test puts there.
pub struct Scene {
    folder: TempDir,
}

/// What the program did.
pub struct Outcome {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Scene {
    pub fn empty() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    /// Walkers in `data/`: Ann, Bob and Cid, of 24, 20 and 16 frames; and a fast tracker in `fast.toml`.
    pub fn with_walkers() -> Self {
        let scene = Self::empty();
        for (seed, (name, frames)) in (1..).zip([("Ann", 24), ("Bob", 20), ("Cid", 16)]) {
            let options = WalkerOptions { width: 96, height: 96, frames, seed, ..WalkerOptions::default() };
            Walker::new(options).write_otb_folder(&scene.path("data").join(name)).unwrap();
        }
        scene.write("fast.toml", "particles = 60\nparticle_sets = 1\n");
        scene
    }

    /// Boxes of three sequences in `boxes.json`, six frames each, and results of `good` and `other` in `results/`.
    pub fn with_results() -> Self {
        let scene = Self::empty();
        let rows = ["[10, 20, 30, 40]"; 6].join(", ");
        let entry = |name: &str| format!("\"{name}\": {{\"gt_rect\": [{rows}]}}");
        scene.write("boxes.json", &format!("{{{}}}", ["Ann", "Bob", "Cid"].map(entry).join(", ")));
        for tracker in ["good", "other"] {
            for name in ["Ann", "Bob", "Cid"] {
                scene.write(&format!("results/{tracker}/{name}.txt"), &"10,20,30,40\n".repeat(6));
            }
        }
        scene
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file, and the folders it needs.
    pub fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// `otb_eval` with the words of a line, in the scene's folder.
    pub fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_otb_eval"));
        command.args(line.split_whitespace()).current_dir(self.folder.path()).stdin(Stdio::null());
        command
    }

    pub fn run(&self, line: &str) -> Outcome {
        let output = self.command(line).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        let code = output.status.code().unwrap_or(-1);
        let outcome = Outcome { code, stdout: text(output.stdout), stderr: text(output.stderr) };
        assert!(!outcome.stderr.contains("panicked"), "{line}: {}", outcome.stderr);
        self.knows_its_flags(line, &outcome.stderr);
        outcome
    }

    /// That messages of a command name no flag that it lacks, but for those of other commands that they quote whole.
    #[track_caller]
    fn knows_its_flags(&self, line: &str, told: &str) {
        let quoted_commands = |(place, part): (usize, &str)| place % 2 == 0 || !part.starts_with("otb_eval ");
        let own: Vec<&str> =
            told.split('`').enumerate().filter(|one| quoted_commands(*one)).map(|(_, part)| part).collect();
        let is_flag = |word: &str| word.starts_with("--") && word.len() > 2;
        let bare = |word: &str| {
            word.split(|c: char| !(c.is_ascii_alphanumeric() || c == '-')).next().unwrap().to_owned()
        };
        let flags = |text: &str| -> std::collections::BTreeSet<String> {
            let words = text.split(|c: char| c.is_whitespace() || "([`,:;".contains(c));
            words.filter(|word| is_flag(word)).map(bare).collect()
        };
        let Some(command) = line.split_whitespace().next().filter(|command| !command.starts_with('-')) else {
            return;
        };
        let named = flags(&own.join(" "));
        if named.is_empty() {
            return;
        }
        let help = self.command(&format!("{command} --help")).output().unwrap().stdout;
        let known = flags(&String::from_utf8(help).unwrap());
        let given = flags(line);
        let lacking: Vec<&String> =
            named.iter().filter(|flag| !known.contains(*flag) && !given.contains(*flag)).collect();
        assert!(lacking.is_empty(), "{line}: `{command}` lacks {lacking:?}, which it names: {told}");
    }

    /// Runs the program, which must exit with 0.
    #[track_caller]
    pub fn accepts(&self, line: &str) -> Outcome {
        let outcome = self.run(line);
        assert_eq!(outcome.code, 0, "{line}: {}", outcome.stderr);
        outcome
    }

    /// Runs the program, which must exit with 2 and say every one of `needles` on standard error.
    #[track_caller]
    pub fn refuses(&self, line: &str, needles: &[&str]) -> Outcome {
        let outcome = self.run(line);
        assert_eq!(outcome.code, 2, "{line}: {}", outcome.stderr);
        for needle in needles {
            assert!(outcome.stderr.contains(needle), "{line}: `{needle}` is not in: {}", outcome.stderr);
        }
        outcome
    }

    /// All files below a folder with their bytes, but for times and the machine part of `run.json`.
    pub fn reproducible(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let root = self.path(folder);
        let mut files = BTreeMap::new();
        collect(&root, &root, &mut files);
        files.retain(|name, _| !name.ends_with("_time.txt"));
        for (name, bytes) in &mut files {
            if name.ends_with("run.json") {
                let mut run: serde_json::Value = serde_json::from_slice(bytes).unwrap();
                assert!(run.as_object_mut().unwrap().remove("machine").is_some());
                *bytes = run.to_string().into_bytes();
            }
        }
        files
    }
}

/// Files below a folder, by their path in it.
pub fn collect(root: &Path, folder: &Path, files: &mut BTreeMap<String, Vec<u8>>) {
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(root, &path, files);
        } else if let Ok(bytes) = fs::read(&path) {
            files.insert(path.strip_prefix(root).unwrap().to_string_lossy().into_owned(), bytes);
        }
    }
}
