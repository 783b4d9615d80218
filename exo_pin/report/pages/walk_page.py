"""One walk on one device for an engineer or a clinician, with the unit of each number and every choice."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from exo_pin import crosscheck, kinematics
from exo_pin.anatomy import JOINTS
from exo_pin.anatomy.names import Speed
from exo_pin.clinic import ClinicalCycles, NormalBand, clinical_cycles, gait_profile, published_band
from exo_pin.feasible import DeviceWalk
from exo_pin.gait import Gait, Plausibility, Torques
from exo_pin.gait.heading import heading, turned
from exo_pin.gait.marked_feet import FootMarkers
from exo_pin.kinematics import joint_rates, with_events
from exo_pin.report.document.blocks import Document, Paragraph, Player, Section, Tiles
from exo_pin.report.sections import (
    actuators,
    agreement,
    clinical,
    control,
    fact_tables,
    first_sheet,
    foot_paths,
    forces,
)
from exo_pin.report.sections.angles import curves
from exo_pin.report.sections.centre_of_mass_path import centre_of_mass
from exo_pin.report.sections.ranges import ranges
from exo_pin.robot import Robot, load_robot
from exo_pin.simulation import Run


@dataclass(frozen=True, kw_only=True)
class ReportInfo:
    """What the report states about itself; any characters are accepted.

    Attributes:
        title: Heading.
        who: Whose walk, or who made the report.
        what: The file or the walk's name.
        when: The moment of the run.
        choices: What was chosen, by name, e.g. the preset of a file.
        session: Who was recorded, where and when, by the file (`TrialFile.session`), and `body` in words.
    """

    title: str = "Gait report"
    who: str = ""
    what: str = ""
    when: str = ""
    choices: Mapping[str, str] = field(default_factory=dict)
    session: Mapping[str, str] = field(default_factory=dict)


def walk(
    robot: Robot,
    gait: Gait,
    *,
    info: ReportInfo | None = None,
    player: str = "",
    still: bytes = b"",
    normal: NormalBand | Speed | None = "free",
    cutoff: float | None = 6.0,
    torques: Torques | None = None,
    plausibility: Plausibility | None = None,
    feet: FootMarkers | None = None,
    answer: DeviceWalk | None = None,
    clinical_sides: Sequence[ClinicalCycles] | None = None,
    loads: forces.Loads | str = "",
    run: Run | None = None,
) -> Document:
    """The report of a walk: two sheets of answers, forces and control where they are given, an appendix.

    Args:
        robot: The device on a body.
        gait: The walk, with its events (without them cycle and contact are unknown).
        info: Title, person, walk and time of the report.
        player: A whole HTML page to embed; empty: none.
        still: A PNG that replaces the player on paper.
        normal: The normal band, or its speed in Schwartz 2008; None: no band.
        cutoff: Low-pass of velocities and accelerations of recordings [Hz]; None: no filter. Periodic walks
            are differentiated by their Fourier series and never filtered.
        torques: Joint torques at the walk's times, if known.
        plausibility: The verdict on the walk as it was read; default: by its motion on this robot.
        feet: Heel and toe markers of the walk's trial, where lengths are measured.
        answer: The device's answer to the walk: verdict, reason and loss, stated first.
        clinical_sides: The person's cycles; default: `clinic.clinical_cycles` of the walk.
        loads: Forces of the walk; words: why there are none; empty: no chapter on them.
        run: A simulated run; None: no chapter on control.

    Raises:
        DescriptionError: The robot was not made for a body.
        GaitError: The torques belong to another time.
    """
    info = info or ReportInfo()
    gait, forward = _ahead(gait)
    band = published_band(normal) if isinstance(normal, str) else normal
    read = plausibility or kinematics.plausibility(robot, gait)
    person, device = (gait, None) if answer is None else _person_and_device(answer, gait)
    legs = robot if set(JOINTS) <= set(robot.joints) else load_robot(robot.body)
    found = kinematics.walk_numbers(legs, person, feet)
    sides = clinical_cycles(legs, person, feet=feet) if clinical_sides is None else clinical_sides
    profile = None if band is None else gait_profile(sides, band)
    facts = ({"person": info.who} if info.who else {}) | dict(info.session)
    sections = [
        first_sheet.who_and_what(legs, _ahead(person)[0], facts, answer, read),
        first_sheet.numbers(found, profile),
        curves(robot, person, band, device),
        *([_played(player, info.title, still)] if player else []),
        clinical.beside_the_joints(sides, band),
        *([] if profile is None else [clinical.profile(profile)]),
        fact_tables.numbers(found),
        *_forces(loads),
        *([actuators.torques(robot, gait, torques)] if torques else []),
        *([] if run is None else [control.control(run)]),
        *_appendix(robot, gait, info, {"forward": forward, **_cited(found)}, band, cutoff),
    ]
    under = [f"{name}: {words}" for name, words in (("walk", info.what), ("who", info.who)) if words]
    foot = ", ".join(filter(None, (facts.get("person", ""), info.what, info.when)))
    subtitle = "; ".join([*under, *([info.when] if info.when else [])])
    return Document(info.title, subtitle, tuple(sections), foot or info.title)


def _person_and_device(answer: DeviceWalk, shown: Gait) -> tuple[Gait, Gait | None]:
    """The recorded walk with its events, and the device's motion; None where that is the recorded one."""
    person = with_events(answer.as_recorded.robot, answer.recorded) if shown.events else answer.recorded
    same = len(person) == len(shown) and np.allclose(person.q, shown.q, rtol=0, atol=1e-3)
    return person, None if same else shown


