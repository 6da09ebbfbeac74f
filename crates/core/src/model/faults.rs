//! Codes of the faults in a model text.

use gumption_fault::{Fault, Said, codes, say};

/// Words of messages that other modules say in words of their own.
#[derive(Debug)]
pub struct Wording {
    /// What has the formula as its value.
    pub measurand: Said,
    /// The unit that its value is wanted in.
    pub unit: Said,
    /// What names of formulas stand for, beside those that they define.
    pub given: Said,
    /// Where what stands in a formula has its unit.
    pub stated: Said,
}

/// The words of budgets, which the messages of this module use.
pub(super) const OF_BUDGETS: Wording = Wording {
    measurand: say!("the measurand"),
    unit: say!("the measurand's unit"),
    given: say!("an input or constant of the file"),
    stated: say!("where it has its value"),
};

/// A fault of this module in other words.
pub fn reworded(mut fault: Fault, own: &Wording) -> Fault {
    fault.message = said_of(fault.message, own);
    fault.help = fault.help.map(|help| said_of(help, own));
    fault
}

fn said_of(said: Said, own: &Wording) -> Said {
    said.replacing(&OF_BUDGETS.measurand, &own.measurand)
        .replacing(&OF_BUDGETS.unit, &own.unit)
        .replacing(&OF_BUDGETS.given, &own.given)
        .replacing(&OF_BUDGETS.stated, &own.stated)
}

