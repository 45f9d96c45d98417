//! One line or two for every operation, with what it gives: `cargo run -p sweepsim-spline --example operations`.

use sweepsim_spline::{BSpline, Bernstein, BernsteinMap, KnotVector, RationalSpline};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    bernstein()?;
    splines()?;
    bounds()?;
    shapes()
}

fn bernstein() -> Result<(), Box<dyn std::error::Error>> {
    println!("# Bernstein forms on [0,1]ⁿ");
    let (x, y) = (Bernstein::variable(2, 0), Bernstein::variable(2, 1));
    let f = &(&x * &x) - &y;
    println!("x² − y: {f}");
    println!(
        "value and bound at (0.3, 0.2): {:?}",
        f.evaluate_with_error(&[0.3, 0.2])
    );
    println!("∂x: {}", f.derivative(0));
    println!("∫dy: {}", f.integral(1));
    println!(
        "all derivatives to order 2: {:?}",
        f.derivatives(&[0.3, 0.2], 2).iter().collect::<Vec<_>>()
    );
    println!("left half in x: {}", f.split(0, 0.5).0);
    println!("on [0.2, 0.4] × [0, 1]: {}", f.restrict(0, 0.2, 0.4));
    println!("at y = 1: {}", f.slice(1, 1.0));
    println!("on x + y = 1: {}", f.restrict_to_hyperplane(1, &[1.0, 1.0], 1.0)?);
    println!("on y = x²: {}", f.substitute(1, &Bernstein::variable(1, 0).square()));
    let t = Bernstein::variable(1, 0);
    println!("along (t, t³): {}", f.compose(&[t.clone(), t.mul(&t.square())])?);
    println!(
        "after (x, y) ↦ (y, x): {}",
        f.compose_affine(&[(vec![0.0, 1.0], 0.0), (vec![1.0, 0.0], 0.0)])?
    );
    println!("as a function of (x, t, y): {}", f.extend(3, &[0, 2])?);
    println!("times g(z) = z: {}", f.tensor_product(&t));
    println!("elevated: {}", f.elevate(1, 1));
    println!("and back: {}", f.elevate(1, 2).lowest_degrees());
    let surface = BernsteinMap::new(vec![x.clone(), y.clone(), f]);
    let normal = surface.derivative(0).cross(&surface.derivative(1))?;
    println!("normal of (x, y, x² − y): {normal}");
    println!("|N|²: {}", normal.square_norm());
    let polar = BernsteinMap::new(vec![&x * &x, &x * &y]);
    println!("det J of (x², xy): {}", polar.jacobian_determinant()?);
    Ok(())
}

fn splines() -> Result<(), Box<dyn std::error::Error>> {
    println!("\n# B-splines");
    let knots = KnotVector::open(2, &[0.0, 1.0, 2.0])?;
    let curve = BSpline::new(vec![knots.clone()], 2, vec![0.0, 0.0, 1.0, 2.0, 3.0, 2.0, 4.0, 0.0])?;
    println!("{curve}");
    println!("at 0.5: {:?}, slope {}", curve.evaluate(&[0.5]), curve.jacobian(&[0.5]));
    println!("with a knot more: {}", curve.insert_knot(0, 0.5, 1)?);
    println!("elevated: {}", curve.elevate(0, 1)?);
    println!("reduced again: {}", curve.elevate(0, 1)?.reduce(0)?);
    let (left, right) = curve.split(0, 0.7)?;
    println!("split at 0.7: {left}\n{right}");
    println!("joined: {}", left.join(&right, 0)?);
    for piece in curve.pieces()? {
        println!("on {:?}: {}", piece.ranges, piece.map);
    }
    println!("|c|²: {}", curve.square_norm()?);
    println!("c · c′: {}", curve.dot(&curve.derivative(0)?.elevate(0, 1)?)?);
    println!("∫c: {:?}", curve.integral_over_domain()?);
    println!("c(s) + c(t): {}", {
        let line = KnotVector::bernstein(0, 0.0, 2.0)?;
        curve.extend(1, line.clone())?.add(&curve.extend(0, line)?)?
    });
    println!("backwards: {}", curve.reverse(0)?);
    println!("over [0, 1]: {}", curve.reparametrise(0, 0.0, 1.0)?);
    let periodic = BSpline::periodic(
        vec![KnotVector::periodic(2, &[0.0, 1.0, 2.0, 3.0])?],
        1,
        &[0.0, 1.0, 0.5],
    )?;
    println!("periodic: {periodic}");
    let through = BSpline::curve_through(&[[0.0, 0.0], [1.0, 2.0], [3.0, 1.0], [4.0, 4.0]], 3)?;
    println!("through points, off by {:e}: {}", through.residual, through.spline);
    let sine = BSpline::interpolate_function(vec![KnotVector::uniform(3, 8, 0.0, 3.0)?], 1, |x, y| y[0] = x[0].sin())?;
    println!("sine to within {:.1e}", sine.residual);
    Ok(())
}

fn bounds() -> Result<(), Box<dyn std::error::Error>> {
    println!("\n# Bounds");
    let f = Bernstein::new(&[3], vec![-1.0, 2.0, -1.5, 1.0])?;
    println!(
        "enclosure {:?}, after 20 splits {:?}",
        f.enclosure(),
        f.tight_enclosure(20)
    );
    println!("elevated by 4: {:?}", f.elevated_enclosure(4));
    println!("zeros, if any, in {:?}", f.zero_interval(0));
    println!("between two lines: {:?}", f.linear_bound());
    let plane = Bernstein::linear(0.0, &[1.0, 2.0]).add(&Bernstein::variable(2, 0).square().scale(0.1));
    println!("cone of gradients: {:?}", plane.gradient_cone());
    Ok(())
}

fn shapes() -> Result<(), Box<dyn std::error::Error>> {
    println!("\n# Shapes");
    let circle = RationalSpline::circle([0.0, 0.0], 1.0)?;
    println!("{circle}");
    let profile = BSpline::line(&[1.0, 0.0, 0.0], &[2.0, 0.0, 1.0])?;
    let cone = RationalSpline::from_polynomial(&profile)?.revolve([0.0; 3], [0.0, 0.0, 1.0], std::f64::consts::PI)?;
    println!("half a cone at the middle: {:?}", cone.evaluate(&[0.5, 1.0]));
    println!("its normal there: {:?}", cone.normal()?.evaluate(&[0.5, 1.0]));
    println!("a prism: {}", profile.extrude(&[0.0, 1.0, 0.0])?);
    println!(
        "ruled: {}",
        profile.ruled(&BSpline::line(&[0.0, 1.0, 0.0], &[0.0, 2.0, 5.0])?)?
    );
    println!(
        "a plane: {}",
        BSpline::plane(&[0.0; 3], &[1.0, 0.0, 0.0], &[0.0, 1.0, 0.0])?
    );
    Ok(())
}
