//! The arguments of the command line, and what is said where they are not understood: by clap in English, and from the
//! same findings in Chinese.

use std::ffi::OsString;

use clap::Parser;
use clap::error::{ContextKind, ContextValue, ErrorKind};

use super::language::spoken;
use super::{no_command, output};
use gumption::fault::{Said, say};
use gumption::language::Language;

/// The arguments; ends the program where there is nothing else to do.
pub(super) fn parse<T: Parser>() -> T {
    try_parse(std::env::args_os()).unwrap_or_else(|error| refuse(&error))
}

/// `--seed -3` is an option with a value that is wrong, and no option `-3`.
pub(super) fn try_parse<T: Parser>(
    arguments: impl IntoIterator<Item = impl Into<OsString> + Clone>,
) -> Result<T, clap::Error> {
    let numbers = |arg: clap::Arg| {
        let takes_values = arg.get_action().takes_values();
        arg.allow_negative_numbers(takes_values)
    };
    let mut command = T::command().mut_subcommands(|command| command.mut_args(numbers));
    let mut matches = command.try_get_matches_from_mut(arguments)?;
    T::from_arg_matches_mut(&mut matches).map_err(|error| error.format(&mut command))
}

fn refuse(error: &clap::Error) -> ! {
    if let Some(instead) = instead(error) {
        output::complain(instead);
        std::process::exit(error.exit_code())
    }
    let text = match spoken() {
        Language::Chinese => in_chinese(error),
        Language::English => in_english(error),
    };
    let Some(text) = text else { error.exit() };
    output::warn(&text);
    std::process::exit(error.exit_code())
}

/// The words of the standard library for a number that is none, in those of the program.
const NO_NUMBER: [(&str, &str, &str); 4] = [
    (
        "invalid digit found in string",
        "expected a whole number without a sign",
        "应为不带正负号的整数",
    ),
    (
        "cannot parse integer from empty string",
        "expected a whole number, and there is none",
        "应为整数，而此处为空",
    ),
    (
        "number too large to fit in target type",
        "the number is too large",
        "数过大",
    ),
    (
        "number too small to fit in target type",
        "the number is too small",
        "数过小",
    ),
];

/// What clap says where it repeats the words of the standard library, without these; of an option that there is not, without
/// the tip to write `-- -o` in its place.
pub(super) fn in_english(error: &clap::Error) -> Option<String> {
    if error.kind() == ErrorKind::UnknownArgument {
        let text = error.to_string();
        let is_tip = |part: &&str| part.trim_start().starts_with("tip: to pass ");
        let parts: Vec<&str> = text.split("\n\n").filter(|part| !is_tip(part)).collect();
        return Some(parts.join("\n\n"));
    }
    let why = std::error::Error::source(error)?.to_string();
    let (std, own, _) = NO_NUMBER.iter().find(|(std, ..)| *std == why)?;
    Some(error.to_string().replace(std, own))
}

/// What to write where the command is missing: a file or an option stands in its place.
pub(super) fn instead(error: &clap::Error) -> Option<Said> {
    let word = |kind| match error.get(kind)? {
        ContextValue::String(word) => Some(word.as_str()),
        _ => None,
    };
    match error.kind() {
        ErrorKind::InvalidSubcommand => no_command::to_write(word(ContextKind::InvalidSubcommand)?),
        ErrorKind::UnknownArgument => {
            let usage = error.get(ContextKind::Usage)?.to_string();
            let option = word(ContextKind::InvalidArg)?;
            if usage.ends_with("<COMMAND>") {
                return Some(say!(
                    "before the option {option} a command is missing: options stand behind it, as in `gumption eval budget.toml {option} …`"
                ));
            }
            // `Usage: gumption diagnose [OPTIONS] <EXPERIMENT>`
            let (_, command) = usage.split_once(": ")?.1.split_once(' ')?;
            (!option.starts_with('-')).then(|| {
                say!("{option} is one too many for `gumption {command}`: run it once for each")
            })
        }
        _ => None,
    }
}

/// What is wrong, in Chinese; nothing where help or the version was asked for.
pub(super) fn in_chinese(error: &clap::Error) -> Option<String> {
    let text = |kind: ContextKind| match error.get(kind)? {
        ContextValue::String(one) => Some(one.clone()),
        ContextValue::Strings(several) => Some(several.join("、")),
        ContextValue::StyledStr(styled) => Some(styled.to_string()),
        ContextValue::StyledStrs(several) => {
            let several: Vec<String> = several.iter().map(ToString::to_string).collect();
            Some(several.join("、"))
        }
        ContextValue::Number(number) => Some(number.to_string()),
        _ => None,
    };
    let named = |kind: ContextKind| text(kind).unwrap_or_default();
    let (argument, value) = (
        named(ContextKind::InvalidArg),
        named(ContextKind::InvalidValue),
    );
    let what = match error.kind() {
        ErrorKind::DisplayHelp
        | ErrorKind::DisplayVersion
        | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => return None,
        ErrorKind::InvalidSubcommand => {
            format!("没有子命令 `{}`", named(ContextKind::InvalidSubcommand))
        }
        ErrorKind::MissingSubcommand => "缺少子命令".to_owned(),
        ErrorKind::UnknownArgument => format!("没有参数 `{argument}`"),
        ErrorKind::MissingRequiredArgument => format!("缺少必需的参数：{argument}"),
        ErrorKind::ArgumentConflict => {
            let other = named(ContextKind::PriorArg);
            format!("`{argument}` 不能与 `{other}` 同时使用")
        }
        ErrorKind::InvalidValue if value.is_empty() => format!("`{argument}` 缺少值"),
        ErrorKind::InvalidValue | ErrorKind::ValueValidation => {
            let why = std::error::Error::source(error).map(|why| of_value(&why.to_string()));
            let why = why.map_or(String::new(), |why| format!("：{why}"));
            format!("`{argument}` 的值 `{value}` 有误{why}")
        }
        ErrorKind::TooManyValues => format!("`{argument}` 的值 `{value}` 多余"),
        ErrorKind::TooFewValues | ErrorKind::WrongNumberOfValues => {
            format!("`{argument}` 的值的个数有误")
        }
        ErrorKind::NoEquals => format!("`{argument}` 与其值之间须写 `=`"),
        ErrorKind::InvalidUtf8 => "参数不是 UTF-8 文本".to_owned(),
        _ => return None,
    };
    let mut lines = vec![format!("错误: {what}")];
    let near = [
        ContextKind::SuggestedSubcommand,
        ContextKind::SuggestedArg,
        ContextKind::SuggestedValue,
    ];
    lines.extend(
        near.into_iter()
            .filter_map(text)
            .map(|near| format!("  是否为：{near}")),
    );
    lines.extend(text(ContextKind::ValidValue).map(|all| format!("  可用的值：{all}")));
    lines.extend(text(ContextKind::Usage).map(|usage| usage.replace("Usage:", "用法:")));
    lines.push("更多信息见 `--help`。\n".to_owned());
    Some(lines.join("\n"))
}

/// Why a number is refused, as clap and the standard library say it, in Chinese; the program's own reasons are that already.
fn of_value(why: &str) -> String {
    if let Some((value, range)) = why.split_once(" is not in ") {
        return format!("{value} 不在 {range} 之内");
    }
    let of_library = NO_NUMBER.iter().find(|(std, ..)| *std == why);
    of_library.map_or(why, |(.., own)| own).to_owned()
}
