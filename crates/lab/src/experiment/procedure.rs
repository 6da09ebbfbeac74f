//! The procedures of the library.
//!
//! A procedure is data: an experiment (see `tables.rs`) that states the
//! equations, the roles of columns, parameters, inputs and omitted terms, but no recording. A user's file
//! names it, `procedure = "accelerometer-tumble-4"`, and says the rest. Both have the same format; what
//! the user's file states of an entry stands over what the procedure states, key by key.
//!
//! ```toml
//! title = "Gyro scale factor"           # also title_zh, description, description_zh
//! reference = "JJF 2003-2022, 7.2.1"    # clause
//! equations = ["U = K*omega*(1 + e_rate) + b"]   # one for each response; `model = "…"` holds
//!                                       # statements (`;` or new lines) that all equations see
//! [columns.U]                            # what rows of the recording hold: response or right side;
//! description = "Output"                # names of equations that are nothing else are columns, too
//! [columns.omega]
//! like = "rad/s"                        # must have this dimension; numbers stay in the header's unit
//! [parameter.K]                         # estimated. unit = "…", or like = "U/omega", or found from
//! description = "Scale factor"          # the equations where the parameter is a factor of a term;
//! [parameter.b]                         # start = 0 where the equations are not linear in it
//! [input.e_rate]                        # error of a reference: value 0 unless stated, no uncertainty
//! description = "Relative error of the rate"   # until the user's file states one (component keys
//! scope = "common"                      # of budgets). scope = "each": every row has its own;
//!                                       # by = "run": one for each label of the column run
//!                                       # required = true: the user must state it (R, g …)
//! [constant]                            # exactly known
//! [omitted.k2]                          # what would it shift? Linear in its own name
//! term = "k2*omega^2"                   # response = "U" where there are several equations
//! typical = 1e-6
//! [result.asymmetry]                    # functions of the parameters
//! model = "(Kp - Kn)/(Kp + Kn)"
//! [positions]                           # labels that stand for values
//! column = "position"
//! gives = ["nx", "ny", "nz"]
//! at = { "x up" = [1, 0, 0], "x down" = [-1, 0, 0] }
//! ```
//!
//! The left side of an equation may also be a constant or an input instead of a column: `g = norm(…)` with
//! the readings on the right. An input that the user's file lists as `[parameter.theta0]` is estimated; one
//! that is listed as `[parameter.…]` and `[input.…]` is partly known: its value enters as one more
//! observation. A parameter that is listed as `[input.…]` only is not estimated, but known.

use serde::Deserialize;

/// A procedure of the library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Procedure {
    /// As files name it.
    pub name: &'static str,
    /// The experiment that it is.
    pub text: &'static str,
}

/// What a procedure says of itself.
#[derive(Debug, Clone, Deserialize)]
pub struct Card {
    /// In a few words.
    pub title: String,
    /// The same in Chinese.
    pub title_zh: String,
    /// One paragraph.
    pub description: String,
    /// The same in Chinese.
    pub description_zh: String,
    /// Document and clause.
    pub reference: String,
    #[serde(default)]
    model: String,
    equations: Vec<String>,
}

impl Procedure {
    /// What it says of itself.
    pub fn card(&self) -> Card {
        toml::from_str(self.text).expect("a procedure is part of the program")
    }
}

impl Card {
    /// Statements that all equations see, and these.
    pub fn statements(&self) -> impl Iterator<Item = &str> {
        let lines = self.model.lines().map(str::trim);
        let lines = lines.filter(|line| !line.is_empty());
        lines.chain(self.equations.iter().map(String::as_str))
    }
}

// `PROCEDURES`: every file of `procedures/`, by name.
include!(concat!(env!("OUT_DIR"), "/procedures.rs"));

/// The procedure of a name.
pub fn procedure_named(name: &str) -> Option<&'static Procedure> {
    PROCEDURES.iter().find(|procedure| procedure.name == name)
}
