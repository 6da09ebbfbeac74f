//! The corpus of the fuzzer, once more: every text that it found worth keeping, those that it broke something with among
//! them.

use crate::common;

#[path = "../../fuzz/targets.rs"]
mod targets;

#[test]
fn nothing_in_the_corpus_breaks_anything() {
    let corpus = common::root().join("fuzz/corpus");
    for (name, target) in targets::TARGETS {
        let folder = std::fs::read_dir(corpus.join(name)).expect("a corpus");
        let mut texts: Vec<_> = folder.flatten().map(|entry| entry.path()).collect();
        texts.sort();
        assert!(!texts.is_empty(), "{name}");
        for path in texts {
            eprintln!("{}", path.display());
            target(&std::fs::read(path).expect("a text"));
        }
    }
}
