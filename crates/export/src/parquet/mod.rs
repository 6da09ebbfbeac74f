//! Tables as Apache Parquet: read and written some rows at a time, so that their length does not matter.

mod read;
mod write;

pub use read::Rows;
pub use write::Writer;
