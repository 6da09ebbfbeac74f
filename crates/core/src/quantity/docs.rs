//! The page on units for users, generated from the table so that it cannot go stale.

use std::fmt::Write;

use super::builtin::{Prefixes, UNITS, UnitKind};

/// The page in Markdown: how units are written, and all that are built in.
fn unit_documentation() -> String {
    let mut page = SYNTAX.to_owned();
    for (kind, heading) in CHAPTERS {
        let _ = writeln!(page, "\n### {heading}\n");
        page.push_str(
            "| symbol | also read | name | 名称 | value | prefixes |\n|---|---|---|---|---|---|\n",
        );
        for unit in UNITS.iter().filter(|unit| unit.kind == *kind) {
            let aliases: Vec<String> = unit
                .aliases
                .iter()
                .map(|alias| format!("`{alias}`"))
                .collect();
            let prefixes = match unit.prefixes {
                Prefixes::None => "",
                Prefixes::Multiples => "from kilo",
                Prefixes::All => "all",
            };
            let _ = writeln!(
                page,
                "| `{}` | {} | {} | {} | {} | {prefixes} |",
                unit.symbol,
                aliases.join(" "),
                unit.name_en,
                unit.name_zh,
                unit.value(),
            );
        }
    }
    page
}

const CHAPTERS: &[(UnitKind, &str)] = &[
    (UnitKind::Si, "SI units"),
    (
        UnitKind::Accepted,
        "Accepted with the SI, and units of dimension one",
    ),
    (UnitKind::Metric, "Other metric units"),
    (UnitKind::InchPound, "Inch-pound units"),
];

const SYNTAX: &str = "\
# Units

Every quantity in a budget has a unit. gumption checks that the units of a formula fit together before
it computes a number, and converts where two units of the same kind meet. Values stay in the units in
which you state them.

## How a unit is written

| | write | or |
|---|---|---|
| product | `N·m` | `N*m`, `N m` |
| quotient | `m/s` | `m·s^-1` |
| power | `m/s^2` | `m/s²`, `m/s**2`, `m·s⁻²` |
| root | `V/√Hz` | `V/sqrt(Hz)`, `V/Hz^(1/2)`, `V/Hz^0.5` |
| several below the solidus | `W/(m^2·K)` | `W·m^-2·K^-1`, `W/m^2/K` |
| reciprocal | `1/K` | `K^-1` |
| number, ratio | `1` | `%`, `ppm`, `µV/V`, `mV/V` |

- Upper and lower case matter: `mV` and `MV`, `s` (second) and `S` (siemens).
- A product behind a solidus, as in `W/m·K`, is refused because it is read in two ways.
- A digit behind a unit is its power: `m2` and `N/mm2` are read as `m^2` and `N/mm^2`. A product needs its sign: `N·m`, not `Nm`.
- `µ` may be either of the two characters that look like this, or `u`. `℃`, the ohm sign, and the
  signs of a Chinese keyboard such as `（`, `％`, `㎡` and `㎃` are read as well.
- A quantity of dimension one has the unit `1`. An empty unit is an error.

## Prefixes

`Q` 10^30, `R` 10^27, `Y` 10^24, `Z` 10^21, `E` 10^18, `P` 10^15, `T` 10^12, `G` 10^9, `M` 10^6, `k` 10^3,
`h` 10^2, `da` 10^1, `d` 10^-1, `c` 10^-2, `m` 10^-3, `µ` 10^-6, `n` 10^-9, `p` 10^-12, `f` 10^-15, `a` 10^-18,
`z` 10^-21, `y` 10^-24, `r` 10^-27, `q` 10^-30.

A name that is a unit as a whole is never split: `min` is the minute, `cd` the candela, `Pa` the pascal,
`ft` the foot, `mil` a thousandth of an inch.

## Temperatures

`°C` and `°F` are scales with a zero of their own. The difference of two temperatures in °C is in K;
uncertainties are shown in °C, where the number is the same. In a compound unit °C means a difference: `ppm/°C` is `ppm/K`.
Products and ratios of temperatures in °C have no meaning:

