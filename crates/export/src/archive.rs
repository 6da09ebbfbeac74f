//! Archives: files with their names in one file, the same bytes for the same files.

use std::io::{Cursor, Read, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter};

/// A file of an archive: its name with `/` between its parts, and what it holds.
pub type Member = (String, Vec<u8>);

/// Most bytes of all files of an archive that is read.
const MOST: u64 = 1 << 30;

/// Puts files into one.
///
/// # Errors
/// In the words of the library: there are too many files, or they are too large.
pub fn packed(members: &[Member]) -> Result<Vec<u8>, String> {
    // No clock is read.
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default());
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in members {
        archive
            .start_file(name.as_str(), options)
            .map_err(|error| error.to_string())?;
        archive
            .write_all(content)
            .map_err(|error| error.to_string())?;
    }
    let packed = archive.finish().map_err(|error| error.to_string())?;
    Ok(packed.into_inner())
}

/// The files of an archive.
///
/// # Errors
/// In the words of the library: it is no archive, it is damaged, or its files are too large.
pub fn unpacked(bytes: &[u8]) -> Result<Vec<Member>, String> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| error.to_string())?;
    let (mut members, mut left) = (Vec::new(), MOST);
    for at in 0..archive.len() {
        let file = archive.by_index(at).map_err(|error| error.to_string())?;
        if file.is_dir() {
            continue;
        }
        let name = file.name().map_err(|error| error.to_string())?;
        let name = name.into_owned();
        let mut content = Vec::new();
        let mut limited = file.take(left + 1);
        limited
            .read_to_end(&mut content)
            .map_err(|error| error.to_string())?;
        left = left
            .checked_sub(content.len() as u64)
            .ok_or_else(|| format!("its files have more than {} MiB", MOST >> 20))?;
        members.push((name, content));
    }
    Ok(members)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_come_out_as_they_went_in() {
        let members = vec![
            ("a.toml".to_owned(), b"x = 1".to_vec()),
            ("data/b.csv".to_owned(), vec![0, 255, 10]),
        ];
        let bytes = packed(&members).expect("an archive");
        assert_eq!(bytes, packed(&members).expect("an archive"));
        assert_eq!(unpacked(&bytes), Ok(members));
        assert!(unpacked(b"PK nothing").is_err());
        assert!(unpacked(&bytes[..bytes.len() / 2]).is_err());
    }
}
