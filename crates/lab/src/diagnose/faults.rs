//! Codes of the faults in a case file.

use gumption_fault::codes;

codes! {
    MISSING = "D0101", "a case lacks something", "实验文件缺少必需的内容",
        "An experiment names a recording, its equations and what the columns of the recording are.\n\n    recording = \"load.csv\"\n    equations = \"deflection = a + b * load\"\n    [columns]\n    deflection = \"output\"\n    load = \"stimulus\"\n    run = \"run\"";
    LEFT_SIDE = "D0102", "a model does not say what it describes", "模型左边未指明所描述的量",
        "The left side of a model is a column with the role \"output\", or a constant that the right side should give in every row (as in `g = sqrt(x^2 + y^2 + z^2)`).";
    UNKNOWN_NAME = "D0103", "a name stands for nothing", "名称没有所指的对象",
        "A case knows the columns of its recording by their names, the parameters of its model, and its constants.";
    ROLE = "D0104", "a column cannot have this role", "该列不能用作所指定的角色",
        "Outputs stand on the left of a model. Numbers are needed for outputs, stimuli, covariates, angles and times; runs, factors and positions are labels.";
    PER = "D0105", "a parameter cannot have a value for each label of this column", "参数不能按该列的标签分别取值",
        "`per` names a column of labels (a run, factor, position or axis).";
    START = "D0106", "the search for the parameters needs a start", "模型拟合需要参数的起始值",
        "A model that is not linear in its parameters is fitted by a search. State roughly where it begins: [parameter] s = { start = 4000 }.";
    NOT_FITTED = "D0107", "the declared model cannot be fitted to the recording", "声明的模型无法拟合记录",
        "The search found no finite minimum, or the recording determines too few of the parameters. Check the model, give starts, or state what is known of a parameter beforehand: value and u.";
    TOO_FEW = "D0108", "the recording has too few rows", "记录的行数太少",
        "The recording must have more rows than the model has parameters, or there is nothing to confront the model with.";
    CANDIDATE = "D0111", "an explanation of the user's own is not clear", "自定义的解释不明确",
        "An omitted effect has a `term`, linear in its own name, or a `formula` of what it adds per unit of its size; with a formula, `node` names the parameter or column that it changes.\n\n    [omitted.mount_sag]\n    term = \"mount_sag * sin(phi) * cos(phi)\"";
    SETTING = "D0112", "a setting is out of range", "设置超出允许范围",
        "alpha is a probability between 0 and 0.5; u and dof are positive.";
    ROWS = "D0113", "rows beside the recording are not clear", "记录以外的数据行说明不清",
        "A recording that is held out has the columns of the recording. A further measurement names its rows in a CSV file, as lists, or says what is changed when those of the recording are taken again:\n\n    [[action]]\n    name = \"second mounting\"\n    again = { mount = 90 }";
    TOO_LARGE = "D0114", "a diagnosis takes too much memory", "诊断所需内存过大",
        "Observations are compared each with each, and what thousands of effects do to a block of rows is kept. Long recordings are averaged in blocks; without, or with many labels, they take more than a computer has.\n\n    recording = { file = \"run.csv\", average = 400 }";
}

#[cfg(test)]
mod tests {
    #[test]
    fn codes_ascend() {
        assert!(super::CODES.windows(2).all(|pair| pair[0].id < pair[1].id));
    }
}
