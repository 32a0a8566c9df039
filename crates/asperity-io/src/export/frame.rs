//! The XML around the numbers of a VTK file, which are appended to it raw: little-endian, each array behind its length in bytes.

/// The text before the appended numbers, and where the next array goes.
pub(super) struct Frame {
    kind: &'static str,
    text: String,
    offset: u64,
}

/// What follows the appended numbers.
pub(super) const END: &str = "\n  </AppendedData>\n</VTKFile>\n";

impl Frame {
    /// Of a data set such as "ImageData", with its extent and its other attributes.
    pub(super) fn new(kind: &'static str, extent: &str, attributes: &str) -> Frame {
        let text = format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  \
             <{kind} WholeExtent=\"{extent}\"{attributes}>\n    <Piece Extent=\"{extent}\">\n"
        );
        Frame { kind, text, offset: 0 }
    }

    /// Declares arrays of type, name, unit and length in bytes in a section such as "CellData"; returns the offset of each.
    pub(super) fn section<'a>(
        &mut self,
        section: &str,
        arrays: impl IntoIterator<Item = (&'a str, String, &'a str, u64)>,
    ) -> Vec<u64> {
        let mut offsets = vec![];
        self.text += &format!("      <{section}>\n");
        for (kind, name, units, bytes) in arrays {
            let offset = self.offset;
            self.text += &format!(
                "        <DataArray type=\"{kind}\" Name=\"{name}\" format=\"appended\" offset=\"{offset}\">\n          \
                 <InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">{units}</InformationKey>\n        \
                 </DataArray>\n"
            );
            offsets.push(offset);
            self.offset += 8 + bytes;
        }
        self.text += &format!("      </{section}>\n");
        offsets
    }

    /// The text, which the numbers follow.
    pub(super) fn text(self) -> String {
        let Frame { kind, text, .. } = self;
        format!("{text}    </Piece>\n  </{kind}>\n  <AppendedData encoding=\"raw\">\n_")
    }
}
