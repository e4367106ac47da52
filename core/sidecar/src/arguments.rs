//! What may be said on the command line.

use crate::export::{Format, SolidChoice};
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;

/// Turns one JSON design of a blade and its cooling into named, watertight NURBS solids of metal and coolant.
///
/// Exit codes: 0 done, 2 the design or the command line was refused, 1 anything else.
#[derive(Debug, Parser)]
#[command(version, propagate_version = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Print a design to start from
    New {
        /// Name of the template; without it the first is printed, an unknown one lists them all
        template: Option<String>,
    },
    /// Check a design and say everything that is wrong with it
    Validate {
        /// The design, a JSON file
        design: PathBuf,
        /// Answer in JSON
        #[arg(long)]
        json: bool,
    },
    /// Build a design and write its solids and report
    Generate(GenerateOptions),
    /// Build a design and print volumes, wall thickness and tables
    Inspect {
        /// The design, a JSON file
        design: PathBuf,
        /// Print the whole report as JSON
        #[arg(long)]
        json: bool,
    },
    /// Print the JSON Schema of a design
    Schema,
    /// Serve other programs: JSON-RPC, one message a line, over standard input and output
    Serve(ServeOptions),
}

#[derive(Debug, Args)]
pub(crate) struct GenerateOptions {
    /// The design, a JSON file
    pub(crate) design: PathBuf,
    /// Folder for the files; made if it does not exist
    #[arg(long)]
    pub(crate) out: PathBuf,
    /// Formats to write
    #[arg(long, value_delimiter = ',', default_value = "step,glb")]
    pub(crate) format: Vec<Format>,
    /// Solids to write, by the first part of their names; `assembly` is all of them in one file (STEP and GLB)
    #[arg(long, value_delimiter = ',', default_value = "metal,insert,coolant,hub,shroud,assembly")]
    pub(crate) solids: Vec<SolidChoice>,
    /// Greatest distance between mesh and surface, mm
    #[arg(long, default_value_t = 0.02, value_parser = positive)]
    pub(crate) chord: f64,
    /// Greatest angle between the normals of a triangle and of the surface at its corners, degrees
    #[arg(long, default_value_t = 15.0, value_parser = positive)]
    pub(crate) angle: f64,
    /// Print the report, or the faults, as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// How to serve.
#[derive(Debug, Args)]
pub(crate) struct ServeOptions {
    /// Listen on a local socket, too: a path, or a name in the user's folder for such things
    #[arg(long, value_name = "NAME")]
    pub(crate) socket: Option<String>,
    /// Leave standard input and output alone and serve on the socket until a client says `shutdown`
    #[arg(long, requires = "socket")]
    pub(crate) detached: bool,
    /// Print the page of the protocol instead, Markdown
    #[arg(long)]
    pub(crate) describe: bool,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        Ok(value) => Err(format!("{value} is not a positive number")),
        Err(error) => Err(error.to_string()),
    }
}
