//! What the parsers that read a user's file say, in both languages, so that a Chinese message is Chinese.
//!
//! Their sets of messages are finite, and these tables hold all of them: a test reads the sources of the parsers, where
//! they are at hand, and names what a new version says anew. What is in no table is quoted as it is.

use crate::said::{Between, Said, say};

/// A message of the parser of TOML.
pub fn of_toml(message: &str) -> Said {
    let (what, expected) = match message.split_once(", expected ") {
        Some((what, expected)) => (what, Some(expected)),
        None => (message, None),
    };
    let Some(what) = known(&TOML, what) else {
        return Said::quoted(message);
    };
    match expected.filter(|expected| *expected != "nothing") {
        None => what,
        Some(expected) => {
            let words = expected.split(", ");
            let words = words.map(|word| known(&TOML_WORDS, word).unwrap_or_else(|| word.into()));
            say!("{what}; expected {}", Said::row(Between::Or, words))
        }
    }
}

/// A message of the parser of JSON: of its text, or of what was expected of its values.
pub fn of_json(message: &str) -> Said {
    let placed = message.rsplit_once(" at line ");
    let placed = placed.and_then(|(what, place)| Some((what, place.split_once(" column ")?)));
    let (what, place) = match placed {
        Some((what, place)) => (what, Some(place)),
        None => (message, None),
    };
    let what = known(&JSON, what).unwrap_or_else(|| of_value(what));
    match place {
        Some((line, column)) => say!("{what}, in line {line}, column {column}"),
        None => what,
    }
}

/// What does not fit of a value that is well-formed.
fn of_value(message: &str) -> Said {
    let behind = |words: &str| message.strip_prefix(words);
    let named = |words: &str| {
        let rest = behind(words)?.strip_prefix('`')?;
        rest.split_once('`')
    };
    let expected = |words: &str| behind(words)?.split_once(", expected ");
    if let Some((name, _)) = named("missing field ") {
        say!("`{name}` is missing")
    } else if let Some((name, _)) = named("duplicate field ") {
        say!("`{name}` is stated a second time")
    } else if let Some((name, _)) = named("unknown field ") {
        say!("`{name}` is not known")
    } else if let Some((name, _)) = named("unknown variant ") {
        say!("`{name}` is no word that may stand there")
    } else if let Some((found, wanted)) = expected("invalid type: ")
        .or_else(|| expected("invalid value: "))
        .or_else(|| expected("invalid length "))
    {
        say!("{found} was found, {wanted} is expected")
    } else {
        Said::quoted(message)
    }
}

fn known(table: &[(&'static str, &'static str)], message: &str) -> Option<Said> {
    let row = table.iter().find(|(english, _)| *english == message)?;
    Some(Said::pair(row.0, row.1))
}

