//! `from = { … }`: an input that is the result of another budget, or a saved one.

use std::io::ErrorKind;

use super::checker::Checker;
use super::register::{InputEntry, Register, blank};
use super::taken::{OtherResult, Taken};
use crate::budget::faults::{
    FROM, FROM_CIRCLE, FROM_DEEP, FROM_MEASURAND, FROM_REFUSED, SAVED_RESULT, UNIT_CLASH,
};
use crate::budget::open_files::{DEEPEST, Missing};
use crate::budget::tables::{FromTable, InputTable};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, Said, nearest, say};
use gumption_format::toml::Stated;
use gumption_format::toml::faults::UNREADABLE_FILE;
use smol_str::SmolStr;

/// One thing to choose from in another file.
struct Candidate<'a> {
    row: Option<&'a str>,
    measurand: &'a str,
}

impl Checker<'_> {
    /// Reads an input that is a result of another file.
    pub(super) fn taken(
        &mut self,
        name: &SmolStr,
        stated: &Stated<InputTable>,
        from: &Stated<FromTable>,
        register: &mut Register,
    ) {
        let table = &stated.value;
        let start = register.inputs.len();
        let found = self.from(name, table, from);
        register.incomplete |= found.is_none();
        let mut unit = None;
        let mut end = start;
        if let Some((result, file, found)) = found {
            if let OtherResult::Saved { saved, result } = &result {
                let saved = &saved.results[*result];
                let conversion = saved.unit.conversion_to(&found);
                let mut input = blank(name, table, Some(&found), None);
                input.estimate = conversion.map_or(f64::NAN, |c| c.apply(saved.estimate));
                register.inputs.push(input);
                end = start + 1;
            }
            register.taken.push(Taken {
                entry: register.entries.len(),
                result,
                file,
                group: table.group.as_ref().map(|text| text.value.clone()),
                place: from.span.clone(),
            });
            unit = Some(found);
        }
        register.entries.push(InputEntry {
            name: name.clone(),
            place: stated.key.clone(),
            places: start..end,
            vector: false,
            unit,
            formula: None,
        });
    }

    /// The result, its file as the user names it, and the unit of the input.
    fn from(
        &mut self,
        name: &str,
        table: &InputTable,
        from: &Stated<FromTable>,
    ) -> Option<(OtherResult, String, Unit)> {
        let alone = self.nothing_beside(name, table, from);
        let hidden = table.unit.is_none() && table.present.iter().any(|(key, _)| *key == "unit");
        if from.value.refused {
            return None;
        }
        let (result, file) = match (&from.value.budget, &from.value.result) {
            (Some(budget), None) => (self.budget_result(budget, from)?, budget.value.clone()),
            (None, Some(result)) => (self.saved_result(result, from)?, result.value.clone()),
            (budget, _) => {
                let fault = Fault::new(
                    FROM,
                    from.span.clone(),
                    match budget {
                        Some(_) => say!("{name} comes from two files"),
                        None => say!("it is not said from which file {name} comes"),
                    },
                );
                return self.refuse(
                    fault
                        .label(say!("expected `budget` or `result`"))
                        .help(say!("write from = {{ budget = \"other.toml\", measurand = \"Y\" }}, or result = \"saved.json\" for a saved result")),
                );
            }
        };
        let theirs = match &result {
            OtherResult::Budget {
                loaded,
                row,
                output,
            } => loaded.rows[*row].budget.model.outputs()[*output]
                .unit
                .clone(),
            OtherResult::Saved { saved, result } => saved.results[*result].unit.clone(),
        };
        let unit = match &table.unit {
            None if hidden => return None,
            None => theirs.clone(),
            Some(text) => {
                let unit = self.unit(&table.unit)?;
                let fits =
                    theirs.dimension == unit.dimension && theirs.is_point() == unit.is_point();
                if !fits {
                    return self.refuse(
                        Fault::new(
                            UNIT_CLASH,
                            text.span.clone(),
                            say!(
                                "the result in {file} is in {}, {name} in {}",
                                theirs.symbol,
                                unit.symbol
                            ),
                        )
                        .label(say!("units do not fit"))
                        .related(from.span.clone(), say!("a result in {}", theirs.symbol))
                        .help(say!(
                            "write unit = \"{}\", or leave the unit out",
                            theirs.symbol
                        )),
                    );
                }
                unit
            }
        };
        alone.then_some((result, file, unit))
    }

    /// Whether the input states nothing that the other file states already.
    fn nothing_beside(&mut self, name: &str, table: &InputTable, from: &Stated<FromTable>) -> bool {
        let own = table.present.iter();
        let beside = own
            .filter(|(key, _)| !["unit", "description", "group", "from"].contains(key))
            .chain(&table.component.present)
            .next();
        let Some((key, place)) = beside else {
            return true;
        };
        self.report(
            Fault::new(
                FROM,
                place.clone(),
                say!("{name} comes from another file, and `{key}` is stated beside it"),
            )
            .label(say!("stated there already"))
            .related(from.key.clone(), say!("the other file"))
            .help(say!(
                "remove it; a further reason for doubt is an input of its own that the model adds"
            )),
        );
        false
    }

    fn budget_result(
        &mut self,
        file: &Stated<String>,
        from: &Stated<FromTable>,
    ) -> Option<OtherResult> {
        let path = self.source.origin.directory.join(&file.value);
        if path
            .extension()
            .is_some_and(|extension| extension == "json")
        {
            return self.refuse(
                Fault::new(
                    FROM,
                    file.span.clone(),
                    say!("{} is no budget by its name", file.value),
                )
                .label(say!("expected a budget (*.toml)"))
                .help(say!("for a saved result write result = \"{}\"", file.value)),
            );
        }
        let loaded = match self.source.origin.files.budget(&path) {
            Ok(loaded) => loaded,
            Err(missing) => return self.missing(file, missing),
        };
        let labels: Vec<String> = loaded
            .rows
            .iter()
            .enumerate()
            .map(|(index, row)| row.label.clone().unwrap_or_else(|| (index + 1).to_string()))
            .collect();
        let series = loaded.rows.len() > 1 || loaded.rows.iter().any(|row| row.label.is_some());
        let mut candidates = Vec::new();
        let mut places = Vec::new();
        for (row, label) in labels.iter().enumerate() {
            for (output, found) in loaded.rows[row].budget.model.outputs().iter().enumerate() {
                candidates.push(Candidate {
                    row: series.then_some(label.as_str()),
                    measurand: &found.name,
                });
                places.push((row, output));
            }
        }
        let (row, output) = places[self.choice(&file.value, from, &candidates)?];
        Some(OtherResult::Budget {
            loaded,
            row,
            output,
        })
    }

    fn saved_result(
        &mut self,
        file: &Stated<String>,
        from: &Stated<FromTable>,
    ) -> Option<OtherResult> {
        let path = self.source.origin.directory.join(&file.value);
        let saved = match self.source.origin.files.saved(&path) {
            Ok(saved) => saved,
            Err(missing) => return self.missing(file, missing),
        };
        let candidates: Vec<Candidate<'_>> = saved
            .results
            .iter()
            .map(|result| Candidate {
                row: result.row.as_deref(),
                measurand: &result.measurand,
            })
            .collect();
        let result = self.choice(&file.value, from, &candidates)?;
        Some(OtherResult::Saved { saved, result })
    }

    /// Which of the results of another file is meant.
    fn choice(
        &mut self,
        file: &str,
        from: &Stated<FromTable>,
        candidates: &[Candidate<'_>],
    ) -> Option<usize> {
        let different = |names: Vec<&str>| {
            let mut found: Vec<String> = Vec::new();
            for name in names {
                if !found.iter().any(|known| known == name) {
                    found.push(name.to_string());
                }
            }
            found
        };
        let rows = different(candidates.iter().filter_map(|c| c.row).collect());
        let measurands = different(candidates.iter().map(|c| c.measurand).collect());
        let row = from
            .value
            .row
            .as_ref()
            .map(|row| row.map(|row| row.0.clone()));
        let row = self.one(file, from, What::Row, row.as_ref(), &rows)?;
        let measurand = from.value.measurand.as_deref();
        let measurand = self.one(file, from, What::Measurand, measurand, &measurands)?;
        candidates
            .iter()
            .position(|c| c.row == row.as_deref() && Some(c.measurand) == measurand.as_deref())
    }

    /// One of several names, stated or the only one. Nothing is chosen where there is nothing to choose from.
    fn one(
        &mut self,
        file: &str,
        from: &Stated<FromTable>,
        what: What,
        stated: Option<&Stated<String>>,
        names: &[String],
    ) -> Option<Option<String>> {
        match (stated, names) {
            (None, []) => Some(None),
            (None, [only]) => Some(Some(only.clone())),
            (Some(stated), _) if names.contains(&stated.value) => Some(Some(stated.value.clone())),
            (Some(stated), _) => {
                let wanted = &stated.value;
                let message = match names {
                    [] => say!("{file} has no series, and so no row \"{wanted}\""),
                    _ => what.absent(file, wanted),
                };
                let fault =
                    Fault::new(FROM_MEASURAND, stated.span.clone(), message).label(what.no_such());
                let near = nearest(wanted, names.iter().map(String::as_str));
                self.refuse(match (near, names) {
                    (_, []) => fault.help(say!("leave out `row`")),
                    (Some(near), _) => fault.help(say!("did you mean \"{near}\"?")),
                    (None, _) => fault.help(say!("it has: {}", shortened(names))),
                })
            }
            (None, _) => {
                let message = what.several(file, names.len());
                let fault = Fault::new(FROM_MEASURAND, from.span.clone(), message);
                let key = what.key();
                let help = say!("add {key} = \"…\", one of: {}", shortened(names));
                self.refuse(fault.label(what.which()).help(help))
            }
        }
    }

    fn missing<T>(&mut self, file: &Stated<String>, missing: Missing) -> Option<T> {
        let name = &file.value;
        let fault = |code, message: Said| Fault::new(code, file.span.clone(), message);
        let fault = match missing {
            Missing::Refused => fault(FROM_REFUSED, say!("{name} has faults itself"))
                .label(say!("cannot be used as it is"))
                .help(say!("its faults are listed after those of this file")),
            Missing::Circle(files) => {
                let names: Vec<String> = files
                    .iter()
                    .chain(files.first())
                    .map(|file| file.file_name().unwrap_or_default().display().to_string())
                    .collect();
                let (message, label) = if names.len() == 2 {
                    (
                        say!("a budget uses its own result"),
                        say!("this file itself"),
                    )
                } else {
                    let chain = names.iter().skip(1).fold(
                        names.first().map(|first| say!("{first}")).unwrap_or_default(),
                        |chain, next| say!("{chain} uses {next}"),
                    );
                    let circle = say!("a circle: {chain}");
                    (
                        say!("{name} needs the result of this file itself"),
                        circle,
                    )
                };
                fault(FROM_CIRCLE, message)
                    .label(label)
                    .help(say!("a result cannot depend on itself: put what both need into a third file"))
            }
            Missing::Deep => fault(
                FROM_DEEP,
                say!("more than {DEEPEST} budgets use one another, down to {name}"),
            )
            .label(say!("one too many"))
            .help(say!("save the result of a budget in between with --save, and go on from it with `from = {{ result = … }}`")),
            Missing::Unfit(_) if name.ends_with(".toml") => fault(
                SAVED_RESULT,
                say!("{name} is a budget, not a file of saved results"),
            )
            .label(say!("expected a file that `gumption eval --save` wrote"))
            .help(say!("for another budget write budget = \"{name}\"")),
            Missing::Unfit(why) => fault(
                SAVED_RESULT,
                say!("{name} holds no saved results: {why}"),
            )
            .label(say!("expected a file that `gumption eval --save` wrote"))
            .help(say!("write it with: gumption eval BUDGET --save {name}")),
            Missing::Folder => fault(UNREADABLE_FILE, say!("{name} is a folder, not a file"))
                .label(say!("expected a file")),
            Missing::Unreadable(error) => {
                let message = match error.kind() {
                    ErrorKind::NotFound => {
                        say!("there is no file {name} in {}", self.source.origin.folder())
                    }
                    ErrorKind::PermissionDenied => say!("{name} may not be read"),
                    _ => say!("{name} cannot be read: {error}"),
                };
                fault(UNREADABLE_FILE, message)
                    .label(say!("expected a file"))
                    .help(self.source.origin.mend(name))
            }
        };
        self.refuse(fault)
    }
}

/// What is chosen in another file.
#[derive(Clone, Copy)]
enum What {
    Row,
    Measurand,
}

impl What {
    /// The key that states it.
    fn key(self) -> &'static str {
        match self {
            What::Row => "row",
            What::Measurand => "measurand",
        }
    }

    fn absent(self, file: &str, wanted: &str) -> Said {
        match self {
            What::Row => say!("{file} has no row {wanted}"),
            What::Measurand => say!("{file} has no measurand {wanted}"),
        }
    }

    fn no_such(self) -> Said {
        match self {
            What::Row => say!("no such row"),
            What::Measurand => say!("no such measurand"),
        }
    }

    fn several(self, file: &str, count: usize) -> Said {
        match self {
            What::Row => say!("{file} has {count} rows"),
            What::Measurand => say!("{file} has {count} measurands"),
        }
    }

    fn which(self) -> Said {
        match self {
            What::Row => say!("which row?"),
            What::Measurand => say!("which measurand?"),
        }
    }
}

/// At most a dozen names.
fn shortened(names: &[String]) -> Said {
    Said::first(names, 12)
}
