//! Facts of whole figures.

use asperity_io::output::WriteError;
use ndarray::Array2;
use roxmltree::Document;

use super::*;

fn curve() -> Curves {
    let x: Vec<f64> = (1..=100).map(|i| f64::from(i) * 1e-3).collect();
    let y: Vec<f64> = x.iter().map(|x| 3e8 / (1.0 + x)).collect();
    Curves::new("Relaxation <1 & 2>", Axis::log("time", "s"), Axis::linear("modulus", "Pa"))
        .with(Series::new("data", Style::Points, x.clone(), y.clone()))
        .with(Series::new("fit", Style::Line, x, y))
}

fn map() -> Map {
    let values =
        Array2::from_shape_fn((40, 30), |(i, j)| if i == j { f64::NAN } else { (i * j) as f64 * 1e-9 });
    Map::new("Heights", ["height", "m"], Colours::Sequential, values.view(), [4e-5, 3e-5])
}

fn figure() -> Figure {
    Figure::new("Two panels").with(curve()).with(map()).caption("Grey: undefined.")
}

#[test]
fn a_figure_is_well_formed_and_says_its_units() {
    let svg = figure().to_svg();
    let document = Document::parse(&svg).unwrap();
    let texts: Vec<_> =
        document.descendants().filter(|n| n.has_tag_name("text")).filter_map(|n| n.text()).collect();
    for text in [
        "Two panels",
        "Relaxation <1 & 2>",
        "time [ms]",
        "modulus [MPa]",
        "data",
        "fit",
        "x [µm]",
        "height [µm]",
        "10 µm",
    ] {
        assert!(texts.contains(&text), "{text}: {texts:?}");
    }
    assert_eq!(document.descendants().filter(|n| n.has_tag_name("circle")).count(), 101);
    assert_eq!(document.descendants().filter(|n| n.has_tag_name("image")).count(), 2);
}

#[test]
fn the_same_figure_has_the_same_bytes() {
    assert_eq!(figure().to_svg(), figure().to_svg());
    assert_eq!(figure().to_png(100.0).unwrap(), figure().to_png(100.0).unwrap());
}

#[test]
fn nothing_of_a_panel_leaves_the_paper() {
    assert_all_inside(&figure());
}

/// Every text begins and ends on the paper.
fn assert_all_inside(figure: &Figure) {
    let svg = figure.to_svg();
    let document = Document::parse(&svg).unwrap();
    let [width, height] = figure.paper().map(|side| side / figure.zoom);
    for node in document.descendants().filter(|n| n.has_tag_name("text")) {
        let number = |name| node.attribute(name).unwrap().parse::<f64>().unwrap();
        let (x, y, size) = (number("x"), number("y"), number("font-size"));
        let long = font::width(node.text().unwrap(), size);
        let upward = node.attribute("transform").is_some();
        let (before, after) = match node.attribute("text-anchor") {
            Some("start") => (0.0, long),
            Some("end") => (long, 0.0),
            _ => (0.5 * long, 0.5 * long),
        };
        let inside = if upward {
            x - size >= 0.0 && x <= width && y - before >= 0.0 && y + after <= height
        } else {
            x - before >= 0.0 && x + after <= width && y - size >= 0.0 && y <= height
        };
        assert!(inside, "{:?} at {x}, {y}", node.text());
    }
}

/// Four panels like those of a result over time, with long names.
fn evolution() -> Figure {
    let panel = |title: &str| {
        let names = ["nominal mean", "largest", "mean over the contact"];
        let line = |name: &&str| Series::new(*name, Style::Line, vec![1.0, 1e8], vec![1e5, 3e6]);
        let axes = [Axis::log("time", "s"), Axis::linear("pressure", "Pa")];
        let [x, y] = axes;
        names.iter().map(line).fold(Curves::new(title, x, y), Curves::with)
    };
    ["a", "b", "c", "d"]
        .map(panel)
        .into_iter()
        .fold(Figure::new("Rubber under a load"), |figure, panel| figure.with(panel))
}

#[test]
fn a_column_of_a_journal_is_wide_enough_and_small_paper_has_smaller_texts() {
    let points = |mm: f64| mm * 72.0 / 25.4;
    for size in [[84.0, 105.0], [80.0, 60.0], [90.0, 110.0], [160.0, 100.0]] {
        let paper = size.map(points);
        for figure in [figure(), evolution()] {
            let sized = figure.sized(paper).unwrap();
            assert_eq!(sized.paper(), paper);
            assert_all_inside(&sized);
        }
    }
    let usual = evolution().sized([160.0, 120.0].map(points)).unwrap();
    assert_eq!((usual.zoom, usual.columns), (1.0, 2));
    assert!(evolution().sized([80.0, 60.0].map(points)).unwrap().zoom < 1.0);
    let refused = evolution().sized([30.0, 30.0].map(points)).unwrap_err();
    let FigureError::Size { needed, .. } = refused else { panic!("{refused}") };
    assert!(evolution().sized(needed).is_ok());
}

