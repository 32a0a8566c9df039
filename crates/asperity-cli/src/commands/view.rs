//! `asperity view`: the page of a result, served to a browser.

use asperity_io::store::Reader;
use asperity_report::page::Live;

use crate::args::View;
use crate::failure::Failure;
use crate::serve::{self, Body, Request, Response, Site};
use crate::verb::Verb;

impl Verb for View {
    /// Serves until it is interrupted.
    fn run(&self) -> Result<(), Failure> {
        // What cannot be shown is told before anything listens.
        Reader::open(&self.result)?;
        let opened = serve::open(self.host, self.port)?;
        crate::print(&format!("{}\n", opened.address))?;
        crate::messages::message!(
            "open this address in a browser; who knows it can read the result; press Ctrl-C to stop"
        );
        opened.serve(Live::new(&self.result))
    }
}

impl Site for Live {
    fn answer(&self, _: &Request, path: &str, _: Body<'_>) -> Response {
        page_of(self, path)
    }
}

/// What is at a path of the page of a result.
pub fn page_of(live: &Live, path: &str) -> Response {
    match live.answer(path) {
        Ok(Some(answer)) => Response::of(answer.content_type, answer.content),
        Ok(None) => Response::text("404 Not Found", "there is nothing here"),
        Err(error) => Response::text("404 Not Found", &error.to_string()),
    }
}
