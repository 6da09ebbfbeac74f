//! The built-in units, as a table to be read.
//!
//! Values: SI Brochure (9th edition) for the SI and the units accepted for use with it; CODATA 2022
//! for the dalton; NIST SP 811 for the others. A definition may use the rows before it.

/// A built-in unit, for documentation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BuiltinUnit {
    /// Main symbol.
    pub symbol: &'static str,
    /// Other spellings that are read.
    pub aliases: &'static [&'static str],
    /// English name.
    pub name_en: &'static str,
    /// Chinese name.
    pub name_zh: &'static str,
    /// Where it belongs.
    pub kind: UnitKind,
    /// Which prefixes it takes.
    pub prefixes: Prefixes,
    /// What it is in other units.
    pub definition: Definition,
}

/// Groups of units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum UnitKind {
    /// SI base units and derived units with special names.
    Si,
    /// Accepted for use with the SI, or of dimension one.
    Accepted,
    /// Other metric units: CGS, technical, of radiology and of industry.
    Metric,
    /// Units of the inch-pound system.
    InchPound,
}

/// Which SI prefixes a unit takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Prefixes {
    /// None (minute, inch).
    None,
    /// Only those above one (tonne).
    Multiples,
    /// All.
    All,
}

/// What a unit is in other units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Definition {
    /// Unit of a base quantity (place in [`Dimension`](super::Dimension)) times a power of ten.
    Base(usize, i32),
    /// Equal to this.
    Equal(&'static str),
    /// A scale with steps of a unit and its zero at so many kelvin.
    Point(&'static str, f64),
    /// A level unit of so many decibels.
    Decibels(f64),
}

/// All of them.
pub fn units() -> &'static [BuiltinUnit] {
    UNITS
}

impl BuiltinUnit {
    /// How the definition reads in documentation.
    pub fn value(&self) -> String {
        match self.definition {
            Definition::Base(_, 0) => "base unit".to_owned(),
            Definition::Base(_, ten) => format!("10^{ten} of the SI base unit"),
            Definition::Equal(text) => text.to_owned(),
            Definition::Point(step, zero) => format!("steps of {step}, zero at {zero:.2} K"),
            Definition::Decibels(1.0) => "level".to_owned(),
            Definition::Decibels(_) => "20/ln 10 dB".to_owned(),
        }
    }

    const fn also(mut self, aliases: &'static [&'static str]) -> BuiltinUnit {
        self.aliases = aliases;
        self
    }

    const fn prefixes(mut self, prefixes: Prefixes) -> BuiltinUnit {
        self.prefixes = prefixes;
        self
    }
}

const fn unit(
    kind: UnitKind,
    symbol: &'static str,
    name_en: &'static str,
    name_zh: &'static str,
    definition: Definition,
) -> BuiltinUnit {
    BuiltinUnit {
        symbol,
        aliases: &[],
        name_en,
        name_zh,
        kind,
        prefixes: Prefixes::None,
        definition,
    }
}

const fn base(
    symbol: &'static str,
    en: &'static str,
    zh: &'static str,
    place: usize,
    ten: i32,
) -> BuiltinUnit {
    unit(UnitKind::Si, symbol, en, zh, Definition::Base(place, ten)).prefixes(Prefixes::All)
}

const fn si(
    symbol: &'static str,
    en: &'static str,
    zh: &'static str,
    definition: &'static str,
) -> BuiltinUnit {
    unit(UnitKind::Si, symbol, en, zh, Definition::Equal(definition)).prefixes(Prefixes::All)
}

const fn accepted(
    symbol: &'static str,
    en: &'static str,
    zh: &'static str,
    definition: &'static str,
) -> BuiltinUnit {
    unit(
        UnitKind::Accepted,
        symbol,
        en,
        zh,
        Definition::Equal(definition),
    )
}

const fn metric(
    symbol: &'static str,
    en: &'static str,
    zh: &'static str,
    definition: &'static str,
) -> BuiltinUnit {
    unit(
        UnitKind::Metric,
        symbol,
        en,
        zh,
        Definition::Equal(definition),
    )
}

const fn inch_pound(
    symbol: &'static str,
    en: &'static str,
    zh: &'static str,
    definition: &'static str,
) -> BuiltinUnit {
    unit(
        UnitKind::InchPound,
        symbol,
        en,
        zh,
        Definition::Equal(definition),
    )
}

