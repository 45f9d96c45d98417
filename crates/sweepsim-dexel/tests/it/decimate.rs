use sweepsim_dexel::*;

fn solid(stock: &Stock) -> Mesh {
    TriDexels::new([-6.3; 3], [6.1; 3], [41; 3], stock)
        .unwrap()
        .surface()
        .unwrap()
}

fn samples() -> Vec<Mesh> {
    let block = |min: [f64; 3], max: [f64; 3]| Stock::Block { min, max };
    let ball = |centre: [f64; 3], radius: f64| Stock::Ball { centre, radius };
    let dimpled = Stock::Difference(
        Box::new(block([-5.0; 3], [5.0, 5.0, 3.0])),
        vec![ball([1.0, 0.5, 4.0], 3.0), block([-4.0, -6.0, 1.0], [-2.0, 6.0, 9.0])],
    );
    let two = Stock::Union(vec![ball([-3.0; 3], 2.0), block([1.0; 3], [4.0, 5.0, 1.7])]);
    [block([-5.0; 3], [5.0; 3]), ball([0.0; 3], 5.0), dimpled, two]
        .iter()
        .map(solid)
        .collect()
}

#[test]
fn both_surfaces_are_within_the_deviation_of_each_other() {
    for mesh in samples() {
        let mut before = mesh.triangles.len();
        for deviation in [0.001, 0.02, 0.3] {
            let small = mesh.decimated(deviation).unwrap();
            let [whole, fewer] = [&mesh, &small].map(|mesh| mesh.soup().unwrap());
            fewer.check_closed().unwrap();
            // Independently: by samples.
            for (from, to) in [(&whole, &fewer), (&fewer, &whole)] {
                let (_, near) = DistanceTo::new(to).unwrap().furthest(from, 0.1).unwrap();
                assert!(near.distance.abs() <= deviation, "{} {deviation}", near.distance);
            }
            assert!(small.triangles.len() <= before);
            before = small.triangles.len();
            assert_eq!(small.vertices.len(), small.normals.len());
            assert_eq!(small.vertices.len(), small.cut.len());
        }
        assert!(
            before * 10 < mesh.triangles.len(),
            "{before} of {}",
            mesh.triangles.len()
        );
    }
}

#[test]
fn a_bump_that_is_higher_than_the_deviation_stays() {
    let block = Stock::Block {
        min: [-5.0; 3],
        max: [5.0; 3],
    };
    let bump = Stock::Ball {
        centre: [0.0, 0.0, 4.5],
        radius: 0.7,
    };
    let small = solid(&Stock::Union(vec![block, bump])).decimated(0.1).unwrap();
    let top = small.vertices.iter().map(|p| p[2]).fold(f64::MIN, f64::max);
    assert!(top > 5.1, "{top}");
}

#[test]
fn what_cannot_be_reduced_stays() {
    let mesh = samples().remove(0);
    assert_eq!(mesh.decimated(0.0).unwrap(), mesh);
    assert_eq!(mesh.decimated(f64::NAN).unwrap(), mesh);
    let mut open = mesh.clone();
    open.triangles.pop();
    assert_eq!(open.decimated(0.1).unwrap(), open);
    assert_eq!(Mesh::default().decimated(0.1).unwrap(), Mesh::default());
    let mut wrong = mesh.clone();
    wrong.triangles[3][1] = u32::MAX;
    assert_eq!(wrong.decimated(0.1), Err(MeshError::NotFinite { triangle: 3 }));
}
