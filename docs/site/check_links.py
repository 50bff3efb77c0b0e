"""Checks that every local link of a folder of HTML pages leads to a page and a place in it.

    python3 check_links.py FOLDER
"""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urldefrag, urlsplit


class Page(HTMLParser):
    """The links and names of one page."""

    def __init__(self, path):
        super().__init__()
        self.links, self.names = [], set()
        self.feed(path.read_text(encoding="utf-8", errors="replace"))

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.names |= {attributes[key] for key in ("id", "name") if attributes.get(key)}
        link = attributes.get("href" if tag in ("a", "link") else "src")
        if link and not urlsplit(link).scheme and not link.startswith("//"):
            self.links.append(link)


def broken_links(folder):
    """(page, link) of every link that leads nowhere; links within Doxygen's own pages are Doxygen's to check."""
    pages = {path.resolve(): Page(path) for path in Path(folder).rglob("*.html")}
    for path, page in pages.items():
        if (Path(folder) / "cpp").resolve() in path.parents:
            continue
        for link in page.links:
            address, name = urldefrag(link)
            target = (path.parent / unquote(urlsplit(address).path)).resolve() if address else path
            if not target.exists() or (name and target in pages and unquote(name) not in pages[target].names):
                yield path.relative_to(Path(folder).resolve()), link


def main(folder):
    broken = list(broken_links(folder))
    for page, link in broken:
        print(f"docs: {page}: the link {link} leads nowhere", file=sys.stderr)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
