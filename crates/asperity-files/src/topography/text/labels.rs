//! The labels of Gwyddion's text exports in the languages of its user interface.

/// English, Czech, German, Spanish, French, Italian, Japanese, Korean, Portuguese, Russian, between bars. Other languages are
/// understood by the order of the lines (see `header`).
const LABELS: [&str; 5] = [
    "channel|kanál|kanal|canal|canale|チャネル|채널|канал",
    "width|šířka|breite|anchura|ancho|largeur|larghezza|幅|폭|largura|ширина|宽度",
    "height|výška|höhe|altura|alto|hauteur|altezza|高さ|높이|высота|高度",
    "lateral units",
    "value units|jednotky hodnot|einheiten|werteinheiten|unités|unità valore|値の単位|값 단위|unidades de valor|unidades|\
     единицы измерения|единицы значений",
];

/// A label in lower case; one of Gwyddion's labels in English.
pub(super) fn in_english(label: &str) -> String {
    let label = label.trim().to_lowercase();
    let known = LABELS.iter().find(|words| words.split('|').any(|word| word == label));
    known.and_then(|words| words.split('|').next()).map_or(label.clone(), str::to_owned)
}
