//! `gumption import`: a budget file from a spreadsheet or a file of another program.

use std::path::PathBuf;

use super::audit::{found, nothing};
use super::output::Target;
use super::{Outcome, output};
use gumption::audit::budget_files;
use gumption::audit::read::Mapping;
use gumption::fault::say;
use gumption::files::Files;
use gumption::report::Language;

use super::language::system_language;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Spreadsheet (.xlsx, .xls, .ods), table (.csv, .tsv, .md, .txt), or file of another program (.yaml of suncal, .um, .smu,
    /// .txp)
    #[arg(value_name = "SHEET")]
    sheet: PathBuf,
    /// Which budget of the sheet, from 1
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    budget: u32,
    /// What the columns hold, as `gumption audit --map` writes it
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Language of messages and of the comments in the file: en or zh [default: that of the system]
    #[arg(long, value_name = "LANG", default_value = system_language(), hide_default_value = true)]
    lang: Language,
    #[command(flatten)]
    target: Target,
}

pub(super) fn run(args: &Args) -> Outcome {
    let mapping = match &args.map {
        None => Mapping::default(),
        Some(path) => {
            let name = path.display();
            let bytes = match Files::Disk.read(path) {
                Ok(bytes) => bytes,
                Err(error) => return output::complain(say!("cannot read {name}: {error}")),
            };
            match Mapping::parse(&String::from_utf8_lossy(&bytes)) {
                Ok(mapping) => mapping,
                Err(why) => return output::complain(say!("{name}: {why}")),
            }
        }
    };
    let find = |name: &_, bytes: &_, mapping: &_| budget_files(name, bytes, mapping, args.lang);
    let mut budgets = match found(&args.sheet, &mapping, find) {
        Ok(budgets) => budgets,
        Err(complaint) => return output::complain(complaint),
    };
    let name = args.sheet.display();
    let wanted = args.budget as usize - 1;
    if wanted >= budgets.len() {
        return match budgets.len() {
            0 => output::complain(nothing(&args.sheet)),
            count => output::complain(say!("{name} holds {count} budgets")),
        };
    }
    let file = budgets.swap_remove(wanted);
    args.target.write(file.into_bytes(), Vec::new())
}
