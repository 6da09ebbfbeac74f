//! Ctrl-C, and being asked to end: with a word, and never between two halves of a file.

use std::io::{IsTerminal, stderr};

use gumption::files::write;

use super::language::spoken;
use super::output;

/// The exit code that shells give to what Ctrl-C has ended: 128 and the number of the signal.
const INTERRUPTED: i32 = 130;

/// From now on an interrupt ends the program when no file is being written, and says what there is of its work.
pub(super) fn say_so() {
    // Where it cannot be set, the system ends the program without a word.
    let _ = ctrlc::set_handler(|| {
        let written = write::stop();
        if stderr().is_terminal() {
            output::passing("");
        }
        output::warn(match written {
            _ if output::is_printing() => spoken().pick(
                "interrupted: the table on standard output is not whole: it has what was done until then\n",
                "已中断：标准输出上的表格不完整，只有至此已完成的部分\n",
            ),
            0 => spoken().pick(
                "interrupted: nothing is written\n",
                "已中断：没有写出任何文件\n",
            ),
            _ => spoken().pick(
                "interrupted: the files that were written are whole\n",
                "已中断：已写出的文件是完整的\n",
            ),
        });
        std::process::exit(INTERRUPTED);
    });
}