/// The messages of `toml_parser`, and those of `toml` about tables.
const TOML: [(&str, &str); 74] = [
    ("`_` may only go between digits", "`_` 只能写在数字之间"),
    (
        "cannot recurse further; max recursion depth met",
        "嵌套过深",
    ),
    (
        "carriage return must be followed by newline",
        "回车符之后须有换行符",
    ),
    ("extra `=`", "多了一个 `=`"),
    (
        "extra assignment between key-value pairs",
        "键值对之间多了一个等号",
    ),
    ("extra comma in array", "数组中多了一个逗号"),
    ("extra comma in inline table", "行内表中多了一个逗号"),
    (
        "integers with a radix cannot be signed",
        "带进制前缀的整数不能有正负号",
    ),
    ("invalid comment character", "注释中有不允许的字符"),
    ("invalid inline table element", "行内表的内容有误"),
    ("invalid key-value pair", "键值对有误"),
    ("invalid unquoted key", "键须加引号"),
    ("invalid value", "值有误"),
    ("key with no value", "键没有值"),
    (
        "keys cannot be multi-line basic strings",
        "键不能是多行文本",
    ),
    (
        "keys cannot be multi-line literal strings",
        "键不能是多行文本",
    ),
    ("missing array opening", "缺少数组的左方括号"),
    (
        "missing assignment between key-value pairs",
        "键与值之间缺少 `=`",
    ),
    (
        "missing comma between array elements",
        "数组元素之间缺少逗号",
    ),
    (
        "missing comma between key-value pairs",
        "键值对之间缺少逗号",
    ),
    ("missing comment start", "缺少注释符 `#`"),
    ("missing escaped value", "反斜线之后缺少内容"),
    ("missing inline table opening", "缺少行内表的左花括号"),
    ("missing key for inline table element", "行内表中缺少键"),
    ("missing opening quote", "缺少左引号"),
    ("missing table open", "缺少表头的左方括号"),
    ("missing value for key", "键没有值"),
    ("missing value", "缺少值"),
    ("radix must be lowercase", "进制前缀须为小写"),
    ("redundant integer number prefix", "整数的前缀重复"),
    ("redundant numeric sign", "数的正负号重复"),
    ("string values must be quoted", "文本须加引号"),
    ("too few unicode value digits", "Unicode 编码的位数不足"),
    ("unclosed array table", "表数组的表头没有闭合"),
    ("unclosed array", "数组没有闭合"),
    ("unclosed inline table", "行内表没有闭合"),
    ("unclosed table", "表头没有闭合"),
    ("unexpected `=` in array", "数组中不应有 `=`"),
    (
        "unexpected content between comment and newline",
        "注释与换行之间有多余内容",
    ),
    ("unexpected content", "有多余内容"),
    ("unexpected key or value", "此处不应有键或值"),
    ("unexpected leading zero", "数的前面有多余的零"),
    ("unexpected sign", "此处不应有正负号"),
    ("unquoted keys cannot be empty", "不加引号的键不能为空"),
    ("duplicate key", "键重复"),
    ("recursion limit", "嵌套过深"),
    (
        "cannot extend value of type array with a dotted key",
        "不能用带点的键扩展数组",
    ),
    (
        "cannot extend value of type inline table with a dotted key",
        "不能用带点的键扩展行内表",
    ),
    (
        "cannot extend value of type string with a dotted key",
        "不能用带点的键扩展文本",
    ),
    (
        "cannot extend value of type integer with a dotted key",
        "不能用带点的键扩展整数",
    ),
    (
        "cannot extend value of type float with a dotted key",
        "不能用带点的键扩展数",
    ),
    (
        "cannot extend value of type boolean with a dotted key",
        "不能用带点的键扩展布尔值",
    ),
    (
        "cannot extend value of type datetime with a dotted key",
        "不能用带点的键扩展日期",
    ),
    (
        "cannot extend value of type table with a dotted key",
        "不能用带点的键扩展表",
    ),
    ("invalid string", "文本有误"),
    ("invalid literal string", "单引号文本有误"),
    ("invalid basic string", "双引号文本有误"),
    ("invalid multi-line literal string", "多行文本有误"),
    ("invalid multi-line basic string", "多行文本有误"),
    ("invalid key", "键有误"),
    ("invalid table", "表头有误"),
    ("invalid boolean", "布尔值有误"),
    ("invalid date-time", "日期有误"),
    ("invalid float", "数有误"),
    ("invalid integer number", "整数有误"),
    ("invalid hexadecimal number", "十六进制数有误"),
    ("invalid octal number", "八进制数有误"),
    ("invalid binary number", "二进制数有误"),
    ("invalid mantissa", "数的尾数有误"),
    ("invalid fraction", "数的小数部分有误"),
    ("invalid exponent", "数的指数有误"),
    ("invalid number", "数有误"),
    ("invalid datetime", "日期有误"),
    ("number too large to fit in target type", "整数过大"),
];

/// What the parser of TOML expects; signs stand as they are.
const TOML_WORDS: [(&str, &str); 15] = [
    ("basic string", "双引号文本"),
    ("characters", "字符"),
    ("digits", "数字"),
    ("key", "键"),
    ("letters", "字母"),
    ("literal string", "单引号文本"),
    ("multi-line basic string", "多行文本"),
    ("newline", "换行"),
    ("nothing", "到此为止"),
    ("non-double-quote visible characters", "双引号以外的字符"),
    ("non-single-quote characters", "单引号以外的字符"),
    (
        "non-single-quote visible characters",
        "单引号以外的可见字符",
    ),
    ("numbers", "数字"),
    ("unicode hexadecimal value", "Unicode 的十六进制数"),
    ("value", "值"),
];

