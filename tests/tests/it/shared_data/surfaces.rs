//! The stored 2-D systems.

use super::solver_support::audit::solve_surface;
use super::stored::all;

#[test]
#[cfg_attr(not(shared_data), ignore = "needs ../shared/data")]
fn stored_surfaces_have_their_known_topology() {
    let systems = all();
    for stored in systems.iter().filter(|s| s.dimension == 2) {
        let surface = solve_surface(&stored.system().unwrap(), 0.02, &stored.name);
        assert!(surface.unresolved.is_empty(), "{}", stored.name);
        if let Some(euler) = stored.expected["euler"].as_i64() {
            assert_eq!(surface.euler_characteristic(), euler);
            assert_eq!(
                surface.components() as u64,
                stored.expected["components"].as_u64().unwrap()
            );
        }
    }
}
