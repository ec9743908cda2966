//! The elements that resist stretch and shear within the plane of the cloth, family by family.

use super::element::{Element, ElementForeseen};
use super::shear::Shear;
use super::spring::Spring;
use super::stretch::StretchLaw;
use super::thread::Thread;
use crate::geometry::{Mat3, Vec3};

/// Makes [`Elements`] of a list of families, and what tells elements of all families, their stiffness and its bound
/// apart without a table of functions: springs are evaluated by the million.
macro_rules! families {
    ($($(#[$doc:meta])* $family:ident: $Element:ident,)+) => {
        /// Elements of at most three nodes. They are numbered through all families in their order.
        #[derive(Clone, Debug, Default)]
        pub struct Elements {
            $($(#[$doc])* pub $family: Vec<$Element>,)+
        }

        /// An element of any family.
        #[derive(Clone, Copy)]
        pub(super) enum AnyElement<'a> {
            $($Element(&'a $Element),)+
        }

        /// True stiffness of an element of any family.
        pub(super) enum AnyTangent {
            $($Element(<$Element as Element<3>>::Tangent),)+
        }

        /// Bound of the stiffness of an element of any family.
        pub(super) enum AnyBound {
            $($Element(<$Element as Element<3>>::Bound),)+
        }

        impl Elements {
            /// Number of elements.
            pub(super) fn len(&self) -> usize {
                0 $(+ self.$family.len())+
            }

            /// The element with this number.
            pub(super) fn get(&self, number: usize) -> AnyElement<'_> {
                let first = 0;
                $(
                    if let Some(element) = self.$family.get(number - first) {
                        return AnyElement::$Element(element);
                    }
                    let first = first + self.$family.len();
                )+
                unreachable!("element {number} of {first}")
            }

            /// Those of them that are `wanted`, by their numbers.
            pub(super) fn those(&self, wanted: &[bool]) -> Self {
                let rest = wanted;
                $(
                    let (wanted, rest) = rest.split_at(self.$family.len());
                    let $family = those(&self.$family, wanted);
                )+
                debug_assert!(rest.is_empty());
                Self { $($family,)+ }
            }
        }

        impl<'a> AnyElement<'a> {
            /// [`Element::nodes`]
            pub(super) fn nodes(self) -> &'a [u32] {
                match self { $(Self::$Element(e) => Element::nodes(e),)+ }
            }

            /// [`Element::energy`]
            pub(super) fn energy(self, laws: &[StretchLaw], x: &[Vec3]) -> f64 {
                match self { $(Self::$Element(e) => e.energy(laws, x),)+ }
            }

            /// [`Element::forces`]
            pub(super) fn forces(self, laws: &[StretchLaw], x: &[Vec3]) -> [Vec3; 3] {
                match self { $(Self::$Element(e) => e.forces(laws, x),)+ }
            }

            /// [`Element::foresee`]
            pub(super) fn foresee(self, laws: &[StretchLaw], x: &[Vec3], to: &[Vec3]) -> ElementForeseen {
                match self { $(Self::$Element(e) => e.foresee(laws, x, to),)+ }
            }

            /// [`Element::tangent`]
            pub(super) fn tangent(self, laws: &[StretchLaw], x: &[Vec3], load: Option<f64>) -> AnyTangent {
                match self { $(Self::$Element(e) => AnyTangent::$Element(e.tangent(laws, x, load)),)+ }
            }

            /// [`Element::add_row`] with a stiffness of this element.
            pub(super) fn add_row(self, tangent: &AnyTangent, corner: usize, add: impl FnMut(usize, Mat3)) {
                match (self, tangent) {
                    $((Self::$Element(e), AnyTangent::$Element(tangent)) => e.add_row(tangent, corner, add),)+
                    _ => unreachable!("a stiffness of another family"),
                }
            }

            /// [`Element::bound_block`] with a bound of this element.
            pub(super) fn bound_block(self, bound: &AnyBound, i: usize, j: usize) -> Mat3 {
                match (self, bound) {
                    $((Self::$Element(e), AnyBound::$Element(bound)) => e.bound_block(bound, i, j),)+
                    _ => unreachable!("a bound of another family"),
                }
            }
        }

        impl AnyTangent {
            /// [`Element::bound`]
            pub(super) fn bound(&self) -> AnyBound {
                match self { $(Self::$Element(t) => AnyBound::$Element(<$Element as Element<3>>::bound(t)),)+ }
            }
        }
    };
}

// The one list of families. A new one is added here.
families! {
    /// Springs along threads of the grid, along rims, along edges of cloth that is gathered or drawn in by elastic, and
    /// of tacks.
    springs: Spring,
    /// Threads of the triangles between the grid and the outline.
    threads: Thread,
    /// Shear of the grid's triangles and of those that have threads.
    shears: Shear,
}

/// The items that are wanted.
pub(super) fn those<T: Clone>(items: &[T], wanted: &[bool]) -> Vec<T> {
    items.iter().zip(wanted).filter(|(_, wanted)| **wanted).map(|(item, _)| item.clone()).collect()
}
