//! The columns of a recording that the file declares or its equations name: roles, headers, units.

use std::ops::Range;

use super::checker::Checker;
use super::entries::RoleWord;
use super::faults::{KEY, LABELS, UNKNOWN_SYMBOL, UNUSED};
use super::labels::label_columns;
use super::names::{Kind, Names};
use super::purpose::Purpose;
use super::source::entries;
use super::tables::ColumnTable;
use crate::recording::{Content, Heading, Request, headings, text_of};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, Rejection, nearest, say};
use gumption_format::toml::Stated;
use gumption_format::toml::writing::key;

/// A column of the recording.
#[derive(Debug, Clone)]
pub(crate) struct Column<'t> {
    /// As the file calls it.
    pub name: String,
    /// As the first line of the recording calls it.
    pub header: String,
    pub role: RoleWord,
    pub content: Content,
    /// The unit that the file states.
    pub unit: Option<Unit>,
    /// A unit of the dimension that it must have.
    pub like: Option<Unit>,
    /// Whether the recording has it.
    pub is_there: bool,
    /// What the file says of it.
    pub table: Option<&'t ColumnTable>,
}

impl Column<'_> {
    /// What to ask the recording for.
    pub fn request(&self) -> Request {
        Request {
            content: self.content,
            unit: self.unit.clone(),
            like: self.like.clone(),
            ..Request::numbers(&self.name, &self.header)
        }
    }
}

impl<'s> Checker<'s> {
    /// The first line of a recording. That there is no such file, or none that can be read, is a fault of the experiment,
    /// where it is named.
    ///
    /// # Errors
    /// Something is wrong in the recording.
    pub fn headings(
        &mut self,
        file: &Stated<String>,
    ) -> Result<Option<Vec<Heading>>, Box<Rejection>> {
        let path = self.folder.join(&file.value);
        let shown = path.display().to_string();
        let text = match text_of(self.files, &path, &shown) {
            Ok(text) => text,
            Err(rejection) if rejection.text.is_empty() => {
                let faults = rejection.faults.into_iter();
                let placed = faults.map(|fault| Fault {
                    span: file.span.clone(),
                    label: say!("expected a CSV file"),
                    ..fault
                });
                self.faults.extend(placed);
                return Ok(None);
            }
            Err(rejection) => return Err(Box::new(rejection)),
        };
        match headings(&text, &self.units) {
            Ok(headings) => Ok(Some(headings)),
            Err(fault) => Err(Box::new(Rejection::new(&shown, &text, vec![*fault]))),
        }
    }

