//! What writers of budgets mistake, beyond misspelt words.

use gumption_fault::{Said, nearest, say};
use gumption_format::toml::{DeValue, Hints, Table};

use super::tables::FileTable;

/// The mistakes of writers of budgets.
pub static HINTS: Hints = Hints {
    whole: say!("a budget"),
    synonyms: &SYNONYMS,
    top: FileTable::keys,
    unknown_key,
    no_table,
    list_of_amounts: say!(
        "readings of one quantity are `readings = […]`, the elements of a vector `values = […]`"
    ),
};

/// Words that people try for the keys of an uncertainty, and those keys.
pub const SYNONYMS: [(&str, &str); 49] = [
    ("a", "half_width"),
    ("halfwidth", "half_width"),
    ("tolerance", "half_width"),
    ("std", "u"),
    ("stdev", "u"),
    ("sd", "u"),
    ("sigma", "u"),
    ("uncertainty", "u"),
    ("standard_uncertainty", "u"),
    ("resolution", "step"),
    ("q", "step"),
    ("data", "readings"),
    ("observations", "readings"),
    ("measurements", "readings"),
    ("digits", "counts"),
    ("digit", "counts"),
    ("dist", "distribution"),
    ("pdf", "distribution"),
    ("nu", "dof"),
    ("degrees_of_freedom", "dof"),
    ("degf", "dof"),
    ("veff", "dof"),
    ("estimate", "value"),
    ("mean", "value"),
    ("formula", "model"),
    ("equation", "model"),
    ("标题", "title"),
    ("被测量", "measurand"),
    ("输入", "input"),
    ("输入量", "input"),
    ("模型", "model"),
    ("数学模型", "model"),
    ("测量模型", "model"),
    ("值", "value"),
    ("单位", "unit"),
    ("标准不确定度", "u"),
    ("读数", "readings"),
    ("测量值", "readings"),
    ("半宽", "half_width"),
    ("区间半宽", "half_width"),
    ("分辨力", "step"),
    ("分辨率", "step"),
    ("证书", "certificate"),
    ("校准证书", "certificate"),
    ("分布", "distribution"),
    ("自由度", "dof"),
    ("常数", "constant"),
    ("说明", "description"),
    ("分量", "components"),
];

/// Keys of an uncertainty that stand in the wrong place.
pub fn unknown_key(key: &str, table: &str, known: &[&'static str]) -> Option<Said> {
    // `U` must not be taken for a misspelt `u`: they differ by the coverage factor.
    if matches!(key, "U" | "k" | "expanded") && known.contains(&"certificate") {
        return Some(say!(
            "an expanded uncertainty stands with its k: certificate = {{ U = …, k = 2 }}"
        ));
    }
    let has = |wanted: &str| known.contains(&wanted);
    let elsewhere = match (table, key.to_lowercase().as_str()) {
        ("[input]", "accuracy" | "mpe" | "spec" | "tolerance") if has("specification") => {
            Some(say!(
                "limits ±a are half_width = …; those of an instrument that depend on its reading specification = {{ reading = \"0.05 %\", counts = 2, step = … }}"
            ))
        }
        ("[input]" | "a component", "s" | "n") if has("pooled") => Some(say!(
            "s of n readings that are not listed: pooled = {{ s = …, dof = n - 1 }}, of = n"
        )),
        ("[conformity]", "tolerance" | "limits" | "limit") => Some(say!(
            "a tolerance is lower = … and upper = …, or mpe = … about a nominal = …"
        )),
        ("[[correlation]]", "matrix" | "correlation" | "coefficients" | "covariance") => Some(say!(
            "a matrix stands in [[joint]]: inputs = [\"a\", \"b\"] and correlation = [[1, 0.3], [0.3, 1]], or covariance = [[…], […]]"
        )),
        ("[[correlation]]", lower) if lower.contains(',') => {
            let (one, other) = key.split_once(',').unwrap_or((key, ""));
            let (one, other) = (one.trim(), other.trim());
            Some(say!(
                "write [[correlation]], between = [\"{one}\", \"{other}\"] and r = …"
            ))
        }
        ("[series]", _) if nearest(key, known.iter().copied()).is_none() => Some(say!(
            "the columns of a series are named once, its rows follow: columns = [\"{key}\"], rows = [[…], […]]"
        )),
        ("[fit]", _) if key.len() == 1 => Some(say!(
            "columns of data stand below `data`: [fit.NAME.data], {key} = {{ values = […] }}"
        )),
        (
            _,
            "coverage_probability"
            | "p"
            | "confidence"
            | "confidence_level"
            | "k"
            | "coverage_factor",
        ) if has("conventions") => Some(say!(
            "what holds for all results stands below [conventions]: coverage_probability = 0.95, or coverage_factor = 2"
        )),
        _ => None,
    };
    if elsewhere.is_some() {
        return elsewhere;
    }
    let beside = ["specification", "certificate"].contains(&table)
        && ["p", "k", "dof", "distribution", "name"].contains(&key);
    beside.then(|| say!("`{key}` stands beside `{table}`, not in it"))
}

/// What to write in place of a value that stands where a table is expected.
fn no_table(title: &str, found: &DeValue<'_>) -> Option<Said> {
    match (title, found) {
        ("[fit.NAME.data]", DeValue::Array(_)) => Some(say!(
            "a column of data is a table, as it may have a unit and an uncertainty: {{ values = […] }}"
        )),
        ("[input]", DeValue::Array(_)) => Some(say!("readings are {{ readings = […] }}")),
        ("[input]", DeValue::String(_) | DeValue::Integer(_) | DeValue::Float(_)) => Some(say!(
            "an input has a value and a reason for doubt: {{ value = …, u = … }}; what is exactly known stands below [constant]"
        )),
        ("[measurand]", DeValue::String(_)) => {
            Some(say!("the formula is its model: {{ model = \"…\" }}"))
        }
        ("certificate", DeValue::String(_)) => {
            Some(say!("a certificate is {{ U = …, k = 2, number = \"…\" }}"))
        }
        ("specification", DeValue::String(text)) => Some(say!(
            "its parts stand by themselves: {{ {} }}",
            parts_of(text)
        )),
        _ => None,
    }
}

/// The keys of a specification as data sheets write it: `0.5 % of reading + 0.1 % of range + 2 digits`.
fn parts_of(specification: &str) -> String {
    let parts = specification.trim_start_matches(['±', '(']).split('+');
    let keys = parts.map(|part| {
        let part = part.trim().trim_end_matches(')').trim();
        let lower = part.to_lowercase();
        let says = |words: &[&str]| words.iter().any(|word| lower.contains(word));
        let share = part.find('%').map(|end| &part[..=end]);
        let number = part.split_whitespace().next().unwrap_or("…");
        match share {
            Some(share) if says(&["rang", "fs", "f.s", "full", "span", "量程", "满"]) => {
                format!("range = \"{share}\", span = \"…\"")
            }
            Some(share) => format!("reading = \"{share}\""),
            None if says(&["digit", "dgt", "count", "lsd", "字"]) => {
                let number = number.trim_end_matches(char::is_alphabetic);
                format!("counts = {number}, step = \"…\"")
            }
            None => format!("fixed = \"{part}\""),
        }
    });
    keys.collect::<Vec<_>>().join(", ")
}
