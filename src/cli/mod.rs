//! The command line.
//!
//! `args` and the files whose names end in `_args` hold what clap reads, unchecked. Each command has a file that checks
//! its arguments, runs the pipeline and says how it went. Results go to standard output, everything else to standard
//! error.

mod alter;
mod arg_values;
mod args;
mod batch;
mod batch_args;
mod check;
mod check_mesh;
mod console;
mod draft;
mod drawn;
mod exit;
mod export;
mod fabric;
mod fit;
mod flatten;
mod flatten_args;
mod garment_args;
mod import;
mod import_args;
mod import_kind;
mod junit;
mod library_args;
mod make;
mod mannequin;
mod paper_args;
mod picture_args;
mod plan;
mod report;
mod sample;
mod specimen;
mod studio;
mod test;
mod test_outcome;
mod update;

use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::process::ExitCode;

use crate::batch::become_worker;
use crate::io::files::undo_on_interrupt;
use args::{Args, Command};
use console::Console;
use exit::{CliError, Exit};

/// Reads the arguments of the process, does what they say and gives its exit code.
pub fn main() -> ExitCode {
    let itself = std::env::current_exe().map_or_else(|_| "toile".into(), OsString::from);
    ExitCode::from(main_with(std::env::args_os(), &[itself]))
}

/// Does what the arguments say, the first of which is the program's name, and gives the exit code. `itself` is the
/// command that starts this program again: a batch makes each garment in a process of its own.
pub fn main_with(arguments: impl IntoIterator<Item = OsString>, itself: &[OsString]) -> u8 {
    let args = match import_kind::parsed(arguments) {
        Ok(args) => args,
        // --help and --version (0) and wrong usage (2).
        Err(said) => {
            // Nobody is left to tell if this fails.
            let _ = said.print();
            return u8::try_from(said.exit_code()).unwrap_or(Exit::Input as u8);
        }
    };
    let console = Console::new(args.global.quiet, args.global.json, args.global.worker.is_some());
    let done = undo_on_interrupt()
        .map_err(CliError::from)
        .and_then(|()| args.global.worker.map_or(Ok(()), |memory| Ok(become_worker(memory)?)))
        .and_then(|()| with_threads(args.global.threads, || run(&args, itself, &console)))
        .and_then(|done| done);
    let exit = done.unwrap_or_else(|error| {
        console.error(&error);
        args.global.worker.map_or_else(|| error.exit(), |memory| error.exit_of_worker(memory > 0))
    });
    exit.code(args.global.worker.is_some())
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

fn run(args: &Args, itself: &[OsString], console: &Console) -> Result<Exit, CliError> {
    let threads = args.global.threads;
    match &args.command {
        Command::Make(args) => make::make(args, console),
        Command::Check(args) => check::check(args, console),
        Command::Schema => console.document(crate::io::garment::SCHEMA).map(|()| Exit::Done),
        Command::Sew(args) => make::sew(args, console),
        Command::Drape(args) => make::drape(args, console),
        Command::Flatten(args) => flatten::flatten(args, console),
        Command::Report(args) => report::report(args, console),
        Command::Batch(batch) => batch::batch(batch, threads, itself, console),
        Command::Sample(args) => sample::sample(args, console),
        Command::Studio(args) => studio::studio(args, threads, itself, console),
        Command::Test(args) => test::test(args, console),
        Command::Draft(args) => draft::draft(args, console),
        Command::Alter(args) => alter::alter(args, console),
        Command::Fit(args) => fit::fit(args, console),
        Command::Export(command) => export::export(command, console),
        Command::Fabric(command) => fabric::fabric(command, console),
        Command::Import(command) => import::import(command, console),
        Command::Mannequin(command) => mannequin::mannequin(command, console),
    }
}
