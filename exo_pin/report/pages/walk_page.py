"""One walk on one device for an engineer or a clinician, with the unit of each number and every choice."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from exo_pin import crosscheck, kinematics
from exo_pin.anatomy.names import Speed
from exo_pin.feasible import DeviceWalk
from exo_pin.gait import Gait, Plausibility, Torques
from exo_pin.gait.heading import heading, turned
from exo_pin.gait.marked_feet import FootMarkers
from exo_pin.kinematics import joint_rates
from exo_pin.report.document.blocks import Document, Paragraph, Player, Section, Tiles
from exo_pin.report.sections import actuators, agreement, fact_tables, foot_paths
from exo_pin.report.sections.angles import curves
from exo_pin.report.sections.centre_of_mass_path import centre_of_mass
from exo_pin.report.sections.ranges import ranges
from exo_pin.robot import Robot


@dataclass(frozen=True, kw_only=True)
class ReportInfo:
    """What the report states about itself; any characters are accepted.

    Attributes:
        title: Heading.
        who: Whose walk, or who made the report.
        what: The file or the walk's name.
        when: The moment of the run.
        choices: What was chosen, by name, e.g. the preset of a file.
    """

    title: str = "Gait report"
    who: str = ""
    what: str = ""
    when: str = ""
    choices: Mapping[str, str] = field(default_factory=dict)


def walk(
    robot: Robot,
    gait: Gait,
    *,
    info: ReportInfo | None = None,
    player: str = "",
    still: bytes = b"",
    normal: Speed | None = "free",
    cutoff: float | None = 6.0,
    torques: Torques | None = None,
    plausibility: Plausibility | None = None,
    feet: FootMarkers | None = None,
    answer: DeviceWalk | None = None,
) -> Document:
    """The report of a walk.

    Args:
        robot: The device on a body.
        gait: The walk, with its events (without them cycle and contact are unknown).
        info: Title, person, walk and time of the report.
        player: A whole HTML page to embed; empty: none.
        still: A PNG that replaces the player on paper.
        normal: Speed of the normative band behind the joint curves; None: no band.
        cutoff: Low-pass of velocities and accelerations of recordings [Hz]; None: no filter. Periodic walks
            are differentiated by their Fourier series and never filtered.
        torques: Joint torques at the walk's times, if known.
        plausibility: The verdict on the walk as it was read; default: by its motion on this robot.
        feet: Heel and toe markers of the walk's trial, where lengths are measured.
        answer: The device's answer to the walk: verdict, reason and loss, stated first.

    Raises:
        DescriptionError: The robot was not made for a body.
        GaitError: The torques belong to another time.
    """
    info = info or ReportInfo()
    gait, forward = _ahead(gait)
    verdict = crosscheck.check(robot, gait)
    rates = joint_rates(robot, gait, cutoff=cutoff)
    sections = [
        *([] if answer is None else [_answered(answer)]),
        _summary(gait, info, verdict, plausibility or kinematics.plausibility(robot, gait)),
        fact_tables.body(robot),
        fact_tables.device(robot),
        *([_played(player, info.title, still)] if player else []),
        curves(robot, gait, normal, None if answer is None or not answer.device.locked else answer.gait),
        ranges(robot, gait),
        actuators.rates(robot, gait, rates),
        *([actuators.torques(robot, gait, torques)] if torques else []),
        foot_paths.paths(robot, gait, forward),
        centre_of_mass(robot, gait),
        foot_paths.contact(gait),
        fact_tables.numbers(robot, gait, feet),
        agreement.inverse(gait, verdict),
        agreement.agreement(verdict),
        fact_tables.choices(robot, gait, {"forward": forward, **info.choices}, rates.how, normal),
    ]
    under = [f"{name}: {words}" for name, words in (("walk", info.what), ("who", info.who)) if words]
    return Document(info.title, "; ".join([*under, *([info.when] if info.when else [])]), tuple(sections))


def _answered(answer: DeviceWalk) -> Section:
    """The verdict on device and walk with its reason, and what the soles lose."""
    grades = {"fits": "fits", "concession": "fits with a concession", "no": "does not fit"}
    tiles = (
        (f"{answer.title} and this walk", grades[answer.verdict], answer.ok),
        ("soles miss the walk's, rms", f"{1e3 * answer.loss.rms:.1f} mm", None),
        ("motors", str(answer.device.motors), None),
    )
    words = filter(None, (f"{answer.sentence}.", answer.loss_sentence, answer.belt_warning))
    return Section("Verdict", (Tiles(tiles), *(Paragraph(sentence) for sentence in words)))


def _ahead(gait: Gait) -> tuple[Gait, str]:
    """The walk turned so that it goes along x, and what forward means, in words."""
    angle = heading(gait)
    if angle is None:
        return gait, "the walk's own x axis"
    how = f"the pelvis's mean heading, {np.degrees(angle) + 0.0:.1f} deg from the walk's own x axis"
    return turned(gait, -angle), how


def _summary(gait: Gait, info: ReportInfo, verdict: crosscheck.Check, read: Plausibility) -> Section:
    track = verdict.recovery.track
    apart = max(verdict.fk.values())
    outside = verdict.joints_outside
    tiles = (
        ("the walk as it was read", read.word, not read.reasons),
        (
            "cross-checks of the model",
            "all agree" if verdict.consistent else _disagreement(verdict),
            verdict.consistent,
        ),
        ("joints outside their limits", str(len(outside)), not outside),
        ("frames whose feet were reached", f"{int(track.converged.sum())} of {len(track)}", verdict.ik_ok),
        ("largest disagreement of four models [m, rotation entries]", f"{apart:.0e}", verdict.fk_ok),
        ("length of the walk", f"{gait.duration:.3f} s", None),
        ("samples", str(len(gait)), None),
    )
    words = f"{info.what or 'The walk'}: {gait.source or 'source not stated'}."
    kind = "One cycle that repeats." if gait.periodic else "A recording that does not repeat."
    reasons = [Paragraph(f"Doubtful: {reason}") for reason in read.reasons]
    return Section("Summary", (Tiles(tiles), *reasons, Paragraph(f"{words} {kind}")))


def _disagreement(verdict: crosscheck.Check) -> str:
    reasons = (
        (verdict.fk_ok, "forward kinematics differ"),
        (verdict.ik_ok, "inverse kinematics missed feet"),
        (verdict.angles_ok, "recovered angles differ"),
    )
    return "; ".join(words for ok, words in reasons if not ok)


def _played(player: str, title: str, still: bytes) -> Section:
    words = "Drag to turn, space to play; it works without a network."
    return Section("The walk", (Player(player, f"Player: {title}", still), Paragraph(words, "note screen")))
