"""Colours of values, and the colour bar."""

from __future__ import annotations

import difflib
import functools
import math
from typing import Any

import numpy as np

from ..errors import Error
from ..fields import FIELDS

__all__ = ["MAPS", "bar", "parse", "put_bar", "table", "ticks", "unit_of"]

# Samples of viridis and cividis (Smith and van der Walt 2015; Nunez et al. 2018), evenly spaced, as in the view.
_SAMPLES = {
    "viridis": [(68, 1, 84), (71, 44, 122), (59, 81, 139), (44, 113, 142), (33, 144, 141), (39, 173, 129), (92, 200, 99),
                (170, 220, 50), (253, 231, 37)],
    "cividis": [(0, 32, 77), (0, 51, 111), (57, 72, 107), (87, 92, 109), (112, 113, 115), (138, 134, 120), (166, 157, 117),
                (196, 181, 108), (255, 234, 70)],
}  # fmt: skip
#: Names of the colour maps. Both are suitable for readers with red-green colour blindness.
MAPS = tuple(_SAMPLES)
_STEPS = 256
_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))
_TICKS = 5


def unknown(item: str, what: str, name: Any, known: Any) -> Error:
    """An error of the kind unknown-name, with a suggestion."""
    known = list(known)
    near = difflib.get_close_matches(str(name), known, 1, 0.5)
    remedy = f"did you mean {near[0]!r}?" if near else f"use one of {', '.join(known)}"
    return Error("unknown-name", item, f"there is no {what} {name!r}", remedy)


@functools.lru_cache(maxsize=None)
def table(name: str) -> np.ndarray:
    """(256, 3) uint8 sRGB: the colours of a map, from the smallest to the largest value. Raises unknown-name."""
    if name not in _SAMPLES:
        raise unknown("colour_map", "colour map", name, MAPS)
    samples = np.array(_SAMPLES[name], dtype=float)
    at, known = np.linspace(0.0, 1.0, _STEPS), np.linspace(0.0, 1.0, len(samples))
    colours = np.stack([np.interp(at, known, samples[:, c]) for c in range(3)], axis=1).round().astype(np.uint8)
    colours.setflags(write=False)
    return colours


def unit_of(field: str) -> str:
    """The unit of a field of bodies; raises unknown-name."""
    if field == "displacement":
        return "m"
    if field not in FIELDS:
        raise unknown("field", "field", field, ["displacement", *FIELDS])
    return FIELDS[field][0]


def parse(colour: Any, item: str) -> tuple[float, float, float]:
    """Red, green and blue from 0 to 1, from "#rrggbb" or three such numbers. Raises out-of-range."""
    try:
        if isinstance(colour, str) and colour.startswith("#") and len(colour) == 7:
            return tuple(int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5))  # type: ignore[return-value]
        red, green, blue = (float(part) for part in colour)
        if all(0.0 <= part <= 1.0 for part in (red, green, blue)):
            return red, green, blue
    except (TypeError, ValueError):
        pass
    raise Error("out-of-range", item, f"{colour!r} is not a colour", 'give "#rrggbb", or three numbers from 0 to 1')


def ticks(low: float, high: float, unit: str) -> list[str]:
    """Labels of five values from high to low, with a common prefix and enough decimals to distinguish them."""
    largest = max(abs(low), abs(high))
    scale, prefix = next(((s, p) for s, p in _PREFIXES if unit and largest >= 0.9995 * s), (1.0, ""))
    shown = f"{prefix}{unit}".replace("^3", "³")
    span = (high - low) / scale
    decimals = min(max(2 - math.floor(math.log10(span)), 0), 8) if span > 0.0 else 3
    return [f"{value / scale:.{decimals}f} {shown}".strip() for value in np.linspace(high, low, _TICKS)]


@functools.lru_cache(maxsize=16)
def _font(size: int) -> Any:
    from PIL import ImageFont

    try:
        return ImageFont.truetype("DejaVuSans.ttf", size)
    except OSError:  # Pillow has a small built-in font
        return ImageFont.load_default()


@functools.lru_cache(maxsize=32)
def bar(field: str, low: float, high: float, colour_map: str, height: int, ink: tuple[int, int, int]) -> tuple[np.ndarray, np.ndarray]:
    """Colour bar for a picture of a height: colours (h, w, 3) and opacities (h, w, 1), 0 to 1.

    Raises
    ------
    Error
        tool-missing without Pillow.
    """
    try:
        from PIL import Image, ImageDraw
    except ImportError:
        raise Error("tool-missing", "render", "a colour bar needs Pillow, which is not installed",
                    "install python3-pil, or pip install sinew[render]; or leave the bar out: colour_bar=False") from None
    size = max(9, round(height / 36))
    font, pad, width, length = _font(size), size // 2, size, round(0.42 * height)
    unit = unit_of(field)
    title, texts = field.replace("_", " ").replace("von mises", "von Mises"), ticks(low, high, unit)
    image = Image.new("L", (20 * size, length + 4 * size), 0)
    draw = ImageDraw.Draw(image)
    top = 2 * size + pad
    draw.text((pad, pad), title[0].upper() + title[1:], fill=255, font=font)
    wide = pad + draw.textlength(title, font=font)
    for k, text in enumerate(texts):
        y = top + k * (length - 1) / (_TICKS - 1)
        draw.text((pad + width + pad, y), text, fill=255, font=font, anchor="lm" if hasattr(font, "getname") else None)
        wide = max(wide, 2 * pad + width + draw.textlength(text, font=font))
    opacity = np.asarray(image, dtype=np.float32)[:, : int(wide) + 2 * pad, None] / 255.0
    colours = np.empty((*opacity.shape[:2], 3), dtype=np.float32)
    colours[:] = np.array(ink, dtype=np.float32) / 255.0
    strip = table(colour_map)[np.linspace(_STEPS - 1, 0, length).round().astype(int)]
    colours[top : top + length, pad : pad + width] = strip[:, None] / 255.0
    opacity = opacity.copy()
    opacity[top : top + length, pad : pad + width] = 1.0
    return colours, opacity


def put_bar(picture: np.ndarray, field: str, low: float, high: float, colour_map: str, background: tuple[float, float, float]) -> None:
    """Draws the colour bar into the upper left of a picture (height, width, 3) uint8, in ink that contrasts with the background."""
    dark = float(np.dot(background, (0.3, 0.6, 0.1))) < 0.45
    shown, opacity = bar(field, low, high, colour_map, picture.shape[0], (228, 232, 236) if dark else (40, 48, 58))
    below = picture[: shown.shape[0], : shown.shape[1]]
    height, width = below.shape[:2]
    opacity = opacity[:height, :width]
    below[:] = (opacity * 255.0 * shown[:height, :width] + (1.0 - opacity) * below).round()
