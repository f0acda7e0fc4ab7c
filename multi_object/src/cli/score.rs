//! `mot score`: a table of scores, a row a sequence.

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::{Args, ValueEnum};
use infopart::{output::TextTable, program::BadInput};
use multi_object::{
    motchallenge::{MotError, read_annotations, read_tracks, sequence_length, sequence_name},
    scoring::{Benchmark, Counts, Rules, Scores},
};

use super::deliver;

pub const EXAMPLES: &str = "\
Examples:
  mot score mot/PETS09-S2L1/gt/gt.txt result.txt
  mot score mot/A/gt/gt.txt a.txt mot/B/gt/gt.txt b.txt --json scores.json
  mot score mot/train results --rules trackeval --benchmark mot17 --sequence-map seqmaps/MOT17-train.txt
  mot sort det.txt | mot score mot/A/gt/gt.txt -

GT and RESULT are files of MOTChallenge text, - for standard input, or two folders: GT/SEQ/gt/gt.txt goes with RESULT/SEQ.txt. \
Rows stand in any order, and none beyond the seqLength of GT/SEQ/seqinfo.ini, if there is one. Ground truth counts where its \
confidence (seventh field) is not 0; a match needs an overlap of 0.5. A sequence that cannot be scored, as its result is \
missing or damaged, is told and left out; the exit code is then 2.
Columns: IDF1 IDP IDR, recall, precision, GT objects, mostly / partly tracked, mostly lost, false positives, misses, \
identity switches, fragments, MOTA, MOTP (mean of 1 - overlap), transfers, ascents, migrations, MOTPo (mean overlap), \
FAR (false positives a frame), HOTA, DetA, AssA.";

/// The row of all sequences together.
const OVERALL: &str = "OVERALL";

#[derive(Debug, Clone, Copy, ValueEnum)]
enum RulesArg {
    /// py-motmetrics
    Motmetrics,
    /// TrackEval, as the MOTChallenge server
    Trackeval,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum BenchmarkArg {
    /// Rows whose confidence is not 0 count
    Mot15,
    /// As MOT17
    Mot16,
    /// Pedestrians (class 1) count; results on people in vehicles, static people, distractors and reflections (2, 7, 8, 12) are removed
    Mot17,
    /// As MOT17, with vehicles without an engine (6) as distractors, too
    Mot20,
}

#[derive(Debug, Args)]
pub struct ScoreArgs {
    /// Ground truth and result, in turn: files, or one folder each
    #[arg(required = true, num_args = 2.., value_names = ["GT", "RESULT"])]
    pairs: Vec<PathBuf>,
    /// Whose rules: how matches are chosen, what is mostly tracked, what a fragment is
    #[arg(long, value_enum, default_value = "motmetrics")]
    rules: RulesArg,
    /// What counts before it is scored: without classes, or pedestrians only, with distractors left out
    #[arg(long, value_enum, default_value = "mot15")]
    benchmark: BenchmarkArg,
    /// Score only the sequences named in this file, one a line after the heading `name`
    #[arg(long, value_name = "FILE")]
    sequence_map: Option<PathBuf>,
    /// Also write the scores, with all digits, as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Ground truth and result of one sequence.
struct Pair {
    name: String,
    truth: PathBuf,
    result: PathBuf,
}

pub fn score(args: &ScoreArgs) -> Result<()> {
    let rules = match args.rules {
        RulesArg::Motmetrics => Rules::Motmetrics,
        RulesArg::Trackeval => Rules::Trackeval,
    };
    let mut counts = Vec::new();
    let benchmark = args.benchmark();
    let pairs = pairs(args)?;
    let (total, mut bad) = (pairs.len(), 0);
    for pair in pairs {
        match pair.counts(benchmark, rules) {
            Ok(of_pair) => counts.push((pair.name, of_pair)),
            // The others are scored all the same.
            Err(error) if total > 1 => {
                eprintln!("error: {error}");
                bad += 1;
            }
            Err(error) => return Err(error.into()),
        }
    }
    let mut scores: Vec<(String, Scores)> =
        counts.iter().map(|(name, counts)| (name.clone(), counts.scores())).collect();
    if let Some(total) = Counts::total(counts.iter().map(|(_, counts)| counts)).filter(|_| counts.len() > 1) {
        scores.push((OVERALL.to_owned(), total.scores()));
    }
    if let Some(path) = args.json.as_ref().filter(|_| !scores.is_empty()) {
        deliver(Some(path), &format!("{}\n", json(rules, &scores)?))?;
    }
    if !scores.is_empty() {
        deliver(None, &table(&scores))?;
    }
    if bad > 0 {
        let message =
            format!("{bad} of {total} sequences could not be scored and are not in the table; see above");
        return Err(BadInput(message).into());
    }
    Ok(())
}

impl Pair {
    /// GT/SEQ/gt/gt.txt and RESULT/SEQ.txt.
    fn in_folders(truth: &Path, result: &Path, name: String) -> Self {
        let (truth, result) = (truth.join(&name).join("gt/gt.txt"), result.join(format!("{name}.txt")));
        Self { name, truth, result }
    }

