//! The `coolinggen` command: a thin shell over the library crates.

mod arguments;
mod commands;
mod export;
mod outcome;
mod progress;
mod serve;
mod templates;

use arguments::{Arguments, Command};
use clap::Parser;
use outcome::Failure;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match &arguments.command {
        Command::New { template } => commands::new(template.as_deref()),
        Command::Validate { design, json } => commands::validate(design, *json),
        Command::Generate(options) => commands::generate(options),
        Command::Inspect { design, json } => commands::inspect(design, *json),
        Command::Schema => commands::schema(),
        Command::Serve(options) => serve::serve(options),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure { json: true, kind }) => kind.report_json(),
        Err(Failure { json: false, kind }) => kind.report_text(),
    }
}
