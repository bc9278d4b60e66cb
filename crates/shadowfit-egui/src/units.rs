//! Lengths and counts as text for people.

/// Formats width and height in the unit that suits the greater one.
pub(crate) fn size([u, v]: [f32; 2]) -> String {
    let (unit, scale) = unit(u.max(v));
    format!("{} × {} {unit}", short(u * scale), short(v * scale))
}

pub(crate) fn length(metres: f32) -> String {
    let (unit, scale) = unit(metres);
    format!("{} {unit}", short(metres * scale))
}

/// Formats a number with three digits, or with two decimals below 1.
pub(crate) fn short(value: f32) -> String {
    let decimals = match value.abs() {
        v if v >= 99.95 => 0,
        v if v >= 9.995 => 1,
        _ => 2,
    };
    format!("{value:.decimals$}")
}

/// Formats a share in per cent, with two decimals below 10.
pub(crate) fn percent(share: f32) -> String {
    format!("{}\u{a0}%", percent_number(share))
}

/// Formats the number of a share in per cent, without its sign.
pub(crate) fn percent_number(share: f32) -> String {
    match share {
        s if s > 0.0 && s < 0.005 => "<\u{2009}0.01".to_owned(),
        s if s < 9.995 => format!("{s:.2}"),
        s => format!("{s:.1}"),
    }
}

/// Formats a count in thousands, millions or billions, with three digits.
pub(crate) fn brief_count(count: f64) -> String {
    let (scale, suffix) = match count.abs() {
        c if c >= 999.5e6 => (1e-9, "\u{a0}G"),
        c if c >= 999.5e3 => (1e-6, "\u{a0}M"),
        c if c >= 999.5 => (1e-3, "\u{a0}k"),
        _ => return format!("{count:.0}"),
    };
    format!("{}{suffix}", short((count * scale) as f32))
}

/// Returns the unit that suits a length, and the number of these units in a metre.
fn unit(metres: f32) -> (&'static str, f32) {
    match metres.abs() {
        m if m >= 1000.0 => ("km", 1e-3),
        m if m >= 1.0 => ("m", 1.0),
        m if m >= 0.01 => ("cm", 1e2),
        m if m >= 1e-4 => ("mm", 1e3),
        m if m == 0.0 || m.is_nan() => ("m", 1.0),
        _ => ("µm", 1e6),
    }
}

/// Formats a count with its digits in groups of three.
pub(crate) fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push('\u{a0}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_grouped_by_thousands() {
        for (count, text) in [(0, "0"), (999, "999"), (1000, "1 000"), (262_144, "262 144"), (1_000_000, "1 000 000")] {
            assert_eq!(grouped(count).replace('\u{a0}', " "), text);
        }
    }

    #[test]
    fn small_shares_are_not_rounded_to_nothing() {
        let shares = [(0.0, "0.00 %"), (0.001, "< 0.01 %"), (0.125, "0.12 %"), (2.134, "2.13 %"), (42.34, "42.3 %")];
        for (share, text) in shares {
            assert_eq!(percent(share).replace(['\u{a0}', '\u{2009}'], " "), text);
        }
    }

    #[test]
    fn large_counts_are_brief() {
        for (count, text) in [(0.0, "0"), (999.0, "999"), (4096.0, "4.10 k"), (4_194_304.0, "4.19 M"), (2e9, "2.00 G")]
        {
            assert_eq!(brief_count(count).replace('\u{a0}', " "), text);
        }
    }

    #[test]
    fn lengths_read_in_a_fitting_unit() {
        for (metres, text) in [
            (2345.0, "2.35 km"),
            (999.7, "1000 m"),
            (110.0, "110 m"),
            (9.999, "10.0 m"),
            (0.029, "2.90 cm"),
            (0.0034, "3.40 mm"),
            (0.000_013, "13.0 µm"),
            (0.0, "0.00 m"),
        ] {
            assert_eq!(length(metres), text);
        }
        assert_eq!(size([0.03, 0.005]), "3.00 × 0.50 cm");
    }
}