    /// The columns that the file declares, and those that only equations or other keys name, as far as the
    /// recording has them: what it should have and lacks is a fault.
    pub fn columns(&mut self, names: &Names, headings: &[Heading]) -> Option<Vec<Column<'s>>> {
        let before = self.faults.len();
        let labels = label_columns(self);
        let mut columns = Vec::new();
        for (name, entry) in entries(&self.source.table.columns) {
            if let Some(column) = self.declared(name, entry, names, headings) {
                columns.push(column);
            }
        }
        let steps = self.source.table.recording.as_ref();
        let steps = steps.and_then(|recording| recording.value.0.steps.as_ref());
        let numbers = names
            .columns
            .iter()
            .map(|(name, place)| (name, Some(place)));
        let others = names.optional.iter().map(|name| (name, None));
        let stepped = steps.iter().flat_map(|steps| &steps.value.0);
        let stepped = stepped.map(|step| (&step.value, Some(&step.span)));
        for (name, place) in numbers.chain(stepped).chain(others) {
            if self.is_declared(name) || columns.iter().any(|c| c.name == *name) {
                continue;
            }
            match (is_there(headings, name), place) {
                (true, _) => columns.push(plain(name, names, Content::Numbers)),
                (false, Some(place)) => self.not_recorded(name, place, headings, names),
                // What only an omitted term needs may be missing.
                (false, None) => {}
            }
        }
        let noise = self.source.table.noise.as_ref();
        let replicates = noise.and_then(|noise| noise.value.replicates.as_ref());
        for name in replicates.iter().flat_map(|list| &list.value.0) {
            let name = &name.value;
            let known = self.is_declared(name) || columns.iter().any(|c| c.name == *name);
            if !known && is_there(headings, name) {
                columns.push(plain(name, names, Content::Either));
            }
        }
        for label in &labels {
            let number = names.columns.iter().any(|(name, _)| *name == label.name);
            if number && names.kind(&label.name) == Some(Kind::Column) {
                self.faults
                    .push(number_as_labels(&label.name, label.key, &label.place));
            }
            match columns.iter_mut().find(|column| column.name == label.name) {
                Some(column) => column.content = Content::Labels,
                None if is_there(headings, &label.name) => {
                    columns.push(plain(&label.name, names, Content::Labels));
                }
                None => self.faults.push(no_column(
                    &label.name,
                    &label.name,
                    &label.place,
                    RoleWord::Factor,
                    headings,
                )),
            }
        }
        let left = names
            .only_left
            .iter()
            .filter(|_| self.purpose == Purpose::Plan);
        for name in left {
            if !columns.iter().any(|column| column.name == *name) && self.is_column(name, names) {
                let mut column = plain(name, names, Content::Numbers);
                column.is_there = is_there(headings, name);
                columns.push(column);
            }
        }
        (self.faults.len() == before).then_some(columns)
    }

    /// Whether a left side is a column, and no constant or input.
    fn is_column(&self, name: &str, names: &Names) -> bool {
        names.kind(name) == Some(Kind::Column) && !names.given.iter().any(|given| given == name)
    }

    fn is_declared(&self, name: &str) -> bool {
        let mut declared = entries(&self.source.table.columns).iter();
        declared.any(|(other, _)| other == name)
    }

    fn declared(
        &mut self,
        name: &str,
        entry: &'s Stated<super::entries::Short<ColumnTable>>,
        names: &Names,
        headings: &[Heading],
    ) -> Option<Column<'s>> {
        let table = &entry.value.0;
        let header = table.column.as_ref().map_or(name, |column| &column.value);
        let stated = table.role.as_ref().map(|role| role.value);
        let named = names.columns.iter().find(|(other, _)| other == name);
        if stated == Some(RoleWord::Ignore) {
            if let Some((_, place)) = named {
                let message = say!("the equations use the column {name}, which is to be ignored");
                self.faults.push(
                    Fault::new(UNKNOWN_SYMBOL, place.clone(), message)
                        .label(say!("used here"))
                        .related(entry.key.clone(), say!("ignored here")),
                );
            }
            return None;
        }
        self.faults
            .extend(table.range.as_deref().and_then(no_range));
        let role = stated.unwrap_or_else(|| names.role(name));
        let is_there = is_there(headings, header);
        // What a procedure can use need not be there, nor what a plan is to predict.
        let base = self.source.is_base(&entry.key);
        let is_given = names.is_left(name);
        let said = table.role.as_ref().filter(|_| !base && !is_given);
        let declared = entries(&self.source.table.columns);
        let is_declared = |given: &&String| declared.iter().any(|(name, _)| name == *given);
        // An equation that gives nothing has a fault of its own, which may be why.
        let said = said.filter(|_| names.responses.iter().all(|given| !given.is_empty()));
        let undeclared = names.responses.iter().find(|given| !is_declared(given));
        self.faults
            .extend(said.and_then(|said| without_equation(name, said, undeclared)));
        let offered = base && named.is_none();
        let awaited = self.purpose == Purpose::Plan
            && (role == RoleWord::Output || names.only_left.iter().any(|left| left == name));
        // Positions give it.
        if !is_there && (offered || names.given.iter().any(|given| given == name)) {
            return None;
        }
        if !is_there && !awaited {
            let asked = table.column.as_ref();
            let place = match (asked, named) {
                (Some(column), _) => &column.span,
                (None, Some((_, place))) if base => place,
                (None, _) => &entry.key,
            };
            self.faults
                .push(no_column(name, header, place, role, headings));
            return None;
        }
        let content = match role {
            RoleWord::Run
            | RoleWord::Factor
            | RoleWord::Position
            | RoleWord::Axis
            | RoleWord::Direction => Content::Labels,
            _ => Content::Numbers,
        };
        if let (Content::Labels, Some((_, place))) = (content, named) {
            let message = say!("{name} holds labels, which a formula cannot use");
            let fault = Fault::new(LABELS, place.clone(), message).label(say!("not a number"));
            self.faults.push(fault.help(say!(
                "a parameter with a value for each label: [parameter] p = {{ per = \"{name}\" }}"
            )));
            return None;
        }
        let unit = match &table.unit {
            Some(unit) => Some(self.unit(unit)?),
            None => None,
        };
        let like = match &table.like {
            Some(like) => Some(self.unit(like)?),
            None => None,
        };
        Some(Column {
            name: name.to_owned(),
            header: header.to_owned(),
            role,
            content,
            unit,
            like,
            is_there,
            table: Some(table),
        })
    }

    /// A name that is neither declared nor recorded.
    fn not_recorded(
        &mut self,
        name: &str,
        place: &Range<usize>,
        headings: &[Heading],
        names: &Names,
    ) {
        if name.is_empty() {
            let message = say!("the equation does not say which column it gives");
            let text = self.source.text.get(place.clone()).unwrap_or_default();
            let label = match text.contains("==") {
                true => say!("`==` compares; an equation has one `=`"),
                false => say!("there is no `=`"),
            };
            self.faults.push(
                Fault::new(UNKNOWN_SYMBOL, place.clone(), message)
                    .label(label)
                    .help(say!("write what was observed on the left: U = …")),
            );
            return;
        }
        let text = self.source.text.get(place.clone()).unwrap_or_default();
        let left = text.split_once('=').map_or("", |(left, _)| left);
        if left.contains(&format!("{name}(")) {
            let message = say!("the left side of an equation is no formula");
            self.faults.push(
                Fault::new(UNKNOWN_SYMBOL, place.clone(), message)
                    .label(say!("{name} stands on the left"))
                    .help(say!(
                        "write on the left what was observed, and the inverse function on the right: `y = exp(a + b*x)` for `ln(y) = a + b*x`"
                    )),
            );
            return;
        }
        let declared = self.source.table.columns.as_ref();
        if declared.is_some_and(|declared| declared.value.refused) {
            // It may be one of the columns that could not be read.
            return;
        }
        let headers: Vec<&str> = headings
            .iter()
            .map(|heading| heading.name.as_str())
            .filter(|name| !name.is_empty())
            .collect();
        if names.is_left(name) {
            let message = say!("the recording has no column {name}");
            let fault = Fault::new(UNKNOWN_SYMBOL, place.clone(), message)
                .label(say!("the left side is what was observed"));
            let columns = headers.join(", ");
            let declared = entries(&self.source.table.columns);
            let role = |name: &str| {
                let (_, entry) = declared.iter().find(|(other, _)| other == name)?;
                entry.value.0.role.as_ref().map(|role| role.value)
            };
            let is_output =
                |other: &str| role(other) == Some(RoleWord::Output) && !names.is_left(other);
            let is_unused = |other: &str| role(other).is_none() && names.kind(other).is_none();
            let only = |is_it: &dyn Fn(&str) -> bool| {
                let mut found = headers.iter().copied().filter(|other| is_it(other));
                found.next().filter(|_| found.next().is_none())
            };
            let near = nearest(name, headers.iter().copied());
            let near = near
                .or_else(|| only(&is_output))
                .or_else(|| only(&is_unused));
            self.faults.push(match near {
                Some(near) => fault.help(say!("did you mean `{near}`?")),
                None => fault.help(say!("its columns are: {columns}")),
            });
            return;
        }
        let fault = Fault::new(
            UNKNOWN_SYMBOL,
            place.clone(),
            say!("{name} is neither a parameter, an input nor a constant, and the recording has no such column"),
        )
        .label(say!("not known"));
        let known = names.known().filter(|other| *other != name);
        self.faults.push(match nearest(name, known.chain(headers.iter().copied())) {
            Some(near) => fault.help(say!(
                "did you mean `{near}`? If it is to be found, list it under [parameter]"
            )),
            None => fault.help(say!(
                "list it under [parameter] if it is to be found, under [input] or [constant] if it is known; the columns are {}",
                headers.join(", ")
            )),
        });
    }
}

