//! Curvature that a descent has met: the memory of L-BFGS (Nocedal 1980).

use nalgebra::SVector;

/// The last steps of a descent over points of `D` coordinates, and how each changed the gradient.
#[derive(Clone, Debug, Default)]
pub struct Memory<const D: usize> {
    pairs: Vec<StepPair<D>>,
}

#[derive(Clone, Debug)]
struct StepPair<const D: usize> {
    step: Vec<SVector<f64, D>>,
    change: Vec<SVector<f64, D>>,
    /// 1 / (step · change).
    weight: f64,
}

impl<const D: usize> Memory<D> {
    /// Number of steps that are remembered.
    pub fn len(&self) -> usize {
        self.pairs.len()
    }

    /// Whether no step is remembered.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Forgets all steps but the last `most`.
    pub fn keep(&mut self, most: usize) {
        self.pairs.drain(..self.pairs.len().saturating_sub(most));
    }

    /// Adds a step and the change of the gradient along it, unless the energy does not curve upwards there: only steps
    /// along which it does keep the guessed curvature positive definite.
    pub fn remember(&mut self, step: Vec<SVector<f64, D>>, change: Vec<SVector<f64, D>>) {
        let curvature = dot(&step, &change);
        if curvature > f64::EPSILON * dot(&step, &step).sqrt() * dot(&change, &change).sqrt() {
            self.pairs.push(StepPair { step, change, weight: 1.0 / curvature });
        }
    }

    /// The last change of the gradient, and 1 / (step · change).
    pub fn last(&self) -> Option<(&[SVector<f64, D>], f64)> {
        self.pairs.last().map(|pair| (pair.change.as_slice(), pair.weight))
    }

    /// The way down: minus the guessed inverse curvature times the gradient (two-loop recursion). `first_guess` applies
    /// an inverse curvature that knows of no step.
    pub fn direction(
        &self,
        gradient: &[SVector<f64, D>],
        first_guess: impl FnOnce(&mut [SVector<f64, D>]),
    ) -> Vec<SVector<f64, D>> {
        let mut way: Vec<SVector<f64, D>> = gradient.iter().map(|g| -g).collect();
        let mut shares = Vec::with_capacity(self.pairs.len());
        for pair in self.pairs.iter().rev() {
            let share = pair.weight * dot(&pair.step, &way);
            advance(&mut way, &pair.change, -share);
            shares.push(share);
        }
        first_guess(&mut way);
        for (pair, share) in self.pairs.iter().zip(shares.into_iter().rev()) {
            let correction = share - pair.weight * dot(&pair.change, &way);
            advance(&mut way, &pair.step, correction);
        }
        way
    }
}

/// Moves points by `share` of a way.
pub fn advance<const D: usize>(points: &mut [SVector<f64, D>], way: &[SVector<f64, D>], share: f64) {
    points.iter_mut().zip(way).for_each(|(p, d)| *p += d * share);
}

/// The sum of the scalar products of all points.
pub fn dot<const D: usize>(a: &[SVector<f64, D>], b: &[SVector<f64, D>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    type Point = SVector<f64, 2>;

    #[test]
    fn after_as_many_steps_as_unknowns_a_quadratic_is_known() {
        let curvature = |v: &Point| Point::new(3.0 * v.x + v.y, v.x + 2.0 * v.y);
        let mut memory = Memory::<2>::default();
        // Steps that do not feel each other.
        let along = Point::new(1.0, 0.0);
        let across = Point::new(-1.0, 3.0);
        for step in [along, across] {
            memory.remember(vec![step], vec![curvature(&step)]);
        }
        let goal = Point::new(0.7, -1.3);
        let way = memory.direction(&[curvature(&goal)], |_| {});
        assert!((way[0] + goal).norm() < 1e-12, "{way:?}");
    }

    #[test]
    fn a_step_along_which_the_energy_curves_down_is_not_remembered() {
        let mut memory = Memory::<2>::default();
        memory.remember(vec![Point::new(1.0, 0.0)], vec![Point::new(-1.0, 0.0)]);
        assert!(memory.is_empty() && memory.last().is_none());
        for k in 0..3 {
            memory.remember(vec![Point::new(1.0, 0.0)], vec![Point::new(f64::from(k) + 1.0, 0.0)]);
        }
        memory.keep(2);
        assert_eq!(memory.len(), 2);
        assert_eq!(memory.last().map(|last| last.1), Some(1.0 / 3.0));
    }
}