/// Prefix symbols with their powers of ten; those of two letters first, the commonest before the
/// rare ones.
pub(super) const PREFIXES: &[(&str, i32)] = &[
    ("da", 1),
    ("m", -3),
    ("k", 3),
    ("µ", -6),
    ("u", -6),
    ("M", 6),
    ("n", -9),
    ("G", 9),
    ("c", -2),
    ("p", -12),
    ("d", -1),
    ("h", 2),
    ("T", 12),
    ("f", -15),
    ("P", 15),
    ("a", -18),
    ("E", 18),
    ("z", -21),
    ("Z", 21),
    ("y", -24),
    ("Y", 24),
    ("r", -27),
    ("R", 27),
    ("q", -30),
    ("Q", 30),
];

/// Names of the prefixes, by their power of ten.
pub(super) const PREFIX_NAMES: &[(i32, &str)] = &[
    (30, "quetta"),
    (27, "ronna"),
    (24, "yotta"),
    (21, "zetta"),
    (18, "exa"),
    (15, "peta"),
    (12, "tera"),
    (9, "giga"),
    (6, "mega"),
    (3, "kilo"),
    (2, "hecto"),
    (1, "deca"),
    (-1, "deci"),
    (-2, "centi"),
    (-3, "milli"),
    (-6, "micro"),
    (-9, "nano"),
    (-12, "pico"),
    (-15, "femto"),
    (-18, "atto"),
    (-21, "zepto"),
    (-24, "yocto"),
    (-27, "ronto"),
    (-30, "quecto"),
];

/// Names of the prefixes, with their symbols.
pub(super) fn prefix_names() -> impl Iterator<Item = (&'static str, &'static str)> {
    PREFIX_NAMES.iter().filter_map(|(power, name)| {
        let mut symbols = PREFIXES.iter().filter(|(_, known)| known == power);
        Some((*name, symbols.next()?.0))
    })
}

