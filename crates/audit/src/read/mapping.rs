//! What a user says of a sheet that the program cannot place: a small file of keys and values.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::columns::Role;
use crate::claim::Claimed;
use crate::sheet::Grid;

/// What somebody says of a sheet.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mapping {
    /// The head of a column, and what it holds.
    pub columns: Vec<(String, Role)>,
    /// The model, where the sheet has none that is understood.
    pub model: Option<String>,
}

/// The file.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    model: Option<String>,
    #[serde(default)]
    columns: BTreeMap<String, String>,
}

/// What a column of which nothing is said is in the file.
const OPEN: &str = "?";

impl Mapping {
    /// What is said of a head.
    pub fn role(&self, head: &str) -> Option<Role> {
        self.columns
            .iter()
            .find(|(name, _)| name == head.trim())
            .map(|(_, role)| *role)
    }

    /// What is said of columns that a file does not have: their heads.
    pub(crate) fn of_nothing<'m>(&'m self, grids: &'m [Grid]) -> impl Iterator<Item = &'m str> {
        let has = |name: &str| {
            let mut cells = grids.iter().flat_map(|grid| grid.rows.iter().flatten());
            cells.any(|cell| cell.text.trim() == name)
        };
        let names = self.columns.iter().map(|(name, _)| name.as_str());
        names.filter(move |name| !has(name))
    }

    /// Reads a mapping file.
    ///
    /// # Errors
    /// What is wrong with it, where, and what may stand there.
    pub fn parse(text: &str) -> Result<Mapping, String> {
        let file: File = toml::from_str(text).map_err(|error| error.to_string())?;
        let mut columns = Vec::new();
        for (head, name) in file.columns.into_iter().filter(|(_, name)| name != OPEN) {
            let role = Role::ALL.into_iter().find(|role| role.name() == name);
            let role =
                role.ok_or_else(|| format!("\"{head}\" = \"{name}\": write one of {}", roles()))?;
            columns.push((head, role));
        }
        let model = file.model.filter(|model| !model.trim().is_empty());
        Ok(Mapping { columns, model })
    }

    /// A mapping file of what was understood of some budgets, to be mended by hand.
    pub fn template(claims: &[Claimed]) -> String {
        let mut text = format!(
            "# What the columns of the sheet hold: {}.\n# \"?\" was not understood, and is left out.\n",
            roles()
        );
        let model = claims.iter().find_map(|claimed| {
            let model = claimed.model.as_ref()?;
            Some(format!("{} = {model}", claimed.measurand))
        });
        let _ = match model {
            Some(model) => writeln!(text, "model = {model:?}"),
            None => writeln!(text, "# model = \"y = a + b\""),
        };
        text += "\n[columns]\n";
        let mut seen = Vec::new();
        for one in claims.iter().flat_map(|claimed| &claimed.understood) {
            let is_column =
                one.role == OPEN || Role::ALL.iter().any(|role| role.name() == one.role);
            let head = one.text.trim();
            if is_column && !head.is_empty() && !seen.contains(&head) {
                seen.push(head);
                let _ = writeln!(text, "{head:?} = {:?}", one.role);
            }
        }
        text
    }
}

fn roles() -> String {
    Role::ALL.map(Role::name).join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{read, sheet};

    #[test]
    fn what_is_written_is_read() {
        let text = "Item;Foo;Bar;u;c;u_i(y)\na;normal;0.1;0.05;1;0.05\nb;normal;0.2;0.1;1;0.1\nu_c = 0.112\nU = 0.22 (k = 2)\n";
        let grids = sheet::grids("sheet.csv", text.as_bytes()).unwrap();
        let claims = read::budgets(&grids, &Mapping::default());
        let template = Mapping::template(&claims);
        assert!(template.contains("\"Foo\" = \"?\""), "{template}");
        let mended = template.replace("\"Bar\" = \"half_width\"", "\"Bar\" = \"remark\"");
        let mapping = Mapping::parse(&mended).unwrap();
        assert_eq!(mapping.role("Bar"), Some(Role::Remark));
        assert_eq!(mapping.role("Foo"), None);
        assert!(
            Mapping::parse("[columns]\nFoo = \"width\"\n")
                .unwrap_err()
                .contains("half_width")
        );
        assert!(Mapping::parse("colunms = 1").is_err());
    }
}
