//! The protocol: which tools there are, and their calls.

use super::calls::{Refusal, carry_out};
use super::limit::Limit;
use super::parameters::{Compare, Inspect, Section, Simulate, Verify};
use rmcp::model::{
    CallToolRequestParams, CallToolResponse, CallToolResult, ContentBlock, Implementation, JsonObject, ListToolsResult,
    PaginatedRequestParams, ServerCapabilities, ServerConfig, Tool, ToolAnnotations,
};
use rmcp::service::RequestContext;
use rmcp::{ErrorData, RoleServer, ServerHandler};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;
use sweepsim_job::{JobError, words};

const INSTRUCTIONS: &str = "Judges CNC milling programs by exact swept volumes. Ask inspect_program first what a program \
contains, then verify_program whether it may be run: its findings name the lines that do harm. Names of files are \
relative to the root. Nothing is written. Lengths are in millimetres.";

/// Serves the files below a root.
pub(super) struct Server {
    root: PathBuf,
    limit: Duration,
    /// One call after the other: each takes all processors.
    turn: Arc<tokio::sync::Mutex<()>>,
}

impl Server {
    pub fn new(root: PathBuf, limit: Duration) -> Self {
        let turn = Arc::default();
        Self { root, limit, turn }
    }

    /// Carries out a call on a thread of its own.
    async fn done(&self, request: CallToolRequestParams, limit: Arc<Limit>) -> Result<CallToolResult, ErrorData> {
        let turn = Arc::clone(&self.turn).lock_owned().await;
        let root = self.root.clone();
        let work = tokio::task::spawn_blocking(move || {
            // Kept until the work ends, whoever waits for it.
            let _turn = turn;
            let given: JsonObject = request.arguments.unwrap_or_default();
            carry_out(&request.name, given, &root, &limit).map(CallToolResult::from)
        });
        match work.await {
            Ok(Ok(answer)) => Ok(answer),
            Ok(Err(Refusal::Parameters(why))) => Err(ErrorData::invalid_params(why, None)),
            Ok(Err(Refusal::Work(error))) => Ok(refused(in_full(&error))),
            Ok(Err(Refusal::Said(why))) => Ok(refused(why)),
            Err(_) => Err(ErrorData::internal_error(
                "the work ended by a fault of this server",
                None,
            )),
        }
    }
}

fn refused(why: String) -> CallToolResult {
    CallToolResult::error(vec![ContentBlock::text(why)])
}

/// An error with the lines of the file, and the other problems of a program.
fn in_full(error: &JobError) -> String {
    let JobError::Format(error) = error else {
        return error.to_string();
    };
    let further = error.further().iter().map(|error| error.render(false));
    let all = std::iter::once(error.render(false)).chain(further);
    all.take(10).collect::<Vec<_>>().join("\n\n")
}

fn tool<P: rmcp::schemars::JsonSchema + 'static>(name: &'static str, description: &'static str) -> Tool {
    Tool::new(name, description, JsonObject::new())
        .with_input_schema::<P>()
        .with_annotations(ToolAnnotations::new().read_only(true).open_world(false))
}

fn tools() -> Vec<Tool> {
    vec![
        tool::<Inspect>(
            "inspect_program",
            "Says what is in a program, job, tool library, mesh or dexel file, and what was ignored or assumed in it.",
        ),
        tool::<Verify>(
            "verify_program",
            "Judges every move of a program: collisions of shanks and holders, rapids through material, fixtures, gouges \
             and material that is left. Findings have file, line and depth; the picture shows the part.",
        ),
        tool::<Simulate>(
            "simulate_program",
            "Moves the tools of a program through the stock: how much is removed, and a picture of the part.",
        ),
        tool::<Compare>(
            "compare_parts",
            "Compares two parts, each a mesh or dexels: volumes, distances, regions beyond limits, and a picture of the \
             part coloured by distance.",
        ),
        tool::<Section>(
            "section",
            "Cuts what the tools of a program sweep by a plane: the outline as polylines, and a drawing.",
        ),
    ]
}

impl ServerHandler for Server {
    fn get_info(&self) -> ServerConfig {
        ServerConfig::new(ServerCapabilities::builder().enable_tools().build())
            .with_server_info(Implementation::new("sweepsim", env!("CARGO_PKG_VERSION")))
            .with_instructions(INSTRUCTIONS)
    }

    async fn list_tools(
        &self,
        _: Option<PaginatedRequestParams>,
        _: RequestContext<RoleServer>,
    ) -> Result<ListToolsResult, ErrorData> {
        Ok(ListToolsResult::with_all_items(tools()))
    }

    async fn call_tool(
        &self,
        request: CallToolRequestParams,
        context: RequestContext<RoleServer>,
    ) -> Result<CallToolResponse, ErrorData> {
        let limit = Arc::new(Limit::default());
        let answer = tokio::select! {
            done = self.done(request, Arc::clone(&limit)) => done?,
            () = tokio::time::sleep(self.limit) => {
                limit.reach();
                let (seconds, progress) = (words::seconds(self.limit.as_secs_f64()), limit.progress());
                refused(format!(
                    "the limit of {seconds} for a call was reached {progress}: expected a larger `cell`, no `proof`, a \
                     shorter program, or a server with a higher --limit"
                ))
            }
            () = context.ct.cancelled() => {
                limit.reach();
                refused("cancelled".to_owned())
            }
        };
        Ok(answer.into())
    }
}
