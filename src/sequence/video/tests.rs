//! Videos, through stand-ins for ffmpeg; the real one is tried on real videos in `tests/sequence_real.rs`.

use std::{fs, path::PathBuf, process::Command};

use super::*;

const ALL: FrameRange = FrameRange { start: 1, end: None };

/// A shell script that plays ffmpeg, in a folder of its own.
///
/// A shell writes it, for a file this process had open for writing might still be open in a child that another test
/// is just starting, and then cannot be run ("text file busy").
fn stand_in(script: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("ffmpeg").to_str().unwrap().to_owned();
    let write = r#"printf '#!/bin/sh\n%s\n' "$2" > "$1" && chmod 755 "$1""#;
    let status = Command::new("sh").args(["-c", write, "sh", &program, script]).status().unwrap();
    assert!(status.success());
    (folder, program)
}

/// A script that sends frames of one pixel at the given times.
fn frames_at(times: &[&str]) -> String {
    let lines = times.iter().map(|time| {
        format!(
            "echo '[Parsed_showinfo_0 @ 0x1] n: 0 pts_time:{time} fmt:x' >&2; printf 'P6\\n1 1\\n255\\nabc'\n"
        )
    });
    lines.collect()
}

fn opened(script: &str, range: FrameRange) -> Result<VideoFile, SequenceError> {
    let (_folder, program) = stand_in(script);
    VideoFile::open_with(&program, &some_file(), range, patient())
}

fn patient() -> Patience {
    Patience::with(&some_file(), Wait::default())
}

fn some_file() -> VideoInput {
    VideoInput::File(PathBuf::from("some.mp4"))
}

#[test]
fn times_count_from_the_first_frame_and_may_be_uneven() {
    let mut video = opened(&frames_at(&["7.5", "7.54", "NOPTS", "9.5"]), ALL).unwrap();
    let mut times = Vec::new();
    while let Some(frame) = video.next_frame().unwrap() {
        times.push(frame.time.map(|time| time.as_millis()));
    }
    assert_eq!(times, [Some(0), Some(40), None, Some(2000)]);
}

#[test]
fn a_range_skips_and_stops_but_keeps_numbers_and_times() {
    let range = FrameRange { start: 2, end: Some(3) };
    let mut video = opened(&frames_at(&["0", "1", "2", "3"]), range).unwrap();
    let mut seen = Vec::new();
    while let Some(frame) = video.next_frame().unwrap() {
        seen.push((frame.number, frame.label, frame.time.map(|time| time.as_secs())));
    }
    assert_eq!(seen, [(2, "frame 2".to_owned(), Some(1)), (3, "frame 3".to_owned(), Some(2))]);
    let beyond = opened(&frames_at(&["0", "1"]), FrameRange { start: 3, end: None }).unwrap_err().to_string();
    assert!(beyond.contains("--start 3: some.mp4 has only 2 frames"), "{beyond}");
}

#[test]
fn a_missing_ffmpeg_says_how_to_install_it() {
    let error =
        VideoFile::open_with("no-such-ffmpeg", &VideoInput::File(PathBuf::from("a.mp4")), ALL, patient())
            .unwrap_err()
            .to_string();
    for part in
        ["a.mp4", "`no-such-ffmpeg`", "apt install ffmpeg", "brew install ffmpeg", "winget install ffmpeg"]
    {
        assert!(error.contains(part), "{error}");
    }
}

#[test]
fn an_unreadable_file_gives_ffmpegs_own_message() {
    let script = "echo 'file:some.mp4: Invalid data found when processing input' >&2; exit 1";
    let error = opened(script, ALL).unwrap_err().to_string();
    assert!(
        error.contains("some.mp4: ffmpeg finds no video in it: Invalid data found when processing"),
        "{error}"
    );
}

#[test]
fn an_ffmpeg_that_dies_names_the_last_good_frame() {
    for ending in ["echo 'Out of luck' >&2; exit 1", "echo 'Out of luck' >&2; printf 'P6\\n1 1\\n255\\nab'"] {
        let mut video = opened(&(frames_at(&["0", "1"]) + ending), ALL).unwrap();
        assert!(video.next_frame().unwrap().is_some() && video.next_frame().unwrap().is_some());
        let error = video.next_frame().unwrap_err().to_string();
        assert!(error.contains("some.mp4: the video broke off after frame 2: Out of luck"), "{error}");
    }
}

#[test]
fn an_old_ffmpeg_gets_the_old_option() {
    let script = "case \"$*\" in *-fps_mode*) echo \"Unrecognized option 'fps_mode'.\" >&2; exit 1;; esac\n\
        case \"$*\" in *'-vf showinfo -vsync passthrough'*) ;; *) exit 1;; esac\n";
    let mut video = opened(&(script.to_owned() + &frames_at(&["0"])), ALL).unwrap();
    assert!(video.next_frame().unwrap().is_some());
    assert!(video.next_frame().unwrap().is_none());
}

#[test]
fn a_frame_of_another_size_names_the_frame() {
    let script = frames_at(&["0"]) + "printf 'P6\\n2 1\\n255\\nabcdef'";
    let mut video = opened(&script, ALL).unwrap();
    assert!(video.next_frame().unwrap().is_some());
    let error = video.next_frame().unwrap_err().to_string();
    assert!(error.contains("some.mp4, frame 2: this frame is 2x1 but the first is 1x1"), "{error}");
}

