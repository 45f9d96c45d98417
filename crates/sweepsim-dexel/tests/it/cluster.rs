use crate::common::{length, sub};
use sweepsim_dexel::*;

fn block_with_ball(cells: usize) -> Mesh {
    let block = Stock::Block {
        min: [-5.0; 3],
        max: [5.0, 5.0, 3.0],
    };
    let ball = Stock::Ball {
        centre: [1.0, 0.5, 4.0],
        radius: 3.0,
    };
    let stock = Stock::Difference(Box::new(block), vec![ball]);
    let solid = TriDexels::new([-6.3; 3], [6.1; 3], [cells; 3], &stock).unwrap();
    solid.surface().unwrap().crisp(0.766).unwrap()
}

#[test]
fn few_triangles_stay_near_and_sharp() {
    let mesh = block_with_ball(80);
    let whole = DistanceTo::new(&mesh.soup().unwrap()).unwrap();
    let mut tried = 0;
    for most in [20_000, 5_000, 1_000, 200] {
        let made = mesh.clustered(most);
        let few = made.mesh.triangles.len();
        assert!(few <= most && 3 * few > most, "{few} of {most}");
        assert_eq!(made.from.len(), made.mesh.vertices.len());
        let own = DistanceTo::new(&made.mesh.soup().unwrap()).unwrap();
        let far = |from: &Mesh, to: &DistanceTo| {
            let middle =
                |t: &[u32; 3]| [0, 1, 2].map(|k| t.iter().map(|v| from.vertices[*v as usize][k]).sum::<f64>() / 3.0);
            let places = from.vertices.iter().copied().chain(from.triangles.iter().map(middle));
            places
                .map(|p| to.nearest_triangle(p).unwrap().distance)
                .fold(0.0, f64::max)
        };
        let error = far(&made.mesh, &whole).max(far(&mesh, &own));
        assert!(error <= made.within, "{most}: {error} of {}", made.within);
        let farthest = made.farthest(&mesh).unwrap();
        assert!(farthest <= error && farthest < 0.5 * made.within, "{most}: {farthest}");
        // Corners stay, and normals point where those of the whole do.
        for corner in [[-5.0, -5.0, -5.0], [5.0, -5.0, 3.0], [-5.0, 5.0, 3.0]] {
            let near = made.mesh.vertices.iter().map(|p| length(sub(*p, corner)));
            assert!(near.fold(f64::INFINITY, f64::min) < 1e-6, "{most}: {corner:?}");
        }
        for (n, old) in made.mesh.normals.iter().zip(&made.from) {
            let normal = mesh.normals[*old as usize];
            assert!((0..3).map(|k| n[k] * normal[k]).sum::<f32>() > 0.3);
            tried += 1;
        }
    }
    assert!(tried > 5_000, "{tried}");
}

#[test]
fn a_small_mesh_stays_as_it_is() {
    let mesh = block_with_ball(20);
    let made = mesh.clustered(mesh.triangles.len());
    assert_eq!((made.mesh, made.within), (mesh.clone(), 0.0));
    let mut wrong = mesh.clone();
    wrong.triangles[7][0] = u32::MAX;
    assert_eq!(
        wrong.clustered(usize::MAX).mesh.triangles.len(),
        mesh.triangles.len() - 1
    );
    assert!(wrong.clustered(100).mesh.triangles.len() <= 100);
    assert_eq!(Mesh::default().clustered(5).mesh, Mesh::default());
    wrong.vertices[0][1] = f64::NAN;
    assert!(wrong.clustered(100).mesh.triangles.is_empty());
}