/// What is wrong with an output that no equation gives: as a condition it would be looked at.
fn without_equation(
    name: &str,
    role: &Stated<RoleWord>,
    undeclared: Option<&String>,
) -> Option<Fault> {
    let message = say!("no equation gives the output {name}");
    let fault = Fault::new(UNUSED, role.span.clone(), message);
    let fault = fault.label(say!("an output stands on the left of an equation"));
    (role.value == RoleWord::Output).then(|| match undeclared {
        Some(given) => fault.help(say!(
            "an equation gives {given}: call the column by one name in both places"
        )),
        None => fault.help(say!(
            "write the equation of {name}, or say what else it is: \"covariate\" is a condition that was recorded"
        )),
    })
}

/// What is wrong with the least and the greatest value that an instrument can give.
fn no_range(stated: &Stated<Vec<Stated<f64>>>) -> Option<Fault> {
    match stated.value.as_slice() {
        [least, greatest] if least.value < greatest.value => None,
        _ => {
            let message =
                say!("a range is the least and the greatest value that the instrument can give");
            let fault = Fault::new(KEY, stated.span.clone(), message);
            let fault = fault.label(say!("expected two numbers, the smaller one first"));
            Some(fault.help(say!("write for example range = [-10, 10]")))
        }
    }
}

fn plain<'t>(name: &str, names: &Names, content: Content) -> Column<'t> {
    Column {
        name: name.to_owned(),
        header: name.to_owned(),
        role: match content {
            Content::Labels => RoleWord::Factor,
            _ => names.role(name),
        },
        content,
        unit: None,
        like: None,
        is_there: true,
        table: None,
    }
}

