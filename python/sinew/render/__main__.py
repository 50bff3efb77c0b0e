"""Render videos and pictures of scenes and recorded runs."""

from __future__ import annotations

import argparse
import pathlib
import sys
from typing import Any

from .. import load
from .._whole_files import draft
from ..command import exit_code, seconds
from ..errors import Error
from . import Recording, Renderer, png, video
from .camera import VIEWS
from .colours import MAPS
from .context import context
from .recording import need_h5py
from .scene import parsed
from .video import check_path


def _options(words: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python3 -m sinew.render", allow_abbrev=False, description=__doc__)
    parser.add_argument("source", metavar="RUN|SCENE", nargs="?", help="output folder of `sinew run`, or a scene to simulate")
    parser.add_argument("--video", metavar="FILE", help="write a video: NAME.mp4 (needs ffmpeg), NAME.webp, NAME.gif, NAME_%%04d.png or a folder")
    parser.add_argument("--picture", metavar="FILE", help="write a picture: NAME.png")
    parser.add_argument("--time", metavar="TIME", help="time of the picture, e.g. 2s (default: end of a run, start of a scene)")
    parser.add_argument("--duration", metavar="TIME", help="simulated time of a scene, or length of the run to render, e.g. 5s (default: the scene's, the whole run)")
    parser.add_argument("--set", metavar="PATH=VALUE", action="append", default=[], help="override a scene value (repeatable)")
    parser.add_argument("--fps", type=float, default=30.0, help="frames per second (default: 30)")
    parser.add_argument("--speed", type=float, default=1.0, help="simulated seconds per second (default: 1)")
    parser.add_argument("--size", metavar="WxH", default="640x480", help="size in pixels (default: 640x480)")
    parser.add_argument("--camera", choices=list(VIEWS), default="corner", help="view direction (default: corner)")
    parser.add_argument("--field", help="field to colour the bodies by, e.g. displacement or von_mises_stress (default: none)")
    parser.add_argument("--colour-map", choices=list(MAPS), default=MAPS[0], help=f"colour map of --field (default: {MAPS[0]})")
    parser.add_argument("--edges", action="store_true", help="draw mesh edges")
    parser.add_argument("--quiet", action="store_true", help="suppress the progress messages")
    parser.add_argument("--check", action="store_true", help="check that --video can be written, and exit")
    return parser.parse_args(words)


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    if not (width.isdigit() and height.isdigit()):
        raise Error("bad-argument", "--size", f"'{text}' is not a size", "write for example 640x480")
    return int(width), int(height)


def _is_run(source: str) -> bool:
    path = pathlib.Path(source)
    return path.is_dir() or path.suffix == ".h5"


def _scene_duration(sim: Any) -> float:
    """Duration of the scene, s."""
    told = parsed(sim.to_yaml()).get("duration")
    if told is None:
        raise Error("bad-argument", "--duration", "the scene does not say how long to simulate", "add --duration 5s")
    return seconds("duration", told)


def _picture(options: argparse.Namespace, drawn: dict[str, Any]) -> None:
    if _is_run(options.source):
        with Recording(options.source) as run, Renderer(run.sim, **drawn) as renderer:
            time = run.times[-1] if options.time is None else seconds("--time", options.time)
            picture = renderer.frame(run.at(time, renderer.field))
    else:
        sim = load(options.source, set=options.set)
        time = 0.0 if options.time is None else seconds("--time", options.time)
        sim.step(round(time / sim.time_step))
        with Renderer(sim, **drawn) as renderer:
            picture = renderer.frame()
    path = pathlib.Path(options.picture)
    with draft(path) as beside:
        beside.write_bytes(png(picture))
    print(f"drew {path}")


def _video(options: argparse.Namespace, drawn: dict[str, Any]) -> None:
    length = seconds("--duration", options.duration)
    source: Any = options.source
    if not _is_run(source):
        check_path(options.video)
        source = load(source, set=options.set)
        length = _scene_duration(source) if length is None else length
    path = video(options.video, source, options.fps, speed=options.speed, duration=length, progress=not options.quiet, **drawn)
    if not options.quiet:
        print(f"drew {path}")


def _render(options: argparse.Namespace) -> int:
    if options.check:
        check_path(options.video or ".")
        context()
        need_h5py()
        parsed("")
        return 0
    if options.source is None or (options.video is None and options.picture is None):
        raise Error("bad-argument", "python3 -m sinew.render", "nothing to render", "give a run or a scene, and --video or --picture")
    drawn = {"size": _size(options.size), "camera": options.camera, "field": options.field, "colour_map": options.colour_map,
             "edges": options.edges}  # fmt: skip
    if options.picture is not None:
        _picture(options, drawn)
    if options.video is not None:
        _video(options, drawn)
    return 0


def main(words: list[str]) -> int:
    """Runs `python3 -m sinew.render`; returns the exit code, see command.exit_code()."""
    options = _options(words)
    return exit_code(lambda: _render(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
