//! `otb_eval plot`: success and precision plots as SVG, PNG, PDF and CSV.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use infopart::program::BadInput;
use otb_eval::{
    figures::{NamedPlot, long_term_plot, plots},
    plots::{Appearance, curves_csv, points_csv},
    protocol::Protocol,
    toolkits::Toolkit,
};

use super::{score::write, scored::ScoredArgs};

pub const EXAMPLES: &str = "\
Examples:
  otb_eval plot --data otb people --results results --out plots
  otb_eval plot --data OTB100.json --results published --attributes none --out plots

A figure for one column of a paper: letters of 8 points, no title, the five best and one's own, which is in front and in colour:
  otb_eval plot --data OTB100.json --results published --out figures --format pdf --width 3.5in --font-size 8 \\
    --no-title --top 5 --highlight infopart

Written into DIR, for every protocol of which there are results, and for every attribute that some sequence has:
  success_ope.svg, .png, .csv       and precision_ope, normalised_precision_ope
  success_ope_OCC.svg, .png, .csv   and so on
  long_term_ope                     precision and recall over confidence thresholds, with --long-term, or unasked where the
                                    data has frames without a target; a tracker that tells no confidence is a short dash
Legends rank trackers by AUC, by precision at 20 pixels, by normalised precision at 0.2, and by F.";

/// Larger letters leave no room for curves.
const LARGEST_TEXT: f64 = 3.0;

#[derive(Debug, Args)]
pub struct PlotArgs {
    #[command(flatten)]
    scored: ScoredArgs,
    /// Where the plots go
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Whose rules, as `otb_eval score` has them [default: the data set's own; for OTB plain]
    #[arg(long, value_name = "NAME")]
    toolkit: Option<Toolkit>,
    /// Which results: ope, tre or sre [default: all there are]
    #[arg(long, value_name = "ope|tre|sre")]
    protocol: Option<Protocol>,
    /// What is written: svg, png, pdf (its font embedded), and the curves as csv
    #[arg(long, value_enum, value_delimiter = ',', default_value = "svg,png,csv")]
    format: Vec<PlotFormat>,
    /// Width of the figure: a number with in, mm, cm, pt or px; the PNG has 300 pixels an inch of it
    /// [default: 720px, the PNG 1440 pixels]
    #[arg(long, value_name = "LENGTH", value_parser = parse_length)]
    width: Option<f64>,
    /// Size of the axes' labels in the figure, points; other texts keep their proportion to it [default: 2.2 % of the width]
    #[arg(long, value_name = "POINTS", value_parser = parse_points)]
    font_size: Option<f64>,
    /// Only the N best ranked trackers of each plot, and that of --highlight
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    top: Option<u16>,
    /// The tracker that is drawn in front and alone in colour
    #[arg(long, value_name = "TRACKER")]
    highlight: Option<String>,
    /// Draw no title: a paper has it in the caption
    #[arg(long)]
    no_title: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum PlotFormat {
    Svg,
    Png,
    Pdf,
    Csv,
}

impl PlotFormat {
    const fn extension(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Png => "png",
            Self::Pdf => "pdf",
            Self::Csv => "csv",
        }
    }
}

/// A length in points.
fn parse_length(word: &str) -> Result<f64, String> {
    const UNITS: [(&str, f64); 5] =
        [("in", 72.0), ("mm", 72.0 / 25.4), ("cm", 72.0 / 2.54), ("pt", 1.0), ("px", 0.75)];
    let points = UNITS.iter().find_map(|(unit, points)| {
        let number: f64 = word.strip_suffix(unit)?.trim().parse().ok()?;
        Some(number * points)
    });
    points.filter(|points| (36.0..=7200.0).contains(points)).ok_or_else(|| {
        format!("`{word}` is no width from 0.5in to 100in; give, for example, 3.5in, 88mm or 720px")
    })
}

fn parse_points(word: &str) -> Result<f64, String> {
    let points = word.strip_suffix("pt").unwrap_or(word).trim().parse::<f64>().ok();
    points
        .filter(|points| (1.0..=1000.0).contains(points))
        .ok_or_else(|| format!("`{word}` is no size of letters; give points, for example 8"))
}

impl PlotArgs {
    fn appearance(&self) -> Result<Appearance> {
        let appearance = Appearance {
            width_points: self.width,
            font_points: self.font_size,
            has_title: !self.no_title,
            highlight: self.highlight.clone(),
        };
        let factor = appearance.text_factor();
        if factor > LARGEST_TEXT {
            let most = self.font_size.unwrap_or_default() * LARGEST_TEXT / factor;
            return Err(BadInput(format!(
                "--font-size: letters so large leave no room for curves; give at most {most:.1}, or a larger --width"
            ))
            .into());
        }
        Ok(appearance)
    }

    /// The plot in each format asked for.
    fn write(&self, NamedPlot { name, plot }: NamedPlot, appearance: &Appearance) -> Result<()> {
        let plot = match self.top {
            Some(count) => plot.top(usize::from(count), self.highlight.as_deref()),
            None => plot,
        };
        let context = || format!("plot {name}");
        for format in &self.format {
            let bytes = match format {
                PlotFormat::Svg => plot.svg_as(appearance).with_context(context)?.into_bytes(),
                PlotFormat::Png => plot.png(appearance).with_context(context)?,
                PlotFormat::Pdf => plot.pdf(appearance).with_context(context)?,
                PlotFormat::Csv if plot.curves.windows(2).any(|pair| pair[0].x != pair[1].x) => {
                    points_csv(&plot.curves).into_bytes()
                }
                PlotFormat::Csv => curves_csv(&plot.curves).with_context(context)?.into_bytes(),
            };
            write(&self.out.join(format!("{name}.{}", format.extension())), &bytes)?;
        }
        Ok(())
    }
}

pub fn plot(args: &PlotArgs) -> Result<()> {
    let appearance = args.appearance()?;
    let (dataset, mut problems) = args.scored.data.open()?;
    let mut written = 0;
    let toolkit = args.toolkit.unwrap_or_else(|| Toolkit::of(dataset.benchmark()));
    for (results, table) in args.scored.tables(&dataset, args.protocol, toolkit, &mut problems)? {
        if let Some(name) = &args.highlight
            && !table.trackers.iter().any(|one| one.tracker == *name)
        {
            let there: Vec<&str> = table.trackers.iter().map(|one| one.tracker.as_str()).collect();
            let there = there.join(", ");
            let message =
                format!("--highlight: there are no results of the tracker `{name}`, but of: {there}");
            return Err(BadInput(message).into());
        }
        let mut named = plots(&table);
        if table.protocol == Protocol::Ope
            && let Some(scores) = args.scored.long_term(&dataset, &results, toolkit, true)?
        {
            named.extend(long_term_plot(&scores));
        }
        for one in named {
            args.write(one, &appearance)?;
            written += 1;
        }
    }
    let formats: Vec<&str> = args.format.iter().map(|format| format.extension()).collect();
    eprintln!("{written} plots, each as {}, in {}", formats.join(", "), args.out.display());
    problems.into_strict_result(args.scored.strict)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_units() {
        assert_eq!(parse_length("3.5in"), Ok(252.0));
        assert_eq!(parse_length("720px"), Ok(540.0));
        assert!((parse_length("88mm").unwrap() - 249.448).abs() < 0.001);
        for word in ["3.5", "in", "-3in", "0.1in", "nanin", "infin", "3 ft"] {
            assert!(parse_length(word).unwrap_err().contains("88mm"), "{word}");
        }
        assert!(parse_points("8pt") == Ok(8.0) && parse_points("x").is_err() && parse_points("NaN").is_err());
    }
}
