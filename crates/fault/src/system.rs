//! Why the operating system refuses something, in the language of the reader.

use std::io::{Error, ErrorKind};

use crate::said::{Inserted, Said, Value, say};

/// The reason in the words of the program, where it is one that users meet; else as the system has it. What another part
/// of the program wrapped into an error is its own text.
pub fn of_system(error: &Error) -> Said {
    let own = || Said::quoted(error.to_string());
    if error.get_ref().is_some() {
        return own();
    }
    match error.kind() {
        ErrorKind::NotFound => say!("there is no such file or folder"),
        ErrorKind::PermissionDenied => say!("the system does not permit it"),
        ErrorKind::AlreadyExists => say!("it exists already"),
        ErrorKind::IsADirectory => say!("it is a folder"),
        ErrorKind::NotADirectory => say!("part of the path is no folder"),
        ErrorKind::StorageFull => say!("no space is left on the disk"),
        ErrorKind::QuotaExceeded => say!("the disk quota is used up"),
        ErrorKind::ReadOnlyFilesystem => say!("the disk may only be read"),
        ErrorKind::FileTooLarge => say!("the file is too large"),
        ErrorKind::InvalidFilename => say!("no file can have this name"),
        ErrorKind::OutOfMemory => say!("there is not enough memory"),
        ErrorKind::TimedOut => say!("the time is up"),
        ErrorKind::AddrInUse => say!("another program uses this address"),
        ErrorKind::AddrNotAvailable => say!("this machine has no such address"),
        ErrorKind::InvalidData => say!("the data are damaged, or no text in UTF-8"),
        ErrorKind::UnexpectedEof => say!("the data end too early"),
        _ => own(),
    }
}

/// [`say!`] draws an error of the system in the language of the whole.
impl Inserted<'_, Error> {
    /// The value.
    pub fn value(self) -> Value {
        Value::Said(of_system(self.0))
    }
}

impl Inserted<'_, &Error> {
    /// The value.
    pub fn value(self) -> Value {
        Value::Said(of_system(self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::Language;

    #[test]
    fn the_system_speaks_the_language_of_the_sentence() {
        let missing = Error::from(ErrorKind::NotFound);
        let said = say!("{missing}");
        assert_eq!(said, "there is no such file or folder");
        assert_eq!(said.in_language(Language::Chinese), "没有这个文件或文件夹");
        let odd = Error::from_raw_os_error(40);
        assert_eq!(of_system(&odd).to_string(), odd.to_string());
        let own = Error::new(ErrorKind::InvalidData, "too many links");
        assert_eq!(of_system(&own), "too many links");
    }
}
