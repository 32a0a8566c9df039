//! The commented case files that `asperity new` writes and the cases of `asperity reproduce`: the examples of the repository
//! themselves.
//!
//! This crate stands in the folder of the examples because a published crate cannot hold files from outside of its
//! own folder; so each case exists once.

/// A starter case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Template {
    /// Its name, as `asperity new NAME` takes it.
    pub name: &'static str,
    /// The case file.
    pub text: &'static str,
    /// A small picture of its result, as PNG.
    pub picture: &'static [u8],
}

macro_rules! templates {
    ($($name:literal),*) => {
        /// All starter cases, the simplest first.
        pub const TEMPLATES: &[Template] =
            &[$(Template {
                name: $name,
                text: include_str!(concat!($name, ".toml")),
                picture: include_bytes!(concat!("pictures/", $name, ".png")),
            }),*];
    };
}

templates!(
    "hertz",
    "zener-step",
    "relaxation",
    "press-hold-retract",
    "cyclic",
    "creep-decades",
    "pmma-indentation",
    "flat-punch",
    "cylinder",
    "rolling-cylinder",
    "sliding-sphere",
    "rubber-friction",
    "subsurface-stress",
    "capped-cycle",
    "periodic-rough",
    "rough-pmma",
    "warming-rubber",
    "seal",
    "lip-seal",
    "gasket",
    "coated-steel",
    "gel-on-glass",
    "adhesive-sphere",
    "gel-adhesion",
    "fretting-sphere",
    "rough-fretting",
    "running-in",
    "fretting-wear",
    "tyre-flash"
);

/// Cases of the figures of Spinu and Cerlinca (2017), which `asperity reproduce` computes.
pub mod paper {
    /// Figure 1.
    pub const FIGURE_1: &str = include_str!("paper/fig1-zener-step.toml");
    /// Figure 2.
    pub const FIGURE_2: &str = include_str!("paper/fig2-capped-sphere.toml");
    /// Figure 4.
    pub const FIGURE_4: &str = include_str!("paper/fig4-pmma-triangle.toml");
    /// Figures 5 to 8.
    pub const FIGURES_5_TO_8: &str = include_str!("paper/fig5-8-rough-pmma.toml");
}

impl Template {
    /// The starter case of that name.
    ///
    /// ```
    /// use asperity_examples::Template;
    /// assert!(Template::find("hertz").is_some_and(|hertz| hertz.text.contains("kind = \"sphere\"")));
    /// ```
    pub fn find(name: &str) -> Option<&'static Template> {
        TEMPLATES.iter().find(|template| template.name == name)
    }

    /// What the case is, from its title.
    pub fn title(&self) -> &'static str {
        let line = self.text.lines().find_map(|line| line.strip_prefix("title = "));
        line.unwrap_or_default().trim_matches('"')
    }
}
