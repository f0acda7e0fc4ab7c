//! Step 3: a table in each format.

use infopart::output::TextTable;

use super::{Cell, Digits, Rank, ScoreTable, Scored};

/// What stands where there is nothing.
const NOTHING: &str = "-";

pub(super) fn text(table: &ScoreTable, digits: Digits) -> String {
    let ranks = table.ranks(digits);
    let marks_column = |column: usize| ranks.iter().any(|row| row[column] != Rank::Other);
    let mut written = TextTable::new(table.columns.iter().map(|column| column.title.clone()));
    for (row, ranks) in table.rows.iter().zip(&ranks) {
        let cell = |(column, cell): (usize, &Cell)| {
            let mark = match ranks[column] {
                Rank::Best => " *",
                Rank::Second => " +",
                Rank::Other if marks_column(column) => "  ",
                Rank::Other => "",
            };
            plain(cell, digits) + mark
        };
        written.row(row.iter().enumerate().map(cell));
    }
    written.to_string()
}

/// A cell's number with what is known of it, without a mark.
fn plain(cell: &Cell, digits: Digits) -> String {
    let nothing = || NOTHING.to_owned();
    match cell {
        Cell::Text(text) => text.clone(),
        Cell::Count(count) => count.map_or_else(nothing, |count| count.to_string()),
        Cell::Score(score) => score.map_or_else(nothing, |scored| {
            let deviation = scored.deviation.map_or_else(String::new, |d| format!(" ± {}", digits.shown(d)));
            digits.shown(scored.value) + &deviation + &interval(&scored, |value| digits.shown(value))
        }),
        Cell::Difference(difference) => difference.map_or_else(nothing, |scored| {
            digits.signed(scored.value) + &interval(&scored, |value| digits.signed(value))
        }),
        Cell::Probability(p) => p.map_or_else(nothing, probability),
        Cell::Speed(speed) => speed.map_or_else(nothing, |speed| format!("{speed:.1}")),
    }
}

fn interval(scored: &Scored, shown: impl Fn(f64) -> String) -> String {
    scored.interval.map_or_else(String::new, |one| format!(" [{}, {}]", shown(one.low), shown(one.high)))
}

fn probability(p: f64) -> String {
    if p < 0.0005 { "< 0.001".to_owned() } else { format!("{p:.3}") }
}

pub(super) fn csv(table: &ScoreTable) -> String {
    let has = |column: usize, part: fn(&Scored) -> bool| {
        table.rows.iter().any(|row| scored_of(&row[column]).is_some_and(&part))
    };
    let parts: Vec<(bool, bool)> = (0..table.columns.len())
        .map(|column| (has(column, |one| one.deviation.is_some()), has(column, |one| one.interval.is_some())))
        .collect();
    let mut header = Vec::new();
    for (column, (deviation, interval)) in table.columns.iter().zip(&parts) {
        header.push(quoted(&column.key));
        if *deviation {
            header.push(quoted(&format!("{}_deviation", column.key)));
        }
        if *interval {
            header.extend(["low", "high"].map(|end| quoted(&format!("{}_{end}", column.key))));
        }
    }
    let mut csv = header.join(",") + "\n";
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    for row in &table.rows {
        let mut fields = Vec::new();
        for (cell, (deviation, interval)) in row.iter().zip(&parts) {
            let scored = scored_of(cell);
            fields.push(match cell {
                Cell::Text(text) => quoted(text),
                Cell::Count(count) => count.map_or_else(String::new, |count| count.to_string()),
                Cell::Score(_) | Cell::Difference(_) => number(scored.map(|scored| scored.value)),
                Cell::Probability(value) | Cell::Speed(value) => number(*value),
            });
            if *deviation {
                fields.push(number(scored.and_then(|scored| scored.deviation)));
            }
            if *interval {
                let ends = scored.and_then(|scored| scored.interval);
                fields.extend([number(ends.map(|ends| ends.low)), number(ends.map(|ends| ends.high))]);
            }
        }
        csv += &(fields.join(",") + "\n");
    }
    csv
}

fn scored_of(cell: &Cell) -> Option<&Scored> {
    match cell {
        Cell::Score(scored) | Cell::Difference(scored) => scored.as_ref(),
        _ => None,
    }
}

/// A field in quotes if it needs them, the quotes in it doubled.
fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}

/// The rows of a table whose columns without anything in them are left out.
struct Shown<'a> {
    table: &'a ScoreTable,
    ranks: Vec<Vec<Rank>>,
    columns: Vec<usize>,
}

