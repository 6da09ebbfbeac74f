//! Tests of the model language as its users see it.
