"""Everything public of the package, and a valid example for each argument that can be checked."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import exo_pin

NOT_WALKED = {
    "clinic", "export", "plot", "report", "viewer",
}  # fmt: skip
"""Rooms that are still to be walked: they draw, write and score records that other rooms have checked."""

CHECKED_LATER = {
    "devices.Actuator", "dh.JointState", "dh.Needed", "dh.PelvisState", "formats.ReadOptions",
    "ik.Points", "ik.Pose", "ik.Position", "kinematics.PlateStep", "markers.Spot",
}  # fmt: skip
"""Records that are checked by the function that takes them."""

_ROWS = {"one axis less", "one row less"}
_ANY_NUMBER = {"one number less", "one row less"}
_MEANT: Mapping[str, set[str]] = {
    "control.passive_moments.q": _ROWS,
    "control.shares.dq": {"nan"},
    "control.shares.tau": {"nan"},
    "control.stride_work.power": {"nan"},
    "demand.peak_demands.available": {"inf", "one axis less", "integer"},
    "demand.peak_demands.required": {"nan", "one row less"},
    "demand.range_demands.q": {"one row less"},
    "description.arguments_xacro.values": {"unknown name"},
    "description.expand.values": {"unknown name"},
    "devices.movement_of.joint": {"unknown", "empty text"},
    "dynamics.in_world_axes.tau": {"nan", "one number less"},
    "feasible.nearest.q": {"one row less"},
    "crosscheck.forward.q": {"one row less"},
    "formats.is_markers.path": {"folder"},
    "formats.load_gait.columns": {"empty"},
    "formats.load_gait.mapping": {"unknown name"},
    "formats.written_format.path": {"missing", "NUL"},
    "gait.ForcePlate.force": {"nan"},
    "gait.ForcePlate.moment": {"nan", "inf", "-inf"},
    "gait.ForcePlate.point": {"nan", "inf", "-inf"},
    "gait.Markers.angles": {"unknown name", *(f"LHipAngles: {what}" for what in ("nan", "inf", "-inf"))},
    "gait.Markers.position": {"nan"},
    "gait.Markers.up": {"empty text"},
    "gait.Number.of.values": _ANY_NUMBER,
    "gait.Torques.at.time": _ANY_NUMBER,
    "gait.Torques.tau": {"nan"},
    "gait.against_normal.leg_length": {"nan"},
    "gait.against_normal.numbers": {"unknown name"},
    "gait.against_normal.stature": {"nan"},
    "gait.normal.leg_length": {"nan"},
    "gait.normal.numbers": {"unknown name"},
    "gait.normal.stature": {"nan"},
    "gait.spatiotemporal.heels": {"nan", "one number less"},
    "gait.spatiotemporal.until": {"inf"},
    "ground.lowest_corners.positions": {"one row less"},
    "ground.place.q": {"one number less"},
    "ground.standing.time": _ANY_NUMBER,
    "kinematics.smoothed_curves.q": {"one number less"},
    "ik.Online.step.targets": {"nan", "inf", "-inf"},
    "markers.MarkerSet.also": {"unknown name"},
    "markers.MarkerSet.hips": {"number"},
    "markers.MarkerSet.marking.landmark": {"unknown", "empty text"},
    "markers.MarkerSet.names.marker": {"unknown", "empty text"},
    "markers.MarkerSet.spots": {"unknown name"},
    "retarget.Target.feet": {"empty"},
    "retarget.Target.file": {"missing", "folder", "NUL"},
    "retarget.Target.forward": {"empty text"},
    "retarget.Target.limits": {"unknown name"},
    "retarget.Target.locked": {"unknown"},
    "retarget.Target.stand": {"unknown name"},
    "retarget.Target.up": {"empty text"},
    "retarget.find.target": {"folder"},
    "study.part.path": {"missing", "folder", "NUL"},
    "study.recordings.folder": {"folder"},
    "walking.divergent_component.position": _ANY_NUMBER,
    "walking.fall.time": _ANY_NUMBER,
    "walking.margin.point": {"one row less"},
    "signals.filled.y": {"nan", "one axis more", "one number less"},
    "signals.longest_run.good": _ANY_NUMBER,
    "signals.lowpass.y": {"one axis more", "one number less"},
    "signals.spikes.y": {"one axis more", "one number less"},
    "walking.Preview.com.zmp": {"one row less"},
    "walking.com_of_zmp.zmp": {"one row less"},
    "walking.zmp_of_com.com": {"one row less"},
    "sizing.JointLoad.joint": {"unknown", "empty text"},
    "sizing.JointLoad.stride": {"nan"},
    "sizing.Spring.torque.angle": {"one axis more", "integer", *_ROWS, *_ANY_NUMBER},
    "sizing.joint_loads.stride": {"nan"},
    "sizing.size.stride": {"nan"},
}
"""Values that a function understands by its docstring: NaN for what was not measured, any number of rows."""


def means_something(function: str, argument: str) -> set[str]:
    """Names of the wrong values that are right for an argument after all."""
    any_rows = _ROWS if argument in ("q", "base") and function.split(".")[0] in _OF_MANY_SAMPLES else set()
    return _MEANT.get(f"{function}.{argument}", set()) | any_rows


_OF_MANY_SAMPLES = {"dh", "ik", "kinematics", "robot"}
"""Rooms whose configurations and bases may have any axes of samples in front."""

WITHOUT_CALLERS = {
    "arguments", "arrays", "cache", "chunks", "cli", "errors", "examples", "files", "frozen_fields",
    "html_summary", "physics", "plugins", "ros_packages", "safe", "scratch", "short_repr",
    "version", "xacro_files", "__main__",
}  # fmt: skip
"""Rooms that the others stand on, or the command line: no one calls them from outside."""


RESULTS = {
    "anatomy.Leg", "compare.Comparison", "compare.DeviceMotion", "compare.JointChoices", "compare.Loss",
    "compare.Spread", "compare.Walk", "control.JointTorque", "control.Reference", "control.StrideWork",
    "control.WalkTorques", "crosscheck.Check", "crosscheck.Recovery", "demand.JointDemand",
    "demand.PeakDemand", "demand.RangeDemand", "dh.DHRow", "dh.Link", "dynamics.Dynamics",
    "dynamics.GroundForces", "dynamics.Motion", "dynamics.Residual", "dynamics.WeightCheck",
    "edit.Recheck", "feasible.Concession", "feasible.DeviceWalk", "feasible.Failure",
    "feasible.Feasibility", "feasible.Fit", "feasible.Nearest", "formats.Format", "formats.TrialFile",
    "gait.Cycles", "gait.LegCycle", "gait.Norm", "gait.Number", "gait.Plausibility", "gait.Stride",
    "gait.StrideEstimate", "ground.PlacedWalk", "ground.Support", "ik.Solution", "ik.Track",
    "kinematics.CenterOfMass", "kinematics.Contacts", "kinematics.CurveOutlier",
    "kinematics.EventDifference", "kinematics.JointRates", "kinematics.SoleSlide",
    "kinematics.StanceSlide", "kinematics.WalkNumbers", "markers.Recognised", "markers.Reconstruction",
    "report.Document", "report.Drawing", "retarget.Biped", "retarget.LimitUse", "retarget.Retargeted",
    "robot.LegAxes", "robot.Robot", "robot.Subtree", "robot.SubtreeArrays", "signals.Filled",
    "signals.Outlier", "simulation.Run", "simulation.Verdict", "sizing.GearedUse", "sizing.JointSizing",
    "sizing.Ratios", "sizing.Sizing", "sizing.SizingCase", "sizing.WorstCase", "study.Case",
    "study.Outcome", "study.Row", "study.Share", "study.SimulatedRow", "study.SimulatedStudy",
    "study.Study", "viewer.Kinetics", "viewer.Scene", "viewer.View", "walking.Plan",
}  # fmt: skip
"""Records that the package makes and people read; the functions that make them are walked."""

NOT_YET = {
    "dh.inverse_dynamics", "study.Case", "study.load", "study.part", "study.recordings", "study.run",
    "study.run_simulations", "study.save", "study.walking_shares",
    "formats.TrialFile.person", "formats.TrialFile.torques", "formats.ReadOptions.refuse",
}  # fmt: skip
"""Methods of readers: `load_gait`, `load_torques` and the like call them with what they checked."""

SLOW = {
    "crosscheck.check", "crosscheck.inverse_dynamics", "feasible.device_walk", "feasible.feasible",
    "markers.load_walk", "markers.model_set", "markers.reconstruct", "sizing.worst_cases", "study.run",
}  # fmt: skip
"""Functions that other tests call with right values: here they are only to refuse."""

KERNELS = {
    "control.Controller", "control.Patient.given", "control.Patient.own", "control.Patient.tissues",
    "ground.transformed", "robot.LegAxes", "robot.Subtree", "robot.SubtreeArrays", "viewer.Server",
}  # fmt: skip
"""Methods, or whole classes, that run inside solvers and loops or answer a browser: checked before."""

LABELS = {
    "by", "choices", "comment", "compare_title", "failures", "known_as", "licence", "name", "note", "notes",
    "player", "recording_name", "reference_title", "remarks", "source", "subject", "subtitle", "title",
    "token", "unit", "what", "when", "who", "why", "more", "code", "version",
}  # fmt: skip
"""Arguments that hold words for people: any text is right."""

REFERS = {"gait.speed_named", "gait.Markers.of", "markers.find_set"}
"""Functions whose `name` is looked up, not shown."""


class Public(NamedTuple):
    """A public function, class or method: how tests name it, and what is called."""

    name: str
    call: Callable[..., Any]
    owner: type | None = None


def rooms() -> list[str]:
    """Names of the rooms whose functions people call."""
    return sorted({m.name for m in pkgutil.iter_modules(exo_pin.__path__)} - WITHOUT_CALLERS)


def _named(room: str) -> list[str]:
    module = importlib.import_module(f"exo_pin.{room}")
    own = [name for name, what in vars(module).items() if getattr(what, "__module__", "") == module.__name__]
    return [name for name in getattr(module, "__all__", own) if not name.startswith("_")]


def everything() -> Iterator[Public]:
    """Every public callable once: `exo_pin.__all__`, the rooms', and the methods of their classes."""
    seen = set()
    found = [("", name, getattr(exo_pin, name)) for name in exo_pin.__all__]
    for room in rooms():
        module = importlib.import_module(f"exo_pin.{room}")
        found += [(room, name, getattr(module, name)) for name in _named(room)]
    for _, name, what in sorted(found, key=lambda entry: entry[0] == ""):  # under its room's name
        if (
            not callable(what)
            or id(what) in seen
            or not getattr(what, "__module__", "").startswith("exo_pin")
        ):
            continue
        seen.add(id(what))
        home = what.__module__.split(".")[1]
        if home in WITHOUT_CALLERS:
            continue
        yield Public(f"{home}.{name}", what)
        if inspect.isclass(what):
            yield from _methods(f"{home}.{name}", what)