impl<'a> Shown<'a> {
    fn new(table: &'a ScoreTable, digits: Digits) -> Self {
        let is_empty = |cell: &Cell| {
            matches!(
                cell,
                Cell::Count(None)
                    | Cell::Score(None)
                    | Cell::Difference(None)
                    | Cell::Probability(None)
                    | Cell::Speed(None)
            )
        };
        let has_something = |column: &usize| !table.rows.iter().all(|row| is_empty(&row[*column]));
        let columns = (0..table.columns.len()).filter(has_something).collect();
        Self { table, ranks: table.ranks(digits), columns }
    }

    fn titles(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|column| self.table.columns[*column].title.as_str())
    }

    fn rows(&'a self) -> impl Iterator<Item = impl Iterator<Item = (&'a Cell, Rank)>> {
        let cells = |(row, ranks): (&'a Vec<Cell>, &'a Vec<Rank>)| {
            self.columns.iter().map(move |column| (&row[*column], ranks[*column]))
        };
        self.table.rows.iter().zip(&self.ranks).map(cells)
    }
}

pub(super) fn markdown(table: &ScoreTable, digits: Digits) -> String {
    let shown = Shown::new(table, digits);
    let escaped = |text: &str| {
        text.replace('\\', "\\\\")
            .replace('|', "\\|")
            .replace('*', "\\*")
            .replace('_', "\\_")
            .replace('<', "&lt;")
    };
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let mut markdown = line(shown.titles().map(escaped).collect());
    markdown += &line(
        (0..shown.columns.len()).map(|column| if column == 0 { "---" } else { "---:" }.to_owned()).collect(),
    );
    for row in shown.rows() {
        let cells = row.map(|(cell, rank)| {
            let text = escaped(&plain(cell, digits));
            match rank {
                Rank::Best => format!("**{text}**"),
                Rank::Second => format!("*{text}*"),
                Rank::Other => text,
            }
        });
        markdown += &line(cells.collect());
    }
    markdown
}

pub(super) fn latex(table: &ScoreTable, digits: Digits) -> String {
    let shown = Shown::new(table, digits);
    let columns = format!("l{}", "r".repeat(shown.columns.len().saturating_sub(1)));
    let titles: Vec<String> = shown.titles().map(in_latex).collect();
    let mut latex = format!(
        "% {}; best bold, second underlined. Needs \\usepackage{{booktabs}}.\n\\begin{{tabular}}{{{columns}}}\n\\toprule\n{} \\\\\n\\midrule\n",
        table.title.replace('\n', " "),
        titles.join(" & ")
    );
    for row in shown.rows() {
        let cells: Vec<String> = row.map(|(cell, rank)| latex_cell(cell, rank, digits)).collect();
        latex += &format!("{} \\\\\n", cells.join(" & "));
    }
    latex + "\\bottomrule\n\\end{tabular}\n"
}

/// The number alone is marked; its deviation and interval stand beside it, smaller.
fn latex_cell(cell: &Cell, rank: Rank, digits: Digits) -> String {
    let (Cell::Score(Some(scored)) | Cell::Difference(Some(scored))) = cell else {
        return match cell {
            Cell::Probability(Some(p)) if *p < 0.0005 => "$<0.001$".to_owned(),
            Cell::Text(text) => in_latex(text),
            other => in_latex(&plain(other, digits)).replace('-', "--"),
        };
    };
    let is_difference = matches!(cell, Cell::Difference(_));
    let number = |value: f64| {
        if is_difference { format!("${}$", digits.signed(value)) } else { digits.shown(value) }
    };
    let value = number(scored.value);
    let value = match rank {
        Rank::Best => format!("\\textbf{{{value}}}"),
        Rank::Second => format!("\\underline{{{value}}}"),
        Rank::Other => value,
    };
    let deviation =
        scored.deviation.map_or_else(String::new, |d| format!(" {{\\scriptsize$\\pm${}}}", digits.shown(d)));
    let interval = scored.interval.map_or_else(String::new, |one| {
        format!(" {{\\scriptsize[{}, {}]}}", number(one.low), number(one.high))
    });
    value + &deviation + &interval
}

fn in_latex(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => escaped.extend(['\\', letter]),
            '~' => escaped.push_str("\\textasciitilde{}"),
            '^' => escaped.push_str("\\textasciicircum{}"),
            '\\' => escaped.push_str("\\textbackslash{}"),
            '<' => escaped.push_str("\\textless{}"),
            '>' => escaped.push_str("\\textgreater{}"),
            '±' => escaped.push_str("$\\pm$"),
            other => escaped.push(other),
        }
    }
    escaped
}
