//! What a column is, by the words of its head.

use gumption_core::letters::is_chinese;

use super::words::compact;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Role {
    /// A running number.
    Number,
    /// Short name of the quantity.
    Symbol,
    /// Name or source.
    Name,
    /// Estimate.
    Value,
    /// What was used: limits, U, s.
    Used,
    /// Unit.
    Unit,
    /// Type of evaluation, A or B.
    Type,
    /// Distribution.
    Distribution,
    /// Divisor.
    Divisor,
    /// Standard uncertainty.
    U,
    /// Sensitivity coefficient.
    C,
    /// Contribution to u(y).
    Contribution,
    /// Degrees of freedom.
    Dof,
    /// Number of readings.
    Readings,
    /// Square of a contribution, share: computed from others.
    Derived,
    /// Words.
    Remark,
}

impl Role {
    /// Its name in the mapping file and in the list of what was understood.
    pub const fn name(self) -> &'static str {
        match self {
            Role::Number => "number",
            Role::Symbol => "symbol",
            Role::Name => "source",
            Role::Value => "estimate",
            Role::Used => "half_width",
            Role::Unit => "unit",
            Role::Type => "type",
            Role::Distribution => "distribution",
            Role::Divisor => "divisor",
            Role::U => "u",
            Role::C => "sensitivity",
            Role::Contribution => "contribution",
            Role::Dof => "dof",
            Role::Readings => "readings",
            Role::Derived => "derived",
            Role::Remark => "remark",
        }
    }

    /// All of them.
    pub const ALL: [Role; 16] = [
        Role::Number,
        Role::Symbol,
        Role::Name,
        Role::Value,
        Role::Used,
        Role::Unit,
        Role::Type,
        Role::Distribution,
        Role::Divisor,
        Role::U,
        Role::C,
        Role::Contribution,
        Role::Dof,
        Role::Readings,
        Role::Derived,
        Role::Remark,
    ];

    /// Whether figures stand in such a column.
    pub(crate) fn is_figure(self) -> bool {
        use Role::*;
        matches!(self, Value | Used | Divisor | U | C | Contribution | Dof)
    }
}

/// How words are held against the head of a column.
#[derive(Debug, Clone, Copy)]
enum How {
    /// The head has them in it.
    Has,
    /// The head is nothing else.
    Is,
    /// The head begins with them.
    Begins,
    /// The head ends with them.
    Ends,
}

/// What a coverage factor is called in a head.
const FACTOR: &[&str] = &["置信因子", "包含因子", "coveragefactor", "kfactor"];

/// The same, as the whole head.
const FACTOR_ALONE: &[&str] = &["k", "ki", "k值", "ki值"];

/// Whether the head of a column of divisors calls them coverage factors: of a certificate they then state its k.
pub fn names_factor(head: &str) -> bool {
    let head = compact(head);
    FACTOR.iter().any(|word| head.contains(word)) || FACTOR_ALONE.contains(&head.as_str())
}

/// Whether a head says by itself that its figures are limits, as `半宽` does and `数值` does not.
pub fn names_limits(head: &str) -> bool {
    let head = compact(head);
    let of_limits =
        |(role, how, _): &&(Role, How, &[&str])| *role == Role::Used && matches!(how, How::Has);
    let mut words = WORDS
        .iter()
        .filter(of_limits)
        .flat_map(|(_, _, words)| *words);
    words.any(|word| head.contains(word))
}

/// Heads of the units of sensitivity coefficients.
const UNITS_OF_COEFFICIENTS: &[&str] = &[
    "cunit",
    "ciunit",
    "c_iunit",
    "unitofc",
    "unitofci",
    "unitofc_i",
    "sensitivityunit",
    "unitofsensitivity",
    "灵敏系数单位",
    "灵敏系数的单位",
];

/// Whether a head is that of the units of sensitivity coefficients.
pub fn is_unit_of_coefficients(head: &str) -> bool {
    UNITS_OF_COEFFICIENTS.contains(&compact(head).as_str())
}

