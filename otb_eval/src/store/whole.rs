//! Files that are there whole or not at all, whatever happens to their writer.
//!
//! A file grows under a temporary name that its writer holds locked, is brought to the disk, and is then renamed; then its
//! folder is brought to the disk too, so that not even a loss of power leaves a file that is not whole. A temporary file
//! that nobody holds was left by a writer that was killed, and may be removed.

use std::{
    ffi::OsString,
    fs::{self, File, TryLockError},
    io::{self, Write},
    path::{Path, PathBuf},
    process,
};

const SUFFIX: &str = ".partial";

/// Writes a file, and the folders it needs, in one step: a reader sees what was there before or all of `bytes`.
///
/// # Errors
/// What the file system says.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        create_folders(folder)?;
    }
    let (mut file, temporary) = temporary_beside(path)?;
    let written = on_disk(&mut file, bytes).and_then(|()| fs::rename(&temporary, path));
    if written.is_err() {
        // The first failure is the one to tell.
        let _ = fs::remove_file(&temporary);
    }
    written.and_then(|()| sync_folder_of(path))
}

fn on_disk(file: &mut File, bytes: &[u8]) -> io::Result<()> {
    file.write_all(bytes).and_then(|()| file.sync_all())
}

/// A folder and those it is in, each entered on the disk.
pub(super) fn create_folders(folder: &Path) -> io::Result<()> {
    if folder.as_os_str().is_empty() || folder.is_dir() {
        return Ok(());
    }
    if let Some(parent) = folder.parent() {
        create_folders(parent)?;
    }
    match fs::create_dir(folder) {
        // Another process was first.
        Err(_) if folder.is_dir() => Ok(()),
        Err(error) => Err(error),
        Ok(()) => sync_folder_of(folder),
    }
}

/// Brings the names in a file's folder to the disk. Not every file system can do that with a folder.
fn sync_folder_of(path: &Path) -> io::Result<()> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !cfg!(unix) {
        return Ok(());
    }
    match File::open(folder)?.sync_all() {
        Err(error) if matches!(error.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported) => {
            Ok(())
        }
        other => other,
    }
}

/// Writes a file only if there is none; `false` if there is one already.
///
/// # Errors
/// What the file system says.
pub(super) fn write_new(path: &Path, bytes: &[u8]) -> io::Result<bool> {
    let (mut file, temporary) = temporary_beside(path)?;
    let linked = on_disk(&mut file, bytes).and_then(|()| fs::hard_link(&temporary, path));
    let removed = fs::remove_file(&temporary).and_then(|()| sync_folder_of(path));
    match linked {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(false),
        Err(error) => Err(error),
        Ok(()) => removed.map(|()| true),
    }
}

fn temporary_beside(path: &Path) -> io::Result<(File, PathBuf)> {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or(path.as_os_str()));
    name.push(format!(".{}{SUFFIX}", process::id()));
    let temporary = path.with_file_name(name);
    loop {
        let file = File::create(&temporary)?;
        file.lock()?;
        // Between the two calls another process may have taken the file for one that was left, and removed it before
        // it let the lock go.
        if temporary.exists() {
            return Ok((file, temporary));
        }
    }
}

/// Removes what killed writers left in a folder and the folders in it.
///
/// # Errors
/// What the file system says.
pub fn remove_stale(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            remove_stale(&entry.path())?;
        } else if entry.file_name().to_string_lossy().ends_with(SUFFIX) {
            remove_if_left(&entry.path())?;
        }
    }
    Ok(())
}

fn remove_if_left(path: &Path) -> io::Result<()> {
    let file = match File::open(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        other => other?,
    };
    match file.try_lock() {
        Ok(()) => match fs::remove_file(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
            other => other,
        },
        Err(TryLockError::WouldBlock) => Ok(()),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_whole_and_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/er/a.txt");
        write_whole(&path, b"one").unwrap();
        write_whole(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }

    #[test]
    fn a_new_file_is_written_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        assert!(write_new(&path, b"one").unwrap());
        assert!(!write_new(&path, b"two").unwrap());
        assert_eq!(fs::read(&path).unwrap(), b"one");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn writers_and_removers_do_not_disturb_each_other() {
        let folder = tempfile::tempdir().unwrap();
        let path = |i: usize| folder.path().join(format!("{i}.txt"));
        std::thread::scope(|scope| {
            let writer = scope.spawn(|| (0..500).try_for_each(|i| write_whole(&path(i), b"whole")));
            while !writer.is_finished() {
                // A folder that changes while it is read may name files that are gone; nothing else may fail.
                remove_stale(folder.path()).unwrap();
            }
            writer.join().unwrap().unwrap();
        });
        assert!((0..500).all(|i| path(i).exists()));
    }

    #[test]
    fn only_what_nobody_writes_any_more_is_stale() {
        let folder = tempfile::tempdir().unwrap();
        let (_held, living) = temporary_beside(&folder.path().join("sub.txt")).unwrap();
        let dead = folder.path().join(".a.txt.999999.partial");
        fs::write(&dead, "half").unwrap();
        fs::write(folder.path().join("b.txt"), "whole").unwrap();
        remove_stale(folder.path()).unwrap();
        assert!(living.exists() && !dead.exists() && folder.path().join("b.txt").exists());
    }
}
