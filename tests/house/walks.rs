//! Additions touch one place.