fn is_there(headings: &[Heading], header: &str) -> bool {
    let wanted = header.trim();
    headings
        .iter()
        .any(|heading| heading.name == wanted || heading.text == wanted)
}

/// A declared column that the recording does not have.
fn no_column(
    name: &str,
    header: &str,
    place: &Range<usize>,
    role: RoleWord,
    headings: &[Heading],
) -> Fault {
    let names: Vec<&str> = headings.iter().map(|h| h.name.as_str()).collect();
    let texts = headings.iter().map(|h| h.text.as_str());
    let help = match nearest(header, names.iter().copied().chain(texts)) {
        Some(near) if header == name => say!(
            "did you mean \"{near}\"? To call it {name}, write {} = {{ role = \"{}\", column = \"{near}\" }}",
            key(name),
            role.word()
        ),
        Some(near) => say!("did you mean \"{near}\"?"),
        None if header != name => say!("its columns are: {}", names.join(", ")),
        None => say!(
            "its columns are: {}; to call one of them {name}, write {} = {{ role = \"{}\", column = \"…\" }}",
            names.join(", "),
            key(name),
            role.word()
        ),
    };
    Fault::new(
        UNKNOWN_SYMBOL,
        place.clone(),
        say!("the recording has no column \"{header}\""),
    )
    .label(say!("not in the first line of the recording"))
    .help(help)
}

/// Numbers of the equations that a key takes for labels.
fn number_as_labels(name: &str, key: &str, place: &Range<usize>) -> Fault {
    let message = say!("the equations use the numbers of {name}, and `{key}` takes it for labels");
    let fault =
        Fault::new(LABELS, place.clone(), message).label(say!("expected a column of labels"));
    match key {
        "dwells" => fault.help(say!(
            "dwells that steps of {name} tell apart are steps = \"{name}\""
        )),
        _ => fault.help(say!(
            "name a column that says which run, position or direction a row belongs to; a column of numbers may stand once more as labels: setting = {{ role = \"position\", column = \"{name}\" }}"
        )),
    }
}
