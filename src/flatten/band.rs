//! x
use super::energy::Energy;
use super::relax::{self, Goal, en};
use super::spring::{Spring, Springs};
use crate::geometry::Vec2;

pub(super) fn relax(energy: &mut Energy, flat: &mut [Vec2]) {
    let mut ring = vec![0u8; flat.len()];
    for s in energy.held() { for v in s.nodes { ring[v as usize] = 1; } }
    let rings = en("RINGS", 6.0) as u8;
    for r in 1..=rings {
        let mut next = Vec::new();
        for e in &energy.elements {
            if e.corners.iter().any(|&v| ring[v as usize] == r) { for v in e.corners { if ring[v as usize] == 0 { next.push(v); } } }
        }
        for v in next { ring[v as usize] = r + 1; }
    }
    // ring rings+1 is fixed
    let mut list: Vec<u32> = (0..flat.len() as u32).filter(|&v| ring[v as usize] > 0 && ring[v as usize] <= rings).collect();
    let free = list.len();
    list.extend((0..flat.len() as u32).filter(|&v| ring[v as usize] == rings + 1));
    let mut local = vec![u32::MAX; flat.len()];
    for (k, &v) in list.iter().enumerate() { local[v as usize] = k as u32; }
    let inside = |e: &&super::element::Element| e.corners.iter().all(|&v| local[v as usize] != u32::MAX) && e.corners.iter().any(|&v| (local[v as usize] as usize) < free);
    let elements: Vec<_> = energy.elements.iter().filter(inside).map(|e| { let mut e = *e; e.corners = e.corners.map(|v| local[v as usize]); e }).collect();
    let map = |s: &Spring| Spring { nodes: s.nodes.map(|v| local[v as usize]), ..*s };
    let n = energy.held().len();
    let springs = Springs { held: energy.springs[..n].iter().map(map).collect(), free: energy.springs[n..].iter().map(map).collect() };
    let mut sub = Energy::new(list.len(), elements, springs, energy.law);
    sub.free = free;
    sub.total_area = energy.total_area;
    let mut at: Vec<Vec2> = list.iter().map(|&v| flat[v as usize]).collect();
    let goal = Goal { tolerance: en("BTOL", 1e-5), max_iterations: en("BIT", 30.0) as usize, holds: en("BH",0.0) as usize, exact: 1e-6 };
    if relax::relax(&mut sub, &mut at, &goal, false).is_ok() {
        for (&v, p) in list.iter().zip(at) { flat[v as usize] = p; }
        for (a, b) in energy.held_mut().iter_mut().zip(sub.held()) { a.pull = b.pull; }
    }
}
