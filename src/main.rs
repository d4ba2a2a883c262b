//! The program.

fn main() -> std::process::ExitCode {
    isolith::cli::main()
}