/// The messages of `serde_json` about a text.
const JSON: [(&str, &str); 23] = [
    ("EOF while parsing a list", "文件在列表中间结束"),
    ("EOF while parsing an object", "文件在对象中间结束"),
    ("EOF while parsing a string", "文件在文本中间结束"),
    ("EOF while parsing a value", "文件在需要值的地方结束"),
    ("expected `:`", "应为 `:`"),
    ("expected `,` or `]`", "应为 `,` 或 `]`"),
    ("expected `,` or `}`", "应为 `,` 或 `}`"),
    ("expected ident", "应为 true、false 或 null"),
    ("expected value", "应为一个值"),
    ("expected `\"`", "应为 `\"`"),
    ("invalid escape", "反斜线之后的内容有误"),
    ("invalid number", "数有误"),
    ("number out of range", "数超出范围"),
    ("invalid unicode code point", "Unicode 编码有误"),
    (
        "control character (\\u0000-\\u001F) found while parsing a string",
        "文本中有控制字符",
    ),
    ("key must be a string", "键须为文本"),
    (
        "invalid value: expected key to be a number in quotes",
        "键须为引号中的数",
    ),
    (
        "float key must be finite (got NaN or +/-inf)",
        "键须为有限的数",
    ),
    ("lone leading surrogate in hex escape", "Unicode 编码不完整"),
    ("trailing comma", "末尾多了一个逗号"),
    ("trailing characters", "末尾有多余的字符"),
    ("unexpected end of hex escape", "Unicode 编码不完整"),
    ("recursion limit exceeded", "嵌套过深"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::Language::Chinese;
    use std::path::{Path, PathBuf};

    #[test]
    fn a_message_with_what_is_expected_is_chinese() {
        let said = of_toml("missing comma between array elements, expected `,`");
        assert_eq!(said.in_language(Chinese), "数组元素之间缺少逗号；应为`,`");
        assert!(said.to_string().starts_with("missing comma"));
        let said = of_json("expected `,` or `}` at line 3 column 7");
        assert_eq!(said.in_language(Chinese), "应为 `,` 或 `}`，第 3 行第 7 列");
        let said = of_json("missing field `results`");
        assert_eq!(said.in_language(Chinese), "缺少 `results`");
    }

    #[test]
    fn what_is_not_known_is_quoted() {
        let said = of_toml("something new");
        assert_eq!(said.in_language(Chinese), "something new");
    }

    /// The sources of a library as cargo keeps them.
    fn sources(name: &str) -> Vec<String> {
        let home = std::env::var_os("CARGO_HOME").map(PathBuf::from);
        let home = home.or_else(|| Some(Path::new(&std::env::var_os("HOME")?).join(".cargo")));
        let registries = home.map(|home| home.join("registry/src"));
        let folders = |folder: &Path| -> Vec<PathBuf> {
            let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
            entries.map(|entry| entry.path()).collect()
        };
        let registries = registries.as_deref().map(folders).unwrap_or_default();
        let crates = registries.iter().flat_map(|registry| folders(registry));
        let own = crates.filter(|folder| {
            let file = folder.file_name().unwrap_or_default().to_string_lossy();
            let version = file
                .strip_prefix(name)
                .and_then(|rest| rest.strip_prefix('-'));
            version.is_some_and(|version| version.starts_with(|c: char| c.is_ascii_digit()))
        });
        let mut open: Vec<PathBuf> = own.map(|folder| folder.join("src")).collect();
        let mut found = Vec::new();
        while let Some(path) = open.pop() {
            match path.is_dir() {
                true => open.extend(folders(&path)),
                false => found.extend(std::fs::read_to_string(&path)),
            }
        }
        if found.is_empty() {
            eprintln!("skipped: the sources of {name} are not at hand");
        }
        found
    }

    /// The literals behind some words of a source.
    fn literals<'t>(text: &'t str, before: &str) -> Vec<&'t str> {
        let parts = text.split(before).skip(1);
        parts
            .filter_map(|rest| rest.split_once('"').map(|(literal, _)| literal))
            .collect()
    }

    #[test]
    fn every_message_of_the_parser_of_toml_is_known() {
        for text in sources("toml_parser").iter().chain(&sources("toml")) {
            for message in literals(text, "ParseError::new(\"") {
                assert!(known(&TOML, message).is_some(), "{message}");
            }
        }
        // What is wrong with numbers is handed over as a value.
        for text in sources("toml_parser") {
            for rest in literals(&text, "\"invalid ") {
                let message = format!("invalid {rest}");
                assert!(known(&TOML, &message).is_some(), "{message}");
            }
        }
    }

    #[test]
    fn every_message_of_the_parser_of_json_is_known() {
        for text in sources("serde_json") {
            let Some((_, rest)) = text.split_once("impl Display for ErrorCode {") else {
                continue;
            };
            let body = rest.split_once("\n}").map_or(rest, |(body, _)| body);
            for message in literals(&body.replace("\\\"", "\u{1}"), "write_str(\"") {
                let message = message.replace('\u{1}', "\"").replace("\\\\", "\\");
                assert!(known(&JSON, &message).is_some(), "{message}");
            }
        }
    }
}
