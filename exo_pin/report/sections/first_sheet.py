"""The first sheet of a report: who and what, a picture, the verdict in words, the numbers that matter."""

from __future__ import annotations

import math
from collections.abc import Mapping

from exo_pin.anatomy import SIDES
from exo_pin.clinic import GaitProfile
from exo_pin.feasible import DeviceWalk
from exo_pin.gait import Gait, Plausibility
from exo_pin.kinematics import WalkNumbers
from exo_pin.report.document.blocks import Columns, Figure, Paragraph, Section, Table, Tiles
from exo_pin.report.draw import skeleton
from exo_pin.report.sections.clinical import degrees, score
from exo_pin.robot import Robot

_GRADES = {"fits": "fits", "concession": "fits with a concession", "no": "does not fit"}
_SESSION = ("person", "age", "date of birth", "diagnosis", "laboratory", "recorded", "recorded with")


def who_and_what(
    robot: Robot, gait: Gait, facts: Mapping[str, str], answer: DeviceWalk | None, read: Plausibility
) -> Section:
    """Person, recording, body and device beside a picture, and the verdict in words.

    Args:
        robot: The exoskeleton on the person's body.
        gait: The person's walk.
        facts: Who was recorded, where, when, and the body in words, as far as they are known.
        answer: The device's answer to the walk; None: no device was asked.
        read: The verdict on the walk as it was read.
    """
    picture, note = skeleton.poses_chart(robot, gait, width=480.0)
    kind = "one cycle that repeats" if gait.periodic else "a recording"
    rows = [[name, facts[name]] for name in _SESSION if name in facts]
    rows += [] if "recorded" in facts or gait.periodic else [["recorded", "no date in the file"]]
    rows += [["body", facts.get("body") or _body(robot)]]
    rows += [["device", robot.name if answer is None else answer.title]]
    rows += [["walk", f"{gait.source or 'source not stated'}; {kind} of {gait.duration:.2f} s"]]
    rows += [["reading it", "; ".join((read.word, *read.reasons))]]
    table, figure = Table(("", ""), rows, prose=True), Figure((picture,), note, columns=1)
    if answer is None:
        return Section("Who and what", (Columns((table,), (figure,)),))
    tile = Tiles(((f"{answer.title} and this walk", _GRADES[answer.verdict], answer.ok),))
    words = filter(None, (f"{answer.sentence}.", answer.loss_sentence, answer.belt_warning))
    sentences = (Paragraph(sentence) for sentence in words)
    return Section("Who and what", (Columns((table, tile), (figure,)), *sentences))


def _body(robot: Robot) -> str:
    body = robot.body
    return "" if body is None else f"{body.stature:.2f} m, {body.mass:.0f} kg"


def numbers(found: WalkNumbers, profile: GaitProfile | None) -> Section:
    """Speed, cadence, step lengths with their symmetry, and the Gait Profile Score.

    Args:
        found: Spatiotemporal numbers of the walk.
        profile: Its scores; None without a band.
    """
    tiles = [
        ("speed", _number(found, "speed", 2), _within(found, "speed")),
        ("cadence", _number(found, "cadence", 0), _within(found, "cadence")),
        (_lengths_words(found), _step_lengths(found), None),
    ]
    if profile is not None:
        sides = ", ".join(f"{side} {score(profile, side)}" for side in SIDES)
        known = not math.isnan(profile.overall)
        what = f"Gait Profile Score; {sides}" if known else "Gait Profile Score: see there what is missing"
        tiles.append((what, f"{degrees(profile.overall)} deg" if known else "-", None))
    missing = [Paragraph(f"No numbers of steps: {found.missing}.")] if found.missing else []
    return Section("Four numbers", (Tiles(tuple(tiles)), *missing))


def _number(found: WalkNumbers, name: str, digits: int) -> str:
    number = found.numbers.get(name)
    if number is None:
        return "-"
    sd = "" if math.isnan(number.sd) else f" ± {number.sd:.{digits}f}"
    return f"{number.mean:.{digits}f}{sd} {number.unit}"


def _within(found: WalkNumbers, name: str) -> bool | None:
    word = found.verdicts.get(name)
    return None if word is None else word == "within" or None


def _step_lengths(found: WalkNumbers) -> str:
    each = [found.numbers.get(f"{side}_step_length") for side in SIDES]
    words = " / ".join("-" if x is None else f"{x.mean:.2f}" for x in each)
    return f"{words} m"


def _lengths_words(found: WalkNumbers) -> str:
    symmetry = found.numbers.get("step_length_symmetry")
    apart = "" if symmetry is None else f"; they differ by {symmetry.mean:.0f} %"
    return f"step lengths left / right{apart}"
