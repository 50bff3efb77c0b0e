"""Videos and pictures of scenes and recorded runs: python3 -m sinew.render RUN --video OUT.mp4."""

from __future__ import annotations

import argparse
import pathlib
import sys
from typing import Any

from .. import _core, load
from ..errors import Error, RunError
from . import Recording, Renderer, png, video
from .camera import VIEWS
from .colours import MAPS
from .context import context
from .recording import need_h5py
from .scene import parsed
from .video import check_path

_FAILED, _WRONG_INPUT = 1, 2


def _options(words: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python3 -m sinew.render", allow_abbrev=False, description=__doc__)
    parser.add_argument("source", metavar="RUN|SCENE", nargs="?", help="folder that `sinew run` wrote, or a scene, which is simulated")
    parser.add_argument("--video", metavar="FILE", help="NAME.mp4, NAME.webp, NAME.gif, NAME_%%04d.png or a folder")
    parser.add_argument("--picture", metavar="FILE", help="NAME.png, of the end or of --time")
    parser.add_argument("--time", metavar="TIME", help="of the picture")
    parser.add_argument("--duration", metavar="TIME", help="how long to simulate a scene, or how much of a run to draw")
    parser.add_argument("--set", metavar="PATH=VALUE", action="append", default=[], help="a value of the scene; may be repeated")
    parser.add_argument("--fps", type=float, default=30.0, help="frames a second (default: 30)")
    parser.add_argument("--speed", type=float, default=1.0, help="simulated seconds a second (default: 1)")
    parser.add_argument("--size", metavar="WxH", default="640x480", help="pixels (default: 640x480)")
    parser.add_argument("--camera", choices=list(VIEWS), default="corner")
    parser.add_argument("--field", help="what colours the bodies, such as displacement or von_mises_stress")
    parser.add_argument("--colour-map", choices=list(MAPS), default=MAPS[0])
    parser.add_argument("--edges", action="store_true", help="draw the edges of the mesh")
    parser.add_argument("--quiet", action="store_true", help="no progress")
    parser.add_argument("--check", action="store_true", help="only find out whether --video can be written")
    return parser.parse_args(words)


def _seconds(option: str, text: str) -> float:
    value, dimension = _core._quantity(text)
    if dimension not in ((0, 0, 0, 0), (0, 0, 1, 0)):
        raise Error("wrong-dimension", option, f"'{text}' is no time", "write a time such as 5s")
    return value


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    if not (width.isdigit() and height.isdigit()):
        raise Error("bad-argument", "--size", f"'{text}' is no size", "write 640x480")
    return int(width), int(height)


def _is_run(source: str) -> bool:
    path = pathlib.Path(source)
    return path.is_dir() or path.suffix == ".h5"


def _scene_duration(sim: Any) -> float:
    """s: the scene's own."""
    told = parsed(sim.to_yaml()).get("duration")
    if told is None:
        raise Error("bad-argument", "--duration", "the scene does not say how long to simulate", "add --duration 5s")
    return _seconds("duration", told)


def _picture(options: argparse.Namespace, drawn: dict[str, Any]) -> None:
    if _is_run(options.source):
        with Recording(options.source) as run, Renderer(run.sim, **drawn) as renderer:
            time = run.times[-1] if options.time is None else _seconds("--time", options.time)
            picture = renderer.frame(run.at(time, renderer.field))
    else:
        sim = load(options.source, set=options.set)
        time = 0.0 if options.time is None else _seconds("--time", options.time)
        sim.step(round(time / sim.time_step))
        with Renderer(sim, **drawn) as renderer:
            picture = renderer.frame()
    path = pathlib.Path(options.picture)
    try:
        path.write_bytes(png(picture))
    except OSError as problem:
        raise Error("file-unwritable", (str(path), 0, 0, ""), str(problem.strerror), "name a folder that you may write to") from None
    print(f"drew {path}")


def _video(options: argparse.Namespace, drawn: dict[str, Any]) -> None:
    length = None if options.duration is None else _seconds("--duration", options.duration)
    source: Any = options.source
    if not _is_run(source):
        check_path(options.video)
        source = load(source, set=options.set)
        length = _scene_duration(source) if length is None else length
    path = video(options.video, source, options.fps, speed=options.speed, duration=length, progress=not options.quiet, **drawn)
    if not options.quiet:
        print(f"drew {path}")


def main(words: list[str]) -> int:
    """See the file; the exit code."""
    options = _options(words)
    try:
        if options.check:
            check_path(options.video or ".")
            context()
            need_h5py()
            parsed("")
            return 0
        if options.source is None or (options.video is None and options.picture is None):
            raise Error("bad-argument", "python3 -m sinew.render", "nothing is to be drawn",
                        "name a run or a scene, and --video or --picture")
        drawn = {"size": _size(options.size), "camera": options.camera, "field": options.field, "colour_map": options.colour_map,
                 "edges": options.edges}  # fmt: skip
        if options.picture is not None:
            _picture(options, drawn)
        if options.video is not None:
            _video(options, drawn)
    except KeyboardInterrupt:
        return _FAILED
    except Error as error:
        print(f"sinew: error: {error}", file=sys.stderr)
        return _FAILED if isinstance(error, RunError) else _WRONG_INPUT
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
