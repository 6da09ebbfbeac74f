//! From the text of a case to a checked [`Case`]: recording, columns, constants, noise, settings.

use std::ops::Range;
use std::path::Path;

use toml::de::DeTable;

use super::declared::{self, Declared};
use super::tables::{AverageEntry, CaseTable, ColumnTable, RoleWord};
use super::{
    Action, Averaging, Blocks, Case, Column, Data, NoiseClaim, NoiseOrigin, Purpose, Settings,
};
use crate::budget::faults::{NOT_UTF8, UNREADABLE_FILE};
use crate::budget::strings::StringMap;
use crate::budget::table::{Reader, Stated, read_table};
use crate::budget::values::Amount;
use crate::budget::{Files, Rejection, syntax_faults};
use crate::diagnose::faults::{MISSING, NOISE, ROLE, SETTING, UNIT_CLASH, UNKNOWN_NAME};
use crate::fault::{Fault, nearest};
use crate::model::{Role as SymbolRole, Symbol};
use crate::propagate;
use crate::quantity::{Unit, UnitTable};
use crate::recording;
use crate::recording::{Content, Recording, Request, headings};

/// Reads and checks a case.
pub(super) fn load(files: Files<'_>, path: &Path, purpose: Purpose) -> Result<Case, Rejection> {
    let name = path.display().to_string();
    let reject = |text: &str, faults| Rejection::new(&name, text, faults);
    let bytes = files.read(path).map_err(|error| {
        let message = format!("{name} cannot be read: {error}");
        let fault = Fault::new(UNREADABLE_FILE, 0..0, message);
        reject(
            "",
            vec![fault.help("name a case, as in `gumption diagnose case.toml`")],
        )
    })?;
    let text = String::from_utf8(bytes).map_err(|_| {
        let fault = Fault::new(NOT_UTF8, 0..0, format!("{name} is not UTF-8 text"));
        reject("", vec![fault.help("save the file as UTF-8")])
    })?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text).to_owned();
    let (table, errors) = DeTable::parse_recoverable(&text);
    if !errors.is_empty() {
        return Err(reject(&text, syntax_faults(&errors, &text)));
    }
    let mut reader = Reader {
        file: &text,
        faults: Vec::new(),
    };
    let file = read_table::<CaseTable>(table.get_ref(), "a case", &mut reader);
    let mut checker = Checker {
        text: &text,
        folder: path.parent().unwrap_or_else(|| Path::new("")),
        files,
        purpose,
        units: UnitTable::default(),
        faults: reader.faults,
    };
    checker.units(&file);
    checker.case(&file, path, &name)
}

/// What is needed everywhere while a case is checked.
pub(super) struct Checker<'a> {
    pub text: &'a str,
    pub folder: &'a Path,
    pub files: Files<'a>,
    pub purpose: Purpose,
    pub units: UnitTable,
    pub faults: Vec<Fault>,
}

