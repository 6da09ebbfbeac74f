//! Lists.

use gumption_format::toml::Stated;

/// Values with their places.
pub(super) type List<T> = Vec<Stated<T>>;
