"""`exo-pin reproduce`: the paper's figures from our data, with a page that compares."""

from __future__ import annotations

import argparse
import io
import os
import shutil
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from exo_pin.cli import options, shot_options, show, trials
from exo_pin.errors import DescriptionError, ExoPinError, FormatError
from exo_pin.files import write_bytes, write_text

if TYPE_CHECKING:
    from exo_pin.gait import Gait
    from exo_pin.report import Document, RenderedPictures
    from exo_pin.robot import Robot

_EXAMPLES = """examples:
  exo-pin reproduce -o figures
  exo-pin reproduce walk.mot -o figures             with a recording in Fig. 4 and 6
  exo-pin reproduce -o figures --no-render          without the browser's pictures

Writes reproduction.html (one self-contained page), reproduction.md, and every figure as a file of its own.
The 3-D pictures need Chromium; without it line drawings take their place, and the page says so."""

_POSES = 10
_POSE_SIZE = (300, 460)  # [px]
_MODEL_SIZE = (1200, 900)  # [px]


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the command's arguments."""
    parser.epilog = _EXAMPLES
    parser.add_argument("-o", "--output", metavar="DIR", required=True, help="the folder to write into")
    parser.add_argument(
        "gait", metavar="GAIT", nargs="?", help="a recorded walk to show in Fig. 4 and to recover in Fig. 6"
    )
    options.add_preset(parser, "sign convention of that file")
    parser.add_argument(
        "--no-render", action="store_true", help="line drawings instead of the browser's pictures"
    )
    parser.add_argument("--quality", default="high", help="of the browser's pictures: high (default) or low")
    shot_options.add_timeout(parser)
    trials.add(parser)
    options.add_body(parser)


def run(args: argparse.Namespace) -> int:
    """Compute, draw, write."""
    from exo_pin import report
    from exo_pin.cli.clock import moment
    from exo_pin.gait import normative_gait
    from exo_pin.robot import load_robot

    body = options.body_from(args)
    robot = load_robot(body)
    gait = normative_gait("free", leg_length=body.leg_length)
    recording = None
    if args.gait is not None:
        recording, _ = options.with_events(robot, options.gait_from(args, body))
    _check_folder(Path(args.output))
    with show.busy("drawing"):
        document = report.reproduction(
            robot,
            gait,
            recording=recording,
            recording_name=Path(args.gait or "").name,
            rendered=_rendered(args, robot, gait),
            when=moment(),
        )
    with _folder(args.output) as folder:
        size = _write(document, folder)
    print(f"{folder / 'reproduction.html'}: {size / 1e6:.1f} MB; reproduction.md and")
    print(f"{len(document.drawings)} figures are beside it")
    return 0


def _write(document: Document, folder: Path) -> int:
    """Write the figures and both pages; size of the page in HTML [bytes]."""
    from exo_pin import report

    for drawing in document.drawings:
        write_bytes(folder / drawing.file, drawing.data)
    write_text(folder / "reproduction.md", report.markdown(document))
    page = report.html(document)
    write_text(folder / "reproduction.html", page)
    return len(page.encode())


def _check_folder(folder: Path) -> None:
    """Refuse what cannot be made a folder before the work begins; it is made at its end."""
    there = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    if not there.is_dir():
        raise FormatError(folder, f"cannot be made a folder: {there} is a file")
    if not os.access(there, os.W_OK):
        raise FormatError(folder, f"cannot be made a folder: {there} may not be written to")


@contextmanager
def _folder(name: str) -> Iterator[Path]:
    """The folder to write into; what this run makes of its path is removed if the run fails."""
    folder = Path(name)
    new = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FormatError(folder, f"cannot be made a folder: {error.strerror}") from error
    try:
        yield folder
    except BaseException:
        for path in new[-1:]:
            shutil.rmtree(path, ignore_errors=True)
        raise


def _rendered(args: argparse.Namespace, robot: Robot, gait: Gait) -> RenderedPictures:
    """The model and ten poses rendered by the browser; without one, empty and a line on stderr."""
    from exo_pin import viewer
    from exo_pin.report import RenderedPictures
    from exo_pin.viewer.film import shots

    if args.no_render:
        return RenderedPictures()
    scene = viewer.scene(robot, gait, title="the walk")
    chosen = {"quality": args.quality, "timeout": args.timeout}
    phases = [k / _POSES for k in range(_POSES)]
    try:
        model = shots.picture(scene, size=_MODEL_SIZE, **chosen)
        poses = shots.pictures(scene, phases, camera="left", size=_POSE_SIZE, legend=False, **chosen)
    except DescriptionError:  # an option is wrong
        raise
    except ExoPinError as error:
        print(f"no rendered pictures: {error}", file=sys.stderr)
        return RenderedPictures()
    return RenderedPictures(model=model, poses=_side_by_side(poses))


def _side_by_side(pictures: Sequence[bytes]) -> bytes:
    """Pictures side by side in two rows, each with its percent of the cycle, as PNG."""
    from PIL import Image, ImageDraw, ImageFont

    half = (len(pictures) + 1) // 2
    width, height = _POSE_SIZE
    whole = Image.new("RGB", (half * width, 2 * height), "white")
    pen, font = ImageDraw.Draw(whole), ImageFont.load_default(24)
    for k, picture in enumerate(pictures):
        x, y = k % half * width, k // half * height
        whole.paste(Image.open(io.BytesIO(picture)), (x, y))
        pen.text((x + 14, y + 12), f"{100 * k / len(pictures):.0f} %", fill="#1d2733", font=font)
    file = io.BytesIO()
    whole.save(file, "PNG", optimize=True)
    return file.getvalue()
