#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks a site that scripts/docs has built: no link is dead, the search knows the API, and no page
is wider than a narrow screen.

usage: docs_site.py FOLDER [BROWSER]     without a browser, widths are not checked
"""

import json
import re
import subprocess
import sys
import tempfile
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

SCREEN = 390  # CSS pixels

# Loads each page in a frame as wide as the screen. The text says which pages are wider.
CHECKER = """<!doctype html><pre id=result></pre><iframe id=frame width=%d height=800></iframe><script>
const pages = %s, frame = document.getElementById('frame');
const result = document.getElementById('result');
let next = 0;
frame.onload = () => {
    const width = frame.contentDocument.scrollingElement.scrollWidth;
    if (width > %d) result.textContent += pages[next - 1] + ' is ' + width + ' wide; ';
    if (next < pages.length) frame.src = pages[next++];
    else result.textContent += 'checked ' + next;
};
frame.src = pages[next++];
</script>"""


class Page(HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.anchors, self.links = set(), []
        self.feed(path.read_text(errors="replace"))

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.anchors.update(filter(None, (attributes.get("id"), attributes.get("name"))))
        self.links += filter(None, (attributes.get("href"), attributes.get("src")))


def dead_links(pages):
    for path, page in pages.items():
        for link in page.links:
            if re.match(r"[a-z]+:", link):
                continue
            name, _, anchor = link.partition("#")
            target = (path.parent / unquote(name)).resolve() if name else path
            if not target.exists() or (
                anchor and target in pages and anchor not in pages[target].anchors
            ):
                yield f"{path.name}: dead link {link}"


def wide_pages(site, pages, browser):
    names = [path.name for path in pages]
    with tempfile.NamedTemporaryFile("w", dir=site, suffix=".html") as checker:
        checker.write(CHECKER % (SCREEN, json.dumps(names), SCREEN))
        checker.flush()
        text = subprocess.run(
            [browser, "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=600000",
             "--allow-file-access-from-files", "--dump-dom", Path(checker.name).as_uri()],
            check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, timeout=300,
        ).stdout
    result = re.search(r'<pre id="result">(.*?)</pre>', text)[1]
    if f"checked {len(names)}" not in result:
        yield "the browser has not loaded all pages: " + result
    elif " wide" in result:
        yield result


def main():
    site = Path(sys.argv[1]).resolve()
    pages = {path: Page(path) for path in sorted(site.glob("*.html"))}
    faults = list(dead_links(pages))
    found = "".join(path.read_text() for path in (site / "search").glob("*.js"))
    faults += [f"the search does not find {name}" for name in
               ("cellist_insert", "cellist_for_each", "build_slices", "CELLIST_STRUCT")
               if name not in found]
    if len(sys.argv) > 2 and sys.argv[2]:
        faults += wide_pages(site, pages, sys.argv[2])
    print("\n".join(faults) or f"{len(pages)} pages are sound")
    sys.exit(bool(faults) or len(pages) < 50)


main()
