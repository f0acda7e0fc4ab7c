//! The names of sequences as each toolkit writes them.

use std::{collections::HashMap, sync::LazyLock};

use super::{Known, all};

/// A toolkit's way to write names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dialect {
    /// The Python benchmark and pysot: `Jogging-1`, `Human4-2`.
    Benchmark,
    /// pytracking: `Jogging_1`, `Human4_2`.
    Pytracking,
    /// got10k: `Jogging.1`, but `Human4`.
    Got10k,
    /// VOT: `Jogging1`, but `Skating2_1` and `Human4`.
    Vot,
    /// The MATLAB benchmark's result files: `jogging-1`, `carDark`.
    Matlab,
}

impl Dialect {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Benchmark, Self::Pytracking, Self::Got10k, Self::Vot, Self::Matlab];
}

impl Known {
    /// The name in a toolkit's files.
    pub fn spelling(&self, dialect: Dialect) -> String {
        let (folder, number) = match self.name.rsplit_once('-') {
            Some((folder, number)) => (folder, Some(number)),
            None => (self.name, None),
        };
        let numbered = |between: &str| match number {
            Some(number) => format!("{folder}{between}{number}"),
            None => folder.to_owned(),
        };
        match dialect {
            Dialect::Benchmark => self.name.to_owned(),
            Dialect::Pytracking => numbered("_"),
            Dialect::Got10k | Dialect::Vot if folder == "Human4" => folder.to_owned(),
            Dialect::Got10k => numbered("."),
            Dialect::Vot if folder == "Jogging" => numbered(""),
            Dialect::Vot => numbered("_"),
            Dialect::Matlab => with_small_first_letter(self.name),
        }
    }
}

fn with_small_first_letter(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}

/// Every spelling in small letters, since the archived scores even have `BasketBall`.
static SPELLINGS: LazyLock<HashMap<String, &'static Known>> = LazyLock::new(|| {
    let spelled = |known: &'static Known| {
        Dialect::ALL.map(|dialect| (known.spelling(dialect).to_ascii_lowercase(), known))
    };
    all().iter().flat_map(spelled).collect()
});

/// The target of TB-100 that a name in any toolkit's spelling means.
pub fn find(name: &str) -> Option<&'static Known> {
    SPELLINGS.get(name.to_ascii_lowercase().as_str()).copied()
}