def _methods(name: str, owner: type) -> Iterator[Public]:
    for member, how in vars(owner).items():
        own = not isinstance(how, classmethod | staticmethod)
        if not member.startswith("_") and (inspect.isfunction(how) or not own):
            yield Public(f"{name}.{member}", getattr(owner, member), owner if own else None)


_COUNT = re.compile(r"^int( \| None)?$")
_NUMBER = re.compile(r"^(float|npt\.ArrayLike \| float)( \| None)?$")
_PATH = re.compile(r"^(str \| )?Path\b")
_WORDS = (
    "Side|Movement|HipOrder|Base|EventKind|Sex|Speed|PelvisMotion|PassiveJoints|KneeRule|SupportStyle|AngleUnit"
    "|LengthUnit|SignPreset|Segment|HipRegression|Content|str|ConcessionKind|Vertical|Masses"
)
_NAME = re.compile(
    rf"^({_WORDS}|Literal\[.*|Vertical \| .*|SupportName \| .*|str \| [\w.]+)( \| None| \| float)?$"
)
_NAMES = re.compile(
    rf"^(Sequence|Iterable|tuple)\[({_WORDS}|str \| Device|PelvisRotation)(, \.\.\.)?\]( \| None)?$"
)


def kind(annotation: str) -> str:
    """What an argument holds: a name in `bad_arguments.KINDS`, or "" for records, flags and functions."""
    if _PATH.match(annotation):
        return "path"
    if re.match(r"(npt\.)?(Array|Mask|Index|ArrayLike|NDArray)\b", annotation):
        return "array"
    if re.match(r"^tuple\[float", annotation):
        return "array"
    for name, pattern in (("count", _COUNT), ("number", _NUMBER), ("name", _NAME), ("names", _NAMES)):
        if pattern.match(annotation):
            return name
    if re.match(r"^Mapping\[", annotation):
        return "mapping"
    return "names" if re.match(r"^Iterable\[float\]", annotation) else ""


def walked() -> list[Public]:
    """What takes arguments from people."""
    return [p for p in everything() if p.name not in RESULTS | CHECKED_LATER and not _inner(p)]


def _inner(public: Public) -> bool:
    own = {public.name, public.name.rpartition(".")[0]}
    return bool(own & (KERNELS | NOT_YET)) or public.name.split(".")[0] in NOT_WALKED


def checkable(public: Public) -> dict[str, str]:
    """Argument -> kind, of those that a function can tell wrong from right."""
    kinds = {name: kind(annotation) for name, annotation in arguments(public).items()}
    named = {"name"} if public.name in REFERS else set()
    return {name: how for name, how in kinds.items() if how and name not in LABELS - named}


def arguments(public: Public) -> dict[str, str]:
    """Argument -> its annotation."""
    parameters = inspect.signature(public.call).parameters.values()
    free = inspect.Parameter.VAR_KEYWORD
    return {p.name: _text(p.annotation) for p in parameters if p.name != "self" and p.kind is not free}


def _text(annotation: Any) -> str:
    text = getattr(annotation, "__forward_arg__", annotation)
    return text if isinstance(text, str) else getattr(text, "__name__", str(text))