/// The table.
#[rustfmt::skip]
pub(super) const UNITS: &[BuiltinUnit] = &[
    // SI base units. The kilogram is also listed by itself, so that a file that gives `g` another
    // meaning keeps its kilograms.
    base("m", "metre", "米", 0, 0),
    base("g", "gram", "克", 1, -3),
    base("kg", "kilogram", "千克", 1, 0).prefixes(Prefixes::None),
    base("s", "second", "秒", 2, 0),
    base("A", "ampere", "安培", 3, 0),
    base("K", "kelvin", "开尔文", 4, 0),
    base("mol", "mole", "摩尔", 5, 0),
    base("cd", "candela", "坎德拉", 6, 0),
    // SI derived units with special names.
    si("rad", "radian", "弧度", "1"),
    si("sr", "steradian", "球面度", "1"),
    si("Hz", "hertz", "赫兹", "1/s"),
    si("N", "newton", "牛顿", "kg·m/s^2"),
    si("Pa", "pascal", "帕斯卡", "N/m^2"),
    si("J", "joule", "焦耳", "N·m"),
    si("W", "watt", "瓦特", "J/s"),
    si("C", "coulomb", "库仑", "A·s"),
    si("V", "volt", "伏特", "W/A"),
    si("F", "farad", "法拉", "C/V"),
    si("Ω", "ohm", "欧姆", "V/A").also(&["ohm", "Ohm"]),
    si("S", "siemens", "西门子", "A/V"),
    si("Wb", "weber", "韦伯", "V·s"),
    si("T", "tesla", "特斯拉", "Wb/m^2"),
    si("H", "henry", "亨利", "Wb/A"),
    unit(UnitKind::Si, "°C", "degree Celsius", "摄氏度", Definition::Point("K", 273.15)).also(&["degC"]).prefixes(Prefixes::All),
    si("lm", "lumen", "流明", "cd·sr"),
    si("lx", "lux", "勒克斯", "lm/m^2"),
    si("Bq", "becquerel", "贝可勒尔", "1/s"),
    si("Gy", "gray", "戈瑞", "J/kg"),
    si("Sv", "sievert", "希沃特", "J/kg"),
    si("kat", "katal", "开特", "mol/s"),
    // Accepted for use with the SI.
    accepted("min", "minute", "分", "60 s"),
    accepted("h", "hour", "小时", "60 min"),
    accepted("d", "day", "日", "24 h"),
    accepted("a", "year (Julian)", "年（儒略年）", "365.25 d").also(&["yr"]),
    accepted("°", "degree of arc", "度", "pi/180 rad").also(&["deg"]).prefixes(Prefixes::All),
    accepted("′", "minute of arc", "角分", "1/60 °").also(&["arcmin"]),
    accepted("″", "second of arc", "角秒", "1/60 ′").also(&["arcsec"]).prefixes(Prefixes::All),
    accepted("mas", "milliarcsecond", "毫角秒", "10^-3 ″"),
    accepted("µas", "microarcsecond", "微角秒", "10^-6 ″").also(&["uas"]),
    accepted("gon", "gon", "百分度", "pi/200 rad").prefixes(Prefixes::All),
    accepted("r", "revolution", "转", "2 pi rad").also(&["rev"]),
    accepted("rpm", "revolution per minute", "转每分", "r/min"),
    accepted("ha", "hectare", "公顷", "10^4 m^2"),
    accepted("L", "litre", "升", "10^-3 m^3").also(&["l"]).prefixes(Prefixes::All),
    accepted("t", "tonne", "吨", "10^3 kg").prefixes(Prefixes::Multiples),
    accepted("Da", "dalton", "道尔顿", "1.66053906892e-27 kg").also(&["u"]).prefixes(Prefixes::Multiples),
    accepted("eV", "electronvolt", "电子伏", "1.602176634e-19 J").prefixes(Prefixes::All),
    accepted("au", "astronomical unit", "天文单位", "149597870700 m"),
    unit(UnitKind::Accepted, "dB", "decibel", "分贝", Definition::Decibels(1.0)).prefixes(Prefixes::All),
    unit(UnitKind::Accepted, "Np", "neper", "奈培", Definition::Decibels(20.0 / std::f64::consts::LN_10)).prefixes(Prefixes::All),
    accepted("%", "percent", "百分之一", "10^-2"),
    accepted("%RH", "percent relative humidity", "相对湿度百分数", "10^-2").also(&["%rh"]),
    accepted("pH", "pH value", "酸度", "1"),
    accepted("HRA", "Rockwell hardness A", "洛氏硬度 A", "1"),
    accepted("HRB", "Rockwell hardness B", "洛氏硬度 B", "1").also(&["HRBW"]),
    accepted("HRC", "Rockwell hardness C", "洛氏硬度 C", "1"),
    accepted("HBW", "Brinell hardness", "布氏硬度", "1").also(&["HB"]),
    accepted("HV", "Vickers hardness", "维氏硬度", "1"),
    accepted("HLD", "Leeb hardness", "里氏硬度", "1"),
    accepted("‰", "per mille", "千分之一", "10^-3"),
    accepted("ppm", "part per million", "百万分之一", "10^-6"),
    accepted("ppb", "part per billion (10^-9)", "十亿分之一", "10^-9"),
    accepted("count", "count", "计数", "1").also(&["counts"]).prefixes(Prefixes::Multiples),
    accepted("pulse", "pulse", "脉冲", "1").also(&["pulses"]),
    accepted("LSB", "least significant bit", "最低有效位", "1"),
    accepted("bit", "bit", "比特", "1").prefixes(Prefixes::Multiples),
    accepted("VA", "volt-ampere", "伏安", "V·A").prefixes(Prefixes::All),
    accepted("var", "var", "乏", "V·A").prefixes(Prefixes::All),
    accepted("Wh", "watt-hour", "瓦时", "W·h").prefixes(Prefixes::All),
    accepted("Ah", "ampere-hour", "安时", "A·h").prefixes(Prefixes::All),
    // Other metric units.
    metric("gn", "standard acceleration of free fall", "标准自由落体加速度", "9.80665 m/s^2").also(&["g_n", "g0"]).prefixes(Prefixes::All),
    metric("Gal", "gal", "伽", "10^-2 m/s^2").prefixes(Prefixes::All),
    metric("kgf", "kilogram-force", "千克力", "kg·gn"),
    metric("gf", "gram-force", "克力", "g·gn"),
    metric("dyn", "dyne", "达因", "10^-5 N").prefixes(Prefixes::All),
    metric("erg", "erg", "尔格", "10^-7 J").prefixes(Prefixes::All),
    metric("bar", "bar", "巴", "10^5 Pa").prefixes(Prefixes::All),
    metric("atm", "standard atmosphere", "标准大气压", "101325 Pa"),
    metric("Torr", "torr", "托", "1/760 atm").prefixes(Prefixes::All),
    metric("mmHg", "conventional millimetre of mercury", "毫米汞柱", "133.322387415 Pa"),
    metric("mmH2O", "conventional millimetre of water", "毫米水柱", "9.80665 Pa"),
    metric("cal", "thermochemical calorie", "热化学卡", "4.184 J").prefixes(Prefixes::All),
    metric("P", "poise", "泊", "0.1 Pa·s").prefixes(Prefixes::All),
    metric("St", "stokes", "斯托克斯", "10^-4 m^2/s").prefixes(Prefixes::All),
    metric("G", "gauss", "高斯", "10^-4 T").also(&["Gs"]).prefixes(Prefixes::All),
    metric("Mx", "maxwell", "麦克斯韦", "10^-8 Wb"),
    metric("Oe", "oersted", "奥斯特", "10^3/(4 pi) A/m").prefixes(Prefixes::All),
    metric("Å", "ångström", "埃", "10^-10 m"),
    metric("b", "barn", "靶恩", "10^-28 m^2").prefixes(Prefixes::All),
    metric("Ci", "curie", "居里", "3.7e10 Bq").prefixes(Prefixes::All),
    metric("R", "röntgen", "伦琴", "2.58e-4 C/kg").prefixes(Prefixes::All),
    metric("rem", "rem", "雷姆", "10^-2 Sv").prefixes(Prefixes::All),
    metric("dpt", "dioptre", "屈光度", "1/m"),
    metric("ct", "metric carat", "克拉", "0.2 g"),
    metric("nmi", "nautical mile", "海里", "1852 m"),
    metric("kn", "knot", "节", "nmi/h"),
    // Inch-pound units.
    inch_pound("in", "inch", "英寸", "25.4 mm"),
    inch_pound("mil", "mil (thousandth of an inch)", "密耳", "10^-3 in").also(&["thou"]),
    inch_pound("ft", "foot", "英尺", "12 in"),
    inch_pound("yd", "yard", "码", "3 ft"),
    inch_pound("mi", "mile", "英里", "5280 ft"),
    inch_pound("mph", "mile per hour", "英里每小时", "mi/h"),
    inch_pound("lb", "pound", "磅", "0.45359237 kg"),
    inch_pound("oz", "ounce", "盎司", "1/16 lb"),
    inch_pound("grain", "grain", "格令", "1/7000 lb"),
    inch_pound("lbf", "pound-force", "磅力", "lb·gn"),
    inch_pound("ozf", "ounce-force", "盎司力", "oz·gn"),
    inch_pound("psi", "pound-force per square inch", "磅力每平方英寸", "lbf/in^2"),
    inch_pound("ksi", "thousand psi", "千磅力每平方英寸", "10^3 psi"),
    inch_pound("inHg", "conventional inch of mercury", "英寸汞柱", "25.4 mmHg"),
    inch_pound("inH2O", "conventional inch of water", "英寸水柱", "25.4 mmH2O"),
    inch_pound("Btu", "British thermal unit (IT)", "英热单位", "1055.05585262 J"),
    inch_pound("hp", "mechanical horsepower", "英制马力", "550 ft·lbf/s"),
    inch_pound("Δ°F", "difference of one degree Fahrenheit", "华氏度之差", "5/9 K"),
    unit(UnitKind::InchPound, "°F", "degree Fahrenheit", "华氏度", Definition::Point("Δ°F", 45967.0 / 180.0)).also(&["degF"]),
];

/// The typographic spelling of a name that is written in ASCII: `kΩ` for `kohm`, `µm` for `um`.
pub(super) fn typographic(name: &str) -> Option<String> {
    let main = |name: &str| {
        UNITS
            .iter()
            .find(|u| u.symbol == name || u.aliases.contains(&name))
            .map(|u| u.symbol)
    };
    if let Some(symbol) = main(name) {
        let plain_text = name.is_ascii() && symbol.is_ascii();
        return Some(if plain_text { name } else { symbol }.to_owned());
    }
    PREFIXES.iter().find_map(|(prefix, _)| {
        let symbol = main(name.strip_prefix(prefix)?)?;
        let rest = if symbol.is_ascii() {
            name.strip_prefix(prefix)?
        } else {
            symbol
        };
        Some(format!(
            "{}{rest}",
            if *prefix == "u" { "µ" } else { prefix }
        ))
    })
}
