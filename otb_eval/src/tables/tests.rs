use super::*;

fn score(value: f64) -> Cell {
    Cell::Score(Some(Scored { value, deviation: None, interval: None }))
}

fn column(title: &str) -> Column {
    Column { title: title.into(), key: title.to_lowercase().replace(' ', "_") }
}

/// Four trackers, two of them alike in the digits shown.
fn table() -> ScoreTable {
    let sure =
        Scored { value: 0.25, deviation: Some(0.5), interval: Some(Interval { low: 0.125, high: 0.375 }) };
    ScoreTable {
        title: "OPE".into(),
        columns: vec![column("Tracker"), column("AUC"), column("seeds")],
        rows: vec![
            vec![Cell::Text("A_1 & |b|".into()), score(0.671_24), Cell::Count(None)],
            vec![Cell::Text("B, \"c\"".into()), score(0.671_23), Cell::Count(None)],
            vec![Cell::Text("C".into()), Cell::Score(Some(sure)), Cell::Count(None)],
            vec![Cell::Text("D".into()), Cell::Score(None), Cell::Count(None)],
        ],
        ranked: Ranked::Columns,
    }
}

const THREE: Digits = Digits { decimals: 3, percent: false };

#[test]
fn scores_that_show_the_same_digits_are_marked_alike() {
    assert_eq!(
        table().written(TableFormat::Markdown, THREE),
        "| Tracker | AUC |\n| --- | ---: |\n| A\\_1 & \\|b\\| | **0.671** |\n| B, \"c\" | **0.671** |\n| C | *0.250 ± 0.500 [0.125, 0.375]* |\n| D | - |\n"
    );
    let five = Digits { decimals: 5, percent: false };
    let text = table().written(TableFormat::Text, five);
    assert!(
        text.contains("0.67124 *") && text.contains("0.67123 +") && text.contains("0.25000 ± 0.50000"),
        "{text}"
    );
}

#[test]
fn latex_compiles_whatever_the_names_are() {
    let latex = table().written(TableFormat::Latex, Digits { decimals: 1, percent: true });
    let expected = "% OPE; best bold, second underlined. Needs \\usepackage{booktabs}.\n\\begin{tabular}{lr}\n\\toprule\n\
        Tracker & AUC \\\\\n\\midrule\nA\\_1 \\& |b| & \\textbf{67.1} \\\\\nB, \"c\" & \\textbf{67.1} \\\\\n\
        C & \\underline{25.0} {\\scriptsize$\\pm$50.0} {\\scriptsize[12.5, 37.5]} \\\\\nD & -- \\\\\n\\bottomrule\n\\end{tabular}\n";
    assert_eq!(latex, expected);
}

#[test]
fn csv_has_every_digit_a_column_a_number_and_no_mark() {
    assert_eq!(
        table().written(TableFormat::Csv, THREE),
        "tracker,auc,auc_deviation,auc_low,auc_high,seeds\nA_1 & |b|,0.67124,,,,\n\"B, \"\"c\"\"\",0.67123,,,,\nC,0.25,0.5,0.125,0.375,\nD,,,,,\n"
    );
}

#[test]
fn differences_have_signs_and_small_probabilities_a_bound() {
    let difference = |value| {
        Cell::Difference(Some(Scored {
            value,
            deviation: None,
            interval: Some(Interval { low: -0.25, high: 0.5 }),
        }))
    };
    let table = ScoreTable {
        rows: vec![
            vec![Cell::Text("A".into()), difference(0.125), Cell::Probability(Some(0.0001))],
            vec![Cell::Text("B".into()), difference(-0.000_01), Cell::Probability(Some(0.25))],
        ],
        ..table()
    };
    let text = table.written(TableFormat::Text, THREE);
    assert!(text.contains("+0.125 [-0.250, +0.500]  < 0.001"), "{text}");
    assert!(text.contains("+0.000 [-0.250, +0.500]    0.250"), "{text}");
    let latex = table.written(TableFormat::Latex, THREE);
    assert!(latex.contains("A & $+0.125$ {\\scriptsize[$-0.250$, $+0.500$]} & $<0.001$"), "{latex}");
}

#[test]
fn rows_are_ranked_where_trackers_are_columns_and_one_score_is_no_best() {
    let table = ScoreTable {
        columns: vec![column("sequence"), column("A"), column("B")],
        rows: vec![
            vec![Cell::Text("s".into()), score(0.5), score(0.75)],
            vec![Cell::Text("t".into()), score(0.5), Cell::Score(None)],
        ],
        ranked: Ranked::Rows,
        ..table()
    };
    assert_eq!(
        table.written(TableFormat::Text, THREE),
        "sequence        A        B\ns         0.500 +  0.750 *\nt         0.500        -\n"
    );
}

#[test]
fn formats_are_refused_with_a_list() {
    assert_eq!("LaTeX".parse(), Ok(TableFormat::Latex));
    let message = "html".parse::<TableFormat>().unwrap_err().to_string();
    assert!(message.contains("`html`") && message.contains("text, csv, markdown, latex"), "{message}");
}
