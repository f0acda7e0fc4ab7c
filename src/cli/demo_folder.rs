//! The demo's folder: what is in it, and that nothing there is touched which the demo did not write.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result};
use infopart::{program::BadInput, sequence::Walker};

/// How the file begins that says that the folder is the demo's.
const SIGNATURE: &str = "Made by `infopart demo`";

const ABOUT: &str = ", which overwrites it when it runs again: keep nothing of your own here.

walker/             a rendered walking person as an OTB folder: img/ and the exact groundtruth_rect.txt
leaving/            another, who is away for a while
results/            the boxes that were tracked, x,y,w,h a frame, the first pixel being 1,1
contact_sheet.png   frames of each, annotated
";

/// Where the demo's files are.
pub struct DemoFolder {
    root: PathBuf,
}

impl DemoFolder {
    /// Makes the folder, or takes it over from an earlier demo that rendered at most so many frames of either scene.
    pub fn claim(root: &Path, walker_frames: usize, leaving_frames: usize) -> Result<Self> {
        let folder = Self { root: root.to_owned() };
        if !folder.is_free().with_context(|| unreadable(root))? {
            folder.refuse_foreign_pictures([
                (folder.walker(), walker_frames),
                (folder.leaving(), leaving_frames),
            ])?;
        }
        fs::create_dir_all(folder.results()).map_err(|error| unwritable(&folder.results(), &error))?;
        let about = folder.about();
        fs::write(&about, format!("{SIGNATURE}{ABOUT}")).map_err(|error| unwritable(&about, &error))?;
        Ok(folder)
    }

    pub fn walker(&self) -> PathBuf {
        self.root.join("walker")
    }

    pub fn leaving(&self) -> PathBuf {
        self.root.join("leaving")
    }

    pub fn result(&self, tracker: &str) -> PathBuf {
        self.results().join(format!("{tracker}.txt"))
    }

    pub fn contact_sheet(&self) -> PathBuf {
        self.root.join("contact_sheet.png")
    }

    pub fn annotated(&self) -> PathBuf {
        self.root.join("annotated")
    }

    fn results(&self) -> PathBuf {
        self.root.join("results")
    }

    fn about(&self) -> PathBuf {
        self.root.join("ABOUT.txt")
    }

    /// Whether there is nothing yet that could be lost.
    fn is_free(&self) -> io::Result<bool> {
        match fs::read_dir(&self.root) {
            Ok(mut entries) => Ok(entries.next().is_none()),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(true),
            Err(error) => Err(error),
        }
    }

    /// A scene replaces its frames and deletes those behind the last, so all pictures there must be the demo's own.
    fn refuse_foreign_pictures(&self, scenes: [(PathBuf, usize); 2]) -> Result<()> {
        let is_ours = fs::read_to_string(self.about()).is_ok_and(|text| text.starts_with(SIGNATURE));
        if !is_ours {
            return Err(foreign(&self.root));
        }
        for (scene, frames) in scenes {
            let Ok(entries) = fs::read_dir(scene.join("img")) else { continue };
            for entry in entries {
                let path = entry.with_context(|| unreadable(&scene))?.path();
                if !(1..=frames).any(|number| path.ends_with(Walker::image_name(number))) {
                    return Err(foreign(&path));
                }
            }
        }
        Ok(())
    }
}

fn foreign(path: &Path) -> anyhow::Error {
    let path = path.display();
    BadInput(format!(
        "--out: {path} is there already and was not made by `infopart demo`, which only replaces its own files; move \
         it away, or give a new folder with --out DIR"
    ))
    .into()
}

fn unreadable(path: &Path) -> BadInput {
    BadInput(format!(
        "--out: {} cannot be read as a folder; give a new folder with --out DIR",
        path.display()
    ))
}

fn unwritable(path: &Path, error: &io::Error) -> BadInput {
    BadInput(format!(
        "--out: {}: cannot be written: {error}; choose another folder with --out DIR",
        path.display()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_an_empty_and_its_own_folder_are_taken() {
        let empty = tempfile::tempdir().unwrap();
        let new = empty.path().join("new/deep");
        for _ in 0..2 {
            let folder = DemoFolder::claim(&new, 150, 280).unwrap();
            fs::create_dir_all(folder.walker().join("img")).unwrap();
            fs::write(folder.walker().join("img/0150.jpg"), "").unwrap();
        }
        let empty = tempfile::tempdir().unwrap();
        DemoFolder::claim(empty.path(), 150, 280).unwrap();
    }

    #[test]
    fn what_the_demo_did_not_write_is_refused_and_left() {
        let root = tempfile::tempdir().unwrap();
        let images = root.path().join("walker/img");
        fs::create_dir_all(&images).unwrap();
        let mine = images.join("0151.jpg");
        fs::write(&mine, "mine").unwrap();
        for marked in [false, true] {
            if marked {
                fs::write(root.path().join("ABOUT.txt"), SIGNATURE).unwrap();
            }
            let Err(error) = DemoFolder::claim(root.path(), 150, 280) else { panic!("taken over") };
            assert!(error.is::<BadInput>());
            assert!(error.to_string().contains("--out DIR"), "{error}");
            assert_eq!(error.to_string().contains("0151.jpg"), marked);
            assert_eq!(fs::read_to_string(&mine).unwrap(), "mine");
        }
    }
}
