//! What the history of a surface says about its border.

use super::Window;

/// The sentence of [`mirror`](super::mirror()).
pub(super) const MIRRORED: &str = "continue by reflections along each axis (mirror)";
/// How the sentence of [`crop`](super::crop()) begins.
pub(super) const CUT: &str = "crop to";

/// How opposite borders of a surface meet on a periodic domain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Border {
    /// As they are.
    #[default]
    AsMeasured,
    /// At height zero: the border is flat, a dam across every flow.
    Windowed,
    /// As mirror images.
    Mirrored,
}

impl Border {
    /// The border after these steps, each in the words of its [`Operation`](super::Operation). A crop cuts off what was done to the
    /// border before it, and the reflections of a windowed surface stay flat where it was windowed.
    ///
    /// ```
    /// use asperity::surface::{Operation, process::{Border, Window}};
    /// let [window, mirror] = [Operation::Window(Window::Hann), Operation::Mirror].map(|step| step.to_string());
    /// let crop = Operation::Crop { from: [1, 1], cells: [4, 4] }.to_string();
    /// assert_eq!(Border::after([mirror.as_str(), "invert"]), Border::Mirrored);
    /// assert_eq!(Border::after([window.as_str(), &mirror]), Border::Windowed);
    /// assert_eq!(Border::after([mirror.as_str(), &crop]), Border::AsMeasured);
    /// ```
    pub fn after<'a>(history: impl IntoIterator<Item = &'a str>) -> Border {
        history.into_iter().fold(Border::default(), |border, step| match border {
            _ if step.starts_with(CUT) => Border::AsMeasured,
            _ if Window::is_told_by(step) => Border::Windowed,
            Border::AsMeasured if step == MIRRORED => Border::Mirrored,
            border => border,
        })
    }
}