    fn counts(&self, benchmark: Benchmark, rules: Rules) -> Result<Counts, MotError> {
        let length = sequence_length(&self.truth)?;
        let truth = read_annotations(&self.truth, length)?;
        let result = read_tracks(&self.result, length)?;
        if result.is_empty() {
            let path = self.result.display();
            eprintln!("warning: {path}: no row in it: scored as a tracker that found nothing");
        }
        let (truth, result) = benchmark.counted(&truth, &result);
        let counts = Counts::of(&truth, &result, rules);
        Ok(match length {
            Some(length) => counts.of_length(length),
            None => counts,
        })
    }
}

impl ScoreArgs {
    fn benchmark(&self) -> Benchmark {
        match self.benchmark {
            BenchmarkArg::Mot15 => Benchmark::Mot15,
            BenchmarkArg::Mot16 => Benchmark::Mot16,
            BenchmarkArg::Mot17 => Benchmark::Mot17,
            BenchmarkArg::Mot20 => Benchmark::Mot20,
        }
    }
}

fn pairs(args: &ScoreArgs) -> Result<Vec<Pair>> {
    let given = args.pairs.as_slice();
    if let [truth, result] = given
        && truth.is_dir()
    {
        let mut pairs = folders(truth, result)?;
        if let Some(path) = &args.sequence_map {
            let names = sequence_map(path)?;
            pairs.retain(|pair| names.contains(&pair.name));
            // Those that are not there are told when they are to be read.
            let is_known = |name: &String| pairs.iter().any(|pair| pair.name == *name);
            let missing: Vec<String> = names.into_iter().filter(|name| !is_known(name)).collect();
            pairs.extend(missing.into_iter().map(|name| Pair::in_folders(truth, result, name)));
        }
        return Ok(pairs);
    }
    if args.sequence_map.is_some() {
        return Err(BadInput("--sequence-map: it chooses among folders; give two folders".to_owned()).into());
    }
    if given.iter().filter(|path| path.as_os_str() == "-").count() > 1 {
        return Err(BadInput(
            "- twice: standard input can be read once; give files for the others".to_owned(),
        )
        .into());
    }
    if given.len() % 2 == 1 {
        let last = given.last().map(|path| path.display().to_string()).unwrap_or_default();
        let message = format!("{last}: ground truth without a result; give GT RESULT for each sequence");
        return Err(BadInput(message).into());
    }
    Ok(given
        .chunks_exact(2)
        .map(|pair| Pair { name: sequence_name(&pair[0]), truth: pair[0].clone(), result: pair[1].clone() })
        .collect())
}

/// GT/SEQ/gt/gt.txt with RESULT/SEQ.txt, by name.
fn folders(truth: &Path, result: &Path) -> Result<Vec<Pair>> {
    let unreadable = |source| MotError::Unreadable { path: truth.to_owned(), source };
    let mut pairs = Vec::new();
    for entry in std::fs::read_dir(truth).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let pair = Pair::in_folders(truth, result, name);
        if pair.truth.is_file() {
            pairs.push(pair);
        }
    }
    pairs.sort_by(|a, b| a.name.cmp(&b.name));
    if pairs.is_empty() {
        let what = "no SEQ/gt/gt.txt in it; give the folder that holds the sequences".to_owned();
        return Err(MotError::Sequences { path: truth.to_owned(), what }.into());
    }
    Ok(pairs)
}

/// The names in a MOTChallenge sequence map: one a line after the heading `name`.
fn sequence_map(path: &Path) -> Result<Vec<String>> {
    let text = std::fs::read_to_string(path)
        .map_err(|source| MotError::Unreadable { path: path.to_owned(), source })?;
    let names = text.lines().map(|line| line.split(',').next().unwrap_or_default().trim());
    Ok(names.filter(|name| !name.is_empty() && *name != "name").map(str::to_owned).collect())
}

fn json(rules: Rules, scores: &[(String, Scores)]) -> Result<String> {
    let sequences: Vec<serde_json::Value> = (scores.iter())
        .map(|(name, scores)| {
            Ok(serde_json::json!({ "sequence": name, "scores": serde_json::to_value(scores)? }))
        })
        .collect::<Result<_, serde_json::Error>>()?;
    let program = format!("mot {}", infopart::VERSION);
    Ok(serde_json::to_string_pretty(&serde_json::json!({
        "program": program, "rules": rules, "minimum_overlap": 0.5, "sequences": sequences,
    }))?)
}

fn table(scores: &[(String, Scores)]) -> String {
    let mut table = TextTable::new([
        "", "IDF1", "IDP", "IDR", "Rcll", "Prcn", "GT", "MT", "PT", "ML", "FP", "FN", "IDs", "FM", "MOTA",
        "MOTP", "IDt", "IDa", "IDm", "MOTPo", "FAR", "HOTA", "DetA", "AssA",
    ]);
    for (name, one) in scores {
        let percent =
            |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{:.1}%", 100.0 * value));
        let plain = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.3}"));
        let count = |value: Option<usize>| value.map_or("-".to_owned(), |value| value.to_string());
        let shares = [one.idf1, one.idp, one.idr, one.recall, one.precision].map(percent);
        let counts = [
            one.objects,
            one.mostly_tracked,
            one.partially_tracked,
            one.mostly_lost,
            one.false_positives,
            one.misses,
            one.switches,
            one.fragments,
        ];
        let mut cells = vec![name.clone()];
        cells.extend(shares);
        cells.extend(counts.map(|count| count.to_string()));
        cells.extend([percent(one.mota), plain(one.motp_distance)]);
        cells.extend([one.transfers, one.ascents, one.migrations].map(count));
        cells.extend([one.motp_overlap, one.false_positives_per_frame].map(plain));
        cells.extend([one.hota, one.deta, one.assa].map(percent));
        table.row(cells);
    }
    table.to_string()
}