#[test]
fn dropping_a_video_ends_its_process() {
    let (folder, program) = stand_in(&(frames_at(&["0"]) + "echo $$ > \"$0.pid\"; exec sleep 1000"));
    let video = VideoFile::open_with(&program, &some_file(), ALL, patient()).unwrap();
    let pid_file = folder.path().join("ffmpeg.pid");
    let written = || fs::read_to_string(&pid_file).ok().filter(|text| text.ends_with('\n'));
    let pid = (0..2000).find_map(|_| {
        std::thread::sleep(std::time::Duration::from_millis(5));
        written()
    });
    drop(video);
    let alive = Command::new("kill").args(["-0", pid.unwrap().trim()]).output().unwrap();
    assert!(!alive.status.success());
}

#[test]
fn endless_garbage_is_given_up_though_what_writes_it_is_a_grandchild() {
    for garbage in ["cat /dev/zero", "head -c 1000000 /dev/urandom; sleep 1000"] {
        for before in [String::new(), frames_at(&["0"])] {
            let is_frame = !before.is_empty();
            let since = std::time::Instant::now();
            let script = format!("{before}printf x\n{garbage}");
            let message = match opened(&script, ALL) {
                Err(error) => error.to_string(),
                Ok(mut video) => {
                    assert!(is_frame && video.next_frame().unwrap().is_some());
                    video.next_frame().unwrap_err().to_string()
                }
            };
            assert!(message.contains("some.mp4"), "{message}");
            assert!(since.elapsed() < std::time::Duration::from_secs(60), "{garbage}");
        }
    }
}

#[test]
fn no_name_is_an_option_or_a_protocol_unless_it_was_meant() {
    let script = "for word; do echo \"$word\" >> \"$0.args\"; done; exit 1";
    let arguments = |input: VideoInput| {
        let (folder, program) = stand_in(script);
        let _ = VideoFile::open_with(&program, &input, ALL, patient());
        fs::read_to_string(folder.path().join("ffmpeg.args")).unwrap()
    };
    for name in ["-y", "concat:a|b", "http://host/a.mp4", "pipe:0"] {
        let words = arguments(VideoInput::File(PathBuf::from(name)));
        assert!(words.contains(&format!("-i\nfile:{name}\n")), "{words}");
    }
    assert!(arguments(VideoInput::Standard).contains("-i\npipe:0\n"));
    assert!(arguments(VideoInput::Url("rtsp://host/1".into())).contains("-i\nrtsp://host/1\n"));
    let device = VideoInput::Device { format: "v4l2".into(), name: "/dev/video0".into() };
    assert!(arguments(device).contains("-f\nv4l2\n-i\n/dev/video0\n"));
}

#[test]
fn a_live_stream_gives_the_newest_frame_and_its_number() {
    let mut video = opened(&frames_at(&["0", "1", "2", "3"]), ALL).unwrap().live();
    let mut numbers = Vec::new();
    while let Some(frame) = video.next_frame().unwrap() {
        assert_eq!(frame.time.map(|time| time.as_secs()), Some(frame.number as u64 - 1));
        numbers.push(frame.number);
    }
    // How many are left out depends on time, their order and the last one do not.
    assert!(numbers.windows(2).all(|pair| pair[0] < pair[1]) && numbers.ends_with(&[4]), "{numbers:?}");
    assert!(video.next_frame().unwrap().is_none());
    let mut broken = opened(&(frames_at(&["0"]) + "printf garbage"), ALL).unwrap().live();
    assert_eq!(broken.next_frame().unwrap().unwrap().number, 1, "a frame is delivered before the error");
    assert!(broken.next_frame().unwrap_err().to_string().contains("broke off after frame 1"));
    assert!(broken.next_frame().unwrap().is_none());
}

#[test]
fn a_silent_decoder_of_a_file_is_given_up_and_the_last_frame_named() {
    let limit = Some(std::time::Duration::from_millis(400));
    for before in [String::new(), frames_at(&["0", "1"])] {
        // What is silent is a grandchild, which goes on holding the pipe.
        let (_folder, program) = stand_in(&(before.clone() + "sleep 1000"));
        let patience = Patience::limited(limit, Wait::default());
        let message = match VideoFile::open_with(&program, &some_file(), ALL, patience) {
            Err(error) => error.to_string(),
            Ok(mut video) => {
                assert!(video.next_frame().unwrap().is_some() && video.next_frame().unwrap().is_some());
                video.next_frame().unwrap_err().to_string()
            }
        };
        assert!(message.contains("no frame came for 0.4 seconds"), "{message}");
        assert_eq!(message.contains("broke off after frame 2"), !before.is_empty(), "{message}");
    }
}

#[test]
fn a_silent_stream_is_waited_for_until_that_is_called_off() {
    use std::sync::atomic::{AtomicBool, Ordering};
    static STOP: AtomicBool = AtomicBool::new(false);
    let (_folder, program) = stand_in(&(frames_at(&["0"]) + "exec sleep 1000"));
    let patience = || Patience::limited(None, Wait { stop: Some(&STOP), tell: None });
    let mut plain = VideoFile::open_with(&program, &some_file(), ALL, patience()).unwrap();
    let mut live = VideoFile::open_with(&program, &some_file(), ALL, patience()).unwrap().live();
    assert!(plain.next_frame().unwrap().is_some() && live.next_frame().unwrap().is_some());
    STOP.store(true, Ordering::Relaxed);
    assert!(plain.next_frame().unwrap().is_none() && live.next_frame().unwrap().is_none());
}
