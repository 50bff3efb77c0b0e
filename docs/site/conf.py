"""Sphinx settings of the documentation site; scripts/docs.sh prepares its sources and runs it."""

import re
import sys
from os.path import normpath
from pathlib import Path

from docutils import nodes
from sphinx.domains.std import StandardDomain

sys.path.insert(0, str(Path(__file__).parent))
import reference  # noqa: E402

project = "Sinew"
author = "the Sinew authors"
root_doc = "docs/index"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["docs/site/**", "examples/**", "src/**"]

html_theme = "furo"
html_title = "Sinew"
html_show_sourcelink = False
html_show_copyright = False
html_static_path = ["static"]
html_css_files = ["style.css"]

myst_heading_anchors = 4
suppress_warnings = ["myst.header"]  # pages may skip a level
default_role = "literal"  # `name` in docstrings
autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_default_options = {"members": True, "undoc-members": False}
napoleon_use_rtype = False
napoleon_use_ivar = True

TUTORIALS = [
    "tutorials/bending_finger", "tutorials/pneumatic_finger", "tutorials/gripper", "tutorials/force_from_sensors",
    "tutorials/fit_a_model", "tutorials/sweep_a_design",
]  # fmt: skip

# Sections of the navigation; every page of docs/ has to be in one.
SECTIONS = {
    "Start": ["install", "tutorials", *TUTORIALS, "choosing", "troubleshooting", "howto"],
    "Use": ["python", "cli", "view", "rendering", "scene", "scene/*", "sweeps", "gym"],
    "Model": ["materials", "contact", "collision", "joints", "urdf", "pcc", "bending_actuator", "sensors"],
    "Control and estimate": ["steering", "closed_loop", "high_rate", "estimation", "identification", "planning", "bracing", "learning"],
    "Robots": ["grasping", "locomotion"],
    "Theory and numbers": ["conventions", "solver", "convergence", "validation", "scorecard", "scorecard/*", "performance", "errata"],
    "Develop": ["architecture", "view_protocol", "../CONTRIBUTING", "../CHANGELOG", "../README"],
    "Reference": ["../reference/python/*", "../reference/cpp"],
}


def add_navigation(app, docname, source):
    """Appends the contents of the site to its first page."""
    if docname == root_doc:
        for caption, pages in SECTIONS.items():
            pages = [page for page in pages if "*" not in page or list(Path(app.srcdir).glob(normpath(f"docs/{page}.*")))]
            source[0] += f"\n```{{toctree}}\n:hidden:\n:glob:\n:maxdepth: 1\n:caption: {caption}\n" + "\n".join(pages) + "\n```\n"


def name_anchors(app, doctree):
    """Lets links find `<a id="name">` of a Markdown page."""
    labels: StandardDomain = app.env.get_domain("std")
    page = app.env.docname
    for raw in doctree.findall(nodes.raw):
        for name in re.findall(r'<a id="([^"]+)"', raw.astext()):
            label = f"{page}.md#{name}"
            labels.anonlabels[label] = page, name
            labels.labels[label] = page, name, name


def as_restructured_text(app, what, name, obj, options, lines):
    """Docstrings are plain text with `names`: other marks of reStructuredText in them mean themselves."""
    lines[:] = reference.restructured(reference.with_type_apart(lines) if what in ("attribute", "property") else lines)


def setup(app):
    app.connect("source-read", add_navigation)
    app.connect("doctree-read", name_anchors)
    app.connect("autodoc-process-docstring", as_restructured_text, priority=100)  # before napoleon