/// In this order: the first that fits decides. Words are compact ones.
#[rustfmt::skip]
const WORDS: &[(Role, How, &[&str])] = &[
    (Role::Unit, How::Is, UNITS_OF_COEFFICIENTS),
    (Role::Derived, How::Has, &["贡献率", "百分比", "占比", "权重", "比例", "%contribution", "contribution%", "contribution(%)", "contribution/%", "percentcontribution", "share", "significance", "相对贡献", "贡献/%", "贡献(%)", "index"]),
    (Role::Derived, How::Is, &["share", "%", "percent", "weight", "h", "比重", "u(x)/x", "u(xi)/xi", "u(xi)/|xi|", "u/x"]),
    (Role::Derived, How::Has, &["ui^2", "u^2", "(y)^2", "^2", "²", "平方", "squared", "variance", "方差"]),
    (Role::Contribution, How::Begins, &["相对分量", "相对不确定度分量"]),
    (Role::Name, How::Has, &["分量名称", "来源名称", "名称及来源"]),
    (Role::Contribution, How::Has, &["unsicherheitsbeitrag", "beitrag", "ciui", "|ci|ui", "|c|ui", "|ciui|", "ui(y)", "uy(", "u(y)", "|ci|u", "|c|u", "ciu(", "|ci|·u", "cu(", "|ci|×u", "contributiontou", "uncertaintycontribution", "contribution", "贡献", "|u(y", "uncertaintyiny"]),
    (Role::Name, How::Has, &["来源", "source", "influence", "einfluss", "quelle", "因素", "影响量", "description", "contributor", "origin", "cause"]),
    (Role::Contribution, How::Has, &["不确定度分量", "分量值", "componentofu", "uncertaintycomponentu"]),
    (Role::Contribution, How::Is, &["分量", "cu", "uc", "u.c", "c.u", "ci.u", "ciu", "c·u", "ui(y)", "|c|u", "component/y", "curel", "ciurel", "cw", "ciwi"]),
    (Role::Dof, How::Has, &["degreesoffreedom", "degreeoffreedom", "dof", "d.o.f", "自由度", "freiheitsgrad", "degrésdeliberté", "freedom", "νi", "νeff", "veff", "deg.fr", "d.f."]),
    (Role::Dof, How::Is, &["ν", "v", "vi", "df", "nu", "nui", "viorveff", "νioreff", "ν_i"]),
    (Role::C, How::Has, &["sensitivity", "sens.", "sensitivität", "empfindlichkeit", "sensibilité", "灵敏", "敏感系数", "传播系数", "exponent", "指数", "partial", "∂", "coefficient", "传递系数"]),
    (Role::C, How::Is, &["c", "ci", "|ci|", "|c|", "c_i", "sens"]),
    (Role::C, How::Begins, &["ci(", "ci/", "ci["]),
    (Role::Distribution, How::Has, &["distribution", "verteilung", "分布类型", "分布形式", "分布情况", "分布规律", "概率分布", "pdf", "shape", "prob.dist", "probdist"]),
    // `分布因子` and `分布及包含因子` are divisors.
    (Role::Distribution, How::Ends, &["分布"]),
    (Role::Distribution, How::Is, &["distr", "distr.", "dist", "dist.", "prob.", "probability", "loi"]),
    (Role::Divisor, How::Has, &["divisor", "teiler", "diviseur", "divideby", "dividedby", "除数", "分布因子", "dividingfactor"]),
    (Role::Divisor, How::Has, FACTOR),
    (Role::Divisor, How::Is, FACTOR_ALONE),
    (Role::Divisor, How::Is, &["div", "div.", "因子", "b", "factor", "faktor", "facteur", "multiplier", "multiplikator", "factork", "faktork", "facteurk"]),
    (Role::U, How::Has, &["standarduncertainty", "standardunsicherheit", "standardmessunsicherheit", "incertitude-type", "incertitudetype", "标准不确定度", "stdunc", "std.unc", "stduncertainty", "std.-unsicherheit", "std.unsicherheit", "std-unsicherheit", "u(x", "u(", "standardunc", "std.uncertainty", "标准不确定"]),
    (Role::U, How::Is, &["u", "ui", "ux", "stdu", "u_i", "u(xi)", "w", "wi", "w(xi)", "urel", "ui,rel", "urel(xi)", "unsicherheitu", "unsicherheitui", "uncertaintyu", "uncertaintyui", "incertitudeu"]),
    (Role::Readings, How::Has, &["numberofreadings", "测量次数", "readings(n)"]),
    (Role::Readings, How::Is, &["n", "readings", "次数"]),
    (Role::Type, How::Has, &["评定方法", "评定类别", "evaluation", "a/b", "类别", "typea", "评定类型", "typeof", "a类/b类"]),
    (Role::Type, How::Is, &["type", "类型", "评定", "method", "eval.", "a,b"]),
    (Role::Remark, How::Has, &["bemerkung", "angabe", "hinweis", "remarque", "remark", "note", "comment", "备注", "说明", "information", "依据", "howknown", "basis", "evidence", "whatisknown", "已知", "信息", "statement", "注", "details", "data", "justification", "reference", "specification", "技术指标"]),
    (Role::Remark, How::Is, &["how", "why", "howfound", "howobtained"]),
    (Role::Used, How::Has, &["±", "estimateofuncertainty", "uncertaintyestimate", "variationsbreite", "variabilitätsintervall", "spannweite", "halbbreite", "halbweite", "demi-étendue", "demi-largeur", "demi-intervalle", "half-width", "halfwidth", "半宽", "limit", "误差限", "expanded", "扩展不确定度", "a(half", "tolerance", "允差", "interval", "区间", "uncertaintyvalue", "不确定度值", "valueofuncertainty", "spread", "stated", "极限", "given", "最大允许", "+/-"]),
    (Role::Used, How::Is, &["uncertainty", "unsicherheit", "incertitude", "a", "ai", "不确定度", "unc.", "unc", "accuracy", "error", "δ", "figure", "known", "数值", "magnitude", "a/u/s", "a,u,s", "size", "amount", "a或u", "u或a", "a/u", "u/a", "a,u", "半宽a或u", "aoru", "uora", "limit/u", "极限值/u"]),
    (Role::Unit, How::Is, &["unit", "units", "einheit", "unité", "单位", "[unit]", "计量单位"]),
    (Role::Unit, How::Begins, &["unitof"]),
    (Role::Symbol, How::Has, &["symbol", "符号", "variable", "代号"]),
    (Role::Value, How::Has, &["estimate", "schätzwert", "valeurestimée", "估计值", "nominal", "标称", "measuredvalue", "量值", "bestvalue", "最佳", "meanvalue", "输入量的值", "输入量值", "inputvalue", "测得值", "取值"]),
    (Role::Value, How::Is, &["value", "valuex", "valuexi", "wert", "valeur", "estimation", "x", "xi", "值", "mean", "level", "reading", "平均值", "示值"]),
    (Role::Symbol, How::Has, &["quantity", "größe", "grandeur", "输入量", "量的符号"]),
    (Role::Symbol, How::Is, &["量", "input", "xi", "parameter"]),
    (Role::Name, How::Has, &["komponente", "composante", "component", "名称", "分量", "分项", "项目", "contribut", "item", "effect", "内容"]),
    (Role::Name, How::Is, &["name", "input", "what", "uncertainty", "term", "label", "项", "parameter"]),
    (Role::Number, How::Is, &["no", "no.", "#", "序号", "编号", "nr", "nr.", "row", "line", "i", "№", "行", "号"]),
];

