"""The view in a notebook."""

from __future__ import annotations

import html
import sys
from typing import Any, Optional

__all__ = ["frame", "frame_of", "show"]


def frame(url: str) -> str:
    """HTML of a frame with a page in it.

    Parameters
    ----------
    url : str
        Of the page.
    """
    return f'<iframe src="{html.escape(url)}" width="100%" height="600" style="border: 0"></iframe>'


def frame_of(view: Any) -> Optional[str]:
    """What a notebook shows of a sinew.View; None, which is its text, once it is closed."""
    return None if view.closed else frame(view.url)


def show(url: str) -> bool:
    """Shows a page below the cell that runs, and returns whether there is one: a kernel of IPython, no shell."""
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    if getattr(shell, "kernel", None) is None:
        return False
    from IPython.display import HTML, display

    display(HTML(frame(url)))
    return True
