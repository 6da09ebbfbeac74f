//! Special functions, accurate over their whole range.
