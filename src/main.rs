//! The command line: one file per subcommand under `cli/`, nothing but wiring.

mod cli;

fn main() -> std::process::ExitCode {
    cli::run()
}
