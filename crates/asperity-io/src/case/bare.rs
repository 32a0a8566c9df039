//! Numbers of a case without a unit: they are in SI, and `check` lists their keys.

use toml::de::DeValue;

use super::schema;
use super::text::Text;

/// The keys of quantities that the case in `source` gives as bare numbers, each list once. 0 needs no unit.
pub fn bare_numbers(source: &str) -> Vec<String> {
    let mut keys: Vec<String> = vec![];
    let Ok(text) = Text::parse(source) else { return keys };
    text.visit(&mut |path, _, value| {
        let number = match value.get_ref() {
            DeValue::Integer(whole) => i64::from_str_radix(whole.as_str(), whole.radix()).unwrap_or(0) as f64,
            DeValue::Float(real) => real.as_str().parse().unwrap_or(0.0),
            _ => return,
        };
        // A list is named once.
        let key = path.trim_end_matches(|c: char| c == '[' || c == ']' || c.is_ascii_digit());
        let key = if path.ends_with(']') { key } else { path };
        let known = keys.last().is_some_and(|last| last == key);
        if number != 0.0 && number.is_finite() && !known && schema::has_unit(path) {
            keys.push(key.to_owned());
        }
    });
    keys
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_of_bare_quantities_are_named_and_pure_numbers_are_not() {
        let case = r#"
            [domain]
            cells = [64, 64]
            size = [1e-3, "1 mm"]
            [[surface]]
            kind = "sphere"
            radius = 0.01
            [[surface]]
            kind = "self-affine"
            hurst = 0.8
            rms_gradient = 0.1
            longest = "1 mm"
            shortest = 2e-5
            seed = 1
            [[body]]
            poisson = 0.38
            material = { model = "prony", modulus = "young", equilibrium = 2e9, terms = [{ modulus = "1 GPa", time = 3 }] }
            [load]
            control = "load"
            history = { kind = "table", points = [[0, 0], ["1 s", 0.5], ["2 s", 0]] }
            [time]
            end = "2 s"
            steps = 4
        "#;
        let expected = [
            "body[0].material.equilibrium",
            "body[0].material.terms[0].time",
            "domain.size",
            "load.history.points",
            "surface[0].radius",
            "surface[1].shortest",
        ];
        let mut found = bare_numbers(case);
        found.sort();
        assert_eq!(found, expected);
        for template in asperity_examples::TEMPLATES {
            assert_eq!(bare_numbers(template.text), Vec::<String>::new(), "{}", template.name);
        }
    }
}
