use std::collections::HashSet;

use super::*;

#[test]
fn every_line_of_the_table_is_a_target() {
    let lines = include_str!("tb100.tsv").lines().filter(|line| !line.starts_with('#')).count();
    assert_eq!((lines, all().len()), (100, 100));
    let names: HashSet<&str> = all().iter().map(|known| known.name).collect();
    assert_eq!(names.len(), 100);
    for known in all() {
        assert_eq!(known.last_frame - known.first_frame + 1, known.rows, "{}", known.name);
        assert!(known.attributes(AttributeSource::Json) != AttributeSet::default(), "{}", known.name);
    }
}

#[test]
fn starts_and_digits_are_as_the_benchmark_says() {
    let starts: Vec<(&str, usize)> = all()
        .iter()
        .filter(|known| known.first_frame != 1)
        .map(|known| (known.name, known.first_frame))
        .collect();
    assert_eq!(starts, [("BlurCar1", 247), ("BlurCar3", 3), ("BlurCar4", 18), ("David", 300), ("Tiger1", 6)]);
    assert_eq!(find("Board").unwrap().digits, 5);
    let tiger = find("Tiger1").unwrap();
    assert_eq!((tiger.rows, tiger.omitted_frames()), (349, 5));
}

#[test]
fn the_lists_have_their_lengths() {
    let length = |word: &str| word.parse::<SequenceList>().unwrap().sequences().len();
    let lengths = SequenceList::ALL.map(|list| length(list.name()));
    assert_eq!(lengths, [100, 50, 51, 36, 8, 11, 19, 7, 12, 3]);
    let message = "otb50".parse::<SequenceList>().unwrap_err().to_string();
    assert!(message.contains("tb50, cvpr13"), "{message}");
}

#[test]
fn the_sources_of_attributes_differ_on_fourteen_targets() {
    let differing: Vec<&str> = all()
        .iter()
        .filter(|known| {
            known.attributes(AttributeSource::Tb100Txt) != known.attributes(AttributeSource::Json)
        })
        .map(|known| known.name)
        .collect();
    let expected = "Box Car1 Car2 Coke Crossing Deer Freeman3 Freeman4 Ironman Jump MotorRolling Skiing Walking Walking2";
    assert_eq!(differing.join(" "), expected);
    let codes = |source| {
        let attributes = find("Walking2").unwrap().attributes(source);
        attributes.iter().map(Attribute::code).collect::<Vec<_>>().join(" ")
    };
    assert_eq!(codes(AttributeSource::Tb100Txt), "SV OCC LR");
}

#[test]
fn every_spelling_means_one_target() {
    let mut seen = std::collections::HashMap::new();
    for known in all() {
        for dialect in Dialect::ALL {
            let spelling = known.spelling(dialect);
            assert_eq!(find(&spelling).map(|found| found.name), Some(known.name), "{spelling}");
            assert_eq!(*seen.entry(spelling).or_insert(known.name), known.name);
        }
    }
    for (spelling, name) in [
        ("Jogging_1", "Jogging-1"),
        ("Jogging.2", "Jogging-2"),
        ("Jogging1", "Jogging-1"),
        ("Skating2_1", "Skating2-1"),
        ("Human4", "Human4-2"),
        ("carDark", "CarDark"),
        ("BasketBall", "Basketball"),
    ] {
        assert_eq!(find(spelling).unwrap().name, name);
    }
    assert!(find("Jogging").is_none() && find("Skating2").is_none() && find("").is_none());
}

#[test]
fn selections_mix_lists_and_names_without_repeating() {
    assert_eq!(select("Deer, jogging_1,people8").unwrap()[..3], ["Deer", "Jogging-1", "Crossing"]);
    assert_eq!(select("people8,Couple").unwrap().len(), 8);
    assert_eq!(select("people19,others12").unwrap().len(), 31);
    assert_eq!(select("people8,people11").unwrap(), select("people19").unwrap());
    assert_eq!(select("longterm,people19").unwrap().len(), 20);
    assert_eq!(select("my_own").unwrap(), ["my_own"]);
    assert!(matches!(select(" ,"), Err(CatalogueError::NoSequence { .. })));
}

#[test]
fn unknown_words_are_refused_with_what_there_is() {
    assert!("XY".parse::<Attribute>().unwrap_err().to_string().contains("IV, OPR, SV"));
    assert_eq!("sv".parse(), Ok(Attribute::ScaleVariation));
    assert!("x".parse::<AttributeSource>().unwrap_err().to_string().contains("tb100, json"));
}
