//! What agents may ask for. The comments are what they read.

use rmcp::schemars;
use rmcp::schemars::JsonSchema;
use serde::Deserialize;

/// A file, and how it is read.
#[derive(Debug, Deserialize, JsonSchema)]
pub(super) struct Inspect {
    /// A job (.ron), a program (.nc .ngc .mpf .h .cls .apt .csv …), a tool library, a mesh or dexels, relative to the
    /// root.
    pub path: String,
    /// The control that a program is written for: linuxcnc, fanuc, haas, siemens, heidenhain, grbl or okuma. Without
    /// one, as the program says.
    pub controller: Option<String>,
    /// The machine: a file, or the name of a ready one.
    pub machine: Option<String>,
}

/// A program or a job.
#[derive(Debug, Deserialize, JsonSchema)]
pub(super) struct Program {
    /// A program (.nc .ngc .mpf .h .cls .apt .csv …), or a job (.ron), which says itself what the other fields say of a
    /// program; relative to the root.
    pub path: String,
    /// A tool library, a tool table, or a project: without one, tools are those that the program describes.
    pub tools: Option<String>,
    /// `auto` (as the program says, or a block around its feed moves), `block:x0,y0,z0,x1,y1,z1` in millimetres, or a
    /// mesh.
    pub stock: Option<String>,
    /// The control that the program is written for: linuxcnc, fanuc, haas, siemens, heidenhain, grbl or okuma.
    pub controller: Option<String>,
    /// The machine: a file, or the name of a ready one.
    pub machine: Option<String>,
    /// The distance of the dexels in millimetres, or nearly so: a larger one takes less time. Without it, as the job
    /// says, or from the smallest tool and the size of the stock.
    pub cell: Option<f64>,
    /// Whether to draw the part. Without it, true.
    pub picture: Option<bool>,
}

#[derive(Debug, Deserialize, JsonSchema)]
pub(super) struct Simulate {
    #[serde(flatten)]
    pub program: Program,
}

#[derive(Debug, Deserialize, JsonSchema)]
pub(super) struct Verify {
    #[serde(flatten)]
    pub program: Program,
    /// The part that is wanted: a mesh (.stl .ply .step …). Without one, gouges and material that is left are not
    /// looked for.
    pub target: Option<String>,
    /// How deep gouges may be, in millimetres.
    pub gouge: Option<f64>,
    /// How high remaining material may be, in millimetres.
    pub excess: Option<f64>,
    /// How near shanks and holders may come to the workpiece and to fixtures, in millimetres.
    pub clearance: Option<f64>,
    /// Whether to prove what can be proven between the lines of the dexels, which may take several times as long.
    /// Without it, true.
    pub proof: Option<bool>,
}

#[derive(Debug, Deserialize, JsonSchema)]
pub(super) struct Compare {
    /// The part: a mesh (.stl .ply .glb .3mf .vtp .step) or dexels (.dexels .tridexels .npz), relative to the root.
    pub part: String,
    /// The target, likewise.
    pub target: String,
    /// Regions that are missing deeper than this are listed, in millimetres. Without it, 0.1.
    pub gouge: Option<f64>,
    /// Regions that stand higher than this are listed, in millimetres. Without it, 0.1.
    pub excess: Option<f64>,
}

#[derive(Debug, Deserialize, JsonSchema)]
pub(super) struct Section {
    #[serde(flatten)]
    pub program: Program,
    /// The plane: `x=3.5`, `y=…`, `z=…`, or `a,b,c=d` for a x + b y + c z = d.
    pub plane: String,
    /// The largest distance of the polylines from the curves, in millimetres. Without it, 0.01.
    pub chord: Option<f64>,
}
