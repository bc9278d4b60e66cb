//! Reads the corpus files of a fuzz target in ordinary tests.

use std::path::PathBuf;

/// Runs a target on each file of its corpus, which must not be empty.
pub(crate) fn replay(target: &str, run: impl Fn(&[u8])) {
    // Set by cargo, or by the runner of a bundle of tests.
    let package =
        std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| env!("CARGO_MANIFEST_DIR").into(), PathBuf::from);
    // From the root of the repository, or from one of its crates.
    let folder = [".", "../.."].map(|root| package.join(root).join("tests/fuzz/corpus").join(target));
    let folder = folder.iter().find(|folder| folder.is_dir()).expect("a folder of the target's files");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let file = entry.expect("a file").path();
        println!("{}", file.display());
        run(&std::fs::read(&file).expect("a file"));
        count += 1;
    }
    assert!(count > 0, "{} has no files", folder.display());
}