/// What a head says of its column, and the unit in it.
pub fn role(head: &str) -> Option<(Role, String)> {
    let (name, unit) = apart(head);
    if let Some(role) = in_two_languages(&name) {
        return Some((role, unit));
    }
    // `分量(HRC)`, `u (counts)`: what stands in a bracket behind a name of figures is its unit, also one that is not known.
    let figure = without_bracket(&name)
        .and_then(of)
        .filter(|role| role.is_figure());
    if let Some(role) = figure.or_else(|| of(&name)).or_else(|| of(head)) {
        return Some((role, unit));
    }
    // `u_i(R_X) mΩ`: a unit without a mark, where the words alone are known.
    let (name, unit) = head.trim().rsplit_once(' ')?;
    let role = of(name).filter(|role| role.is_figure() && is_unit(unit))?;
    Some((role, unit.into()))
}

/// What a head says twice, in Chinese and in other letters: `unit / 单位`, `分量 c·u`. Only where both say the same: the `V` of
/// `电压 V` is no degrees of freedom.
fn in_two_languages(name: &str) -> Option<Role> {
    let is_first = is_chinese(name.chars().next()?);
    let at = name.find(|c: char| c.is_alphabetic() && is_chinese(c) != is_first)?;
    let between = |c: char| c.is_whitespace() || "/()（）".contains(c);
    let one = of(name[..at].trim_end_matches(between))?;
    let (other, _) = role(name[at..].trim_start_matches(between))?;
    (one == other).then_some(one)
}

