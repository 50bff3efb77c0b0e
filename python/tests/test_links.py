"""Every link between the pages of the documentation leads to a file, and to a heading or a name in it."""

import re
from pathlib import Path
from urllib.parse import unquote

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md")])
LINK = re.compile(r"\]\(([^)\s]+)\)")


def prose(page):
    """The lines of a page outside of fenced code."""
    fenced = False
    for line in page.read_text(encoding="utf-8").splitlines():
        fenced ^= line.startswith("```")
        if not fenced and not line.startswith("```"):
            yield line


def anchors(page):
    """Valid anchors of the page: GitHub's names of its headings, and those of <a id>."""
    found = {}
    for line in prose(page):
        heading = re.match(r"#+ +(.*)", line)
        if heading:
            name = re.sub(r"[^\w -]", "", heading.group(1).lower()).replace(" ", "-")
            count = found[name] = found.get(name, -1) + 1
            if count:
                found[f"{name}-{count}"] = 0
        found.update(dict.fromkeys(re.findall(r'<a id="([^"]+)"', line), 0))
    return set(found)


@pytest.mark.parametrize("page", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_lead_somewhere(page):
    for link in (link for line in prose(page) for link in LINK.findall(line)):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, name = link.partition("#")
        target = (page.parent / unquote(path)).resolve() if path else page
        assert target.exists(), f"{link}: there is no such file"
        if name and target.suffix == ".md":
            assert name in anchors(target), f"{link}: there is no such heading"


def test_every_page_is_in_the_site():
    # docs/site/conf.py lists all pages as paths below docs/, without suffix.
    named = re.findall(r'"([^"\n]+)"', (ROOT / "docs" / "site" / "conf.py").read_text(encoding="utf-8"))
    listed = {path for name in named if re.fullmatch(r"[\w/]+(/\*)?", name) for path in (ROOT / "docs").glob(f"{name}.md")}
    assert not [str(page) for page in (ROOT / "docs").rglob("*.md") if page not in listed and page.name != "index.md"]
