//! The tools of a job.

mod of_job;
mod shapes;
mod surface_tool;
mod tool_box;

pub(crate) use tool_box::ToolBox;