fn of(head: &str) -> Option<Role> {
    let text = compact(head);
    // `X_i` is a name and `x_i` its estimate.
    match head.trim().replace(['_', ' '], "").as_str() {
        "" => return None,
        "Xi" | "X" | "量Xi" | "量X" | "输入量Xi" => return Some(Role::Symbol),
        // A capital letter is an expanded uncertainty (GUM 2.3.5), a small one a standard uncertainty.
        "U" | "W" | "Urel" | "Ur" | "Wrel" | "U95" => return Some(Role::Used),
        _ => {}
    }
    // `u_i(R_X)` is a contribution to u of R_X; `u(x_i)`, `u_i(x)` are the inputs' own.
    if let Some(argument) = text.strip_prefix("ui(").or(text.strip_prefix("|ui("))
        && !argument.starts_with('x')
    {
        return Some(Role::Contribution);
    }
    let fits = |how: How, word: &str| match how {
        How::Has => text.contains(word),
        How::Is => text == word,
        How::Begins => text.starts_with(word),
        How::Ends => text.ends_with(word),
    };
    let entry = WORDS
        .iter()
        .find(|(_, how, words)| words.iter().any(|word| fits(*how, word)));
    entry.map(|(role, ..)| *role)
}

/// What stands in front of a short word in a bracket, or behind a slash, where a blank or a Chinese character parts the
/// two.
fn without_bracket(name: &str) -> Option<&str> {
    let bracket = name
        .strip_suffix(')')
        .and_then(|name| name.rsplit_once('('));
    let (front, inner) = bracket.or_else(|| name.rsplit_once('/'))?;
    let inner = inner.trim_start();
    let parted = front.ends_with(|c: char| c == ' ' || is_chinese(c));
    let letters = (2..=6).contains(&inner.len()) && inner.chars().all(|c| c.is_ascii_alphabetic());
    (parted && letters).then(|| front.trim())
}

/// Whether a head is `u_i` and no more than that: `u(x_i)` and words are of the input.
pub fn is_bare_u(head: &str) -> bool {
    let (name, _) = apart(head);
    let name = without_bracket(&name).unwrap_or(&name);
    matches!(
        name.replace(['_', ' '], "").to_lowercase().as_str(),
        "u" | "ui"
    )
}

/// Whether a head says that its figures are uncertainties, and not which.
pub fn is_bare_uncertainty(head: &str) -> bool {
    const WORDS: [&str; 6] = [
        "uncertainty",
        "unc",
        "unc.",
        "unsicherheit",
        "incertitude",
        "不确定度",
    ];
    WORDS.contains(&compact(&apart(head).0).as_str())
}

/// A head without the unit in it: `u(x_i) / mm`, `Estimate [mm]`, `contribution (mm)`.
pub fn apart(head: &str) -> (String, String) {
    let head = head.trim();
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some(inner) = head.strip_suffix(close)
            && let Some(at) = inner.rfind(open)
        {
            // `u / (mm²/s)`: a solidus in front of the bracket is none of the name.
            let name = inner[..at].trim().trim_end_matches([' ', '/']);
            let unit = inner[at + 1..].trim();
            let before = inner[..at].chars().next_back();
            // `u(xi)` is a symbol: a bracket that belongs to one letter holds no unit.
            let symbol = open == '('
                && before.is_some_and(|c| c.is_ascii_alphanumeric())
                && inner[..at]
                    .split(' ')
                    .next_back()
                    .is_some_and(|w| w.len() <= 3)
                // `u(mV)`: more than a letter that is a unit is no argument.
                && (unit.chars().count() < 2 || !is_unit(unit));
            if !symbol && !name.is_empty() && is_unit(unit) {
                return (name.into(), unit.into());
            }
        }
    }
    // `u(x_i) mm`: behind a symbol a unit needs no mark.
    if let Some((name, unit)) = head.rsplit_once(' ')
        && name.ends_with(')')
        && is_unit(unit)
    {
        return (name.into(), unit.into());
    }
    for mark in [", ", " in ", " / ", "/"] {
        if let Some((name, unit)) = head.split_once(mark)
            && (name.chars().count() > 1 || mark == " in " || matches!(name, "u" | "U"))
            && is_unit(unit.trim_matches(['(', ')', ' ', '/']))
        {
            return (
                name.trim().into(),
                unit.trim_matches(['(', ')', ' ', '/']).into(),
            );
        }
    }
    (head.into(), String::new())
}

