//! Codes of the faults in a case file.

use crate::fault::codes;

codes! {
    MISSING = "D0101", "a case lacks something",
        "A case names a recording, a model and what the columns of the recording are.\n\n    recording = \"load.csv\"\n    model = \"deflection = a + b * load\"\n    [columns]\n    deflection = \"output\"\n    load = \"stimulus\"\n    run = \"run\"";
    LEFT_SIDE = "D0102", "a model does not say what it describes",
        "The left side of a model is a column with the role \"output\", or a constant that the right side should give in every row (as in `g = sqrt(x^2 + y^2 + z^2)`).";
    UNKNOWN_NAME = "D0103", "a name stands for nothing",
        "A case knows the columns of its recording by their names, the parameters of its model, and its constants.";
    ROLE = "D0104", "a column cannot have this role",
        "Outputs stand on the left of a model. Numbers are needed for outputs, stimuli, covariates, angles and times; runs, factors and positions are labels.";
    PER = "D0105", "a parameter cannot have a value for each label of this column",
        "`per` names a column of labels (a run, factor, position or axis).";
    START = "D0106", "the search for the parameters needs a start",
        "A model that is not linear in its parameters is fitted by a search. State roughly where it begins: [parameter] s = { start = 4000 }.";
    NOT_FITTED = "D0107", "the declared model cannot be fitted to the recording",
        "The search found no finite minimum, or the recording determines too few of the parameters. Check the model, give starts, or state what is known of a parameter beforehand: value and u.";
    TOO_FEW = "D0108", "the recording has too few rows",
        "The recording must have more rows than the model has parameters, or there is nothing to confront the model with.";
    NOISE = "D0109", "the claim about the noise is not clear",
        "One of: u (with dof), a column with the role \"u\", replicates, at_rest, budget. Without any of them the noise is estimated from what the model leaves.";
    UNIT_CLASH = "D0110", "two units do not fit",
        "A unit in the case contradicts the unit in the first line of the recording, or has another dimension than it should.";
    CANDIDATE = "D0111", "an explanation of the user's own is not clear",
        "A candidate has a `name` and a `formula` of columns, parameters and constants. `node` names the parameter or column that it changes; without it, it adds to the output.\n\n    [[candidate]]\n    name = \"mount sag\"\n    formula = \"sin(phi) * cos(phi)\"";
    SETTING = "D0112", "a setting is out of range",
        "alpha is a probability between 0 and 0.5; u and dof are positive.";
    ROWS = "D0113", "rows beside the recording are not clear",
        "A recording that is held out has the columns of the recording. A further measurement names its rows in a CSV file, as lists, or says what is changed when those of the recording are taken again:\n\n    [[action]]\n    name = \"second mounting\"\n    again = { mount = 90 }";
}

#[cfg(test)]
mod tests {
    #[test]
    fn codes_ascend() {
        assert!(super::CODES.windows(2).all(|pair| pair[0].id < pair[1].id));
    }
}
