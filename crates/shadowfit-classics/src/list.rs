//! The list of samples, and look-up by name.

use crate::sample::{Sample, SampleVariant};
use crate::{ambient_occlusion, comparison, headlight, parallel_split, sky_box, terrain, xna};

/// Every sample, in the order of the documentation.
pub static SAMPLES: [Sample; 8] = [
    xna::SAMPLE,
    headlight::projective::SAMPLE,
    headlight::real_shadow::SAMPLE,
    comparison::SAMPLE,
    terrain::SAMPLE,
    parallel_split::SAMPLE,
    ambient_occlusion::SAMPLE,
    sky_box::SAMPLE,
];

impl Sample {
    /// Returns the sample with a name.
    pub fn find(id: &str) -> Option<&'static Self> {
        SAMPLES.iter().find(|sample| sample.id == id)
    }

    /// Returns the sample and the variant of a name such as `xna-shadow-mapping/acne`.
    pub fn find_with_variant(name: &str) -> Option<(&'static Self, Option<&'static SampleVariant>)> {
        let (id, variant) = name.split_once('/').map_or((name, None), |(id, variant)| (id, Some(variant)));
        let sample = Self::find(id)?;
        match variant {
            None => Some((sample, None)),
            Some(variant) => Some((sample, Some(sample.variants.iter().find(|known| known.id == variant)?))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::SampleValues;

    #[test]
    fn names_are_found_and_unlike() {
        for (index, sample) in SAMPLES.iter().enumerate() {
            assert_eq!(SAMPLES.iter().position(|other| other.id == sample.id), Some(index));
            let (found, none) = Sample::find_with_variant(sample.id).expect("a sample");
            assert!(core::ptr::eq(found, Sample::find(sample.id).expect("a sample")) && none.is_none());
            for variant in sample.variants {
                let name = format!("{}/{}", sample.id, variant.id);
                let (_, found) = Sample::find_with_variant(&name).expect("a sample with a variant");
                assert!(found.is_some_and(|found| core::ptr::eq(found, variant)), "{name}");
            }
        }
        assert!(Sample::find_with_variant("xna-shadow-mapping/no-such").is_none());
        assert!(Sample::find("no-such").is_none());
    }

    #[test]
    fn the_options_of_every_variant_are_possible() {
        for sample in &SAMPLES {
            for variant in sample.variants {
                SampleValues::of_variant(sample, Some(variant))
                    .unwrap_or_else(|error| panic!("{}: {error}", variant.id));
            }
        }
    }
}
