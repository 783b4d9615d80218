"""The verdict on a walk: plausible only where nothing speaks against it."""

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS
from exo_pin.gait import SPEEDS, Gait, Plausibility, normative_gait
from exo_pin.kinematics import plausibility

WALK = normative_gait("free")


@pytest.mark.parametrize("speed", SPEEDS)
def test_normal_walks_are_plausible(robot, speed):
    found = plausibility(robot, normative_gait(speed))
    assert (found.word, found.reasons, str(found)) == ("plausible", (), "plausible")


def test_one_sample_off_its_curve_is_a_reason(robot):
    recording = WALK.repeated(2)
    q = recording.q.copy()
    q[61, JOINTS.index("left_knee_flexion")] += np.radians(15)
    found = plausibility(robot, Gait(recording.time, q))
    assert found.word == "doubtful"
    (reason,) = found.reasons
    assert "left_knee_flexion" in reason
    assert f"{recording.time[61]:.3f} s" in reason


def test_a_joint_outside_human_range_is_a_reason(robot):
    q = WALK.q.copy()
    q[:, JOINTS.index("right_ankle_inversion")] += np.radians(70)
    assert any(
        "right_ankle_inversion" in reason for reason in plausibility(robot, Gait(WALK.time, q)).reasons
    )


def test_a_foot_that_slides_is_a_reason_that_names_foot_and_distance(robot):
    """A pelvis that goes by faster than the feet: they are dragged along."""
    walk = normative_gait("free").repeated(3)
    base = np.array(walk.base)
    base[:, 0, 3] += 2.0 * walk.time
    dragged = Gait(walk.time, walk.q, base=base, events=walk.events)
    (reason,) = plausibility(robot, dragged).reasons
    assert "foot slides" in reason
    assert "body" in reason


def test_reasons_found_elsewhere_count_once():
    found = Plausibility(("a",)).with_reasons(("b", "a"))
    assert found.reasons == ("a", "b")
    assert found.facts() == {"word": "doubtful", "reasons": ["a", "b"]}
    assert str(found) == "doubtful: a; b"
