//! The faults of any TOML file, each with its stable code and its explanation.

use gumption_fault::codes;

codes! {
UNREADABLE_FILE = "B0101", "a file cannot be read", "文件无法读取",
"The budget file, or a CSV file that it names, does not exist or may not be read. Files named in a \
budget are looked up from the folder in which the budget stands.";

NOT_UTF8 = "B0102", "a file is not UTF-8 text", "文件不是 UTF-8 文本",
"Budgets and CSV files are UTF-8 text. Files saved by older Windows programs often are in a code page \
such as GBK or Windows-1252; save them again as UTF-8.";

TOML_SYNTAX = "B0103", "the file is not well-formed TOML", "文件不符合 TOML 语法",
"A budget is a TOML file: `key = value` lines under `[table]` headers, texts in double quotes, lists in \
square brackets. A key may be stated once per table. See toml.io.";

UNKNOWN_KEY = "B0104", "a key is not known", "未知的键",
"A misspelt key would otherwise be ignored, and with it an uncertainty. Every table accepts only the keys \
that the reference lists; the message names the nearest one.";

WRONG_TYPE = "B0105", "a value is of the wrong type", "值的类型不符",
"A number stands where a text is expected, a list where a number is expected, and so on.";

QUOTED_NUMBER = "B0106", "a number stands in quotes", "数值写在引号内",
"`u = \"0.5\"` is a text. Write `u = 0.5`, or a text with a unit: `u = \"0.5 mV\"`.";

NOT_FINITE = "B0107", "a number is not finite", "数值不是有限数",
"`nan` and `inf` are not values of a quantity. Only degrees of freedom (`dof = inf`) may be infinite.";

UNKNOWN_WORD = "B0108", "a word is not one of the known ones", "该词不在可选项之列",
"The key takes one of a few words, which the message lists.";

AMOUNT = "B0110", "an amount is not a number with a unit", "数值或量值的写法有误",
"An amount is a plain number in the unit of its input (`u = 0.5`), or a text with a number and a unit \
(`u = \"25 µV\"`, `u = \"50 ppm\"`). The decimal sign is a point.";

NOT_WHOLE = "B0117", "a number is not whole", "数值不是非负整数",
"Counts, bits, seeds and numbers of trials are whole numbers from 0 upwards.";
}

#[cfg(test)]
mod tests {
    #[test]
    fn codes_are_in_order() {
        assert!(super::CODES.windows(2).all(|pair| pair[0].id < pair[1].id));
    }
}
