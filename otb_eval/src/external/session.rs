//! A conversation with a tracker, as its TraX client.

use std::{fmt, path::Path, time::Duration};

use infopart::{
    geometry::Rect,
    trax::{Kind, Message, parse_region, rectangle},
};

use super::{
    ExternalOptions, Introduction,
    process::{Heard, Process},
};
use crate::words::printable;

/// Why a conversation cannot go on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Trouble {
    /// The evaluation called it off.
    CalledOff,
    /// Something is wrong with the tracker.
    Broken(String),
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CalledOff => f.write_str("it was stopped"),
            Self::Broken(reason) => f.write_str(reason),
        }
    }
}

/// What a tracker answered to a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct State {
    pub box_in_frame: Rect,
    /// Seconds that it says it took itself.
    pub own_seconds: Option<f64>,
    /// How sure it says that it is.
    pub confidence: Option<f64>,
    /// Whether it says that the target is lost.
    pub is_lost: bool,
}

/// A running tracker and how it wants to be spoken to.
pub(super) struct Session<'a> {
    process: Process,
    timeout: Duration,
    called_off: &'a dyn Fn() -> bool,
    hello: Option<Message>,
}

impl<'a> Session<'a> {
    /// Starts the command; the tracker has not said anything yet.
    pub fn start(
        command: &str,
        options: &ExternalOptions,
        seed: u64,
        called_off: &'a dyn Fn() -> bool,
    ) -> Result<Self, Trouble> {
        let process = Process::start(command, options, seed)
            .map_err(|error| Trouble::Broken(format!("it cannot be started: {error}")))?;
        Ok(Self { process, timeout: options.answer_timeout, called_off, hello: None })
    }

    /// Hears what the tracker says of itself, and whether it can be spoken to.
    pub fn introduction(&mut self) -> Result<Introduction, Trouble> {
        let hello = self.expect(Kind::Hello, "at its introduction")?;
        let takes = |name: &str, what: &str| {
            hello.property(name).is_none_or(|list| list.split([';', ',']).any(|word| word.trim() == what))
        };
        if !takes("trax.image", "path") {
            return Err(Trouble::Broken("it takes no paths of images, and nothing else is sent".to_owned()));
        }
        if !takes("trax.channels", "color") {
            return Err(Trouble::Broken("it wants other images than colour ones".to_owned()));
        }
        if !takes("trax.region", "rectangle") && !takes("trax.region", "polygon") {
            return Err(Trouble::Broken("it takes neither rectangles nor polygons".to_owned()));
        }
        let word = |name: &str| printable(hello.property(name).unwrap_or_default());
        let introduction = Introduction { name: word("trax.name"), identifier: word("trax.identifier") };
        self.hello = Some(hello);
        Ok(introduction)
    }

    /// Starts on an image with the target in a box.
    pub fn initialize(&mut self, image: &Path, box_in_frame: Rect) -> Result<State, Trouble> {
        let property = |name| self.hello.as_ref().and_then(|hello| hello.property(name));
        let version = property("trax.version").and_then(|version| version.parse::<u32>().ok()).unwrap_or(1);
        let takes_rectangles = property("trax.region").is_none_or(|list| list.contains("rectangle"));
        let region = if takes_rectangles { rectangle(box_in_frame) } else { corners(box_in_frame) };
        if version < 4 {
            let message = Message::new(Kind::Initialize).with(address(image)).with(region);
            self.say(&message, "at its first frame")?;
        } else {
            self.say(&Message::new(Kind::Initialize).with(region), "at its first frame")?;
            self.say(&Message::new(Kind::Frame).with(address(image)), "at its first frame")?;
        }
        self.state("at its first frame")
    }

    /// Finds the target in the next image, which the message calls `what`.
    pub fn frame(&mut self, image: &Path, what: &str) -> Result<State, Trouble> {
        self.say(&Message::new(Kind::Frame).with(address(image)), what)?;
        self.state(what)
    }

    /// Ends it in peace.
    pub fn quit(&mut self) {
        // All is done; whether it hears it does not matter.
        let _ = self.process.say(&Message::new(Kind::Quit).to_string());
        self.process.end();
    }

    fn state(&mut self, what: &str) -> Result<State, Trouble> {
        let message = self.expect(Kind::State, what)?;
        let broken = |reason: String| Trouble::Broken(format!("its answer {what} {reason}"));
        let [region] = &message.arguments[..] else {
            return Err(broken(format!("has {} regions instead of one", message.arguments.len())));
        };
        let box_in_frame = parse_region(region)
            .map_err(|error| broken(format!("is no box: {}", printable(&error.to_string()))))?;
        let number = |name: &str| {
            let number = message.property(name).and_then(|text| text.parse().ok());
            number.filter(|number: &f64| number.is_finite())
        };
        let own_seconds = number("time").filter(|seconds| *seconds >= 0.0);
        Ok(State {
            box_in_frame,
            own_seconds,
            confidence: number("confidence"),
            is_lost: message.property("status") == Some("lost"),
        })
    }

    fn say(&mut self, message: &Message, what: &str) -> Result<(), Trouble> {
        match self.process.say(&message.to_string()) {
            Ok(()) => Ok(()),
            Err(_) => Err(self.ended(what)),
        }
    }

    fn expect(&mut self, kind: Kind, what: &str) -> Result<Message, Trouble> {
        let heard = self.process.hear(self.timeout, self.called_off);
        match heard {
            Err(error) => Err(Trouble::Broken(format!("its output cannot be read {what}: {error}"))),
            Ok(Heard::CalledOff) => Err(Trouble::CalledOff),
            Ok(Heard::End) => Err(self.ended(what)),
            Ok(Heard::Silence) => {
                let seconds = self.timeout.as_secs_f64();
                Err(Trouble::Broken(format!(
                    "it did not answer {what} within {seconds} seconds; give it more with --frame-timeout"
                )))
            }
            Ok(Heard::Line(line)) => match line.parse::<Message>() {
                Ok(message) if message.kind == kind => Ok(message),
                Ok(message) if message.kind == Kind::Quit => {
                    let reason = message.property("trax.reason").map(printable);
                    let reason = reason.unwrap_or_else(|| self.process.last_words());
                    Err(Trouble::Broken(format!("it quit {what}: {reason}")))
                }
                Ok(message) => Err(Trouble::Broken(format!(
                    "it said `{}` {what}, where `{}` was due",
                    message.kind.word(),
                    kind.word()
                ))),
                Err(error) => Err(Trouble::Broken(format!("{what}: {}", printable(&error.to_string())))),
            },
        }
    }

    fn ended(&mut self, what: &str) -> Trouble {
        Trouble::Broken(format!("it ended {what}: {}", self.process.last_words()))
    }
}

fn address(image: &Path) -> String {
    format!("file://{}", image.display())
}

/// A box as a polygon.
fn corners(Rect { x, y, w, h }: Rect) -> String {
    let (right, bottom) = (x + w, y + h);
    format!("{x},{y},{right},{y},{right},{bottom},{x},{bottom}")
}
