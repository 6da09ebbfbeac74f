//! The command line: one file per subcommand under `cli/`, nothing but wiring.

fn main() {}
