//! How a file is known to be as this program wrote it.
//!
//! Length and checksum of what was written is kept as an extended attribute of the file, `user.gumption`. A file that has it,
//! and whose content still gives it, holds nothing that anybody else has written. Editors, copies, archives and
//! version control drop the attribute or change the content, and then the file is somebody's work; so it is on file
//! systems and systems that keep no attributes. The mark is never needed to read a file.

use std::fs::File;
use std::path::Path;

/// Notes on an open file that this is its content. What cannot be noted makes the file somebody's work.
pub(super) fn set(file: &File, digest: &Digest) {
    system::set(file, &digest.noted());
}

/// Notes on an open file that its content is somebody's.
pub(super) fn clear(file: &File) {
    system::set(file, b"");
}

/// Whether a file is as this program wrote it.
pub(super) fn is_ours(path: &Path) -> bool {
    let Ok(file) = File::open(path) else {
        return false;
    };
    let Some(noted) = system::get(&file) else {
        return false;
    };
    super::content_of(path).is_ok_and(|content| Digest::of(&content).noted() == noted)
}

/// Length and the sum of Fowler, Noll and Vo (FNV-1a, 64 bits): against accident, not against intent.
pub(super) struct Digest {
    length: u64,
    sum: u64,
}

impl Default for Digest {
    /// Of nothing.
    fn default() -> Self {
        const BASIS: u64 = 0xcbf2_9ce4_8422_2325;
        Digest {
            length: 0,
            sum: BASIS,
        }
    }
}

impl Digest {
    /// Of a content that is at hand.
    pub(super) fn of(content: &[u8]) -> Digest {
        let mut digest = Digest::default();
        digest.add(content);
        digest
    }

    /// Of what was there, and this behind it.
    pub(super) fn add(&mut self, content: &[u8]) {
        const PRIME: u64 = 0x0100_0000_01b3;
        let mix = |sum: u64, byte: &u8| (sum ^ u64::from(*byte)).wrapping_mul(PRIME);
        self.sum = content.iter().fold(self.sum, mix);
        self.length += content.len() as u64;
    }

    fn noted(&self) -> Vec<u8> {
        format!("{}:{:016x}", self.length, self.sum).into_bytes()
    }
}

#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
mod system {
    use std::fs::File;

    use rustix::fs::{XattrFlags, fgetxattr, fsetxattr};

    const NAME: &str = "user.gumption";

    pub fn set(file: &File, digest: &[u8]) {
        let _ = fsetxattr(file, NAME, digest, XattrFlags::empty());
    }

    pub fn get(file: &File) -> Option<Vec<u8>> {
        let mut digest = vec![0; 64];
        let length = fgetxattr(file, NAME, digest.as_mut_slice()).ok()?;
        digest.truncate(length);
        Some(digest)
    }
}

#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
mod system {
    use std::fs::File;

    pub fn set(_: &File, _: &[u8]) {}

    pub fn get(_: &File) -> Option<Vec<u8>> {
        None
    }
}
