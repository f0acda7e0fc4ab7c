//! A tracker as a TraX server.
//!
//! Steps:
//! 1. `hello`, with what the tracker is and understands,
//! 2. `initialize` with a region, and with an image or with one that follows in `frame`: a new target,
//! 3. `frame` with an image: the next one,
//! 4. after 2 and 3 `state`, with the box, confidence, status and seconds that the tracker took,
//! 5. `quit`, or the end of the input.

use std::{
    io::{BufRead, Write},
    time::Instant,
};

use crate::{
    geometry::Rect,
    tracker::{Estimate, Status, Tracker},
};

use super::{
    error::TraxError,
    image,
    message::{Kind, Message},
    region::{parse_region, rectangle},
};

/// The version of the protocol that the server speaks; it understands earlier clients too.
const VERSION: u32 = 4;

/// How a server introduces itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct About {
    /// The tracker's name.
    pub name: String,
    /// The tracker's version or parameters.
    pub identifier: String,
}

/// Serves `tracker` until the client says `quit` or goes away. Lines that are no messages are passed over.
///
/// # Errors
/// [`TraxError`] for a message that cannot be understood or that the tracker refuses; the client has then been told `quit`
/// with the reason.
pub fn serve(
    input: impl BufRead,
    mut output: impl Write,
    tracker: &mut dyn Tracker,
    about: &About,
) -> Result<(), TraxError> {
    let hello = Message::new(Kind::Hello)
        .and("trax.version", VERSION)
        .and("trax.name", &about.name)
        .and("trax.identifier", &about.identifier)
        .and("trax.image", "path;memory;data;")
        .and("trax.region", "rectangle;polygon;")
        .and("trax.channels", "color");
    send(&mut output, &hello)?;
    let mut target = Target::Nobody;
    for line in input.lines() {
        let answer = Message::of_line(&line?).and_then(|message| match message {
            Some(message) => target.hear(&message, tracker),
            None => Ok(Answer::Silence),
        });
        match answer {
            Ok(Answer::Silence) => {}
            Ok(Answer::State(state)) => send(&mut output, &state)?,
            Ok(Answer::End) => return Ok(()),
            Err(error) => {
                // The client may be gone; the error is told anyway.
                let _ = send(&mut output, &Message::new(Kind::Quit).and("trax.reason", &error));
                return Err(error);
            }
        }
    }
    Ok(())
}

fn send(output: &mut impl Write, message: &Message) -> Result<(), TraxError> {
    writeln!(output, "{message}")?;
    Ok(output.flush()?)
}

/// What is known of the target.
enum Target {
    Nobody,
    /// Its box, in an image that is still to come.
    Waiting(Rect),
    Tracked,
}

enum Answer {
    Silence,
    State(Message),
    End,
}

impl Target {
    fn hear(&mut self, message: &Message, tracker: &mut dyn Tracker) -> Result<Answer, TraxError> {
        let unexpected = |when| TraxError::Unexpected { kind: message.kind.word().to_owned(), when };
        let arguments: Vec<&str> = message.arguments.iter().map(String::as_str).collect();
        match (message.kind, &arguments[..]) {
            (Kind::Quit, _) => Ok(Answer::End),
            // Since version 4: all targets are forgotten.
            (Kind::Initialize, []) => {
                *self = Self::Nobody;
                Ok(Answer::Silence)
            }
            (Kind::Initialize, [region]) => {
                if matches!(self, Self::Waiting(_)) {
                    return Err(unexpected("again: InfoPart tracks one target"));
                }
                *self = Self::Waiting(parse_region(region)?);
                Ok(Answer::Silence)
            }
            (Kind::Initialize, [image, region]) => self.start(image, parse_region(region)?, tracker),
            (Kind::Frame, [image]) => match *self {
                Self::Waiting(region) => self.start(image, region, tracker),
                Self::Tracked => {
                    let frame = image::read(image)?;
                    let since = Instant::now();
                    let found = tracker.update(frame.view())?;
                    Ok(Answer::State(state(found.box_in_frame, &found, since)))
                }
                Self::Nobody => Err(unexpected("before `initialize`")),
            },
            (Kind::Initialize | Kind::Frame, _) => Err(unexpected("with so many arguments")),
            (Kind::Hello | Kind::State, _) => Err(unexpected("from a client")),
        }
    }

    fn start(&mut self, image: &str, region: Rect, tracker: &mut dyn Tracker) -> Result<Answer, TraxError> {
        let frame = image::read(image)?;
        let since = Instant::now();
        tracker.init(frame.view(), region)?;
        *self = Self::Tracked;
        let known = tracker.estimate().cloned();
        let found = known.unwrap_or_else(|| Estimate::new(region, region, 1.0, Status::Tracking));
        Ok(Answer::State(state(region, &found, since)))
    }
}

