"""Controllers: torques point towards the walk, learn where it errs, and come from a user's file."""

import numpy as np
import pytest

from exo_pin.control import CONTROLLERS, Reference, find_controller, load_controller, reset
from exo_pin.control.assist_as_needed import AssistAsNeeded
from exo_pin.errors import DescriptionError, FormatError, UnknownNameError


def wanted(**changes):
    """A walk that stands still at zero, unless changed."""
    still = {name: np.zeros(12) for name in ("q", "dq", "ddq", "feed_forward", "missing")}
    return Reference(phase=changes.pop("phase", 0.0), **(still | changes))


@pytest.mark.parametrize("name", [name for name in CONTROLLERS if name not in ("off", "pd_gravity")])
def test_the_torque_drives_the_joints_towards_the_walk(name, robot, gait):
    _, controller = find_controller(name)
    reset(controller, robot, gait)
    for error in 0.05 * np.eye(12):
        assert error @ controller(0.0, np.zeros(12), np.zeros(12), wanted(q=error)) > 0.0


def test_what_the_person_does_not_give_is_fed_forward():
    missing = np.arange(12.0)
    still = np.zeros(12)
    for name, expected in (
        ("pd", missing),
        ("impedance_ff", missing),
        ("pd_only", still),
        ("impedance", still),
    ):
        tau = find_controller(name)[1](0.0, still, still, wanted(missing=missing))
        np.testing.assert_array_equal(tau, expected)


def test_gravity_is_held_by_its_own_controller(robot, gait):
    _, controller = find_controller("pd_gravity")
    reset(controller, robot, gait)
    bent = np.zeros(12)
    bent[[0, 6]] = 0.5
    tau = controller(0.0, bent, np.zeros(12), wanted(q=bent))
    assert (tau[[0, 6]] > 10.0).all()  # a raised leg is heavy


def test_assistance_stiffens_where_the_leg_errs_and_softens_where_it_does_not(robot, gait):
    controller = AssistAsNeeded()
    reset(controller, robot, gait)
    off = np.zeros(12)
    off[3] = 0.05
    for _ in range(3):
        for phase in np.linspace(0.0, 0.99, 50):
            controller(0.0, off if phase < 0.5 else np.zeros(12), np.zeros(12), wanted(phase=phase))
    early, late = controller.stiffness[10, 3], controller.stiffness[40, 3]
    assert early > 500.0
    assert late == pytest.approx(50.0 * 0.8**3, rel=0.3)
    assert controller.stiffness[10, 0] < 50.0


FILE = """
import numpy as np

class Soft:
    def reset(self, robot, gait):
        self.robot = robot

    def __call__(self, time, q, dq, reference):
        return 100.0 * (reference.q - q)
"""


def test_a_class_of_a_file_is_a_controller(tmp_path, robot, gait):
    path = tmp_path / "mine.py"
    path.write_text(FILE)
    for text in (f"{path}:Soft", str(path)):
        controller = load_controller(text)
        reset(controller, robot, gait)
        assert vars(controller)["robot"] is robot
        assert controller(0.0, np.zeros(12), np.zeros(12), wanted(q=np.ones(12)))[0] == 100.0


@pytest.mark.parametrize(
    ("content", "name", "error", "word"),
    [
        (None, ":Soft", FormatError, "not a file"),
        ("def broken(:\n", "", FormatError, "SyntaxError"),
        ("raise SystemExit\n", "", FormatError, "SystemExit"),
        (FILE, ":Sotf", UnknownNameError, "Soft"),
        (FILE + "class Other:\n    pass\n", "", DescriptionError, "name one"),
        ("", ":Soft", DescriptionError, "neither"),
        ("while True:\n    pass\n", "", FormatError, "does not end"),
        (
            "class Slow:\n    def __init__(self):\n        while True:\n            pass\n",
            "",
            FormatError,
            "does not end",
        ),
        ("class Gain:\n    def __init__(self, gain):\n        pass\n", "", FormatError, "gain"),
        ("class Dumb:\n    pass\n", ":Dumb", DescriptionError, "called"),
        ("class Bad:\n    def __init__(self):\n        1 / 0\n", ":Bad", FormatError, "bad.py:3"),
    ],
)
def test_a_file_that_holds_no_controller_is_refused(tmp_path, content, name, error, word, monkeypatch):
    monkeypatch.setattr("exo_pin.control.users_code.LONGEST_START", 0.2)
    path = tmp_path / "bad.py"
    if content is not None:
        path.write_text(content)
    with pytest.raises(error, match=word):
        load_controller(f"{path}{name}")


def failing(robot, gait):
    raise ValueError("no model")


def endless(robot, gait):
    while True:
        pass


@pytest.mark.parametrize(
    ("start", "word"),
    [(failing, r"test_controllers.py:\d+: ValueError: no model"), (endless, "does not end")],
)
def test_a_reset_that_fails_is_refused(robot, gait, start, word, monkeypatch):
    monkeypatch.setattr("exo_pin.control.users_code.LONGEST_START", 0.2)
    controller = find_controller("pd")[1]
    monkeypatch.setattr(controller, "reset", start, raising=False)
    with pytest.raises(DescriptionError, match=word):
        reset(controller, robot, gait)


def test_a_controller_that_does_not_exist_is_refused_with_those_that_do():
    with pytest.raises(UnknownNameError, match="computed_torque"):
        find_controller("computed torqe")
