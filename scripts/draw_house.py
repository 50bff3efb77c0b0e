#!/usr/bin/env python3
"""Draws docs/images/architecture.svg from the #include lines of the sources.

Every folder is a box. An arrow means that files of one folder include headers of another; its thickness grows with their
number. Arrows that follow from others (a -> c from a -> b -> c) are omitted. If folders include each other in a circle,
or a folder includes one that its DEPENDS line in src/sinew/CMakeLists.txt does not allow, itself or through those that it
names, the script draws nothing and exits with 1. With --check, it only verifies that the picture is up to date.
"""
import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUTSIDE = {"viewer": "viewer", "apps/sinew": "apps", "python/src": "python"}
WIDTH, HEIGHT, GAP_X, GAP_Y = 118, 40, 26, 46


def includes():
    """{(from, to): number of include lines}, with the names of the folders."""
    counts = collections.Counter()
    homes = {path: path.name for path in (ROOT / "src/sinew").iterdir() if path.is_dir()}
    homes |= {ROOT / path: name for path, name in OUTSIDE.items()}
    for home, name in homes.items():
        for source in [*home.rglob("*.cpp"), *home.rglob("*.hpp")]:
            for target in re.findall(r'^#include "(?:sinew/)?(\w+)/', source.read_text(), re.M):
                if target != name and target in homes.values():
                    counts[name, target] += 1
    return counts


def levels(counts):
    """{folder: longest chain of includes below it}, {folder: folders that it includes}. Exits if there is a circle."""
    below = collections.defaultdict(set)
    for upper, lower in counts:
        below[upper].add(lower)
    level, open_ = {}, set()

    def visit(name):
        if name in open_:
            sys.exit(f"folders include each other in a circle through '{name}'")
        if name not in level:
            open_.add(name)
            level[name] = 1 + max((visit(other) for other in below[name]), default=-1)
            open_.discard(name)
        return level[name]

    for name in {name for pair in counts for name in pair}:
        visit(name)
    return level, below


def allowed():
    """{folder: folders that its DEPENDS line allows, itself or through those that it names}."""
    text = (ROOT / "src/sinew/CMakeLists.txt").read_text()
    named = {}
    for name, rest in re.findall(r"sinew_module\((\w+)([^)]*)\)", text):
        depends = re.search(r"DEPENDS([a-z_ \n]*)", rest)
        named[name] = depends.group(1).split() if depends else []

    def reach(name):
        return set(named[name]).union(*(reach(other) for other in named[name]))

    return {name: reach(name) for name in named}


def check_depends(counts):
    """Exits if a folder of the library includes one that its DEPENDS line does not allow."""
    may = allowed()
    for upper, lower in sorted(counts):
        if upper in may and lower not in may[upper]:
            sys.exit(f"src/sinew/{upper} includes headers of {lower}, which its DEPENDS line does not allow")


def reduced(below):
    """The (from, to) arrows that do not follow from others."""
    reach = {}

    def reaches(name):
        if name not in reach:
            reach[name] = set().union(*({other} | reaches(other) for other in below[name]), set())
        return reach[name]

    return [(a, b) for a in list(below) for b in sorted(below[a])
            if not any(b in reaches(other) for other in below[a] if other != b)]


def draw():
    counts = includes()
    level, below = levels(counts)
    check_depends(counts)
    rows = collections.defaultdict(list)
    for name in sorted(level):
        rows[level[name]].append(name)
    most = max(len(row) for row in rows.values())
    width = (most + 1) * (WIDTH + GAP_X) + GAP_X
    height = len(rows) * (HEIGHT + GAP_Y) + GAP_Y // 2
    place = {}
    for rank, row in rows.items():
        start = (width - len(row) * (WIDTH + GAP_X) + GAP_X) / 2
        for k, name in enumerate(row):
            place[name] = (start + k * (WIDTH + GAP_X), height - (rank + 1) * (HEIGHT + GAP_Y) + GAP_Y / 2)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" '
           'font-size="14">', '<rect width="100%" height="100%" fill="white"/>',
           '<defs><marker id="tip" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="6" markerHeight="6" '
           'orient="auto" markerUnits="userSpaceOnUse"><path d="M0,0 8,4 0,8z" fill="#667"/></marker></defs>']
    for upper, lower in reduced(below):
        (x1, y1), (x2, y2) = place[upper], place[lower]
        thick = next(width for least, width in ((40, 4), (10, 2), (0, 1)) if counts[upper, lower] >= least)
        x1, y1, x2 = x1 + WIDTH / 2, y1 + HEIGHT, x2 + WIDTH / 2
        # Arrows across several levels are drawn around the boxes between them, on the outside.
        round_ = level[upper] - level[lower] > 1
        side = (1 if (x1 + x2) / 2 > width / 2 else -1) * (0.75 * WIDTH if round_ else 0)
        bend = (y2 - y1) / 3 if round_ else GAP_Y / 2
        out.append(f'<path d="M{x1:.0f},{y1:.0f} C{x1 + side:.0f},{y1 + bend:.0f} {x2 + side:.0f},{y2 - bend:.0f} '
                   f'{x2:.0f},{y2:.0f}" fill="none" stroke="#667" stroke-width="{thick}" marker-end="url(#tip)"/>')
    for name, (x, y) in sorted(place.items()):
        fill = "#fdf1dc" if name in OUTSIDE.values() else "#e3eef9"
        out.append(f'<rect x="{x:.0f}" y="{y:.0f}" width="{WIDTH}" height="{HEIGHT}" rx="6" fill="{fill}" '
                   f'stroke="#345"/><text x="{x + WIDTH / 2:.0f}" y="{y + HEIGHT / 2 + 5:.0f}" '
                   f'text-anchor="middle">{name}</text>')
    return "\n".join([*out, "</svg>", ""])


def main():
    picture = ROOT / "docs/images/architecture.svg"
    text = draw()
    if "--check" in sys.argv[1:]:
        if picture.read_text() != text:
            sys.exit("docs/images/architecture.svg is not that of the sources: run scripts/draw_house.py")
        return
    picture.write_text(text)


if __name__ == "__main__":
    main()
