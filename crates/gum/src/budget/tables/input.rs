//! Inputs, and causes that several of them share.

use super::component::ComponentTable;
use super::list::List;
use crate::budget::variants::RowLabel;
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::faults::WRONG_TYPE;
use gumption_format::toml::{Amount, FromToml, KeyRow, Named, Raw, Reader, table};
use serde_json::Value;
use toml::de::DeValue;

table! {
    /// A quantity on which measurands depend: its estimate and its reasons for doubt.
    InputTable "[input]" {
        /// Its estimate, in its unit.
        value: Amount,
        /// Estimates of a vector.
        values: List<f64>,
        /// Its unit; when left out that of `value`, and dimension one where that has none either.
        unit: String,
        /// What it is.
        description: String,
        /// Heading under which the budget table sums it up.
        group: String,
        /// Result of another budget, or a saved result, in place of a value and its uncertainty.
        from: FromTable,
        /// Several reasons to doubt the input; with a single one its keys may stand in the input itself.
        components: List<ComponentTable>,
        with component: ComponentTable
    }
}

table! {
    /// A result of another file, with everything that makes it uncertain.
    FromTable "`from`" {
        /// Path of another budget, from the folder of this one; its formulas and components become part of this budget.
        budget: String,
        /// Path of a file that `gumption eval --save` wrote; the result is taken over in linear form.
        result: String,
        /// Which of its measurands; may be left out where it has only one.
        measurand: String,
        /// Which row of its series, by label or by number.
        row: RowLabel,
    }
}

table! {
    /// A cause of uncertainty that several inputs share; its value is zero.
    SourceTable "[source]" {
        /// Its unit; dimension one when left out.
        unit: String,
        /// What it is.
        description: String,
        /// Several reasons for doubt; with a single one its keys may stand in the table itself.
        components: List<ComponentTable>,
        with component: ComponentTable
    }
}

/// `[source.NAME]`: causes of uncertainty that several inputs share.
#[derive(Debug, Clone)]
pub struct Sources(pub Named<SourceTable>);

impl FromToml for Sources {
    fn expected() -> Said {
        say!("tables [source.NAME]")
    }

    fn read(value: &Raw<'_>, reader: &mut Reader<'_>) -> Option<Self> {
        if matches!(value.get_ref(), DeValue::String(_)) {
            let fault = Fault::new(
                WRONG_TYPE,
                value.span(),
                say!("`source` is not a text here"),
            )
            .label(say!(
                "expected tables [source.NAME], the causes that several inputs share"
            ))
            .help(say!(
                "to say where the figures come from, write reference = \"…\""
            ));
            return reader.refuse(fault);
        }
        Named::read(value, reader).map(Sources)
    }

    fn schema() -> Value {
        Named::<SourceTable>::schema()
    }

    fn tables(path: &str, rows: &mut Vec<KeyRow>) {
        Named::<SourceTable>::tables(path, rows);
    }
}
