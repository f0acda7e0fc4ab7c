//! `otb_eval plot`: success and precision plots as SVG, PNG and CSV.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;
use otb_eval::{figures::plots, plots::curves_csv, protocol::Protocol, toolkits::Toolkit};

use super::{score::write, scored::ScoredArgs};

pub const EXAMPLES: &str = "\
Examples:
  otb_eval plot --data otb people --results results --out plots
  otb_eval plot --data OTB100.json --results published --attributes none --out plots

Written into DIR, for every protocol of which there are results, and for every attribute that some sequence has:
  success_ope.svg, .png, .csv       and precision_ope, normalised_precision_ope
  success_ope_OCC.svg, .png, .csv   and so on
Legends rank trackers by AUC, by precision at 20 pixels, and by normalised precision at 0.2.";

#[derive(Debug, Args)]
pub struct PlotArgs {
    #[command(flatten)]
    scored: ScoredArgs,
    /// Where the plots go
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Whose rules
    #[arg(long, value_name = "NAME", default_value = "plain")]
    toolkit: Toolkit,
    /// Which results: ope, tre or sre [default: all there are]
    #[arg(long, value_name = "ope|tre|sre")]
    protocol: Option<Protocol>,
}

pub fn plot(args: &PlotArgs) -> Result<()> {
    let (dataset, mut problems) = args.scored.data.open()?;
    let mut written = 0;
    for (_, table) in args.scored.tables(&dataset, args.protocol, args.toolkit, &mut problems)? {
        for named in plots(&table) {
            let path = |extension: &str| args.out.join(format!("{}.{extension}", named.name));
            let context = || format!("plot {}", named.name);
            write(&path("svg"), named.plot.svg().with_context(context)?.as_bytes())?;
            write(&path("png"), &named.plot.png().with_context(context)?)?;
            write(&path("csv"), curves_csv(&named.plot.curves).with_context(context)?.as_bytes())?;
            written += 1;
        }
    }
    eprintln!("{written} plots, each as SVG, PNG and CSV, in {}", args.out.display());
    problems.into_strict_result(args.scored.strict)
}
