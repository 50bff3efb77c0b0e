"""Videos: frames as mp4, animated WebP or GIF, or a series of PNG files."""

from __future__ import annotations

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from typing import Any, Optional, Union

import numpy as np

from .._core import Simulation
from .._whole_files import draft
from ..errors import Error
from .recording import Recording
from .renderer import Renderer

__all__ = ["check_path", "need_pillow", "video"]

_ANIMATED = (".webp", ".gif")
_MAX_FRAMES = 1_000_000
_LOOKED_AT = 40  # moments of a recorded run from which camera and colour range are determined


def video(
    path: Union[str, os.PathLike[str]],
    source: Union[Iterable[np.ndarray], Simulation, Recording, str, os.PathLike[str]],
    fps: float = 30.0,
    *,
    speed: float = 1.0,
    duration: Optional[float] = None,
    progress: bool = False,
    **options: Any,
) -> pathlib.Path:
    """Writes a video.

    Parameters
    ----------
    path : path-like
        NAME.mp4 (needs the program ffmpeg), NAME.webp or NAME.gif (need Pillow, which keeps all frames in memory and merges
        equal consecutive frames), or a series of PNG files: a name with %04d, or a folder.
    source : iterable of arrays, Simulation, Recording or path-like
        Frames (height, width, 3) uint8 of one size; a simulation, which is stepped and drawn; or a recorded run or its
        folder, which is drawn.
    fps : float
        Frames per second of the video.
    speed : float
        Simulated seconds per second of the video; not for frames.
    duration : float, optional
        Simulated time, s; required for a simulation. For a recorded run, the time from its start; by default all of it.
    progress : bool
        Whether to show the progress on a terminal.
    **options
        As for Renderer: size, camera, field ...

    Returns
    -------
    Path
        The file, or the folder of the series.

    Raises
    ------
    Error
        tool-missing, unknown-format, file-unwritable, out-of-range, bad-argument, wrong-shape; and the errors of Recording
        and Renderer.
    """
    writer = check_path(path)
    for name, value in (("fps", fps), ("speed", speed)):
        if not 0.0 < value < 1e6:
            raise Error("out-of-range", f"video({name})", f"it is {value}", "give a positive number")
    if isinstance(source, (str, os.PathLike)):
        with Recording(source) as run:
            return video(path, run, fps, speed=speed, duration=duration, progress=progress, **options)
    if isinstance(source, Simulation):
        if duration is None:
            raise Error("bad-argument", "video(duration)", "the duration is missing", "give duration in s")
        count = _count(duration, fps, speed)
        frames = _of_simulation(source, count, speed / fps, options)
    elif isinstance(source, Recording):
        length = float(source.times[-1] - source.times[0])
        count = _count(length if duration is None else min(duration, length), fps, speed)
        frames = _of_recording(source, count, speed / fps, options)
    else:
        count, frames = len(source) if hasattr(source, "__len__") else 0, iter(source)  # type: ignore[arg-type]
    try:
        return writer(pathlib.Path(path), _shown(_checked(frames), count if progress else 0), fps)
    except OSError as problem:
        raise Error("file-unwritable", (str(path), 0, 0, ""), f"it cannot be written: {problem.strerror or problem}",
                    "name a folder that you may write to, with room on its disk") from None


def _count(duration: float, fps: float, speed: float) -> int:
    """Number of frames of a duration, including both ends."""
    frames = duration * fps / speed
    if not 0.0 <= frames < _MAX_FRAMES:
        raise Error("out-of-range", "video(duration)", f"{duration:g} s are {frames:g} frames",
                    "give a duration of less than a million frames")
    return int(np.floor(frames + 1e-9)) + 1


def _of_simulation(sim: Simulation, count: int, interval: float, options: dict[str, Any]) -> Iterator[np.ndarray]:
    done = 0
    with Renderer(sim, **options) as renderer:
        for k in range(count):
            due = round(k * interval / sim.time_step)
            if due > done:
                sim.step(due - done)
                done = due
            yield renderer.frame()


