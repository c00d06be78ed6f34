//! What the tests of the formats share.

/// Asserts that the outcome is an error of this pattern.
macro_rules! assert_refused {
    ($outcome:expr => $($error:tt)+) => {
        let outcome = $outcome;
        assert!(matches!(outcome, Err(crate::FormatError::$($error)+)), "{outcome:?}");
    };
}