impl Checker<'_> {
    fn case(mut self, file: &CaseTable, path: &Path, name: &str) -> Result<Case, Rejection> {
        let (Some(recording), Some(models)) = (&file.recording, &file.model) else {
            self.missing(file);
            return Err(Rejection::new(name, self.text, self.faults));
        };
        let Some(csv) = recording.value.0.file.as_ref() else {
            self.faults.push(
                Fault::new(MISSING, recording.key.clone(), "the recording has no file")
                    .label("`file` is missing"),
            );
            return Err(Rejection::new(name, self.text, self.faults));
        };
        let csv_path = self.folder.join(&csv.value);
        let headings = self.headings(&csv_path, csv)?;
        let constants = self.constants(file);
        let wanted = self.wanted(file, models, &headings, &constants);
        if !self.faults.is_empty() {
            return Err(Rejection::new(name, self.text, self.faults));
        }
        let present = wanted.iter().filter(|w| w.present);
        let requests: Vec<Request> = present.map(|w| w.request.clone()).collect();
        let recorded = Recording::open(self.files, &csv_path, &requests, &self.units)?;
        let (columns, rows, left_out) = self.columns(&wanted, &recorded);
        let declared = declared::declared(&mut self, file, models, &columns, &constants);
        let noise = self.noise(file, &columns, declared.as_ref());
        let averaging = self.averaging(file, &columns);
        let settings = self.settings(file);
        let actions = self.actions(file);
        let candidates = match &declared {
            Some(declared) => declared::candidates(&mut self, file, &columns, &constants, declared),
            None => Vec::new(),
        };
        let (Some(declared), true) = (declared, self.faults.is_empty()) else {
            return Err(Rejection::new(name, self.text, self.faults));
        };
        Ok(Case {
            title: file.title.as_ref().map_or_else(
                || {
                    path.file_stem()
                        .unwrap_or_default()
                        .to_string_lossy()
                        .into_owned()
                },
                |title| title.value.clone(),
            ),
            reference: file.reference.as_ref().map(|text| text.value.clone()),
            note: file.note.as_ref().map(|text| text.value.clone()),
            text: self.text.to_owned(),
            path: path.to_path_buf(),
            units: self.units,
            rows,
            left_out,
            columns,
            parameters: declared.parameters,
            constants,
            responses: declared.responses,
            equations: declared.equations,
            model: models.value.0.iter().map(|m| m.value.clone()).collect(),
            noise,
            candidates,
            actions,
            averaging,
            settings,
        })
    }

    fn missing(&mut self, file: &CaseTable) {
        for (present, key, example) in [
            (
                file.recording.is_some(),
                "recording",
                "recording = \"readings.csv\"",
            ),
            (file.model.is_some(), "model", "model = \"y = a + b * x\""),
        ] {
            let stated = file.present.iter().any(|(name, _)| *name == key);
            if !present && !stated {
                self.faults.push(
                    Fault::new(MISSING, 0..0, format!("the case has no `{key}`"))
                        .label("missing in this file")
                        .help(format!("add for example {example}")),
                );
            }
        }
    }

    fn headings(
        &self,
        path: &Path,
        csv: &Stated<String>,
    ) -> Result<Vec<recording::Heading>, Rejection> {
        // The recording's own reader has the words for what is wrong with the file.
        let bytes = match self.files.read(path) {
            Ok(bytes) => bytes,
            Err(_) => {
                let missing = Recording::open(self.files, path, &[], &self.units);
                return Err(missing.err().unwrap_or_else(|| {
                    let fault = Fault::new(
                        UNREADABLE_FILE,
                        csv.span.clone(),
                        "the recording cannot be read",
                    );
                    Rejection::new("", self.text, vec![fault])
                }));
            }
        };
        let text = String::from_utf8_lossy(&bytes).into_owned();
        headings(&text, &self.units)
            .map_err(|fault| Rejection::new(&path.display().to_string(), &text, vec![*fault]))
    }

    fn units(&mut self, file: &CaseTable) {
        let Some(named) = &file.unit else { return };
        for (name, definition) in &named.value.entries {
            if self.units.define(name, &definition.value).is_err() {
                self.faults.push(
                    Fault::new(
                        UNIT_CLASH,
                        definition.span.clone(),
                        format!("{:?} does not define a unit", definition.value),
                    )
                    .label("expected other units, with a number if need be: \"0.5 mV\""),
                );
            }
        }
    }

    /// The unit of a text; the unit one where none is stated.
    pub fn unit(&mut self, stated: Option<&Stated<String>>) -> Option<Unit> {
        let Some(stated) = stated else {
            return Some(Unit::one());
        };
        match self.units.parse(&stated.value) {
            Ok(unit) => Some(unit),
            Err(error) => {
                let map = StringMap::new(self.text, stated.span.clone());
                let fault = Fault::from(error).moved(|range| match &map {
                    Some(map) if map.text() == stated.value => map.place(range),
                    _ => stated.span.clone(),
                });
                self.faults.push(fault);
                None
            }
        }
    }

    /// An amount in a unit.
    pub fn quantity(&mut self, amount: &Stated<Amount>, unit: &Unit) -> Option<f64> {
        let Some((text, span)) = &amount.value.unit else {
            return Some(amount.value.number);
        };
        let stated = Stated {
            value: text.clone(),
            span: span.clone(),
            key: span.clone(),
        };
        let own = self.unit(Some(&stated))?;
        match own.conversion_to(unit) {
            Some(conversion) => Some(conversion.apply(amount.value.number)),
            None => {
                self.faults.push(
                    Fault::new(
                        UNIT_CLASH,
                        span.clone(),
                        format!(
                            "an amount in {} cannot be one in {}",
                            own.symbol, unit.symbol
                        ),
                    )
                    .label(format!("expected a unit such as {}", unit.symbol)),
                );
                None
            }
        }
    }

    /// A positive amount in the unit of differences.
    pub fn spread(&mut self, amount: &Stated<Amount>, unit: &Unit) -> Option<f64> {
        let value = self.quantity(amount, &unit.difference())?;
        if value > 0.0 {
            return Some(value);
        }
        self.faults.push(
            Fault::new(
                SETTING,
                amount.span.clone(),
                "a standard uncertainty is positive",
            )
            .label("expected a positive number"),
        );
        None
    }

    fn constants(&mut self, file: &CaseTable) -> Vec<Symbol> {
        let Some(named) = &file.constant else {
            return Vec::new();
        };
        let mut constants = Vec::new();
        for (name, stated) in &named.value.entries {
            let table = &stated.value.0;
            let unit = self.unit(table.unit.as_ref()).unwrap_or_else(Unit::one);
            let value = table
                .value
                .as_ref()
                .and_then(|value| self.quantity(value, &unit));
            let role = match (value, &table.values) {
                (Some(value), _) => SymbolRole::Constant(value),
                (None, Some(values)) => {
                    SymbolRole::ConstantVector(values.value.iter().map(|v| v.value).collect())
                }
                (None, None) => {
                    if table.value.is_none() && !table.refused {
                        self.faults.push(
                            Fault::new(
                                MISSING,
                                stated.span.clone(),
                                format!("the constant {name} has no value"),
                            )
                            .label("state `value`"),
                        );
                    }
                    continue;
                }
            };
            constants.push(Symbol {
                name: name.clone(),
                unit,
                role,
            });
        }
        constants
    }

    /// The columns that take part: the declared ones, and those that only the model names.
    fn wanted(
        &mut self,
        file: &CaseTable,
        models: &Stated<crate::budget::values::OneOrMany<String>>,
        headings: &[recording::Heading],
        constants: &[Symbol],
    ) -> Vec<Wanted> {
        let mut wanted = Vec::new();
        let declared = file
            .columns
            .as_ref()
            .map_or(&[][..], |named| named.value.entries.as_slice());
        for (name, stated) in declared {
            let table = &stated.value.0;
            let role = match &table.role {
                Some(role) => role.value,
                None => {
                    if !table.refused {
                        self.faults.push(
                            Fault::new(
                                MISSING,
                                stated.key.clone(),
                                format!("the column {name} has no role"),
                            )
                            .label("`role` is missing")
                            .help(format!("write for example {name} = \"covariate\"")),
                        );
                    }
                    continue;
                }
            };
            if role == RoleWord::Ignore {
                continue;
            }
            let header = table.column.as_ref().map_or(name, |column| &column.value);
            let present = headings
                .iter()
                .any(|h| h.text == *header || h.name == *header);
            if !present && !(self.purpose == Purpose::Plan && role == RoleWord::Output) {
                let span = table
                    .column
                    .as_ref()
                    .map_or(stated.key.clone(), |column| column.span.clone());
                self.no_column(header, span, headings);
                continue;
            }
            let unit = match &table.unit {
                Some(unit) => self.unit(Some(unit)),
                None => None,
            };
            wanted.push(Wanted::new(
                name,
                header,
                role,
                unit,
                present,
                Some((stated.key.clone(), table.clone())),
            ));
        }
        let known = |name: &str, wanted: &[Wanted]| {
            constants.iter().any(|constant| constant.name == name)
                || wanted.iter().any(|w| w.name == name)
                || declared.iter().any(|(declared, _)| declared == name)
        };
        for model in &models.value.0 {
            let Ok(outline) = crate::model::outline(&model.value, &self.units) else {
                continue;
            };
            let given = outline
                .gives
                .iter()
                .map(|(name, _)| (name, RoleWord::Output));
            let needed = outline
                .needs
                .iter()
                .map(|(name, _)| (name, RoleWord::Stimulus));
            for (name, role) in given.chain(needed) {
                let heading = headings.iter().any(|h| h.text == *name || h.name == *name);
                if heading && !known(name, &wanted) {
                    wanted.push(Wanted::new(name, name, role, None, true, None));
                }
            }
        }
        wanted
    }

    fn no_column(&mut self, name: &str, span: Range<usize>, headings: &[recording::Heading]) {
        let names: Vec<&str> = headings.iter().map(|h| h.name.as_str()).collect();
        let texts = headings.iter().map(|h| h.text.as_str());
        let help = match nearest(name, names.iter().copied().chain(texts)) {
            Some(near) => format!("did you mean \"{near}\"?"),
            None => format!("its columns are: {}", names.join(", ")),
        };
        self.faults.push(
            Fault::new(
                UNKNOWN_NAME,
                span,
                format!("the recording has no column \"{name}\""),
            )
            .label("not in the first line of the recording")
            .help(help),
        );
    }

    /// The columns without the rows that lack a value.
    fn columns(&mut self, wanted: &[Wanted], recorded: &Recording) -> (Vec<Column>, usize, usize) {
        let all = recorded.rows();
        let complete: Vec<usize> = (0..all)
            .filter(|row| {
                wanted.iter().all(|w| match recorded.numbers(&w.name) {
                    Some(numbers) => !w.present || numbers[*row].is_finite(),
                    None => true,
                })
            })
            .collect();
        let mut columns = Vec::new();
        for w in wanted {
            let column = recorded.column(&w.name);
            let unit = match (column.and_then(|c| c.unit.clone()), &w.unit) {
                (_, Some(unit)) => unit.clone(),
                (Some(unit), None) => unit,
                (None, None) => Unit::one(),
            };
            let data = if !w.present {
                Data::Absent
            } else if let Some(numbers) = recorded.numbers(&w.name) {
                Data::Numbers(complete.iter().map(|row| numbers[*row]).collect())
            } else if let Some(labels) = recorded.labels(&w.name) {
                Data::Labels(recording::Labels {
                    levels: labels.levels.clone(),
                    of_row: complete.iter().map(|row| labels.of_row[*row]).collect(),
                })
            } else {
                Data::Absent
            };
            let (u, u_common) = match &w.stated {
                Some((_, table)) => (
                    table.u.as_ref().and_then(|u| self.spread(u, &unit)),
                    table.u_common.as_ref().and_then(|u| self.spread(u, &unit)),
                ),
                None => (None, None),
            };
            columns.push(Column {
                name: w.name.clone(),
                header: column.map_or_else(|| w.header.clone(), |c| c.header.clone()),
                role: w.role,
                unit,
                data,
                u,
                u_common,
            });
        }
        (columns, complete.len(), all - complete.len())
    }

    fn noise(
        &mut self,
        file: &CaseTable,
        columns: &[Column],
        declared: Option<&Declared>,
    ) -> NoiseClaim {
        let per_row = columns
            .iter()
            .position(|column| column.role == RoleWord::Uncertainty);
        let Some(stated) = &file.noise else {
            return per_row.map_or(NoiseClaim::Estimated, NoiseClaim::PerRow);
        };
        let table = &stated.value;
        let ways = [
            table.u.is_some(),
            table.replicates.is_some(),
            table.at_rest.is_some(),
            table.budget.is_some(),
            table.from.is_some(),
            per_row.is_some(),
        ];
        if ways.iter().filter(|way| **way).count() != 1 {
            if !table.refused {
                self.faults.push(
                    Fault::new(NOISE, stated.span.clone(), "the noise is to be stated in one way")
                        .label("expected one of `u`, `replicates`, `at_rest`, `budget`, `from`, or a column \"u\""),
                );
            }
            return NoiseClaim::Estimated;
        }
        if let Some(column) = per_row {
            return NoiseClaim::PerRow(column);
        }
        let dof = table.dof.as_ref().map_or(f64::INFINITY, |dof| dof.value);
        if dof <= 0.0 {
            self.faults.push(Fault::new(
                SETTING,
                stated.span.clone(),
                "degrees of freedom are positive",
            ));
        }
        let responses = declared.map_or(&[][..], |declared| declared.responses.as_slice());
        if let Some(amount) = &table.u {
            let u: Vec<f64> = responses
                .iter()
                .filter_map(|response| self.spread(amount, &response.unit))
                .collect();
            let origin = NoiseOrigin::Case;
            return NoiseClaim::Stated { u, dof, origin };
        }
        if let Some(names) = &table.replicates {
            let found = names
                .value
                .0
                .iter()
                .filter_map(|name| self.known(name, columns))
                .collect();
            return NoiseClaim::Replicates(found);
        }
        if let Some(at_rest) = &table.at_rest {
            return self.at_rest(at_rest, columns, responses);
        }
        if let Some(path) = &table.budget {
            return self.budget(path, responses);
        }
        NoiseClaim::Estimated
    }

    fn at_rest(
        &mut self,
        stated: &Stated<super::tables::StaticTable>,
        columns: &[Column],
        responses: &[super::Response],
    ) -> NoiseClaim {
        let Some(file) = &stated.value.file else {
            self.faults.push(
                Fault::new(
                    NOISE,
                    stated.span.clone(),
                    "a recording at rest has a `file`",
                )
                .label("expected `file`"),
            );
            return NoiseClaim::Estimated;
        };
        let path = self.folder.join(&file.value);
        let named = stated
            .value
            .column
            .as_ref()
            .map(|column| column.value.as_str());
        match super::at_rest::read(self.files, &path, named, columns, responses, &self.units) {
            Ok(readings) => NoiseClaim::AtRest {
                file: file.value.clone(),
                readings,
            },
            Err(why) => {
                self.faults.push(Fault::new(
                    NOISE,
                    file.span.clone(),
                    format!("the recording at rest: {why}"),
                ));
                NoiseClaim::Estimated
            }
        }
    }

    /// The noise that a budget claims: the combined standard uncertainty of the measurand that is called like
    /// the response, or of its only one.
    fn budget(&mut self, path: &Stated<String>, responses: &[super::Response]) -> NoiseClaim {
        let refuse = |checker: &mut Self, message: String| {
            checker
                .faults
                .push(Fault::new(NOISE, path.span.clone(), message));
            NoiseClaim::Estimated
        };
        let loaded = match crate::budget::load(&self.folder.join(&path.value)) {
            Ok(loaded) => loaded,
            Err(rejection) => {
                let first = rejection
                    .faults
                    .first()
                    .map_or_else(String::new, |fault| fault.message.clone());
                return refuse(
                    self,
                    format!("the budget {} is refused: {first}", path.value),
                );
            }
        };
        let Some(row) = loaded.rows.first() else {
            return refuse(self, "the budget is empty".into());
        };
        let options = propagate::Options {
            monte_carlo: propagate::MonteCarloChoice::Off,
            ..propagate::Options::default()
        };
        let Ok(evaluation) = propagate::evaluate(&row.budget, &options) else {
            return refuse(self, "the budget has no result".into());
        };
        let outputs = row.budget.model.outputs();
        let mut u = Vec::new();
        let mut dof = f64::INFINITY;
        for response in responses {
            let named = outputs
                .iter()
                .position(|output| output.name == response.name);
            let only = (outputs.len() == 1).then_some(0);
            let Some(at) = named.or(only) else {
                return refuse(
                    self,
                    format!("the budget has no measurand {}", response.name),
                );
            };
            let own = outputs[at].unit.difference();
            let Some(conversion) = own.conversion_to(&response.unit.difference()) else {
                let message = format!(
                    "{} is in {} in the budget and in {} here",
                    response.name, own.symbol, response.unit.symbol
                );
                return refuse(self, message);
            };
            let gum = &evaluation.results[at].gum;
            u.push(conversion.apply(gum.u));
            dof = dof.min(match gum.freedom {
                propagate::Freedom::WelchSatterthwaite(dof)
                | propagate::Freedom::Ensembles(dof) => dof,
                propagate::Freedom::Refused { lower_bound, .. } => lower_bound,
                propagate::Freedom::Infinite => f64::INFINITY,
            });
        }
        NoiseClaim::Stated {
            u,
            dof,
            origin: NoiseOrigin::Budget(path.value.clone()),
        }
    }

    /// A column that a key names.
    pub fn known(&mut self, name: &Stated<String>, columns: &[Column]) -> Option<usize> {
        let found = columns.iter().position(|column| column.name == name.value);
        if found.is_none() {
            let names = columns.iter().map(|column| column.name.as_str());
            let fault = Fault::new(
                UNKNOWN_NAME,
                name.span.clone(),
                format!("the case has no column {}", name.value),
            )
            .label("not a column of this case");
            self.faults.push(match nearest(&name.value, names) {
                Some(near) => fault.help(format!("did you mean \"{near}\"?")),
                None => fault.help("declare it below [columns]"),
            });
        }
        found
    }

    fn averaging(&mut self, file: &CaseTable, columns: &[Column]) -> Averaging {
        let table = file
            .recording
            .as_ref()
            .map(|stated| stated.value.0.clone())
            .unwrap_or_default();
        let settle = table
            .settle_rows
            .as_ref()
            .map_or(0, |rows| rows.value as usize);
        let blocks = match (&table.dwells, &table.average) {
            (Some(names), _) => {
                let mut found = Vec::new();
                for name in &names.value.0 {
                    let Some(column) = self.known(name, columns) else {
                        continue;
                    };
                    if columns[column].labels().is_none() {
                        self.faults.push(
                            Fault::new(
                                ROLE,
                                name.span.clone(),
                                format!("{} holds numbers, not labels", name.value),
                            )
                            .label("expected a run, factor or position"),
                        );
                    }
                    found.push(column);
                }
                Blocks::Dwells(found)
            }
            (None, None) => Blocks::Auto,
            (None, Some(stated)) => match stated.value {
                AverageEntry::Auto => Blocks::Auto,
                AverageEntry::Nothing => Blocks::Rows,
                AverageEntry::AtMost(most) => Blocks::AtMost(most.max(1) as usize),
            },
        };
        Averaging { blocks, settle }
    }

    fn settings(&mut self, file: &CaseTable) -> Settings {
        let table = file
            .diagnosis
            .as_ref()
            .map(|stated| stated.value.clone())
            .unwrap_or_default();
        let texts = |list: &Option<Stated<Vec<Stated<String>>>>| {
            list.as_ref().map(|list| {
                list.value
                    .iter()
                    .map(|text| text.value.clone())
                    .collect::<Vec<_>>()
            })
        };
        let alpha = table.alpha.as_ref().map_or(0.01, |alpha| alpha.value);
        if !(alpha > 0.0 && alpha < 0.5) {
            let span = table
                .alpha
                .as_ref()
                .map_or(0..0, |alpha| alpha.span.clone());
            self.faults.push(
                Fault::new(
                    SETTING,
                    span,
                    format!("alpha = {alpha} is not a small probability"),
                )
                .label("expected a number between 0 and 0.5"),
            );
        }
        Settings {
            alpha,
            catalogue: texts(&table.catalogue),
            exclude: texts(&table.exclude).unwrap_or_default(),
            seed: table.seed.as_ref().map_or(1, |seed| seed.value),
            draws: table
                .draws
                .as_ref()
                .map_or(2000, |draws| draws.value.clamp(200, 100_000) as usize),
        }
    }

    fn actions(&mut self, file: &CaseTable) -> Vec<Action> {
        let list = file
            .action
            .as_ref()
            .map_or(&[][..], |list| list.value.0.as_slice());
        let mut actions = Vec::new();
        for stated in list {
            let (Some(name), Some(rows)) = (&stated.value.name, &stated.value.rows) else {
                self.faults.push(
                    Fault::new(
                        MISSING,
                        stated.span.clone(),
                        "a further measurement has a `name` and `rows`",
                    )
                    .label("expected both"),
                );
                continue;
            };
            actions.push(Action {
                name: name.value.clone(),
                cost: stated.value.cost.as_ref().map_or(1.0, |cost| cost.value),
                rows: self.folder.join(&rows.value),
            });
        }
        actions
    }
}

/// A column that is asked of the recording.
struct Wanted {
    name: String,
    header: String,
    role: RoleWord,
    unit: Option<Unit>,
    present: bool,
    stated: Option<(Range<usize>, ColumnTable)>,
    request: Request,
}

impl Wanted {
    fn new(
        name: &str,
        header: &str,
        role: RoleWord,
        unit: Option<Unit>,
        present: bool,
        stated: Option<(Range<usize>, ColumnTable)>,
    ) -> Wanted {
        let content = match role {
            RoleWord::Run
            | RoleWord::Factor
            | RoleWord::Position
            | RoleWord::Axis
            | RoleWord::Direction => Content::Labels,
            _ => Content::Numbers,
        };
        let request = Request {
            role: name.to_owned(),
            column: header.to_owned(),
            content,
            unit: unit.clone(),
            like: None,
        };
        Wanted {
            name: name.to_owned(),
            header: header.to_owned(),
            role,
            unit,
            present,
            stated,
            request,
        }
    }
}