def _of_recording(run: Recording, count: int, interval: float, options: dict[str, Any]) -> Iterator[np.ndarray]:
    with Renderer(run.sim, **options) as renderer:
        moments = [run.at(run.times[0] + k * interval, renderer.field) for k in range(0, count, max(1, count // _LOOKED_AT))]
        # Fits camera and colour range to the whole run.
        renderer.see(np.concatenate([renderer.extent(moment) for moment in moments]))
        renderer.widen(moments)
        for k in range(count):
            yield renderer.frame(run.at(run.times[0] + k * interval, renderer.field))


def _checked(frames: Iterable[np.ndarray]) -> Iterator[np.ndarray]:
    """Yields the frames and checks that they have one size."""
    shape = None
    for frame in frames:
        frame = np.asarray(frame)
        if frame.dtype != np.uint8 or frame.ndim != 3 or frame.shape[2] != 3 or frame.shape != (shape or frame.shape):
            raise Error("wrong-shape", "video(source)", f"a frame has shape {frame.shape} and numbers of type {frame.dtype}",
                        "give (height, width, 3) of uint8, all of one size")
        shape = frame.shape
        yield frame
    if shape is None:
        raise Error("wrong-length", "video(source)", "there are no frames", "give at least one")


def _shown(frames: Iterator[np.ndarray], count: int) -> Iterator[np.ndarray]:
    """Yields the frames and shows on a terminal how many of `count` are done."""
    shown = count > 0 and sys.stderr.isatty()
    for k, frame in enumerate(frames):
        yield frame
        if shown and (k % 5 == 4 or k + 1 == count):
            print(f"\rdrawing: {k + 1} of {count} frames", end="" if k + 1 < count else "\n", file=sys.stderr, flush=True)


def check_path(path: Union[str, os.PathLike[str]]) -> Any:
    """Checks that a video of that name can be written; to be called before a long run. Raises tool-missing, unknown-format,
    file-unwritable.
    """
    path = pathlib.Path(path)
    folder = path if path.suffix == "" else path.parent
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    if not folder.is_dir() or not os.access(folder, os.W_OK):
        raise Error("file-unwritable", (str(path), 0, 0, ""), "nothing can be written there", "name a folder that you may write to")
    if path.suffix == ".mp4":
        if shutil.which("ffmpeg") is None:
            raise Error("tool-missing", (str(path), 0, 0, ""), "a video in mp4 needs the program ffmpeg, which is not installed",
                        "apt-get install ffmpeg, or name a file .webp, or a folder for a series of PNG")
        return _write_mp4
    need_pillow()
    if path.suffix in _ANIMATED:
        return _write_animated
    if path.suffix == "" or (path.suffix == ".png" and re.search(r"%0?\d*d", path.name)):
        return _write_series
    raise Error("unknown-format", (str(path), 0, 0, ""), f"a video cannot be written as {path.suffix}",
                "name a file .mp4, .webp or .gif, one such as frame_%04d.png, or a folder")


def need_pillow() -> Any:
    """Pillow's module Image; raises tool-missing."""
    try:
        from PIL import Image
    except ImportError:
        raise Error("tool-missing", "render", "pictures are written by Pillow, which is not installed",
                    "install python3-pil, or pip install sinew[render]") from None
    return Image


def _write_series(path: pathlib.Path, frames: Iterator[np.ndarray], _: float) -> pathlib.Path:
    image = need_pillow()
    if path.suffix == "":
        path = path / "frame_%04d.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    for k, frame in enumerate(frames):
        image.fromarray(frame).save(path.parent / (path.name % k), compress_level=4)
    return path.parent


def _write_animated(path: pathlib.Path, frames: Iterator[np.ndarray], fps: float) -> pathlib.Path:
    image = need_pillow()
    path.parent.mkdir(parents=True, exist_ok=True)
    # GIF stores durations in hundredths of a second.
    first, *rest = [image.fromarray(frame) for frame in frames]
    with draft(path) as beside:
        first.save(beside, save_all=True, append_images=rest, duration=round(1000.0 / fps), loop=0,
                   **({"quality": 88, "method": 3} if path.suffix == ".webp" else {"optimize": False}))  # fmt: skip
    return path


def _write_mp4(path: pathlib.Path, frames: Iterator[np.ndarray], fps: float) -> pathlib.Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    with draft(path) as beside:
        _run_ffmpeg(beside, path, frames, fps)
    return path


def _run_ffmpeg(out: pathlib.Path, path: pathlib.Path, frames: Iterator[np.ndarray], fps: float) -> None:
    """Writes a video to `out`; `path` names it in errors."""
    first = next(frames)
    height, width = first.shape[:2]
    # Most players need even sizes and 4:2:0 chroma subsampling.
    command = ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", f"{fps:g}",
               "-i", "-", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", "-movflags", "+faststart", str(out)]  # fmt: skip
    with tempfile.TemporaryFile() as complaints:
        process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=complaints)
        try:
            process.stdin.write(first.tobytes())
            for frame in frames:
                process.stdin.write(frame.tobytes())
            process.stdin.close()
        except BrokenPipeError:
            pass  # its exit code and messages give the reason
        except BaseException:
            process.kill()
            process.wait()
            raise
        if process.wait() != 0:
            complaints.seek(0)
            told = complaints.read().decode("utf-8", "replace").strip().splitlines()
            raise Error("recording-failed", (str(path), 0, 0, ""), f"ffmpeg failed: {told[-1] if told else 'it says nothing'}",
                        "name a file .webp, or a folder for a series of PNG")
