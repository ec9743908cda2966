//! The numbers that matrices are made of.

mod private {
    /// Keeps faer's number trait out of the public bound.
    pub trait Field: faer::traits::ComplexField<Real = Self> + faer::traits::RealField {}
    impl Field for f32 {}
    impl Field for f64 {}
}

/// The numbers a matrix may be made of: `f64`, or `f32` where a Newton direction need not be exact (half the memory,
/// measurably faster).
pub trait Scalar:
    private::Field
    + Copy
    + Send
    + Sync
    + std::fmt::Debug
    + std::ops::AddAssign
    + std::ops::SubAssign
    + std::ops::Add<Output = Self>
    + std::ops::Mul<Output = Self>
    + std::ops::Div<Output = Self>
{
    /// The nearest value.
    fn from_f64(value: f64) -> Self;
    /// The value as `f64`.
    fn to_f64(self) -> f64;
}

impl Scalar for f64 {
    #[inline]
    fn from_f64(value: f64) -> Self {
        value
    }
    #[inline]
    fn to_f64(self) -> f64 {
        self
    }
}

impl Scalar for f32 {
    #[inline]
    fn from_f64(value: f64) -> Self {
        value as f32
    }
    #[inline]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
}