codes! {
    UNEXPECTED = "M0101", "something else was expected here", "公式在此处不符合语法",
        "The formula cannot be read on from this place: a value, an operator or a word is missing.\n\n    y = a + * b      wrong: two operators follow one another\n    y = a + b        right";
    UNCLOSED = "M0102", "a bracket is never closed", "括号未闭合",
        "Every `(` needs its `)` and every `[` its `]` before the statement ends.\n\n    y = (a + b / c      wrong\n    y = (a + b) / c     right";
    EQUALS = "M0103", "`=` stands inside an expression", "表达式中出现 `=`",
        "One `=` gives a name to an expression. To compare two quantities, as in `if` and `solve`, write `==`.\n\n    y = if(a = b, 1, 2)      wrong\n    y = if(a == b, 1, 2)     right";
    MISSING_OPERATOR = "M0104", "an operator is missing between two values", "两个值之间缺少运算符",
        "Products need their `*`, because `ab` is the name of one quantity. A unit stands between single quotes.\n\n    y = 2x        wrong\n    y = 2 * x     right";
    CHARACTER = "M0105", "a character has no meaning in a model", "模型中有不能使用的字符",
        "Models are written with names, numbers, the operators + - * / ^, comparisons, brackets and units between single quotes.\n\n    y = 5 %         wrong\n    y = 5 '%'       right";
    NUMBER = "M0106", "a number is malformed", "数字的写法有误",
        "Numbers have a decimal point (not a comma) and may have an exponent; `_` may stand between digits.\n\n    y = 1.2.3      wrong\n    y = 1.5e-3     right";
    CHAINED_COMPARISON = "M0107", "comparisons cannot follow one another", "比较运算不能连写",
        "A comparison has two sides. Join two comparisons by `and`.\n\n    y = if(0 < x < 1, a, b)              wrong\n    y = if(0 < x and x < 1, a, b)        right";
    TOO_DEEP = "M0108", "the formula is nested too deep", "公式嵌套过深",
        "Brackets, signs and calls stand inside one another more often than anybody can read. Name the parts.\n\n    y = f(f(f(f(…))))      wrong\n    a = f(f(x)); f(f(a))   right";
    NO_EFFECT = "M0109", "the value of this line goes nowhere", "该行的值未被使用",
        "Only the last line of a measurand's model may be a bare expression: it is the measurand's value. Any other line gives a name to something.\n\n    a + b ; c * d          wrong: what is a + b for?\n    s = a + b ; s * d      right";
    NO_VALUE = "M0110", "the model has no value", "模型没有给出值",
        "The last line of a measurand's model must be its value: an expression, or `name = expression`.\n\n    f(x) = x^2             wrong: only defines a function\n    f(x) = x^2 ; f(a)      right";
    LEFT_SIDE = "M0111", "this cannot stand left of `=`", "`=` 左边不能是这种形式",
        "A statement defines a name, or a function of names. An equation to be solved is written with `solve`.\n\n    a + b = c                        wrong\n    a = solve(a + b == c, a, 1)      right";
    BRACKET_PAIR = "M0112", "brackets do not pair", "左右括号不匹配",
        "A `)` closes a `(`, a `]` closes a `[`, and nothing else.\n\n    y = mean([a, b)]      wrong\n    y = mean([a, b])      right";
    UNIT_TEXT = "M0113", "a unit is out of place", "单位的位置不对",
        "A unit stands between single quotes right after a number, or where a function asks for one.\n\n    y = x 'mm'             wrong: x has its unit already\n    y = value_in(x, 'mm')  right: the number of x in mm";

    UNKNOWN_NAME = "M0201", "a name is not known", "公式中的名称未定义",
        "A model may use the file's inputs and constants, names defined by statements above, `pi` and numbers. Upper and lower case differ.\n\n    y = Lenght / t      wrong, when the input is called Length\n    y = Length / t      right";
    UNKNOWN_FUNCTION = "M0202", "a function is not known", "未知的函数",
        "`gumption explain functions` lists the functions. Own functions are defined by a statement.\n\n    y = sine(x)      wrong\n    y = sin(x)       right";
    ARGUMENTS = "M0203", "a function is given the wrong number of arguments", "函数的参数个数不符",
        "The signature says what the function takes.\n\n    y = atan2(y)         wrong\n    y = atan2(y, x)      right";
    DEFINED_TWICE = "M0204", "a name is defined twice", "名称重复定义",
        "A name stands for one thing in the whole file, so that a reader never has to ask which one is meant.\n\n    a = x + 1 ; a = a * 2      wrong\n    a = x + 1 ; b = a * 2      right";
    RESERVED = "M0205", "a name belongs to the language", "名称为模型语言所保留",
        "Inputs, constants and intermediate quantities may not be called like a function or like `pi`.\n\n    [input.min]        wrong: min is a function\n    [input.t_min]      right";
    FUNCTION_AS_VALUE = "M0206", "a function is used without arguments", "使用函数时未写参数",
        "A function has a value only at its arguments.\n\n    y = sqrt / 2         wrong\n    y = sqrt(x) / 2      right";
    VALUE_AS_FUNCTION = "M0207", "a quantity is called like a function", "量被当作函数调用",
        "A name followed by `(` is a function call. Write the `*` of a product.\n\n    y = a(b + c)        wrong, when a is a quantity\n    y = a * (b + c)     right";
    USED_BEFORE = "M0208", "a name is used before it is defined", "名称在定义之前使用",
        "Statements are read from top to bottom; a quantity cannot depend on itself. Equations that define a quantity implicitly are written with `solve`.\n\n    d = a - d * h                        wrong\n    d = solve(d == a - d * h, d, 1)      right";
    NO_MODEL = "M0209", "a measurand has no model", "被测量没有测量模型",
        "A measurand needs `model = \"…\"`, or the model at the top of the file must define a quantity of its name.\n\n    [measurand.P]\n    model = \"U * I\"";

    LENGTHS = "M0301", "vectors have different lengths", "向量长度不同",
        "Vectors are combined element by element, so they need equal lengths; a scalar goes with any vector.\n\n    [1, 2, 3] + [1, 2]      wrong\n    [1, 2, 3] + 1           right";
    SHAPE = "M0302", "a vector stands where a number belongs, or the reverse", "标量或向量不合要求",
        "Reductions such as `mean` need a vector; conditions, indices and starting values need a single number.\n\n    y = mean(x)      wrong, when x is a single quantity\n    y = mean([x, z]) right";
    INDEX = "M0303", "an index is not one of the vector's places", "向量的下标无效",
        "Elements are counted from 1, and the index must be a whole number written in the model.\n\n    y = x[0]      wrong\n    y = x[1]      right: the first element";
    VECTOR_RESULT = "M0304", "the value of a measurand is too long a vector", "被测量的向量元素过多",
        "The elements of a vector become measurands, `G[1]`, `G[2]` …, up to a hundred of them. Reduce a longer vector, or take the elements that are wanted.\n\n    model = \"x - y\"            wrong, when x has 1000 elements\n    model = \"mean(x - y)\"      right";
    NESTED_VECTOR = "M0305", "a vector stands inside a vector", "向量的元素不能是向量",
        "Vectors hold single quantities; there are no matrices.\n\n    [[1, 2], [3, 4]]      wrong\n    [1, 2, 3, 4]          right";
    TRUTH_AS_NUMBER = "M0306", "a comparison is used as a number", "比较结果被当作数值使用",
        "A comparison is true or false. Choose between two values by `if`.\n\n    y = (a < b) * c           wrong\n    y = if(a < b, c, 0)       right";
    NUMBER_AS_TRUTH = "M0307", "a number is used as a condition", "数值被当作条件使用",
        "Conditions are comparisons, or several joined by `and`, `or`, `not`.\n\n    y = if(a, b, c)           wrong\n    y = if(a > 0, b, c)       right";

    CLASH = "M0401", "quantities of different kinds are added or compared", "各量的量纲不一致",
        "Only quantities of the same dimension can be added, subtracted, compared or put into one vector. A number without a unit has dimension one.\n\n    y = L + 5           wrong, when L is a length\n    y = L + 5 'mm'      right";
    NOT_ONE = "M0402", "a function needs a quantity of dimension one", "函数的参数应为量纲为一的量",
        "Functions such as exp, ln and sin take numbers (or angles). Divide by a reference quantity, or take the number in a stated unit.\n\n    y = ln(p)                       wrong, when p is a pressure\n    y = ln(p / (1 'bar'))           right\n    y = ln(value_in(p, 'bar'))      right";
    EXPONENT = "M0403", "an exponent cannot be used here", "此处不能使用该指数或方根",
        "Exponents are numbers. A quantity with a unit needs an exponent that is a constant simple fraction, or the unit of the power would not be known.\n\n    y = L^n        wrong, when L is a length and n an input\n    y = L^2        right";
    POINT = "M0404", "a temperature with an origin is used like a difference", "温标上的温度与温度差混用",
        "`20 °C` is a point on a scale, not an amount: twice that is meaningless. Differences between points are in K.\n\n    y = alpha * T                   wrong, when T is in °C\n    y = alpha * (T - 20 '°C')       right\n    y = R * kelvin(T)               right: thermodynamic temperature";
    RESULT_UNIT = "M0405", "the value does not fit the measurand's unit", "模型值的量纲与被测量的单位不符",
        "The model was checked and gives a quantity of another dimension than the measurand's unit.\n\n    [measurand.P] model = \"U * I\", unit = \"V\"      wrong\n    [measurand.P] model = \"U * I\", unit = \"W\"      right";
    RESULT_NEEDS_UNIT = "M0406", "the measurand needs a unit", "被测量缺少单位",
        "The model gives a quantity with a dimension; say in which unit it is wanted.\n\n    [measurand.P] model = \"U * I\"                   wrong\n    [measurand.P] model = \"U * I\", unit = \"W\"      right";
    BARE_ANGLE = "M0407", "a bare number meets an angle", "无单位的数与角度混用",
        "A number without a unit would be radians, which is hardly meant beside an angle in degrees.\n\n    y = phi + 90          wrong, when phi is in °\n    y = phi + 90 '°'      right";

    CONVERTED_TWICE = "M0408", "an angle is converted to radians twice", "角度被两次换算为弧度",
        "An angle with a unit is converted to radians by `sin`, `cos` and `tan` themselves; a factor pi/180 beside it would do so again.\n\n    y = sin(phi * pi/180)                     wrong, when phi is in °\n    y = sin(phi)                              right\n    y = sin(value_in(phi, '°') * pi/180)      right";
    REVOLUTIONS = "M0409", "revolutions would be converted with a hidden 2π", "转数的换算隐含因子 2π",
        "In `r/min`, `rpm` and `°/s` a revolution is an angle, 2π; in `Hz`, `1/min` and seconds it is counted. Say which is meant; a formula that counts revolutions has a 2π of its own.\n\n    [measurand.f] model = \"n\", unit = \"Hz\"               wrong, when n is in r/min\n    [measurand.f] model = \"n / (1 'r')\", unit = \"Hz\"     right: revolutions per second\n    [measurand.w] model = \"n\", unit = \"rad/s\"            right: angular velocity\n    [measurand.P] model = \"2 * pi * n * M\", unit = \"W\"           wrong, when n is in r/min\n    [measurand.P] model = \"n * M\", unit = \"W\"                    right";

    SCALED_TWICE = "M0410", "a number of the formula converts to the unit, which is done without it", "公式中的数重复了单位换算",
        "Units are converted without a factor in the formula: a ratio is shown in %, a mass over a volume in mg/L. A number that is the very factor of that conversion would be applied twice, also in a term of a sum.\n\n    model = \"100 * (a - b) / b\", unit = \"%\"      wrong\n    model = \"(a - b) / b\", unit = \"%\"            right\n    model = \"dilution * m / V\"                     right: a factor with a name, stated in [constant]";

    TOO_LARGE = "M0501", "the model is too large", "模型规模过大",
        "Written out element by element the model has too many operations. Shorten the vectors or the functions that call one another.\n\n    g(x) = f(f(f(x))) …      each level multiplies the work";
    UNKNOWN_OF_SOLVE = "M0502", "the unknown of `solve` is not fit", "`solve` 的未知量不合适",
        "`solve(equation, unknown, start)` needs a new name as its unknown, and the equation must contain it.\n\n    d = solve(a == b, d, 1)          wrong: d does not occur\n    d = solve(d * exp(d) == a, d, 1) right";
    NOT_EXACT = "M0504", "an argument must be exactly known", "函数的参数必须是精确已知的量",
        "Quantiles with degrees of freedom, the gamma function, the number of values of `linspace` and the first column of a table to interpolate in must be numbers that no input makes uncertain: written in the model or stated under [constant].\n\n    k = t_quantile(0.975, nu)      wrong, when nu is an input\n    k = t_quantile(0.975, 9)       right";
    UNDEFINED = "M0503", "the formula has no value at the estimates", "公式在输入量的估计值处没有值",
        "At the estimates of the inputs the formula divides by zero, takes the root or logarithm of a negative number, exceeds the range of numbers, or its `solve` finds no solution. The message names the operation.\n\n    model = \"V / (I - I_0)\"      has no value when I and I_0 are equal";
}
