//! The command line.
//!
//! `args` holds what clap reads, unchecked; each command has a file that checks its arguments, runs the pipeline and
//! says how it went. Results go to standard output, everything else to standard error.

mod alter;
mod args;
mod check;
mod check_mesh;
mod console;
mod exit;
mod export;
mod fabric;
mod flatten;
mod import;
mod junit;
mod make;
mod mannequin;
mod report;
mod specimen;
mod test;
mod update;

use std::num::NonZeroUsize;
use std::process::ExitCode;

use clap::Parser;

use crate::io::files::remove_on_interrupt;
use args::{Args, Command};
use console::Console;
use exit::{CliError, Exit};

/// Reads the arguments of the process, does what they say and gives its exit code.
pub fn main() -> ExitCode {
    // Ends the process itself for --help, --version (0) and wrong usage (2).
    let args = Args::parse();
    let console = Console::new(args.global.quiet, args.global.json);
    let done = remove_on_interrupt()
        .map_err(CliError::from)
        .and_then(|()| with_threads(args.global.threads, || run(&args.command, &console)))
        .and_then(|done| done);
    let exit = done.unwrap_or_else(|error| {
        console.error(&error);
        error.exit()
    });
    ExitCode::from(exit)
}

/// Most threads that are started, whatever is asked for: every one takes a stack, and a slip of the pen must not take
/// the memory.
const MOST_THREADS: usize = 256;

/// Stack of a thread, bytes: that of a main thread, because commands run in the pool.
const STACK: usize = 8 << 20;

fn with_threads<T: Send>(threads: Option<NonZeroUsize>, work: impl FnOnce() -> T + Send) -> Result<T, CliError> {
    // 0 means as many as the machine has. Work that is handed out from one of the pool's own threads costs least.
    let threads = threads.map_or(0, |threads| threads.get().min(MOST_THREADS));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build()?;
    Ok(pool.install(work))
}

fn run(command: &Command, console: &Console) -> Result<Exit, CliError> {
    match command {
        Command::Make(args) => make::make(args, console),
        Command::Check(args) => check::check(args, console),
        Command::Schema => console.document(crate::io::garment::SCHEMA).map(|()| Exit::Done),
        Command::Sew(args) => make::sew(args, console),
        Command::Drape(args) => make::drape(args, console),
        Command::Flatten(args) => flatten::flatten(args, console),
        Command::Report(args) => report::report(args, console),
        Command::Test(args) => test::test(args, console),
        Command::Alter(args) => alter::alter(args, console),
        Command::Export(command) => export::export(command, console),
        Command::Fabric(command) => fabric::fabric(command, console),
        Command::Import(command) => import::import(command, console),
        Command::Mannequin(command) => mannequin::mannequin(command, console),
    }
}
