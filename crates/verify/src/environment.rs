//! The program and the computer on which examples were verified.

/// What a reader must know to repeat a verification.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Environment {
    /// Version of the program.
    pub version: &'static str,
    /// Operating system.
    pub os: &'static str,
    /// Architecture of the processor.
    pub architecture: &'static str,
    /// Instruction set that the Monte Carlo method ran on; results do not depend on it.
    pub instruction_set: &'static str,
    /// Day of the verification, ISO 8601.
    pub date: String,
}

impl Environment {
    /// This program on this computer.
    pub fn here(date: String) -> Self {
        Environment {
            version: env!("CARGO_PKG_VERSION"),
            os: std::env::consts::OS,
            architecture: std::env::consts::ARCH,
            instruction_set: gumption_lanes::level::name(gumption_lanes::level()),
            date,
        }
    }
}
