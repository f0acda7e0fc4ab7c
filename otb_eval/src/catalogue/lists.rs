//! Lists of sequences by name.

use std::str::FromStr;

use super::{CatalogueError, Known, all, find};

/// A list that has a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SequenceList {
    /// All 100 targets.
    Tb100,
    /// The 50 harder ones, which pysot calls OTB50.
    Tb50,
    /// The 51 targets of the benchmark's first version (CVPR 2013), which others call OTB50.
    Cvpr13,
    /// The 36 targets that are persons.
    Person,
    /// Eight sequences of people, two of them not from TB-100.
    People8,
    /// Eleven more of people, six of them not from TB-100.
    People11,
    /// `people8` and `people11`.
    People19,
    /// Seven sequences of other targets.
    Other7,
    /// `other7` and five more, two of them not from TB-100.
    Others12,
    /// Three of TLD, in two of which the target is absent for a while.
    Longterm,
}

const PEOPLE8: [&str; 8] =
    ["Crossing", "Walking2", "David3", "Jogging-1", "Jogging-2", "Couple", "pedestrian1", "person11"];
const PEOPLE11: [&str; 11] = [
    "Woman",
    "Bolt",
    "Singer2",
    "Skating1",
    "Human3",
    "pedestrian2",
    "campus2",
    "campus3",
    "campus4",
    "campus5",
    "campus7",
];
const OTHER7: [&str; 7] = ["Deer", "David", "DragonBaby", "FaceOcc1", "Freeman1", "Football1", "Diving"];
const OTHERS5: [&str; 5] = ["boat1", "Bird2", "Man", "bag", "MotorRolling"];
const LONGTERM: [&str; 3] = ["pedestrian1", "pedestrian2", "car"];

impl SequenceList {
    /// All lists.
    pub const ALL: [Self; 10] = [
        Self::Tb100,
        Self::Tb50,
        Self::Cvpr13,
        Self::Person,
        Self::People8,
        Self::People11,
        Self::People19,
        Self::Other7,
        Self::Others12,
        Self::Longterm,
    ];

    /// The name in flags.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tb100 => "tb100",
            Self::Tb50 => "tb50",
            Self::Cvpr13 => "cvpr13",
            Self::Person => "person",
            Self::People8 => "people8",
            Self::People11 => "people11",
            Self::People19 => "people19",
            Self::Other7 => "other7",
            Self::Others12 => "others12",
            Self::Longterm => "longterm",
        }
    }

    /// The sequences in it.
    pub fn sequences(self) -> Vec<&'static str> {
        let known =
            |is_in: fn(&Known) -> bool| all().iter().filter(|one| is_in(one)).map(|one| one.name).collect();
        match self {
            Self::Tb100 => known(|_| true),
            Self::Tb50 => known(|one| one.in_tb50),
            Self::Cvpr13 => known(|one| one.in_cvpr13),
            Self::Person => known(|one| one.is_person),
            Self::People8 => PEOPLE8.to_vec(),
            Self::People11 => PEOPLE11.to_vec(),
            Self::People19 => [&PEOPLE8[..], &PEOPLE11[..]].concat(),
            Self::Other7 => OTHER7.to_vec(),
            Self::Others12 => [&OTHER7[..], &OTHERS5[..]].concat(),
            Self::Longterm => LONGTERM.to_vec(),
        }
    }
}

impl FromStr for SequenceList {
    type Err = CatalogueError;

    fn from_str(word: &str) -> Result<Self, CatalogueError> {
        let is_meant = |list: &Self| list.name().eq_ignore_ascii_case(word);
        Self::ALL.into_iter().find(is_meant).ok_or_else(|| CatalogueError::List { word: word.to_owned() })
    }
}

/// The sequences that a comma-separated mix of lists and names in any toolkit's spelling stands for, each once, in their
/// order. A name that is not TB-100's stays as it is: it may be a sequence of the user's own.
///
/// # Errors
/// [`CatalogueError::NoSequence`] if there is none.
pub fn select(words: &str) -> Result<Vec<String>, CatalogueError> {
    let mut selected: Vec<String> = Vec::new();
    for word in words.split(',').map(str::trim).filter(|word| !word.is_empty()) {
        let names = match word.parse::<SequenceList>() {
            Ok(list) => list.sequences(),
            Err(_) => vec![find(word).map_or(word, |known| known.name)],
        };
        for name in names {
            if !selected.iter().any(|one| one == name) {
                selected.push(name.to_owned());
            }
        }
    }
    if selected.is_empty() {
        return Err(CatalogueError::NoSequence { words: words.to_owned() });
    }
    Ok(selected)
}
