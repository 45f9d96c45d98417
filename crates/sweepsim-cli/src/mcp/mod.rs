//! Serves agents by the Model Context Protocol, on standard input and output.
//!
//! `parameters` says what may be asked, `calls` carries it out by [`sweepsim_job`], `answers` says what was found, and
//! `server` speaks the protocol. Nothing is written, and nothing outside of the root is read.

mod answers;
mod calls;
mod limit;
mod parameters;
mod server;

use crate::arguments::McpOptions;
use crate::session::Failure;
use rmcp::ServiceExt;
use rmcp::transport::stdio;
use server::Server;
use std::process::ExitCode;
use std::time::Duration;
use sweepsim_formats::io_reason;

/// Serves until standard input ends.
pub(crate) fn serve(options: &McpOptions) -> Result<ExitCode, Failure> {
    let named = options.root.display();
    let refused = |error: std::io::Error| Failure::message(format!("the root {named}: {}", io_reason(&error)));
    let root = options.root.canonicalize().map_err(refused)?;
    // Names are relative to the root, in questions and in answers.
    std::env::set_current_dir(&root).map_err(refused)?;
    let server = Server::new(root, Duration::from_secs_f64(options.limit));
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    let runtime = runtime.map_err(|error| Failure::message(io_reason(&error)))?;
    let served = runtime.block_on(async {
        let service = server.serve(stdio()).await.map_err(|error| error.to_string())?;
        service.waiting().await.map_err(|error| error.to_string())
    });
    // Work that goes on is of no use to anybody any more.
    runtime.shutdown_background();
    match served {
        Ok(_) => Ok(ExitCode::SUCCESS),
        Err(error) => Err(Failure::message(format!("the Model Context Protocol: {error}"))),
    }
}
