//! Rows read and refused.

use std::path::Path;

use infopart::geometry::Rect;

use super::{
    MotError, RowProblem, TrackRow,
    read::{parse_annotations, parse_tracks},
    row_text, sequence_name,
};

fn result(text: &str) -> Result<Vec<TrackRow>, MotError> {
    parse_tracks(text, Path::new("r.txt"), None)
}

fn refused(text: &str) -> (usize, RowProblem) {
    match result(text) {
        Err(MotError::Row { line, problem, .. }) => (line, problem),
        other => panic!("{text:?} gave {other:?}"),
    }
}

#[test]
fn rows_are_cut_at_commas_or_blanks_and_lines_count_blank_ones() {
    let expected =
        TrackRow { frame: 2, identity: 7, box_in_file: Rect::new(1.5, -2.0, 3.0, 4.0), confidence: 1.0 };
    for text in [
        "2,7,1.5,-2,3,4",
        "\n2, 7, 1.5, -2, 3, 4, 1, -1, -1, -1\r\n",
        "2 7 1.5 -2 3 4\n",
        "2.0,7.0,1.5,-2,3,4,1,",
    ] {
        assert_eq!(result(text).unwrap(), [expected], "{text:?}");
    }
    assert_eq!(refused("\n\n2,7,1,2,3"), (3, RowProblem::TooFewFields { found: 5, needed: 6 }));
}

#[test]
fn only_ground_truth_is_filtered_and_needs_the_confidence() {
    let text = "1,1,0,0,9,9,1\n1,2,0,0,9,9,0\n1,2,0,0,-9,9,0\n";
    let truth = |text| parse_annotations(text, Path::new("gt.txt"), None);
    let counted = |text| truth(text).unwrap().iter().filter(|one| one.is_counted()).count();
    assert_eq!(counted(text), 1);
    // None given counts; the class is the eighth field.
    assert_eq!(counted("1,1,0,0,9,9,-1,-1\n"), 1);
    let classes: Vec<_> =
        truth("1,1,0,0,9,9,1,7,0.5\n1,2,0,0,9,9,1,-1\n").unwrap().iter().map(|one| one.class).collect();
    assert_eq!(classes, [Some(7), None]);
    let short = truth("1,1,0,0,9,9\n").unwrap_err().to_string();
    assert!(short.contains("gt.txt, line 1: 6 fields where 7 are needed"), "{short}");
    assert_eq!(result("1,1,0,0,9,9,0.2\n1,2,0,0,9,9,-1\n").unwrap().len(), 2);
}

#[test]
fn odd_rows_are_refused_with_their_line() {
    assert_eq!(refused("1,1,0,0,9,9\n0,1,0,0,9,9"), (2, RowProblem::Frame { text: "0".into() }));
    assert_eq!(refused("1.5,1,0,0,9,9"), (1, RowProblem::Frame { text: "1.5".into() }));
    assert_eq!(refused("1,-1,0,0,9,9"), (1, RowProblem::Identity { text: "-1".into() }));
    assert_eq!(refused("1,1,0,nan,9,9"), (1, RowProblem::NotANumber { field: "y", text: "nan".into() }));
    assert_eq!(refused("1,1,0,0,9,x"), (1, RowProblem::NotANumber { field: "the height", text: "x".into() }));
    assert_eq!(refused("1,1,0,0,-9,9"), (1, RowProblem::Size { width: -9.0, height: 9.0 }));
    let twice = RowProblem::DuplicateIdentity { identity: 4, frame: 1, first_line: 1 };
    assert_eq!(refused("1,4,0,0,9,9\n1,4,5,5,9,9"), (2, twice));
}

#[test]
fn frames_beyond_the_sequence_are_refused() {
    let text = "1,1,0,0,9,9,1\n4,1,0,0,9,9,1\n";
    let beyond = |length| match parse_tracks(text, Path::new("r.txt"), Some(length)) {
        Err(MotError::Row { line, problem, .. }) => Some((line, problem)),
        _ => None,
    };
    assert_eq!((beyond(4), beyond(3)), (None, Some((2, RowProblem::Beyond { frame: 4, length: 3 }))));
    let truth = parse_annotations(text, Path::new("gt.txt"), Some(3)).unwrap_err().to_string();
    assert!(truth.contains("gt.txt, line 2: frame 4 is beyond the 3 frames"), "{truth}");
}

#[test]
fn rows_stand_in_any_order() {
    let rows = result("2,1,0,0,9,9\n1,2,0,0,9,9\n1,1,0,0,9,9").unwrap();
    assert_eq!(rows.iter().map(|row| row.frame).collect::<Vec<_>>(), [2, 1, 1]);
}

#[test]
fn boxes_that_no_picture_holds_are_refused() {
    for (text, width, height) in [
        ("1,1,0,0,1e30,9", 1e30, 9.0),
        ("1,1,0,0,1e308,1e308", 1e308, 1e308),
        ("1,1,0,0,1e-200,1e-200", 1e-200, 1e-200),
    ] {
        assert_eq!(refused(text), (1, RowProblem::Absurd { x: 0.0, y: 0.0, width, height }));
    }
    assert!(matches!(refused("1,1,-1e12,0,9,9"), (1, RowProblem::Absurd { .. })));
}

#[test]
fn a_row_is_written_as_others_read_it() {
    let row =
        TrackRow { frame: 3, identity: 12, box_in_file: Rect::new(1.0, 2.345, 30.0, 4.0), confidence: 1.0 };
    assert_eq!(
        row_text(&row),
        "3,12,1.00,2.35,30.00,4.00,1,-1,-1,-1\n".replace("2.35", &format!("{:.2}", 2.345))
    );
    assert_eq!(result(&row_text(&row)).unwrap()[0].identity, 12);
}

#[test]
fn a_sequence_is_called_after_its_folder() {
    assert_eq!(sequence_name(Path::new("mot/PETS09-S2L1/gt/gt.txt")), "PETS09-S2L1");
    assert_eq!(sequence_name(Path::new("mot/PETS09-S2L1/sort/result.txt")), "PETS09-S2L1");
    assert_eq!(sequence_name(Path::new("out/PETS09-S2L1.txt")), "PETS09-S2L1");
    assert_eq!(sequence_name(Path::new("gt.txt")), "gt");
}