def _forces(loads: forces.Loads | str) -> list[Section]:
    if isinstance(loads, str):
        return [forces.not_known(loads)] if loads else []
    return [forces.forces(loads)]


def _appendix(
    robot: Robot,
    gait: Gait,
    info: ReportInfo,
    said: Mapping[str, str],
    band: NormalBand | None,
    cutoff: float | None,
) -> list[Section]:
    """Numerics: residuals, limits, cross-checks, choices."""
    verdict, rates = crosscheck.check(robot, gait), joint_rates(robot, gait, cutoff=cutoff)
    sections = [
        _checked(gait, verdict),
        fact_tables.body(robot),
        fact_tables.device(robot),
        ranges(robot, gait),
        actuators.rates(robot, gait, rates),
        foot_paths.paths(robot, gait, said["forward"]),
        centre_of_mass(robot, gait),
        foot_paths.contact(gait),
        agreement.inverse(gait, verdict),
        agreement.agreement(verdict),
        fact_tables.choices(robot, gait, {**said, **info.choices}, rates.how, band),
    ]
    return [replace(section, kind="appendix") for section in sections]


def _cited(found: kinematics.WalkNumbers) -> dict[str, str]:
    """Where lengths were measured, and the publications of the usual ranges."""
    cited = "; ".join(f"{key}: {text}" for key, text in sorted(found.citations.items()))
    places = ", ".join(dict.fromkeys(found.measured.values()))
    words = {"lengths are measured at": places, "usual ranges": cited}
    return {what: text for what, text in words.items() if text}


def _checked(gait: Gait, verdict: crosscheck.Check) -> Section:
    track = verdict.recovery.track
    outside = verdict.joints_outside
    apart = max(verdict.fk.values())
    tiles = (
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
    return Section("Appendix: how far to trust the numbers", (Tiles(tiles),))


def _ahead(gait: Gait) -> tuple[Gait, str]:
    """The walk turned so that it goes along x, and what forward means, in words."""
    angle = heading(gait)
    if angle is None:
        return gait, "the walk's own x axis"
    how = f"the pelvis's mean heading, {np.degrees(angle) + 0.0:.1f} deg from the walk's own x axis"
    return turned(gait, -angle), how


def _disagreement(verdict: crosscheck.Check) -> str:
    reasons = (
        (verdict.fk_ok, "forward kinematics differ"),
        (verdict.ik_ok, "inverse kinematics missed feet"),
        (verdict.angles_ok, "recovered angles differ"),
    )
    return "; ".join(words for ok, words in reasons if not ok)


def _played(player: str, title: str, still: bytes) -> Section:
    words = "Drag to turn, space to play; it works without a network."
    blocks = (Player(player, f"Player: {title}", still), Paragraph(words, "note screen"))
    return Section("The walk in 3-D", blocks, "" if still else "screen")
