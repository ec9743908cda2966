//! Which triangles a panel has.

use std::collections::BTreeSet;

use super::place::Form;
use super::skin::LinedSkin;
use crate::contact::nearest_on_surface;
use crate::geometry::{DisjointSets, MM, Topology, Vec3, rim_loops, sorted_pair};

/// Regions between the lines: of every triangle the one that stands for its region.
pub(super) fn regions(skin: &LinedSkin) -> Vec<u32> {
    let lines = skin.edges();
    let mut sets = DisjointSets::new(skin.mesh.triangles.len());
    for edge in Topology::new(&skin.mesh.triangles).edges {
        if let [Some(a), Some(b)] = edge.triangles
            && !lines.contains(&sorted_pair(edge.ends))
        {
            sets.join(a, b);
        }
    }
    (0..skin.mesh.triangles.len() as u32).map(|t| sets.root(t)).collect()
}

/// The first line with an end that hangs in the air, and what is wrong with it.
pub(super) fn loose_end(form: &Form) -> Option<(String, String)> {
    for line in &form.skin.lines {
        let (&first, &last) = (line.chain.first()?, line.chain.last()?);
        if first == last {
            continue;
        }
        for end in [first, last] {
            let others = form.skin.lines.iter().filter(|l| l.name != line.name);
            if others.clone().any(|l| l.chain.contains(&end)) {
                continue;
            }
            let p = form.skin.at(end);
            let [x, y, z] = [p.x, p.y, p.z].map(|x| (x * MM).round());
            let near = form.nearest_line(p, &line.name).map_or_else(String::new, |(_, far, other)| {
                format!("; the nearest line is '{other}', {:.0} mm away", far * MM)
            });
            let why = format!("is open: it ends at ({x}, {y}, {z}) on no other line{near}; let it end 'on' a line");
            return Some((line.name.clone(), why));
        }
    }
    None
}

/// The region of every panel, by a point in it; `regions` as [`regions`] gives them.
pub(super) fn chosen(
    skin: &LinedSkin,
    regions: &[u32],
    panels: &[(String, Vec3)],
) -> Result<Vec<u32>, (String, String)> {
    let mut out: Vec<u32> = Vec::new();
    for (name, at) in panels {
        let region = regions[nearest_on_surface(&skin.mesh, *at).0];
        if let Some(k) = out.iter().position(|other| *other == region) {
            let why = format!("overlaps panel '{}': no line lies between their points; draw one", panels[k].0);
            return Err((name.clone(), why));
        }
        let own: Vec<[u32; 3]> =
            (0..regions.len()).filter(|&t| regions[t] == region).map(|t| skin.mesh.triangles[t]).collect();
        is_disk(&own).map_err(|why| (name.clone(), why))?;
        out.push(region);
    }
    Ok(out)
}

/// Whether triangles make a piece with one rim.
fn is_disk(triangles: &[[u32; 3]]) -> Result<(), String> {
    let rims = rim_loops(triangles).len();
    let vertices: BTreeSet<u32> = triangles.iter().flatten().copied().collect();
    let edges = Topology::new(triangles).edges.len();
    let euler = vertices.len() as i64 - edges as i64 + triangles.len() as i64;
    match (rims, euler) {
        (1, 1) => Ok(()),
        (0, _) => Err("no closed line bounds it; draw the lines round it".into()),
        _ => Err(format!(
            "has {rims} rims, as a tube has, and cannot be laid flat in one piece; draw a line from one rim to another"
        )),
    }
}