| the formula takes | write |
|---|---|
| the thermodynamic temperature | `kelvin(T)`, not `T + 273.15` |
| the difference from a reference, as in 1 + α (T − 20 °C) | `T - 20 '°C'`, in K |
| the temperature in °C with coefficients that have units, as in R₀ (1 + A t + B t²) with A in 1/°C | `T - 0 '°C'`, in K |
| the number of °C with coefficients that are numbers, as in the formula of Magnus | `value_in(T, '°C')`, a number |

An amount in °C is the point on the scale where the quantity is a temperature in °C, and refused where the quantity
is in K; in `u`, `half_width`, `U` and other deviations it is a difference.

## Angles, levels, revolutions

`rad` and `sr` are of dimension one with the value 1, so that `rad/s` and `1/s` fit together; `°` is
π/180. `r` (revolution) is 2π, hence `r/min` and `rpm` are 6 °/s; give a number of revolutions per time that
is not an angular velocity in `1/min` or `Hz`. A conversion that would silently hold 2π is refused, with what to write in its place: from `r/min` or `rad/s` to
`Hz`, from `1/min` or a period to `r/min`, a product such as `2*pi*n*M` or `pi*d*n` with n in `r/min`, a flow `n*V` with V in `mL` rather than `mL/r`. What
a unit does not tell goes through: the advance `n*f` of a tool and the speed `n*d/2` of a rim have the same units. Levels in `dB` and `Np` have a dimension of their own, so that
a level is never taken for a ratio by mistake.

## `g` is the gram

The standard acceleration of free fall, 9.80665 m/s², is `gn`, with prefixes: `mgn`, `µgn`. If your laboratory
writes `g`, declare it in the file; `kg` stays the kilogram.

## Units of your own

```toml
[unit]
g = \"9.80665 m/s^2\"
FS = \"10 V\"
step = \"1/65536 FS\"
tick = \"1\"
```

They take prefixes, may be stated in any order, and replace built-in units of the same name.

## All built-in units
";

#[cfg(test)]
mod tests {
    use super::super::UnitTable;
    use super::super::builtin::PREFIXES;
    use super::*;

    #[test]
    fn the_page_in_docs_is_up_to_date() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/units.md");
        if std::env::var_os("GUMPTION_UPDATE").is_some() {
            std::fs::write(path, unit_documentation()).expect("docs/ can be written");
        }
        let page = std::fs::read_to_string(path).unwrap_or_default();
        let current = page.replace("\r\n", "\n") == unit_documentation();
        assert!(
            current,
            "docs/units.md differs from the table of units; run `GUMPTION_UPDATE=1 cargo test`"
        );
    }

    /// Everything in the column of `heading` of the table of syntax.
    fn syntax_examples() -> impl Iterator<Item = &'static str> {
        let rows = SYNTAX
            .lines()
            .skip_while(|line| !line.starts_with("|---"))
            .skip(1);
        rows.take_while(|line| line.starts_with('|'))
            .flat_map(|line| line.split('`').skip(1).step_by(2))
    }

    #[test]
    fn what_the_page_says_is_true() {
        let mut table = UnitTable::default();
        assert!(syntax_examples().count() > 15);
        for example in syntax_examples() {
            assert!(table.parse(example).is_ok(), "{example}");
        }
        for (prefix, ten) in PREFIXES.iter().filter(|(prefix, _)| *prefix != "u") {
            assert!(SYNTAX.contains(&format!("`{prefix}` 10^{ten}")), "{prefix}");
        }
        let example = SYNTAX
            .split("[unit]\n")
            .nth(1)
            .and_then(|rest| rest.split("```").next());
        let entries: Vec<(&str, &str)> = example
            .into_iter()
            .flat_map(str::lines)
            .filter_map(|line| line.split_once(" = "))
            .map(|(name, definition)| (name, definition.trim_matches('"')))
            .collect();
        assert_eq!(entries.len(), 4);
        assert_eq!(table.define_all(entries), []);
    }
}
