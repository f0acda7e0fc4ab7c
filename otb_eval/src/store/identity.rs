//! `run.json`: what decides the bytes of a tracker's results, and the machine they were first made on.

use std::{fs, path::Path, thread};

use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};

use super::{StoreError, whole::write_new};
use crate::protocol::{HiddenFrames, Protocol, ShiftRules};

/// What decides the bytes of a tracker's results.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Identity {
    /// The tracker's name.
    pub tracker: String,
    /// The protocol.
    pub protocol: Protocol,
    /// Whose shifts SRE used; absent in other protocols.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shifts: Option<String>,
    /// SHA-256 of the lists of hidden frames that TRE's starts kept away from; absent in other protocols.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hidden_frames: Option<String>,
    /// The program that tracked, with its version.
    pub program: String,
    /// SHA-256 of the parameters' JSON, hexadecimal.
    pub parameters_hash: String,
    /// The parameters but for the seed.
    pub parameters: Value,
}

/// Where results were made. It decides times, not boxes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Operating system and architecture.
    pub system: String,
    /// The processor's name, where the system tells it.
    pub processor: Option<String>,
    /// Threads that can run at the same time.
    pub cores: usize,
    /// Jobs that ran at the same time.
    pub jobs: usize,
    /// Threads that each job's tracker used.
    pub threads_per_job: usize,
}

#[derive(Serialize, Deserialize)]
struct RunFile {
    #[serde(flatten)]
    identity: Identity,
    machine: Machine,
}

impl Identity {
    /// The identity of a tracker's results under a protocol.
    pub fn new(
        tracker: &str,
        program: String,
        parameters: Value,
        protocol: Protocol,
        shift_rules: ShiftRules,
        hidden: &HiddenFrames,
    ) -> Self {
        let shifts = match shift_rules {
            ShiftRules::Matlab => "matlab",
            ShiftRules::OtbPy => "otb-py",
        };
        let digest = Sha256::digest(parameters.to_string().as_bytes());
        Self {
            tracker: tracker.to_owned(),
            protocol,
            shifts: (protocol == Protocol::Sre).then(|| shifts.to_owned()),
            hidden_frames: (protocol == Protocol::Tre).then(|| hidden.digest()),
            program,
            parameters_hash: digest.iter().map(|byte| format!("{byte:02x}")).collect(),
            parameters,
        }
    }

    /// Reads `run.json` of a tracker's folder; `None` if there is none.
    ///
    /// # Errors
    /// [`StoreError::BadRunFile`], [`StoreError::Io`].
    pub fn read(folder: &Path) -> Result<Option<(Self, Machine)>, StoreError> {
        let path = folder.join(FILE);
        let text = match fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            Err(source) => return Err(StoreError::Io { path, source }),
        };
        let run: RunFile = serde_json::from_str(&text)
            .map_err(|error| StoreError::BadRunFile { path, problem: error.to_string() })?;
        Ok(Some((run.identity, run.machine)))
    }

    /// Writes `run.json` if there is none, else checks that it is of the same.
    pub(super) fn claim(&self, folder: &Path, machine: &Machine) -> Result<(), StoreError> {
        let path = folder.join(FILE);
        // In this order: `run.json` is written before any result, so another shard's is there if its results are.
        if has_results(folder) && !path.exists() {
            let what = "unknown parameters (there is no run.json)".to_owned();
            return Err(StoreError::OtherRun { path: folder.to_owned(), what });
        }
        let run = RunFile { identity: self.clone(), machine: machine.clone() };
        let text = serde_json::to_string_pretty(&run)
            .map_err(|error| StoreError::BadRunFile { path: path.clone(), problem: error.to_string() })?;
        let is_new = write_new(&path, format!("{text}\n").as_bytes());
        if is_new.map_err(|source| StoreError::Io { path, source })? {
            return Ok(());
        }
        match Self::read(folder)? {
            Some((there, _)) if there != *self => {
                let what = self.difference(&there);
                Err(StoreError::OtherRun { path: folder.to_owned(), what })
            }
            _ => Ok(()),
        }
    }

    /// In what the results that are there differ.
    fn difference(&self, there: &Self) -> String {
        if self.program != there.program {
            return format!("{}, and this is {}", there.program, self.program);
        }
        if self.shifts != there.shifts {
            let name = |shifts: &Option<String>| shifts.clone().unwrap_or_default();
            return format!("the shifts of {}, not of {}", name(&there.shifts), name(&self.shifts));
        }
        if self.hidden_frames != there.hidden_frames {
            return "other starts: with other lists of hidden frames, or with none as older versions had it"
                .to_owned();
        }
        let here = self.parameters.as_object();
        let changed = there.parameters.as_object().into_iter().flatten().find_map(|(key, value)| {
            let now = here.and_then(|here| here.get(key)).unwrap_or(&Value::Null);
            (now != value).then(|| format!("other parameters (`{key}` is {value} there and {now} here)"))
        });
        changed.unwrap_or_else(|| "other parameters".to_owned())
    }
}

const FILE: &str = "run.json";

/// Whether a tracker's folder has that of a seed.
fn has_results(folder: &Path) -> bool {
    let is_seed = |entry: fs::DirEntry| entry.file_name().to_string_lossy().starts_with("seed_");
    fs::read_dir(folder).is_ok_and(|entries| entries.flatten().any(is_seed))
}

impl Machine {
    /// This machine.
    pub fn here(jobs: usize, threads_per_job: usize) -> Self {
        let processor = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
            let line = text.lines().find(|line| line.starts_with("model name"))?;
            Some(line.split_once(':')?.1.trim().to_owned())
        });
        Self {
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            processor,
            cores: thread::available_parallelism().map_or(1, usize::from),
            jobs,
            threads_per_job,
        }
    }
}
