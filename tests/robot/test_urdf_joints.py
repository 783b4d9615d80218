"""Joints of a URDF: limits are judged, endless joints bounded, floating ones held, followers resolved."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from exo_pin import ik
from exo_pin.errors import DescriptionError
from exo_pin.kinematics import poses
from exo_pin.robot import load_urdf
from exo_pin.robot.urdf_joints import accepted, followers, with_limits

LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'


def robot(*joints: str, kind: str = "revolute", inner: str = LIMIT) -> str:
    """A chain a - b - c ... of joints about y, one tenth of a metre apart."""
    text = '<robot name="r"><link name="l0"/>'
    for k, name in enumerate(joints):
        text += (
            f'<link name="l{k + 1}"/><joint name="{name}" type="{kind}"><parent link="l{k}"/>'
            f'<child link="l{k + 1}"/><origin xyz="0 0 0.1"/><axis xyz="0 1 0"/>{inner}</joint>'
        )
    return text + "</robot>"


@pytest.mark.parametrize(
    ("lower", "upper", "said"),
    [
        ("1", "-1", "joint 'j'.*57.3 deg is above.*-57.3 deg"),
        ("nan", "1", "joint 'j': lower .*'nan'; a finite number"),
        ("-1", "inf", "joint 'j': upper .*'inf'; a finite number"),
        ("-1", "1 rad", "joint 'j': upper .*'1 rad'; a finite number"),
        ("-1\x1b[31m".replace("\x1b", "&#x9;"), "1", "joint 'j': lower"),
    ],
)
def test_wrong_limits_are_refused_with_joint_and_values(lower, upper, said):
    text = robot("j", inner=f'<limit lower="{lower}" upper="{upper}" effort="1" velocity="1"/>')
    with pytest.raises(DescriptionError, match=said) as refusal:
        load_urdf(text)
    assert str(refusal.value).isprintable()


def test_limits_that_coincide_are_a_joint_that_stands_still():
    held = load_urdf(robot("j", inner='<limit lower="0.3" upper="0.3" effort="1" velocity="1"/>'))
    assert held.lower == held.upper == pytest.approx(0.3)


def test_joints_without_end_stops_get_half_a_turn_each_way_and_it_is_said():
    text = robot("j", "k", kind="continuous", inner="")
    made = load_urdf(text)
    assert made.upper == pytest.approx([math.pi, math.pi])
    assert made.lower == pytest.approx([-math.pi, -math.pi])
    assert made.remarks == ("half a turn each way for joints without end stops: j, k",)
    assert load_urdf(robot("j")).remarks == ()
    assert accepted(robot("j")).text == robot("j")  # what needs no change has none


@pytest.mark.parametrize("kind", ["floating", "planar"])
def test_joints_that_float_are_held_and_it_is_said(kind):
    text = robot("j", "k").replace('type="revolute"', f'type="{kind}"', 1)
    made = load_urdf(text)
    assert made.joints == ("k",)
    assert made.remarks == ("floating or planar joints are held: j",)


def test_links_may_have_the_names_of_joints():
    plain = load_urdf(robot("j", "k", "m"))
    shared = load_urdf(re.sub('"l([123])"', lambda m: f'"{"jkm"[int(m[1]) - 1]}"', robot("j", "k", "m")))
    q = np.array([0.1, 0.2, -0.3])
    assert poses(shared, q, ["m"]) == pytest.approx(poses(plain, q, ["l3"]))
    for name, made in (("k", shared), ("l2", plain)):
        target = ik.Position(poses(made, np.array([0.4, 0.2, 0.0]), [name])[0, :3, 3])
        assert ik.solve(made, {name: target}).converged
        assert made.subtree([name]).frames == (name,)


def test_followers_of_followers_follow_the_first_leader():
    text = robot("a", "b", "c")
    for name, leader, rest in (("b", "a", 'multiplier="2" offset="0.1"'), ("c", "b", 'multiplier="-1"')):
        end = text.index("</joint>", text.index(f'name="{name}"'))
        text = text[:end] + f'<mimic joint="{leader}" {rest}/>' + text[end:]
    found = followers(text)
    assert found["b"] == ("a", 2.0, 0.1)
    assert found["c"] == ("a", -2.0, pytest.approx(-0.1))
    with pytest.raises(DescriptionError, match="circle"):
        followers(text.replace("</joint>", '<mimic joint="c"/></joint>', 1))
    with pytest.raises(DescriptionError, match=r"multiplier .*'two'"):
        followers(text.replace('multiplier="2"', 'multiplier="two"'))


def test_other_limits_take_the_place_of_the_file_s():
    text = with_limits(robot("j", "k", kind="continuous", inner=""), {"k": (-0.5, 0.25)})
    made = load_urdf(text)
    assert made.upper == pytest.approx([math.pi, 0.25])
    with pytest.raises(DescriptionError, match="unknown joint with limits 'q'"):
        with_limits(text, {"q": (0.0, 1.0)})
