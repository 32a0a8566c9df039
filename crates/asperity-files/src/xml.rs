//! XML documents piece by piece, for the readers of spreadsheets and of X3P.

use quick_xml::Reader;
use quick_xml::escape::resolve_predefined_entity;
use quick_xml::events::{BytesStart, Event};

/// A piece of XML; names are without their namespace.
pub(crate) enum Piece<'a> {
    Open(&'a str, &'a BytesStart<'a>),
    Text(&'a str),
    Close(&'a str),
}

/// XML that is not well-formed; the words say why.
pub(crate) struct Malformed(pub String);

/// Gives the pieces of a document to `on`, one after the other.
pub(crate) fn walk<E: From<Malformed>>(
    xml: &str,
    mut on: impl FnMut(Piece<'_>) -> Result<(), E>,
) -> Result<(), E> {
    let malformed = |why: &str| E::from(Malformed(why.to_owned()));
    let mut reader = Reader::from_str(xml.trim_start_matches('\u{feff}'));
    let mut open = 0;
    loop {
        match reader.read_event().map_err(|error| malformed(&error.to_string()))? {
            Event::Start(element) => {
                open += 1;
                on(Piece::Open(element.local_name().as_ref(), &element))?;
            }
            Event::Empty(element) => {
                on(Piece::Open(element.local_name().as_ref(), &element))?;
                on(Piece::Close(element.local_name().as_ref()))?;
            }
            Event::End(element) => {
                open -= 1;
                on(Piece::Close(element.local_name().as_ref()))?;
            }
            Event::Text(text) => on(Piece::Text(&text.xml10_content()))?,
            Event::CData(text) => on(Piece::Text(&text))?,
            Event::GeneralRef(reference) => match reference.resolve_char_ref() {
                Ok(Some(character)) => on(Piece::Text(character.encode_utf8(&mut [0; 4])))?,
                _ => {
                    let known = resolve_predefined_entity(&reference);
                    on(Piece::Text(known.ok_or_else(|| malformed("an entity that is not declared"))?))?;
                }
            },
            // What is cut off between two elements reads well up to there.
            Event::Eof if open > 0 => return Err(malformed("it ends inside an element")),
            Event::Eof => return Ok(()),
            _ => {}
        }
    }
}