fn state(box_in_frame: Rect, found: &Estimate, since: Instant) -> Message {
    Message::new(Kind::State)
        .with(rectangle(box_in_frame))
        .and("confidence", found.confidence)
        .and("status", found.status)
        .and("time", format!("{:.6}", since.elapsed().as_secs_f64()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tracker::{InfoPart, Parameters};

    fn picture(left: usize) -> String {
        use base64::{Engine, engine::general_purpose::STANDARD};
        let inside = |x: usize, y: usize| (left..left + 16).contains(&x) && (20..36).contains(&y);
        let pixel = |i: usize| if inside(i % 64, i / 64) { 220 } else { (i * 7 % 90) as u8 };
        format!("image:64;64;gray8;{}", STANDARD.encode((0..64 * 64).map(pixel).collect::<Vec<_>>()))
    }

    /// What the server answers to these lines, and how it ends.
    fn conversation(lines: &[String]) -> (Vec<Message>, Result<(), TraxError>) {
        let mut tracker = InfoPart::new(Parameters::default().check().unwrap());
        let about = About { name: "infopart".into(), identifier: "test".into() };
        let mut output = Vec::new();
        let outcome = serve(lines.join("\n").as_bytes(), &mut output, &mut tracker, &about);
        let text = String::from_utf8(output).unwrap();
        (text.lines().map(|line| line.parse().unwrap()).collect(), outcome)
    }

    fn message(kind: Kind, arguments: &[&str]) -> String {
        arguments.iter().fold(Message::new(kind), |message, word| message.with(*word)).to_string()
    }

    #[test]
    fn clients_of_either_generation_get_the_boxes_of_the_tracker() {
        let mut tracker = InfoPart::new(Parameters::default().check().unwrap());
        let frames = [picture(24), picture(26)].map(|address| image::read(&address).unwrap());
        tracker.init(frames[0].view(), Rect::new(24.0, 20.0, 16.0, 16.0)).unwrap();
        let expected = tracker.update(frames[1].view()).unwrap();

        let region = "24,20,16,16";
        let old = vec![message(Kind::Initialize, &[&picture(24), region])];
        let polygon = "24,20,40,20,40,36,24,36";
        let new = vec![message(Kind::Initialize, &[polygon]), message(Kind::Frame, &[&picture(24)])];
        for mut lines in [old, new] {
            lines.insert(0, "a line of chatter".to_owned());
            lines.push(message(Kind::Frame, &[&picture(26)]));
            lines.push(message(Kind::Quit, &[]));
            lines.push("@@TRAX:nonsense after the end".to_owned());
            let (answers, outcome) = conversation(&lines);
            outcome.unwrap();
            let kinds: Vec<_> = answers.iter().map(|answer| answer.kind).collect();
            assert_eq!(kinds, [Kind::Hello, Kind::State, Kind::State]);
            assert_eq!(answers[0].property("trax.name"), Some("infopart"));
            assert_eq!(answers[1].arguments, [region]);
            assert_eq!(parse_region(&answers[2].arguments[0]).unwrap(), expected.box_in_frame);
            assert_eq!(answers[2].property("confidence"), Some(expected.confidence.to_string().as_str()));
            assert_eq!(answers[2].property("status"), Some("tracking"));
        }
    }

    #[test]
    fn a_second_target_replaces_the_first_and_an_empty_message_forgets_it() {
        let start = |left: usize| {
            let region = format!("{left},20,16,16");
            [message(Kind::Initialize, &[&region]), message(Kind::Frame, &[&picture(left)])]
        };
        let lines = [start(24).to_vec(), vec![message(Kind::Initialize, &[])], start(30).to_vec()].concat();
        let (answers, outcome) = conversation(&lines);
        outcome.unwrap();
        assert_eq!(answers[2].arguments, ["30,20,16,16"]);
    }

    #[test]
    fn what_cannot_be_done_ends_the_conversation_with_its_reason() {
        let region = "24,20,16,16";
        let far = "900,900,16,16";
        for (lines, reason) in [
            (vec![message(Kind::Frame, &[&picture(24)])], "before `initialize`"),
            (vec![message(Kind::Initialize, &[region]), message(Kind::Initialize, &[region])], "one target"),
            (vec![message(Kind::State, &[region])], "from a client"),
            (vec![message(Kind::Initialize, &[&picture(24), &picture(24), region])], "so many"),
            (vec![message(Kind::Initialize, &[&picture(24), far])], "no pixel inside"),
            (vec!["@@TRAX:frame \"".to_owned()], "quote"),
        ] {
            let (answers, outcome) = conversation(&lines);
            assert!(outcome.unwrap_err().to_string().contains(reason), "{reason}");
            let last = answers.last().unwrap();
            assert_eq!(last.kind, Kind::Quit);
            assert!(last.property("trax.reason").unwrap().contains(reason));
        }
    }
}
