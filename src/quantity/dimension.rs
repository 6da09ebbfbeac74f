//! The dimension of a quantity: exponents of the base quantities.

/// Exponents of length, mass, time, electric current, thermodynamic temperature, amount of
/// substance, luminous intensity, and logarithmic level (dB, Np), each in sixtieths so that
/// square and cube roots stay exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Dimension(pub [i16; 8]);
