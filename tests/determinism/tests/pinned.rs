//! The hash over all fits on the machine that runs the tests.

use shadowfit_determinism::chunk::{self, Kind};
use shadowfit_determinism::{FITS, HASH, NUMBERS, Outcome, numbers, outcome};

#[test]
fn ten_thousand_fits_have_the_same_bits_as_everywhere_else() {
    let Outcome { hash, fits, refused } = outcome();
    assert!(fits >= FITS, "{fits} fits");
    assert!(refused < FITS / 20, "{refused} inputs were refused: they say little");
    assert_eq!(hash, HASH, "the fits' hash is {hash:#018x}; pin it if fits were changed on purpose");
}

#[test]
fn the_same_settings_give_the_same_numbers_as_ever() {
    let numbers = numbers();
    assert_eq!(numbers, NUMBERS, "engines get other numbers: {numbers:#018x?}");
}

#[test]
fn random_fits_are_finite_and_their_hash_follows_from_seed_and_chunk() {
    for kind in [Kind::Cascades, Kind::Windows] {
        let run = |seed, index| chunk::run(kind, seed, index).expect("finite numbers");
        let hash = run(1, 0);
        assert_eq!(run(1, 0), hash);
        assert!(run(1, 1) != hash && run(2, 0) != hash);
    }
}
