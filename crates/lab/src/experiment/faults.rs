//! Codes of the faults in experiment files.

use gumption_fault::codes;

codes! {
    NO_PROCEDURE = "C0101", "a procedure is not in the library", "内置库中没有该测量程序",
        "`procedure` names a procedure of the library. A file without it states its own `equations`.";
    NO_EQUATIONS = "C0102", "a calibration has no equations", "校准文件没有给出测量方程",
        "What is observed, and how it depends on the coefficients, is said by `equations`, or by a `procedure` of the library.\n\n    equations = [\"U = K*omega + b\"]";
    NO_PARAMETERS = "C0103", "a calibration estimates nothing", "校准文件没有待求的参数",
        "Coefficients that the calibration shall find are listed as parameters.\n\n    [parameter]\n    K = {}\n    b = {}";
    UNKNOWN_SYMBOL = "C0104", "a name of the equations is not known", "方程中的名称未知",
        "Names in equations are columns of the recording, quantities that [positions] gives, parameters, inputs or constants.";
    NAME_TWICE = "C0105", "a name stands for two things", "一个名称指代两个对象",
        "Columns, positions, inputs, constants and results need names of their own. Only a parameter may be an input as well: it is then partly known.";
    UNUSED = "C0106", "something is stated that no equation uses", "给出的量未被任何方程使用",
        "A parameter that no equation contains cannot be found; an input that none contains has no effect. A misspelt name is the usual cause.";
    NO_DATA = "C0107", "a calibration has no data", "校准文件没有给出数据",
        "`calibrate` needs a [recording] with the response columns; `plan` a [recording] or a [schedule] with the other columns.";
    POSITION = "C0108", "a position is not known", "位置标签与 [positions] 不对应",
        "[positions] says what each label of a column stands for. A label that occurs in the recording must be there, and each label there must occur in the recording, unless it is among `optional`.";
    STATE_INPUT = "C0109", "a quantity of the set-up must be stated", "缺少须由实验室给出的量",
        "The procedure needs a value that only the laboratory knows: a resistor, the local acceleration of free fall, a rate. State it in the file with its uncertainty, or as a [constant].";
    TOO_FEW = "C0111", "there are too few points", "测量点太少",
        "The parameters cannot be found from fewer readings than parameters. To tell their scatter from the residuals, there must be more.";
    SCATTER = "C0112", "the scatter of the readings is not known", "读数的分散性未知",
        "With as many parameters as readings there are no residuals; averages without their samples do not tell their scatter. State the errors of the readings in [reading.NAME] and write noise.from = \"stated\".";
    START = "C0113", "a search has no place to begin", "参数搜索缺少起始值",
        "The equations are not linear in the parameters. State roughly where the search begins: [parameter.K] start = 0.2. Parameters that enter linearly once the others are held need none.";
    KEY = "C0114", "a key has no meaning here", "该键在此处不适用",
        "The key belongs to another way of stating the same, or to another table.";
    UNIT = "C0115", "the unit cannot be found", "无法确定单位",
        "State the unit: unit = \"mA/gn\".";
    RECORDING = "C0116", "a recording cannot be used as it is", "记录不能直接使用",
        "Times that go backwards, columns without any number, too few rows: nothing is computed from such a recording.";
    SCHEDULE = "C0117", "a schedule is not well formed", "测量安排的写法有误",
        "[schedule] lists the points of an experiment column by column, all of one length; keys are headings with units.\n\n    [schedule]\n    \"theta [deg]\" = [0, 90, 180, 270]";
    RESULT = "C0118", "a result cannot be evaluated", "结果的公式无法计算",
        "Results are formulas of parameters, inputs and constants.";
    TERM = "C0119", "an omitted term is not well formed", "遗漏项的写法有误",
        "The term is what the effect would add to the equation of its response; its coefficient is the name of the entry.\n\n    [omitted.k2]\n    term = \"k2*omega^2\"";
    LABELS = "C0120", "numbers are taken for labels", "把数值当作标签使用",
        "Columns of labels say which dwell, run or position a row belongs to. A column whose numbers the equations use is no such column.\n\n    recording = { file = \"run.csv\", steps = \"omega\" }";
    TOO_LARGE = "C0122", "a calibration takes too much memory", "校准所需内存过大",
        "Every reading of a calibration is kept with all that follows from an error of it. Samples of one state are averaged first: name the columns that tell them apart, the column whose steps do, or how long a state at rest lasts.\n\n    recording = { file = \"run.csv\", steps = \"omega\" }";
    LEFT_OUT = "C0123", "rows are left out that are not there, or without a reason", "所剔除的行不存在，或未说明理由",
        "A row may be left out for a cause that is known, not because it does not fit. [[left_out]] names lines of the CSV file and says why; the report repeats it.\n\n    [[left_out]]\n    lines = [12, \"20-25\"]\n    reason = \"the door was opened\"";
    NOISE = "C0121", "the claim about the noise is not clear", "噪声的声明不明确",
        "One of: u (with dof), a column with the role \"u\", replicates, at_rest, budget, from. Without any of them the noise is estimated from what the equations leave.";
}
