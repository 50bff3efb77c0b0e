"""Pages of the site that come from the code: one for each Python module, one with the names of the C++ reference.

    python3 reference.py FOLDER TAGFILE

TAGFILE is Doxygen's (GENERATE_TAGFILE).
"""

import re
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

MODULES = [
    "sinew", "sinew.collision", "sinew.control", "sinew.estimate", "sinew.fields", "sinew.gym", "sinew.identify", "sinew.learn",
    "sinew.mesh", "sinew.pcc", "sinew.plan", "sinew.qp", "sinew.render", "sinew.sensors", "sinew.sweep",
]  # fmt: skip


def with_type_apart(lines):
    """Lines of a property's docstring, "float: length (m).", with the type in a paragraph of its own."""
    typed = re.match(r"([^:`]{1,40}): +(\S.*)", lines[0]) if lines else None
    return [f"``{typed.group(1)}``", "", typed.group(2), *lines[1:]] if typed else lines


def restructured(lines):
    """Lines of a docstring as reStructuredText: indented code before the first section is a code block, and `*`, `|` and a
    final `_` outside of `names` mean themselves."""
    result, in_code, in_sections = [], False, False
    for line in lines:
        in_sections |= bool(re.fullmatch("-{3,}", line))
        if line and not line.startswith(" "):
            in_code = False
        elif line and not in_code and not in_sections and (not result or not result[-1]):
            in_code = True
            result += [".. code-block:: python", "    :force:", ""]
        result.append(line if in_code else escaped(line))
    return result


def escaped(line):
    pieces = re.split(r"(``.+?``|`[^`]*`)", line)
    return "".join(piece if k % 2 else re.sub(r"([*|\\]|_(?=\W|$))", r"\\\1", piece) for k, piece in enumerate(pieces))


def python_page(module):
    return heading(f"Python: {module}", "=") + f".. automodule:: {module}\n"


def cpp_page(tagfile):
    """Every namespace with its classes and functions, each with a link into Doxygen's pages."""
    text = heading("C++ reference", "=") + (
        "Doxygen's pages describe every class, function and file of the library: `namespaces <../cpp/namespaces.html>`__, "
        "`classes <../cpp/annotated.html>`__, `files <../cpp/files.html>`__.\n"
    )
    compounds = {compound.findtext("name"): compound for compound in xml.parse(tagfile).getroot()}
    for name in sorted(name for name, compound in compounds.items() if compound.get("kind") == "namespace"):
        entries = {}
        for inner in compounds[name].findall("class"):
            if inner.text in compounds:
                entries[inner.text.removeprefix(f"{name}::")] = compounds[inner.text].findtext("filename")
        for member in compounds[name].findall("member[@kind='function']"):
            entries[member.findtext("name") + "()"] = f"{member.findtext('anchorfile')}#{member.findtext('anchor')}"
        if entries and "anonymous" not in name:
            links = [f"`{escaped(entry)} <../cpp/{target}>`__" for entry, target in sorted(entries.items()) if "<" not in entry]
            text += "\n" + heading(name, "-") + ",\n".join(links) + "\n"
    return text


def heading(text, mark):
    return f"{text}\n{mark * len(text)}\n\n"


def main(folder, tagfile):
    folder = Path(folder)
    (folder / "python").mkdir(parents=True, exist_ok=True)
    for module in MODULES:
        (folder / "python" / f"{module}.rst").write_text(python_page(module), encoding="utf-8")
    (folder / "cpp.rst").write_text(cpp_page(tagfile), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
