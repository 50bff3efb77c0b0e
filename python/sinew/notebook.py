"""The view in a notebook."""

from __future__ import annotations

import html
import sys
from typing import Any, Optional

__all__ = ["frame", "frame_of", "show"]


def frame(url: str) -> str:
    """HTML of an inline frame that shows a page.

    Parameters
    ----------
    url : str
        Address of the page.
    """
    return f'<iframe src="{html.escape(url)}" width="100%" height="600" style="border: 0"></iframe>'


def frame_of(view: Any) -> Optional[str]:
    """HTML that a notebook shows for a sinew.View; None after it is closed."""
    return None if view.closed else frame(view.url)


def show(url: str) -> bool:
    """Shows a page below the running cell. Returns False outside of a notebook."""
    ipython = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    if getattr(shell, "kernel", None) is None:
        return False
    from IPython.display import HTML, display

    display(HTML(frame(url)))
    return True
