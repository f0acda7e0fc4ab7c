//! One message: a line with a kind, arguments and named values.

use std::{fmt, str::FromStr};

use super::error::{TraxError, shortened};

/// What every message begins with; other lines are chatter.
pub const PREFIX: &str = "@@TRAX:";

/// Letters that the name of a value may have at most.
const LONGEST_KEY: usize = 64;

/// What a message says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// From the tracker: what it is and understands.
    Hello,
    /// From the client: a target to track.
    Initialize,
    /// From the client: the next image.
    Frame,
    /// From the tracker: where the target is.
    State,
    /// From either: the end.
    Quit,
}

impl Kind {
    const ALL: [Self; 5] = [Self::Hello, Self::Initialize, Self::Frame, Self::State, Self::Quit];

    /// The word on the line.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Hello => "hello",
            Self::Initialize => "initialize",
            Self::Frame => "frame",
            Self::State => "state",
            Self::Quit => "quit",
        }
    }
}

/// A message. Shown, it is a line without its end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// What it says.
    pub kind: Kind,
    /// Images and regions, in order.
    pub arguments: Vec<String>,
    /// Named values, in order.
    pub properties: Vec<(String, String)>,
}

impl Message {
    /// A message of that kind without anything.
    pub fn new(kind: Kind) -> Self {
        Self { kind, arguments: Vec::new(), properties: Vec::new() }
    }

    /// With one more argument.
    pub fn with(mut self, argument: impl Into<String>) -> Self {
        self.arguments.push(argument.into());
        self
    }

    /// With one more named value.
    pub fn and(mut self, name: &str, value: impl ToString) -> Self {
        self.properties.push((name.to_owned(), value.to_string()));
        self
    }

    /// A named value.
    pub fn property(&self, name: &str) -> Option<&str> {
        self.properties.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str())
    }

    /// The message of a line, or `None` if the line is chatter.
    ///
    /// # Errors
    /// [`TraxError::BadMessage`] for a line that begins as a message and is none.
    pub fn of_line(line: &str) -> Result<Option<Self>, TraxError> {
        if line.starts_with(PREFIX) { line.parse().map(Some) } else { Ok(None) }
    }
}

impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{PREFIX}{}", self.kind.word())?;
        for argument in &self.arguments {
            write!(f, " \"{}\"", escaped(argument))?;
        }
        for (name, value) in &self.properties {
            write!(f, " \"{name}={}\"", escaped(value))?;
        }
        Ok(())
    }
}

impl FromStr for Message {
    type Err = TraxError;

    fn from_str(line: &str) -> Result<Self, TraxError> {
        let bad = |reason: &str| TraxError::BadMessage { line: shortened(line), reason: reason.to_owned() };
        let text = line.strip_prefix(PREFIX).ok_or_else(|| bad("it does not begin with @@TRAX:"))?;
        let text = text.trim_end_matches(['\n', '\r']);
        let (word, rest) = text.split_once(' ').unwrap_or((text, ""));
        let kind = Kind::ALL.into_iter().find(|kind| kind.word() == word);
        let mut message = Self::new(kind.ok_or_else(|| bad("there is no such kind of message"))?);
        for word in words(rest).ok_or_else(|| bad("a quote is not closed"))? {
            match word.split_once('=').filter(|(key, _)| is_key(key)) {
                Some((key, value)) => message.properties.push((key.to_owned(), value.to_owned())),
                None => message.arguments.push(word),
            }
        }
        Ok(message)
    }
}

fn is_key(word: &str) -> bool {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '.' || letter == '_';
    (1..=LONGEST_KEY).contains(&word.len()) && word.chars().all(is_plain)
}

fn escaped(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n").replace('\r', "")
}

/// Words between spaces, in double quotes or without; `None` if a quote is not closed.
fn words(text: &str) -> Option<Vec<String>> {
    let mut words = Vec::new();
    let mut letters = text.chars().peekable();
    loop {
        while letters.next_if(|letter| letter.is_whitespace()).is_some() {}
        let mut word = String::new();
        match letters.next() {
            None => return Some(words),
            Some('"') => loop {
                match letters.next()? {
                    '"' => break,
                    '\\' => match letters.next()? {
                        'n' => word.push('\n'),
                        other => word.push(other),
                    },
                    letter => word.push(letter),
                }
            },
            Some(first) => {
                word.push(first);
                while let Some(letter) = letters.next_if(|letter| !letter.is_whitespace()) {
                    word.push(letter);
                }
            }
        }
        words.push(word);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_message_of_the_reference_client_is_read() {
        let line =
            "@@TRAX:initialize \"file:///a b/x=1.jpg\" \"1.5,2,3,4\" \"key.a_1=some \\\"words\\\"\\nmore\"\n";
        let message = Message::of_line(line).unwrap().unwrap();
        assert_eq!(message.kind, Kind::Initialize);
        assert_eq!(message.arguments, ["file:///a b/x=1.jpg", "1.5,2,3,4"]);
        assert_eq!(message.property("key.a_1"), Some("some \"words\"\nmore"));
        assert_eq!(Message::of_line("@@TRAX:quit").unwrap(), Some(Message::new(Kind::Quit)));
    }

    #[test]
    fn other_lines_are_chatter_and_broken_ones_errors() {
        assert!(Message::of_line("loading weights ...").unwrap().is_none());
        for (line, reason) in [
            ("@@TRAX:state \"1,2,3,4", "quote"),
            ("@@TRAX:state \"1,2,3,4\\", "quote"),
            ("@@TRAX:sing", "no such kind"),
            ("@@TRAX:", "no such kind"),
        ] {
            let message = Message::of_line(line).unwrap_err().to_string();
            assert!(message.contains(reason), "{message}");
        }
    }

    proptest! {
        #[test]
        fn what_is_written_is_read_back(arguments in prop::collection::vec("[^\r=]*", 0..4), value in "[^\r]*") {
            let mut message = Message::new(Kind::Frame).and("some.key", &value);
            message.arguments = arguments;
            let line = message.to_string();
            prop_assert!(!line.contains('\n'));
            prop_assert_eq!(Message::of_line(&line).unwrap(), Some(message));
        }
    }
}
