"""Looks at the site in Chromium, as a reader would: links, errors, network, formulas, phone width, search.

`cargo xtask site --check` calls it. Without a Chromium or Chrome on the path it says so and fails.
"""

import functools
import http.server
import shutil
import threading
from pathlib import Path
from urllib.parse import unquote, urljoin, urlsplit

from playwright.sync_api import TimeoutError, sync_playwright

SITE = Path(__file__).parents[2] / "target/site"
BROWSERS = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"]
#: Width of a phone [px].
PHONE = 390
#: Queries and a page that each must find.
QUERIES = {"hardness": "materials.html", "percolates": "leakage.html", "Polonsky": "theory.html", "large-strain": "findings.html"}


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *args):
        pass


def main():
    browser = next((found for name in BROWSERS if (found := shutil.which(name))), None)
    if browser is None:
        raise SystemExit("check.py: no Chromium or Chrome is on the path: the site is not checked")
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=SITE))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    address = f"http://127.0.0.1:{server.server_port}/"
    pages = sorted(path.relative_to(SITE).as_posix() for path in SITE.rglob("*.html"))
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=browser, args=["--no-sandbox"])
        faults = Checks(chromium, address).all(pages)
        chromium.close()
    for fault in faults:
        print(fault)
    if faults:
        raise SystemExit(f"check.py: {len(faults)} faults on {len(pages)} pages")
    print(f"check.py: {len(pages)} pages are in order")


class Checks:
    def __init__(self, chromium, address):
        self.page, self.address = chromium.new_page(viewport={"width": PHONE, "height": 844}), address
        self.faults, self.anchors, self.links = [], {}, []
        self.formulas, self.current = 0, ""
        self.page.on("console", lambda message: message.type in ("error", "warning") and self.fault(f"console: {message.text}"))
        self.page.on("pageerror", lambda error: self.fault(f"script: {error}"))
        self.page.on("response", lambda response: response.status >= 400 and self.fault(f"{response.status}: {response.url}"))
        self.page.on("request", self.request)

    def fault(self, what):
        self.faults.append(f"{self.current}: {what}")

    def request(self, request):
        # A page without network must look the same.
        if not request.url.startswith((self.address, "data:", "blob:")):
            self.fault(f"asks for {request.url}")

    def all(self, pages):
        for page in pages:
            self.look(page)
        self.follow()
        self.search()
        self.dark()
        if self.formulas < 50:
            self.fault(f"only {self.formulas} formulas on the whole site")
        return self.faults

    def look(self, place):
        self.current = place
        self.page.goto(self.address + place)
        found = self.page.evaluate(LOOK)
        self.anchors[place] = set(found["anchors"])
        self.links += [(place, link) for link in found["links"]]
        self.formulas += found["formulas"]
        wide = [f"{found['width']} px wide on a phone: {found['widest']}"] if found["width"] > PHONE else []
        flat = [f"a formula is not drawn: {formula}" for formula in found["flat"]]
        broken = [f"picture {picture}" for picture in found["broken"]]
        for fault in [*wide, *flat, *broken, *(f"unread markup: {source}" for source in found["raw"])]:
            self.fault(fault)

    def follow(self):
        """Links within the site lead to pages and headings."""
        for place, link in dict.fromkeys(self.links):
            self.current, whole = place, urljoin(self.address + place, link)
            if not whole.startswith(self.address):
                continue
            target = urlsplit(whole)
            path = unquote(target.path).lstrip("/") or "index.html"
            if not (SITE / path).is_file():
                self.fault(f"dead link {link}")
            elif target.fragment and unquote(target.fragment) not in self.anchors.get(path, ()):
                self.fault(f"no heading for {link}")

    def search(self):
        self.current = "search"
        self.page.set_viewport_size({"width": 1280, "height": 900})
        for query, wanted in QUERIES.items():
            self.page.goto(self.address + "index.html")
            self.page.fill("input.md-search__input", query)
            found = self.page.locator(f".md-search-result__link[href*='{wanted}']").first
            try:
                # A busy machine takes a while to read the index.
                found.wait_for(state="attached", timeout=120_000)
            except TimeoutError:
                self.fault(f"{query!r} does not find {wanted}")

    def dark(self):
        """The switch to dark changes the background, and stays."""
        self.current = "dark"
        background = "getComputedStyle(document.body).backgroundColor"
        self.page.goto(self.address + "theory.html")
        before = self.page.evaluate(background)
        self.page.locator("label[for^=__palette]:visible").first.click()
        self.page.goto(self.address + "index.html")
        if self.page.evaluate(background) == before:
            self.fault("the switch does nothing")


#: What the check asks a page. A formula is drawn where its box is higher than a line is, or at least has a width.
LOOK = """() => {
  const all = (what) => [...document.querySelectorAll(what)];
  const wide = all("main *").filter((e) => e.getBoundingClientRect().right > innerWidth + 1 && !e.closest(
    "pre, .formula, .md-typeset__scrollwrap, .tabbed-labels, .md-sidebar, .md-header, .highlight, .linenos"));
  return {
    anchors: all("[id]").map((e) => e.id).concat(all("a[name]").map((e) => e.name)),
    links: all("a[href]").map((e) => e.getAttribute("href")),
    width: document.documentElement.scrollWidth,
    widest: wide.slice(0, 3).map((e) => e.tagName + " " + e.className + ": " + e.textContent.slice(0, 60)).join(" | "),
    formulas: all("math").length,
    flat: all("math").filter((e) => e.querySelector("merror") || (e.offsetParent && e.getBoundingClientRect().width < 5))
      .map((e) => e.textContent.slice(0, 60)),
    broken: all("img").filter((e) => e.loading !== "lazy" && e.complete && e.naturalWidth === 0).map((e) => e.src),
    raw: all("article p, article li").map((e) => e.innerText).filter((t) => /^(```|===|\\?\\?\\?|:::)|\\{ \\.|\\$[^$]*\\\\[a-z]/.test(t)).map((t) => t.slice(0, 60)),
  };
}"""

if __name__ == "__main__":
    main()
