//! The energies that make up the elasticity of the cloth, in one list.

use super::bending::Bending;
use super::crease::Crease;
use super::energy::{Bound, Elastic, Energy, Exerted, Foreseen, Stiffness};
use super::membrane::Membrane;
use super::scattered::Scattered;
use crate::geometry::Vec3;

/// Makes [`Elasticity`], which is an energy, of a list of energies.
macro_rules! energies {
    ($($(#[$doc:meta])* $vis:vis $name:ident: $Energy:ty,)+) => {
        /// The elasticity of the cloth.
        #[derive(Clone, Debug, Default)]
        pub struct Elasticity {
            $($(#[$doc])* $vis $name: $Energy,)+
        }

        /// Loads of every energy as a step predicts them.
        #[derive(Default)]
        pub(super) struct Loads {
            $($name: <$Energy as Elastic>::Loads,)+
        }

        impl Energy for Elasticity {
            fn energy(&self, x: &[Vec3]) -> f64 {
                0.0 $(+ self.$name.energy(x))+
            }

            fn forces<'a>(&'a self, x: &'a [Vec3]) -> impl Exerted + 'a {
                let all = ();
                $(let all = (all, self.$name.forces(x));)+
                all
            }

            fn stiffness<'a>(&'a self, x: &'a [Vec3]) -> impl Stiffness + 'a {
                let all = ();
                $(let all = (all, self.$name.stiffness(x));)+
                all
            }

            fn bound<'a>(&'a self, x: &'a [Vec3]) -> impl Bound + 'a {
                let all = ();
                $(let all = (all, self.$name.bound(x));)+
                all
            }

            fn pairs(&self) -> impl Iterator<Item = [u32; 2]> {
                std::iter::empty()$(.chain(self.$name.pairs()))+
            }
        }

        impl Elastic for Elasticity {
            type Loads = Loads;

            fn foresee(&self, x: &[Vec3], to: &[Vec3]) -> Foreseen<Loads> {
                $(let $name = self.$name.foresee(x, to);)+
                Foreseen {
                    beyond: 0.0 $(+ $name.beyond)+,
                    energy: 0.0 $(+ $name.energy)+,
                    loads: Loads { $($name: $name.loads,)+ },
                }
            }

            fn follow(&mut self, x: &[Vec3], foreseen: Loads) {
                $(self.$name.follow(x, foreseen.$name);)+
            }

            fn around(&self, is_held: &[bool]) -> Self {
                Self { $($name: self.$name.around(is_held),)+ }
            }

            fn take_back(&mut self, part: &Self, is_held: &[bool]) {
                $(self.$name.take_back(&part.$name, is_held);)+
            }
        }
    };
}

// The one list of energies, in the order in which they are added. A new one is added here.
energies! {
    /// Bending.
    pub bending: Bending,
    /// Pressed folds.
    pub(super) creases: Scattered<'static, Crease>,
    /// Stretch and shear.
    pub membrane: Membrane,
}