/// Whether a text is a unit that the program knows.
pub fn is_unit(text: &str) -> bool {
    !text.is_empty()
        && text != "k"
        && text != "a"
        && text != "%/100"
        && (crate::units::parse(text).is_some() || crate::units::power_of_ten(text).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_of_four_guides() {
        let heads = |text: &str| -> Vec<Option<Role>> {
            text.split(" | ").map(|h| role(h).map(|(r, _)| r)).collect()
        };
        use Role::*;
        assert_eq!(
            heads(
                "Quantity X_i | Estimate x_i | Standard uncertainty u(x_i) | Probability distribution | Sensitivity coefficient c_i | Uncertainty contribution u_i(y)"
            ),
            [Symbol, Value, U, Distribution, C, Contribution].map(Some)
        );
        assert_eq!(
            heads(
                "Symbol | Source of uncertainty | Value ± | Probability distribution | Divisor | c_i | u_i(y) | v_i or v_eff"
            ),
            [
                Symbol,
                Name,
                Used,
                Distribution,
                Divisor,
                C,
                Contribution,
                Dof
            ]
            .map(Some)
        );
        assert_eq!(
            heads(
                "序号 | 不确定度来源 | 输入量估计值 | 评定方法(A/B类) | 概率分布 | 区间半宽 a | 包含因子 k | 标准不确定度 u(x_i) | 灵敏系数 c_i | 标准不确定度分量 |c_i|u(x_i) | 自由度 ν_i"
            ),
            [
                Number,
                Name,
                Value,
                Type,
                Distribution,
                Used,
                Divisor,
                U,
                C,
                Contribution,
                Dof
            ]
            .map(Some)
        );
        assert_eq!(
            heads("Component | Type | a | Unit | Dist. | k | u(x) | ci | |ci|·u(xi) | dof | %"),
            [
                Name,
                Type,
                Used,
                Unit,
                Distribution,
                Divisor,
                U,
                C,
                Contribution,
                Dof,
                Derived
            ]
            .map(Some)
        );
    }

    #[test]
    fn heads_in_two_languages() {
        let heads =
            "unit / 单位 | 单位/Unit | c·u / 分量 c·u | 类型 Type | u\n标准不确定度 | 电压 V";
        let roles: Vec<Option<Role>> = heads
            .split(" | ")
            .map(|head| role(head).map(|(role, _)| role))
            .collect();
        use Role::*;
        let known = [Unit, Unit, Contribution, Type, U].map(Some);
        assert_eq!(roles[..5], known);
        assert_eq!(roles[5], None);
    }

    #[test]
    fn units_stand_in_heads() {
        assert_eq!(role("u(x_i) / mm").unwrap(), (Role::U, "mm".into()));
        assert_eq!(role("Estimate [mm]").unwrap(), (Role::Value, "mm".into()));
        assert_eq!(
            role("contribution u_i(y) (µm)").unwrap(),
            (Role::Contribution, "µm".into())
        );
        assert_eq!(role("标准不确定度/mV").unwrap(), (Role::U, "mV".into()));
        assert_eq!(role("Value ±").unwrap(), (Role::Used, String::new()));
        assert_eq!(role("u / HRC").unwrap().0, Role::U);
        assert_eq!(role("u / (mm2/s)").unwrap(), (Role::U, "mm2/s".into()));
        assert_eq!(
            role("标准不确定度(×10⁻⁶)").unwrap(),
            (Role::U, "×10⁻⁶".into())
        );
    }
}
