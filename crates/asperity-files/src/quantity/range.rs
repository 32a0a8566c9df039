//! The ranges that a quantity may be limited to. Each refuses NaN.

/// A set of numbers with its words.
pub trait Range {
    /// What an error message adds to "a length" ("greater than 0"); empty for any finite number.
    const WORDS: &'static str;
    /// What the schema adds to the name of the type ("Positive").
    const TITLE: &'static str;
    /// An example of its own, where the dimension's would mislead.
    const EXAMPLE: Option<&'static str> = None;
    /// Whether `value` is inside.
    fn contains(value: f64) -> bool;
    /// Adds the limits to the schema of a bare number, where it has any.
    fn limit(schema: &mut schemars::Schema);
}

macro_rules! range {
    ($(#[$doc:meta])* $type:ident, $words:literal, $title:literal, $example:expr,
     |$value:ident| $inside:expr, { $($keyword:literal : $limit:expr),* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $type;

        impl Range for $type {
            const WORDS: &'static str = $words;
            const TITLE: &'static str = $title;
            const EXAMPLE: Option<&'static str> = $example;

            fn contains($value: f64) -> bool {
                $inside
            }

            fn limit(_schema: &mut schemars::Schema) {
                $(_schema.insert($keyword.to_owned(), serde_json::json!($limit));)*
            }
        }
    };
}

range!(
    /// Any finite number.
    Finite, "", "", None, |v| v.is_finite(), {}
);
range!(
    /// Finite and greater than 0.
    Positive, "greater than 0", "Positive", None, |v| v.is_finite() && v > 0.0,
    { "exclusiveMinimum": 0 }
);
range!(
    /// Finite and not less than 0.
    NonNegative, "not less than 0", "NonNegative", None, |v| v.is_finite() && v >= 0.0,
    { "minimum": 0 }
);
range!(
    /// Greater than 0, or infinite: the radius of a flat.
    PositiveOrInfinite, "greater than 0 (\"inf\" for a flat)", "PositiveOrInfinite", None, |v| v > 0.0,
    { "exclusiveMinimum": 0 }
);
range!(
    /// Poisson's ratio of an isotropic solid: greater than -1, at most 0.5.
    Poisson, "greater than -1 and at most 0.5", "PoissonRatio", Some("0.38"), |v| v > -1.0 && v <= 0.5,
    { "exclusiveMinimum": -1, "maximum": 0.5 }
);
range!(
    /// Hurst exponent: greater than 0, at most 1.
    Hurst, "greater than 0 and at most 1", "HurstExponent", Some("0.8"), |v| v > 0.0 && v <= 1.0,
    { "exclusiveMinimum": 0, "maximum": 1 }
);
range!(
    /// A share of a whole: greater than 0, at most 1.
    Share, "greater than 0 and at most 1", "Share", Some("0.25"), |v| v > 0.0 && v <= 1.0,
    { "exclusiveMinimum": 0, "maximum": 1 }
);
range!(
    /// A relative tolerance: at least 1e-14 (rounding), less than 1.
    Tolerance, "from 1e-14 to 0.1", "Tolerance", Some("1e-6"), |v| (1e-14..=0.1).contains(&v),
    { "minimum": 1e-14, "maximum": 0.1 }
);
range!(
    /// Order of a fractional derivative: greater than 0, at most 1.
    Order, "greater than 0 and at most 1", "Order", Some("0.3"), |v| v > 0.0 && v <= 1.0,
    { "exclusiveMinimum": 0, "maximum": 1 }
);
range!(
    /// Number of times per decade.
    Density, "from 0.5 to 20", "Density", Some("3"), |v| (0.5..=20.0).contains(&v),
    { "minimum": 0.5, "maximum": 20 }
);
range!(
    /// Decades beyond measured data.
    Decades, "from 0 to 5", "Decades", Some("1"), |v| (0.0..=5.0).contains(&v),
    { "minimum": 0, "maximum": 5 }
);
