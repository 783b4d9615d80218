"""Public functions refuse wrong numbers, shapes, counts and names with a documented error, and in no time."""

from __future__ import annotations

import inspect
import re
import signal
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest

from exo_pin import arguments, ik
from exo_pin.errors import DescriptionError, ExoPinError
from tests import bad_arguments, public_api
from tests.api_examples import Examples
from tests.bad_arguments import Wrong
from tests.public_api import Public

SECONDS = 5.0  # of a refusal: it comes before the work
WALKED = {public.name: public for public in public_api.walked()}


@pytest.fixture(scope="module")
def examples(tmp_path_factory: pytest.TempPathFactory) -> Examples:
    return Examples(tmp_path_factory.mktemp("examples"))


@contextmanager
def _at_most(seconds: float) -> Iterator[None]:
    """Interrupt what hangs."""

    def stop(*_: Any) -> None:
        raise AssertionError(f"no answer within {seconds:g} s")

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def _right(public: Public, examples: Examples) -> dict[str, Any]:
    """A right value for every argument that has an example or no default."""
    found: dict[str, Any] = {} if public.owner is None else {"self": examples.instance(public.owner)}
    for name, parameter in inspect.signature(public.call).parameters.items():
        required = parameter.default is parameter.empty and parameter.kind is not parameter.VAR_KEYWORD
        if name != "self" and (required or examples.has(public.name, name)):
            found[name] = examples.of(public.name, name)
    return found


def _call(public: Public, values: dict[str, Any], *, seconds: float = SECONDS) -> Any:
    kinds = {name: p.kind for name, p in inspect.signature(public.call).parameters.items()}
    several = inspect.Parameter.VAR_POSITIONAL in kinds.values()
    positional = inspect.Parameter.VAR_POSITIONAL
    in_front = {name for name in values if several and (name == "self" or kinds[name] is positional)}
    first = [value for name, value in values.items() if name in in_front]
    rest = {name: value for name, value in values.items() if name not in in_front}
    with warnings.catch_warnings(), _at_most(seconds):
        warnings.simplefilter("ignore")
        return public.call(*first, **rest)


def _objection(public: Public, values: dict[str, Any], wrong: Wrong, usual: bool) -> str:
    """What is wrong with how a function takes a wrong value; empty where it refuses or bears it."""
    try:
        answer = _call(public, values)
    except ExoPinError:
        return ""
    except Exception as error:  # whatever it is: that is the question
        documented = re.search(rf"Raises:.*\b{type(error).__name__}:", public.call.__doc__ or "", re.DOTALL)
        return "" if documented else f"{type(error).__name__}: {str(error)[:80]}"
    if not wrong.bearable:
        return "accepted"
    return "NaN in the answer" if _holds_nan(answer) and not usual else ""


def _holds_nan(answer: Any) -> bool:
    if isinstance(answer, float | np.floating):
        return bool(np.isnan(answer))
    if isinstance(answer, np.ndarray):
        return answer.dtype.kind == "c" or (answer.dtype.kind == "f" and bool(np.isnan(answer).any()))
    if isinstance(answer, dict):
        return any(map(_holds_nan, answer.values()))
    if isinstance(answer, list | tuple):
        return any(map(_holds_nan, answer))
    return any(map(_holds_nan, vars(answer).values())) if hasattr(answer, "__dataclass_fields__") else False


def objections(public: Public, examples: Examples) -> list[str]:
    """Every wrong value that a function takes, after a call with right ones."""
    right = _right(public, examples)
    slow = public.name in public_api.SLOW
    usual = not slow and _holds_nan(_call(public, right, seconds=10 * SECONDS))
    found = []
    for name, kind in public_api.checkable(public).items():
        if right[name] is None or (kind == "names" and not len(right[name])):  # it excludes another one
            continue
        annotation = public_api.arguments(public)[name]
        given = list(bad_arguments.KINDS[kind](right[name]))
        if "None" not in annotation and kind not in ("mapping", "path"):
            given.append(Wrong("None", None))
        for wrong in given:
            if (slow and wrong.bearable) or wrong.what in public_api.means_something(public.name, name):
                continue
            objection = _objection(public, {**right, name: wrong.value}, wrong, usual)
            if objection:
                found.append(f"{public.name}({name}: {wrong.what}): {objection}")
    return found


@pytest.mark.parametrize("name", sorted(name for name in WALKED if public_api.checkable(WALKED[name])))
def test_a_public_function_refuses_what_is_no_right_value(name: str, examples: Examples) -> None:
    assert not objections(WALKED[name], examples)


def test_every_room_is_walked_or_listed() -> None:
    rooms = {name.split(".")[0] for name in WALKED}
    assert set(public_api.rooms()) <= rooms | public_api.NOT_WALKED
    assert not rooms & public_api.NOT_WALKED


_MEANT = {("p", "nan"), ("weight", "one axis less"), ("weight", "integer")}
"""A marker that was not seen; one weight for all."""


@pytest.mark.parametrize(
    ("record", "field", "right"),
    [
        (ik.Pose, "T", np.eye(4)[None]),
        (ik.Pose, "position_weight", 1.0),
        (ik.Pose, "rotation_weight", 1.0),
        (ik.Position, "p", np.ones((1, 3))),
        (ik.Position, "weight", 1.0),
        (ik.Points, "local", np.ones((2, 3))),
        (ik.Points, "p", np.ones((1, 2, 3))),
        (ik.Points, "weight", np.ones(2)),
    ],
)
def test_targets_are_checked_where_they_are_solved(
    record: Callable[..., Any], field: str, right: Any, examples: Examples
) -> None:
    others: dict[str, Any] = {"T": np.eye(4)[None], "local": np.ones((2, 3)), "p": np.ones((1, 2, 3))}
    if record is ik.Position:
        others["p"] = np.ones((1, 3))
    known = {f: others[f] for f in inspect.signature(record).parameters if f in others}
    many = isinstance(right, np.ndarray)
    for wrong in (bad_arguments.of_array if many else bad_arguments.of_number)(right):
        if wrong.bearable or wrong.what == "one row less" or (field, wrong.what) in _MEANT:
            continue
        with pytest.raises(DescriptionError):
            ik.track(examples.robot, {"left_foot": record(**{**known, field: wrong.value})})


@pytest.mark.parametrize(
    ("check", "name"),
    [
        ("real", "signals.spikes"),
        ("number", "signals.filled"),
        ("names", "signals.outliers"),
        ("real", "kinematics.velocities"),
        ("number", "kinematics.contacts"),
        ("count", "ik.Dls"),
        ("word", "gait.strides"),
        ("table", "edit.scaled"),
        ("word", "sizing.WorstCase.worst"),
        ("number", "retarget.Target"),
        ("number", "markers.MarkerSet"),
        ("real", "dynamics.in_pelvis_axes"),
        ("number", "simulation.Floor"),
        ("real", "sizing.Motor.line_use"),
    ],
)
def test_the_walk_notices_a_check_that_is_missing(
    check: str, name: str, examples: Examples, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The proof that this file can fail: without one check, the function of that check is found."""
    module = inspect.getmodule(WALKED[name].call)
    own = next(n for n, what in vars(module).items() if what is getattr(arguments, check))
    monkeypatch.setattr(module, own, _unchecked)
    assert objections(WALKED[name], examples)


def _unchecked(_: str, value: Any, *__: Any, **___: Any) -> Any:
    """What a function would do without a check."""
    return np.asarray(value, dtype=float) if isinstance(value, np.ndarray) else value
