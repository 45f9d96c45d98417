//! A brute-force oracle of swept volumes that shares no code with the solver.
//!
//! It takes only the public definitions (`Pose`, `Profile`) and the motion law, and knows nothing of envelopes,
//! Bernstein forms or coverage counts. There are two independent ways to the truth, and tests use both:
//!
//! - [`SweptLine`]: *dense time sampling with local refinement.* At an instant the intersection of a vertical line with
//!   the tool is exact ([`chords`]: roots of quadratics and quartics); the union over many instants is the swept set,
//!   whose ends are then moved outwards by minimising over `t` around the instants that made them. It gives intervals,
//!   and says where sampling cannot resolve them.
//! - [`Depth`]: *signed distance.* `D(P) = min over t of d(t, P)`, with `d` the signed distance of `P` from the placed
//!   tool. It is 1-Lipschitz in `P`, so `|D| ≤ ε` says that `P` is within `ε` of the boundary of the swept volume,
//!   whatever the slope of the wall there. That is just what the tolerance of a sweep promises, so it is the judge
//!   where two interval sets differ.
//!
//! [`compare`] puts both together.
//!
//! | file | what |
//! | --- | --- |
//! | `motion.rs` | the pose at an instant, and a bound of the speed |
//! | `outline.rs` | a profile as a plane figure: inside or outside, signed distance |
//! | `roots.rs` | all real roots of a polynomial on an interval |
//! | `minimum.rs` | the least value of a function of time |
//! | `chord.rs` | a vertical line through a placed tool |
//! | `union.rs` | the union of the chords over time |
//! | `depth.rs` | signed distance from the swept volume |
//! | `agreement.rs` | the verdict on intervals found by somebody else |

mod agreement;
mod chord;
mod depth;
mod minimum;
mod motion;
mod outline;
mod roots;
mod union;

pub use agreement::{Disagreement, Verdict, compare};
pub use chord::chords;
pub use depth::{Depth, Nearest};
pub use motion::{Arc, Motion, Place, Placement};
pub use outline::Outline;
pub use roots::{Polynomial, roots_between};
pub use union::{Sampling, Span, SweptLine, swept_line};
