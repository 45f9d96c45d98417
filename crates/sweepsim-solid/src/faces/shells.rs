//! Connected faces: shells around material, and around hollows in it.

use crate::label::Groups;
use crate::net::Net;
use crate::parts::Body;
use nalgebra::Vector3;
use std::ops::Range;

/// The bodies of a solid: each an outer shell, with those of its hollows.
pub(crate) fn shells(net: &Net, groups: &Groups, of_group: &[Range<u32>]) -> Vec<Body> {
    let mut shell_of = vec![u32::MAX; net.triangles()];
    let mut volumes = Vec::new();
    for start in 0..net.triangles() {
        if shell_of[start] != u32::MAX {
            continue;
        }
        let number = volumes.len() as u32;
        shell_of[start] = number;
        let (mut next, mut volume) = (vec![start], 0.0);
        let origin = net.place(net.mesh.triangles[start][0]);
        while let Some(triangle) = next.pop() {
            let [a, b, c] = net.mesh.triangles[triangle].map(|v| net.place(v) - origin);
            volume += a.dot(&b.cross(&c)) / 6.0;
            for k in 0..3 {
                let other = net.across[3 * triangle + k] as usize / 3;
                if shell_of[other] == u32::MAX {
                    shell_of[other] = number;
                    next.push(other);
                }
            }
        }
        volumes.push((volume, start));
    }
    let mut faces: Vec<Vec<u32>> = vec![Vec::new(); volumes.len()];
    for group in 0..groups.count() {
        if let Some(triangle) = groups.triangles(group).first() {
            faces[shell_of[*triangle as usize] as usize].extend(of_group[group].clone());
        }
    }
    let outer: Vec<usize> = (0..volumes.len())
        .filter(|k| volumes[*k].0 > 0.0 && faces[*k].len() > 1)
        .collect();
    let mut bodies: Vec<Body> = outer
        .iter()
        .map(|shell| Body {
            faces: std::mem::take(&mut faces[*shell]),
            hollows: Vec::new(),
        })
        .collect();
    for shell in 0..volumes.len() {
        if faces[shell].len() < 2 || volumes[shell].0 > 0.0 {
            continue;
        }
        // In the smallest body that has it inside.
        let p = net.place(net.mesh.triangles[volumes[shell].1][0]);
        let around = (0..outer.len()).filter(|k| inside(net, &shell_of, outer[*k] as u32, p));
        let smallest = around.min_by(|a, b| volumes[outer[*a]].0.total_cmp(&volumes[outer[*b]].0));
        if let Some(body) = smallest {
            bodies[body].hollows.push(std::mem::take(&mut faces[shell]));
        }
    }
    bodies
}

/// Whether a point is inside a shell: by how much of all directions it fills.
fn inside(net: &Net, shell_of: &[u32], shell: u32, p: Vector3<f64>) -> bool {
    let mut sum = 0.0;
    for triangle in (0..net.triangles()).filter(|t| shell_of[*t] == shell) {
        let [a, b, c] = net.mesh.triangles[triangle].map(|v| net.place(v) - p);
        let (x, y, z) = (a.norm(), b.norm(), c.norm());
        let below = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
        sum += 2.0 * a.dot(&b.cross(&c)).atan2(below);
    }
    sum > 2.0 * std::f64::consts::PI
}
