//! What writers of budgets mistake, beyond misspelt words.

use gumption_core::distribution::Entry;
use gumption_fault::{Said, nearest, say};
use gumption_format::toml::{DeValue, Hints, Table};

use super::tables::{ConventionsTable, FileTable, MonteCarloTable};

/// The mistakes of writers of budgets.
pub static HINTS: Hints = Hints {
    whole: say!("a budget"),
    synonyms: &SYNONYMS,
    top: FileTable::keys,
    unknown_key,
    no_table,
    wrong_type,
    list_of_amounts: say!(
        "readings of one quantity are `readings = […]`, the elements of a vector `values = […]`"
    ),
};

/// Words that people try, and the keys and words that they mean.
pub const SYNONYMS: [(&str, &str); 131] = [
    ("a", "half_width"),
    ("halfwidth", "half_width"),
    ("tolerance", "half_width"),
    ("tolerance", "conformity"),
    ("tolerances", "conformity"),
    ("specification", "conformity"),
    ("std", "u"),
    ("stdev", "u"),
    ("sd", "u"),
    ("sigma", "u"),
    ("uncertainty", "u"),
    ("standard_uncertainty", "u"),
    ("resolution", "step"),
    ("q", "step"),
    ("interval", "limits"),
    ("bounds", "limits"),
    ("expanded_uncertainty", "U"),
    ("expanded", "U"),
    ("coverage_factor", "k"),
    ("coverage", "k"),
    ("factor", "k"),
    ("coverage_probability", "p"),
    ("p", "coverage_probability"),
    ("k", "coverage_factor"),
    ("n", "trials"),
    ("samples", "trials"),
    ("u95", "U"),
    ("u_95", "U"),
    ("k95", "k"),
    ("confidence", "p"),
    ("rows", "lines"),
    ("data", "readings"),
    ("data", "recording"),
    ("file", "recording"),
    ("path", "file"),
    ("filename", "file"),
    ("csv", "file"),
    ("observations", "readings"),
    ("measurements", "readings"),
    ("measured", "readings"),
    ("indications", "readings"),
    ("repeat", "readings"),
    ("repeats", "readings"),
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
    ("equation", "equations"),
    ("equation", "model"),
    ("temperature", "covariate"),
    ("humidity", "covariate"),
    ("response", "output"),
    ("dependent", "output"),
    ("independent", "stimulus"),
    ("group", "run"),
    ("day", "run"),
    ("simple_acceptance", "simple"),
    ("shared_risk", "simple"),
    ("简单接受", "simple"),
    ("简单验收", "simple"),
    ("保护接受", "guarded-acceptance"),
    ("保护带", "guarded-acceptance"),
    ("guarded", "guarded-acceptance"),
    ("guard_band", "guarded-acceptance"),
    ("jjf1094", "JJF 1094"),
    ("iso_14253", "ISO 14253-1"),
    ("ilac_g8:09/2019", "ILAC-G8"),
    ("标题", "title"),
    ("被测量", "measurand"),
    ("测量结果", "measurand"),
    ("输出量", "measurand"),
    ("output", "measurand"),
    ("outputs", "measurand"),
    ("result", "measurand"),
    ("results", "measurand"),
    ("输入", "input"),
    ("输入量", "input"),
    ("模型", "model"),
    ("数学模型", "model"),
    ("测量模型", "model"),
    ("值", "value"),
    ("单位", "unit"),
    ("标准不确定度", "u"),
    ("不确定度", "u"),
    ("扩展不确定度", "U"),
    ("包含因子", "k"),
    ("包含概率", "p"),
    ("类型", "type"),
    ("名称", "name"),
    ("规范", "profile"),
    ("方法", "method"),
    ("备注", "note"),
    ("符合性", "conformity"),
    ("符合性判定", "conformity"),
    ("相关", "correlation"),
    ("相关系数", "correlation"),
    ("常量", "constant"),
    ("读数", "readings"),
    ("测量值", "readings"),
    ("示值", "readings"),
    ("观测值", "readings"),
    ("重复测量", "readings"),
    ("半宽", "half_width"),
    ("区间半宽", "half_width"),
    ("分辨力", "step"),
    ("分辨率", "step"),
    ("分度值", "step"),
    ("least_count", "step"),
    ("证书", "certificate"),
    ("校准证书", "certificate"),
    ("分布", "distribution"),
    ("自由度", "dof"),
    ("常数", "constant"),
    ("说明", "description"),
    ("分量", "components"),
    ("mu", "mean"),
    ("mu", "location"),
    ("std", "sd"),
    ("stdev", "sd"),
    ("sigma", "sd"),
    ("sigma", "scale"),
    ("alpha", "shape"),
    ("theta", "scale"),
    ("df", "dof"),
];

