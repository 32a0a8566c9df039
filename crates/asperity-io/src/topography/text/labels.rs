//! The labels of Gwyddion's text exports in the languages of its user interface.

/// What a label stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Label {
    Channel,
    Width,
    Height,
    LateralUnits,
    ValueUnits,
}

/// English, Czech, German, Spanish, French, Italian, Japanese, Korean, Portuguese, Russian. Other languages are
/// understood by the order of the lines (see `header`).
pub(super) fn label(text: &str) -> Option<Label> {
    const CHANNEL: &[&str] = &["channel", "kanál", "kanal", "canal", "canale", "チャネル", "채널", "канал"];
    const WIDTH: &[&str] = &[
        "width",
        "šířka",
        "breite",
        "anchura",
        "ancho",
        "largeur",
        "larghezza",
        "幅",
        "폭",
        "largura",
        "ширина",
        "宽度",
    ];
    const HEIGHT: &[&str] = &[
        "height",
        "výška",
        "höhe",
        "altura",
        "alto",
        "hauteur",
        "altezza",
        "高さ",
        "높이",
        "высота",
        "高度",
    ];
    const LATERAL: &[&str] = &["lateral units"];
    const VALUE: &[&str] = &[
        "value units",
        "jednotky hodnot",
        "einheiten",
        "werteinheiten",
        "unités",
        "unità valore",
        "値の単位",
        "값 단위",
        "unidades de valor",
        "unidades",
        "единицы измерения",
        "единицы значений",
    ];
    let text = text.trim().to_lowercase();
    let is = |labels: &[&str]| labels.contains(&text.as_str());
    Some(match () {
        () if is(CHANNEL) => Label::Channel,
        () if is(WIDTH) => Label::Width,
        () if is(HEIGHT) => Label::Height,
        () if is(LATERAL) => Label::LateralUnits,
        () if is(VALUE) => Label::ValueUnits,
        () => return None,
    })
}