#[test]
fn words_that_would_overlap_on_small_paper_are_refused() {
    let points = |mm: f64| mm * 72.0 / 25.4;
    let stress = Map::new(
        "Section y = 352.7 µm",
        ["largest principal stress", "Pa"],
        Colours::Sequential,
        Array2::from_shape_fn((8, 8), |(i, j)| 1e9 * (i + j) as f64).view(),
        [7e-4; 2],
    );
    let six = (0..6).fold(Figure::new(""), |figure, _| figure.with(stress.clone())).columns(3);
    let Err(FigureError::Size { needed, .. }) = six.clone().sized([80.0, 60.0].map(points)) else {
        panic!("six maps with long words fit on 80 mm x 60 mm")
    };
    let enough = six.sized(needed).unwrap();
    assert_eq!(enough.whole(&enough.places()), 6);
}

#[test]
fn a_thumbnail_takes_the_room_of_its_map() {
    // Spikes lie beyond the ends of the colours and are told beside the bar.
    let mut spiked = Array2::from_shape_fn((60, 60), |(i, j)| (i + j) as f64 * 1e-9);
    spiked[[3, 4]] = 4.123e-5;
    spiked[[5, 4]] = -3.2e-5;
    let spiked = Map::new("", ["height", "m"], Colours::Sequential, spiked.view(), [1e-3, 1e-3]);
    let none = Array2::zeros((9, 9));
    let none = Map::new("", ["pressure", "Pa"], Colours::Pressure, none.view(), [1e-3, 1e-3]);
    for map in [map(), spiked, none] {
        let place = Place { corner: [0.0; 2], size: [200.0; 2], margins: Margins::default() };
        assert_eq!(map.frame(&place), map.thumbnail().frame(&place));
    }
}

#[test]
fn a_long_title_is_wrapped() {
    let long = Figure { title: "a title of many words ".repeat(10), ..figure() };
    assert_eq!(long.paper()[0], figure().paper()[0]);
    assert!(long.paper()[1] > figure().paper()[1] + 2.0 * LARGE);
    assert_all_inside(&long);
}

#[test]
fn a_narrow_area_is_stretched_and_has_numbers_at_both_axes() {
    for size in [[4e-5, 4e-3], [4e-3, 4e-5]] {
        let narrow = Map { size, ..map() };
        let (axis, times) = narrow.stretched().unwrap();
        // A hundred times as long as broad, drawn eight times as long.
        assert!((times - 12.5).abs() < 1e-9 && axis == if size[0] < size[1] { "x" } else { "y" });
        let figure = Figure::new("").with(narrow);
        assert_all_inside(&figure);
        assert!(!figure.to_svg().contains(">1 mm<"), "a scale bar is longer than the map is broad");
    }
    assert_eq!(map().stretched(), None);
}

#[test]
fn letters_that_the_typeface_lacks_are_told() {
    let figure = Figure { title: "接触 of a 接 µm".into(), ..figure() };
    assert_eq!(figure.missing_letters(), ['接', '触']);
    assert!(figure.to_svg().contains("接触"));
}

#[test]
fn a_map_of_the_gap_where_all_touches_has_no_colour_bar() {
    let of = |value: f64| {
        let values = Array2::from_elem((4, 4), value);
        let map = Map::new("", ["gap", "m"], Colours::Gap, values.view(), [1e-3, 1e-3]);
        Figure::new("").with(map).to_svg().matches("<image").count()
    };
    // A negative gap is an overlap at the hardness.
    assert_eq!([of(0.0), of(1e-6), of(-1e-6)], [1, 2, 2]);
}

#[test]
fn a_figure_is_as_low_as_its_area_is_wide() {
    let of = |size: [f64; 2]| Figure { panel: [345.0, 280.0], ..Figure::new("").with(Map { size, ..map() }) };
    let [square, wide] = [[4e-5, 4e-5], [8e-5, 1e-5]].map(|size| of(size).paper());
    // The map itself would be 35 points high; its colour bar has 96.
    assert!(wide[0] == square[0] && wide[1] < 0.6 * square[1], "{square:?} {wide:?}");
    assert_eq!(of([8e-5, 1e-5]).sized([400.0, 300.0]).unwrap().paper(), [400.0, 300.0]);
}

#[test]
fn a_map_of_no_pressure_has_no_colour_bar() {
    let of = |value: f64| {
        let values = Array2::from_elem((4, 4), value);
        let map = Map::new("", ["pressure", "Pa"], Colours::Pressure, values.view(), [1e-3, 1e-3]);
        let svg = Figure::new("").with(map).to_svg();
        svg.matches("<image").count()
    };
    assert_eq!([of(0.0), of(1e6)], [1, 2]);
}

