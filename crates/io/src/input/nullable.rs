//! Numbers of result files: null, as JSON writes what is no number, is read back as NaN.

use serde::{Deserialize, Deserializer};

/// One number.
pub fn number<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

/// A list of them.
pub fn numbers<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
    let read: Vec<Option<f64>> = Vec::deserialize(deserializer)?;
    Ok(read.into_iter().map(|x| x.unwrap_or(f64::NAN)).collect())
}

/// Two of them.
pub fn pair<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 2], D::Error> {
    Ok(<[Option<f64>; 2]>::deserialize(deserializer)?.map(|x| x.unwrap_or(f64::NAN)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Serialize;

    #[derive(Serialize, Deserialize)]
    struct Page {
        #[serde(deserialize_with = "number")]
        one: f64,
        #[serde(deserialize_with = "numbers")]
        many: Vec<f64>,
        #[serde(deserialize_with = "pair")]
        two: [f64; 2],
    }

    #[test]
    fn what_is_no_number_comes_back_as_such() {
        let page = Page { one: f64::INFINITY, many: vec![1.5, f64::NAN], two: [f64::NAN, -2.0] };
        let text = serde_json::to_string(&page).expect("JSON");
        assert_eq!(text, r#"{"one":null,"many":[1.5,null],"two":[null,-2.0]}"#);
        let read: Page = serde_json::from_str(&text).expect("it was just written");
        assert!(read.one.is_nan() && read.many[1].is_nan() && read.two[0].is_nan());
        assert_eq!((read.many[0], read.two[1]), (1.5, -2.0));
    }
}
