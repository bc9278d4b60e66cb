//! Whole numbers in JSON, as `2048` or `2048.0`: languages without integers write the second form.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{self, Deserialize, Deserializer, Visitor};

/// Limit above which an f64 cannot represent every whole number: 2^53.
const FLOAT_LIMIT: f64 = 9_007_199_254_740_992.0;

/// Reads a whole number that fits in `T`.
pub(crate) fn number<'de, T: TryFrom<u64>, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    Ok(Whole::deserialize(deserializer)?.0)
}

/// Reads two whole numbers, or `None` for `null`.
pub(crate) fn pair<'de, T: TryFrom<u64>, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[T; 2]>, D::Error> {
    let pair = Option::<[Whole<T>; 2]>::deserialize(deserializer)?;
    Ok(pair.map(|pair| pair.map(|Whole(number)| number)))
}

/// A whole number, read from either form.
struct Whole<T>(T);

impl<'de, T: TryFrom<u64>> Deserialize<'de> for Whole<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(WholeVisitor(PhantomData))
    }
}

struct WholeVisitor<T>(PhantomData<T>);

impl<T: TryFrom<u64>> Visitor<'_> for WholeVisitor<T> {
    type Value = Whole<T>;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("a whole number")
    }

    fn visit_u64<E: de::Error>(self, value: u64) -> Result<Whole<T>, E> {
        T::try_from(value).map(Whole).map_err(|_| E::custom(format_args!("{value} is too large")))
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Whole<T>, E> {
        let value = u64::try_from(value).map_err(|_| E::custom(format_args!("{value} is negative")))?;
        self.visit_u64(value)
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Whole<T>, E> {
        if value < 0.0 {
            return Err(E::custom(format_args!("{value:?} is negative")));
        }
        if value.fract() != 0.0 {
            return Err(E::custom(format_args!("{value:?} is not a whole number")));
        }
        if value >= FLOAT_LIMIT {
            return Err(E::custom(format_args!("{value:?} is too large")));
        }
        self.visit_u64(value as u64)
    }
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use crate::peers::error::parse_json;

    #[derive(Debug, PartialEq, Deserialize)]
    struct Numbers {
        #[serde(deserialize_with = "super::number")]
        side: u32,
        #[serde(default, deserialize_with = "super::pair")]
        sides: Option<[u32; 2]>,
    }

    #[test]
    fn whole_numbers_are_read_with_and_without_a_point() {
        for text in ["2048", "2048.0", "2.048e3", "204800e-2"] {
            let json = format!("{{\"side\": {text}, \"sides\": [{text}, 3.0]}}");
            let wanted = Numbers { side: 2048, sides: Some([2048, 3]) };
            assert_eq!(parse_json::<Numbers>(json.as_bytes()), Ok(wanted), "{text}");
        }
        let without = parse_json::<Numbers>(b"{\"side\": 0.0, \"sides\": null}");
        assert_eq!(without, Ok(Numbers { side: 0, sides: None }));
        assert_eq!(parse_json::<Numbers>(b"{\"side\": 4294967295.0}").map(|numbers| numbers.side), Ok(u32::MAX));
    }

    #[test]
    fn other_numbers_are_refused_with_the_reason() {
        let cases = [
            ("2048.5", "2048.5 is not a whole number"),
            ("-1.0", "-1.0 is negative"),
            ("-1", "-1 is negative"),
            ("-0.5", "-0.5 is negative"),
            ("4294967296", "4294967296 is too large"),
            ("4294967296.0", "4294967296 is too large"),
            ("1e300", "1e300 is too large"),
            ("\"2048\"", "invalid type: string \"2048\", expected a whole number"),
            ("null", "invalid type: null, expected a whole number"),
        ];
        for (text, reason) in cases {
            let refused = |json: String| {
                let problem = parse_json::<Numbers>(json.as_bytes()).expect_err("refused");
                problem.at(std::path::Path::new("a.json")).to_string()
            };
            let message = refused(format!("{{\"side\": {text}}}"));
            assert!(message.starts_with(&format!("a.json: side: {reason}")), "{message}");
            let message = refused(format!("{{\"side\": 1, \"sides\": [1, {text}]}}"));
            assert!(message.starts_with(&format!("a.json: sides[1]: {reason}")), "{message}");
        }
    }
}