#[test]
fn a_png_has_the_dots_that_its_paper_asks_for() {
    let data = figure().to_png(150.0).unwrap();
    let reader = png::Decoder::new(std::io::Cursor::new(&data)).read_info().unwrap();
    let [width, height] = figure().paper();
    let dots = |points: f64| (points * 150.0 / 72.0).round() as u32;
    assert_eq!((reader.info().width, reader.info().height), (dots(width), dots(height)));
    assert!(figure().to_png(f64::NAN).is_err());
}

#[test]
fn a_pdf_is_a_page_of_the_figures_size_with_its_texts() {
    let data = figure().to_pdf().unwrap();
    assert!(data.starts_with(b"%PDF-"));
    let text = String::from_utf8_lossy(&data);
    let box_at = text.find("/MediaBox").unwrap();
    let numbers: Vec<f64> =
        text[box_at + 9..].split(['[', ']', ' ', '\n']).filter_map(|w| w.parse().ok()).take(4).collect();
    let [width, height] = figure().paper();
    assert!((numbers[2] - width).abs() < 0.01 && (numbers[3] - height).abs() < 0.01, "{numbers:?}");
    assert!(text.contains("DejaVuSans"), "the typeface is in the file");
}

#[test]
fn empty_and_odd_data_still_draw() {
    let odd = [vec![], vec![f64::NAN, 1.0], vec![f64::INFINITY, -1.0], vec![0.0, 0.0]];
    for y in odd {
        for style in [Style::Line, Style::Dashed, Style::Reference, Style::Points, Style::Bars] {
            for axis in [Axis::linear("y", "m"), Axis::log("y", "m")] {
                let x: Vec<f64> = (0..y.len()).map(|i| i as f64).collect();
                let panel =
                    Curves::new("", Axis::linear("x", "m"), axis).with(Series::new("", style, x, y.clone()));
                let svg = Figure::new("").with(panel).to_svg();
                assert!(
                    Document::parse(&svg).is_ok() && !svg.contains("NaN") && !svg.contains("inf"),
                    "{y:?}"
                );
            }
        }
    }
    let flat = Array2::from_elem((3, 3), 2.0);
    for colours in [Colours::Sequential, Colours::Diverging, Colours::Heat] {
        let map = Map::new("", ["gap", "m"], colours, flat.view(), [1.0, 1e-3]);
        assert!(Figure::new("").with(map).to_png(50.0).is_ok());
    }
    let undefined = Array2::from_elem((3, 3), f64::NAN);
    let map = Map::new("", ["gap", "m"], Colours::Sequential, undefined.view(), [1.0, 1.0]);
    assert!(Document::parse(&Figure::new("").with(map).to_svg()).is_ok());
}

#[test]
fn a_figure_replaces_nothing_unless_told() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("figure.svg");
    figure().write(&path, false).unwrap();
    let first = std::fs::read(&path).unwrap();
    assert!(matches!(curve_figure().write(&path, false), Err(FigureError::Write(WriteError::Exists { .. }))));
    assert_eq!(std::fs::read(&path).unwrap(), first);
    curve_figure().write(&path, true).unwrap();
    assert_ne!(std::fs::read(&path).unwrap(), first);
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
    assert!(matches!(figure().write(&directory.path().join("a.jpg"), true), Err(FigureError::Ending { .. })));
    let nowhere = directory.path().join("none").join("a.png");
    assert!(matches!(figure().write(&nowhere, true), Err(FigureError::Write(WriteError::Io { .. }))));
}

#[test]
fn too_many_panels_and_endless_titles_are_refused() {
    let many = |panels: usize| Figure { panels: vec![curve().into(); panels], ..Figure::new("") };
    let titled = |letters: usize| Figure { title: "ä".repeat(letters), ..curve_figure() };
    assert!(matches!(many(65).to_png(20.0), Err(FigureError::Panels { found: 65 })));
    assert!(matches!(many(65).sized([500.0, 500.0]), Err(FigureError::Panels { .. })));
    assert!(matches!(titled(1001).to_pdf(), Err(FigureError::Title { letters: 1001 })));
    assert!(many(64).to_png(20.0).is_ok() && titled(1000).to_png(20.0).is_ok());
}

fn curve_figure() -> Figure {
    Figure::new("").with(curve())
}

#[test]
fn curves_end_where_the_map_over_time_below_them_ends() {
    let states = Values::States(&[("open", [0; 3])]);
    for map in [
        map().over(Axes::Times { start: 0.0 }),
        Map { meaning: states, ..map().over(Axes::Times { start: 0.0 }) },
    ] {
        let figure = Figure::new("").columns(1).with(curve()).with(map);
        let places = figure.places();
        let [Panel::Curves(curves), Panel::Map(map)] = &figure.panels[..] else { panic!("two panels") };
        let (above, below) = (curves.frame(&places[0]), frame::Layout::of(map, &places[1]).area);
        assert_eq!([above[0], above[2]], [below[0], below[2]]);
    }
}