/// Keys of an uncertainty that stand in the wrong place.
pub fn unknown_key(key: &str, table: &str, known: &[&'static str]) -> Option<Said> {
    // `U` must not be taken for a misspelt `u`: they differ by the coverage factor.
    const EXPANDED: [&str; 9] = [
        "U",
        "U95",
        "U_95",
        "k95",
        "expanded",
        "expanded_uncertainty",
        "coverage_factor",
        "扩展不确定度",
        "包含因子",
    ];
    let distribution = Entry::named(table);
    if let Some(mend) = distribution.and_then(|entry| (entry.in_place_of)(key)) {
        return Some(mend);
    }
    if EXPANDED.contains(&key) && known.contains(&"certificate") {
        return Some(say!(
            "an expanded uncertainty stands with its k: certificate = {{ U = …, k = 2 }}"
        ));
    }
    if key == "k" && known.contains(&"certificate") {
        return Some(say!(
            "an expanded uncertainty stands with its k: certificate = {{ U = …, k = 2 }}; the divisor of limits follows from their distribution"
        ));
    }
    let has = |wanted: &str| known.contains(&wanted);
    let elsewhere = match (table, key.to_lowercase().as_str()) {
        ("certificate", "u" | "standard_uncertainty" | "标准不确定度") => Some(say!(
            "a certificate states U with its k; the standard uncertainty that one states stands alone: u = …"
        )),
        (
            "certificate",
            "half_width" | "limits" | "accuracy" | "mpe" | "tolerance" | "class" | "允差"
            | "最大允许误差",
        ) => Some(say!(
            "limits ±a are no expanded uncertainty: half_width = … in the place of `certificate`"
        )),
        (
            "[input]" | "a component",
            "accuracy" | "class" | "mpe" | "spec" | "tolerance" | "允差" | "最大允许误差"
            | "准确度等级",
        ) if has("specification") => Some(say!(
            "limits ±a are half_width = …; those of an instrument that depend on its reading specification = {{ reading = \"0.05 %\", counts = 2, step = … }}"
        )),
        (
            "[input]" | "[source]",
            "repeatability" | "reproducibility" | "drift" | "stability" | "calibration"
            | "temperature" | "linearity" | "hysteresis" | "uniformity" | "重复性" | "复现性"
            | "漂移" | "稳定性" | "校准" | "温度" | "线性" | "滞后" | "均匀性",
        ) if has("components") => Some(say!(
            "reasons for doubt are entries of a list: components = [{{ name = \"{key}\", half_width = … }}, …], what is known of each in its own way"
        )),
        ("certificate", "u_rel" | "urel" | "u_r" | "rel_u" | "relative" | "relative_u") => {
            Some(say!(
                "a relative expanded uncertainty has its unit: U = \"0.1 %\", or \"50 ppm\"; of a quantity that is itself a ratio write certificate = {{ U = 0.001, k = 2 }}, relative = true"
            ))
        }
        (_, "u_rel" | "urel" | "u_r" | "rel_u" | "relative_u" | "relative_uncertainty")
            if has("relative") =>
        {
            Some(say!(
                "a relative uncertainty is u = \"0.1 %\", or u = 0.001 with relative = true"
            ))
        }
        (_, "upper" | "lower" | "min" | "max") if has("limits") => Some(say!(
            "limits of the quantity itself are limits = [lower, upper], distances from its value plus = … and minus = …"
        )),
        ("certificate" | "specification" | "[conformity]" | "a component" | "pooled", "unit") => {
            Some(say!(
                "a plain number is in the unit of the quantity; another unit stands with its number: \"0.1 mg\""
            ))
        }
        (_, shape) if has("distribution") && has_limits(shape) => Some(say!(
            "a shape goes with what it spreads over: half_width = …, distribution = \"{shape}\""
        )),
        ("distribution", "type" | "name" | "kind" | "shape") => Some(say!(
            "the shape that goes with another way is a text: distribution = \"triangular\""
        )),
        (
            "[input]" | "a component",
            "c" | "ci" | "c_i" | "sensitivity_coefficient" | "灵敏系数",
        ) => Some(say!(
            "sensitivity coefficients follow from the model; one that is known is a factor in it"
        )),
        ("[input]" | "a component", "correlation" | "correlated" | "相关系数") => Some(say!(
            "write [[correlation]], between = [\"A\", \"B\"] with the names of two inputs, and r = …"
        )),
        (
            "[measurand]",
            "limit" | "limits" | "lower" | "upper" | "mpe" | "nominal" | "tolerance" | "允差"
            | "最大允许误差",
        ) => Some(say!(
            "what the result has to keep to stands below [conformity]: lower = … and upper = …, or mpe = … about a nominal = …, and the rule"
        )),
        ("[measurand]", "value" | "readings" | "u" | "half_width" | "certificate") => Some(say!(
            "what is known of a quantity stands with an input: model = \"x\", and below [input.x] {key} = …"
        )),
        ("[measurand]", "name" | "symbol") => {
            Some(say!("its name stands in the header: [measurand.NAME]"))
        }
        ("[measurand]", "functions" | "function" | "model2" | "equations") => Some(say!(
            "functions and intermediate quantities are lines of the `model`, above its last one: f(x) = …"
        )),
        (
            "[measurand]",
            "k"
            | "p"
            | "digits"
            | "rounding"
            | "coverage"
            | "coverage_factor"
            | "coverage_probability",
        ) => Some(say!(
            "what holds for all results stands below [conventions]: coverage_probability = 0.95, or coverage_factor = 2"
        )),
        (
            "[input]" | "a component",
            "s" | "n" | "standard_deviation" | "std_dev" | "stddev" | "标准差" | "标准偏差"
            | "实验标准差",
        ) if has("pooled") => Some(say!(
            "s of n readings that are not listed: pooled = {{ s = …, dof = n - 1 }}, of = n"
        )),
        ("[conformity]", "tolerance" | "limits" | "limit") => Some(say!(
            "a tolerance is lower = … and upper = …, or mpe = … about a nominal = …"
        )),
        ("[[correlation]]", "matrix" | "correlation" | "coefficients" | "covariance") => {
            Some(say!(
                "a matrix stands in [[joint]]: inputs = [\"a\", \"b\"] and correlation = [[1, 0.3], [0.3, 1]], or covariance = [[…], […]]"
            ))
        }
        ("[[correlation]]", lower) if lower.contains(',') => {
            let (one, other) = key.split_once(',').unwrap_or((key, ""));
            let (one, other) = (one.trim(), other.trim());
            Some(say!(
                "write [[correlation]], between = [\"{one}\", \"{other}\"] and r = …"
            ))
        }
        ("[[correlation]]", _) if nearest(key, known.iter().copied()).is_none() => Some(say!(
            "write [[correlation]], between = [\"A\", \"B\"] with the names of two inputs, and r = …"
        )),
        (_, "language" | "lang" | "语言") if has("conventions") => Some(say!(
            "the language of a report is chosen on the command line: --lang en, zh or both"
        )),
        ("[[joint]]", "readings") => Some(say!(
            "the readings stand with each input, in the same order: [input.V] readings = […], [input.I] readings = […]"
        )),
        ("[input]", "u_A" | "u_B" | "uA" | "uB" | "A类" | "B类") => Some(say!(
            "types A and B are components side by side: components = [{{ readings = […] }}, {{ u = 0.02 }}]"
        )),
        ("a CSV column in groups", _) => Some(say!(
            "groups are lists of readings, one for each group: groups = [[…], […]]"
        )),
        ("a CSV column", "k" | "U" | "p" | "dof") => Some(say!(
            "an expanded uncertainty is stated as certificate = {{ U = …, k = 2 }}, a standard uncertainty as a number: u = 0.1, dof = 9"
        )),
        ("a CSV column", _) if nearest(key, known.iter().copied()).is_none() => Some(say!(
            "a number or a list stands without braces, and other keys beside it: u = 0.1, dof = 9; in braces stands a column of a file"
        )),
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
        (_, "procedure" | "recording" | "equations" | "columns" | "noise" | "positions")
            if has("conventions") =>
        {
            Some(say!(
                "`{key}` belongs to an experiment, which `gumption calibrate`, `plan`, `simulate` and `diagnose` read"
            ))
        }
        (_, "certificate" | "laboratory" | "customer" | "item") if has("conventions") => {
            Some(say!(
                "data of a certificate stand in a file of their own: --certificate FILE; the U and k of a reference stand with its input, certificate = {{ U = …, k = 2 }}"
            ))
        }
        _ if has("conventions") => header_of(key).or_else(|| {
            let is_budget = has("measurand");
            is_budget.then(|| of_an_input(key, known)).flatten()
        }),
        ("[measurand]", _) => of_an_input(key, known),
        _ => None,
    };
    if elsewhere.is_some() {
        return elsewhere;
    }
    let beside = ["specification", "certificate"].contains(&table)
        && ["p", "k", "dof", "distribution", "name"].contains(&key);
    beside.then(|| say!("`{key}` stands beside `{table}`, not in it"))
}

/// Where a key stands that whoever wrote it has put at the top of the file.
fn header_of(key: &str) -> Option<Said> {
    let below = [
        ("[conventions]", ConventionsTable::keys()),
        ("[monte_carlo]", MonteCarloTable::keys()),
    ];
    let (header, _) = below.into_iter().find(|(_, keys)| keys.contains(&key))?;
    Some(say!("`{key}` stands below the header {header}"))
}

/// Whether this names a distribution between limits.
fn has_limits(name: &str) -> bool {
    let parameters = Entry::named(name).map(|entry| entry.parameters);
    parameters.is_some_and(|all| all.iter().any(|rule| rule.key == "half_width"))
}

/// What to write for a value of the wrong type at this key.
pub fn wrong_type(key: &str, found: &str) -> Option<Said> {
    let number = found.trim_matches(['"', '\'']);
    match (key, number.starts_with('[')) {
        ("input" | "measurand" | "constant" | "source" | "fit", true) => {
            return Some(say!(
                "single brackets, and its name behind a dot: [{key}.NAME] is the header of each"
            ));
        }
        ("measurand", false) => {
            let is_name = |c: char| c.is_alphanumeric() || c == '_';
            let name = number.split('=').next().unwrap_or_default().trim();
            let name = match name.chars().all(is_name) {
                true => name,
                false => "NAME",
            };
            return Some(say!(
                "its name stands in the header, its formula is the model: [measurand.{name}], model = \"…\""
            ));
        }
        ("between", _) if !number.contains(',') => {
            return Some(say!(
                "two names are wanted: between = [\"{number}\", \"…\"]"
            ));
        }
        ("readings" | "values", false) if let Some(list) = listed(number) => return Some(list),
        _ => {}
    }
    let begins = number.starts_with(|c: char| c.is_ascii_digit() || "+-.±".contains(c));
    if !begins || number.contains([',', ';', '，', '、']) {
        return None;
    }
    let number = number.trim_start_matches(['±', '+', '-']);
    let signed = |sign: &str| match found.starts_with(['"', '\'']) {
        true => format!("\"{sign}{number}\""),
        false => format!("{sign}{number}"),
    };
    let (width, below) = (signed(""), signed("-"));
    match key {
        "limits" => Some(say!(
            "two limits are limits = [lower, upper]; a distance from the value, the same on both sides, is half_width = {width}"
        )),
        "range" => Some(say!(
            "a range has two ends: range = [0, {width}] or range = [{below}, {width}]; the range R of n readings tells their s: pooled = {{ s = R/C, dof = ν }}, of = n, with C and ν for n (2.06 and 2.7 for n = 4)"
        )),
        "readings" => Some(say!(
            "one reading is value = {found}, with its uncertainty beside it; readings = […] are two or more"
        )),
        _ => None,
    }
}

/// A list of numbers for a text that has them, and may have a unit behind the last one.
fn listed(text: &str) -> Option<Said> {
    let parts = text.split([',', ';', '，', '、', ' ', '\t']);
    let parts: Vec<&str> = parts.filter(|part| !part.is_empty()).collect();
    let (unit, numbers) = parts.split_last()?;
    let is_number = |part: &str| part.parse::<f64>().is_ok();
    let has_decimal_comma = text
        .split(',')
        .skip(1)
        .any(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    if parts.len() > 1 && !has_decimal_comma && parts.iter().all(|part| is_number(part)) {
        let numbers = parts.join(", ");
        return Some(say!("numbers stand in brackets: [{numbers}]"));
    }
    if is_number(unit) || numbers.len() < 2 || !numbers.iter().all(|part| is_number(part)) {
        return None;
    }
    let numbers = numbers.join(", ");
    Some(say!(
        "numbers stand in brackets, their unit apart: [{numbers}], and unit = \"{unit}\""
    ))
}

/// What to write in place of a value that stands where a table is expected.
pub fn no_table(title: &str, found: &DeValue<'_>) -> Option<Said> {
    match (title, found) {
        ("[fit.NAME.data]", DeValue::Array(_)) => Some(say!(
            "a column of data is a table, as it may have a unit and an uncertainty: {{ values = […] }}"
        )),
        ("[input]", DeValue::Array(_)) => Some(say!("readings are {{ readings = […] }}")),
        ("[input]", DeValue::String(_) | DeValue::Integer(_) | DeValue::Float(_)) => Some(say!(
            "an input has a value and a reason for doubt: {{ value = …, u = … }}; what is exactly known stands below [constant]"
        )),
        ("[measurand]", DeValue::String(_)) => Some(say!(
            "its name stands in the header, its formula is the model: [measurand.NAME], model = \"…\""
        )),
        ("[monte_carlo]", _) => Some(say!(
            "[monte_carlo] is a header, with trials = … below it; every budget is checked by Monte Carlo, unless --no-mc is given"
        )),
        ("certificate", DeValue::String(_) | DeValue::Integer(_) | DeValue::Float(_)) => {
            Some(say!("a certificate is {{ U = …, k = 2, number = \"…\" }}"))
        }
        ("specification", DeValue::String(text)) => Some(say!(
            "its parts stand by themselves: {{ {} }}",
            parts_of(text)
        )),
        ("specification", DeValue::Integer(_) | DeValue::Float(_)) => {
            Some(say!("its parts stand by themselves: {{ {} }}", "fixed = …"))
        }
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

/// A name that resembles no key is that of an input, whose header is missing.
fn of_an_input(key: &str, known: &[&'static str]) -> Option<Said> {
    let plain = key.to_lowercase().replace(['-', ' '], "_");
    let is_key = FileTable::keys().contains(&key)
        || SYNONYMS
            .iter()
            .any(|(word, meant)| *word == plain && known.contains(meant))
        || nearest(&plain, known.iter().copied()).is_some();
    (!is_key).then(|| {
        say!(
            "an input stands below a header of its own: [input.{key}]; known keys: {}",
            known.join(", ")
        )
    })
}
