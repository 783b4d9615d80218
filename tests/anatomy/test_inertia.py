"""Masses and inertias of the links are those of a plain sum over the segments of the wearer and the device.

The sum is written here once more, from the meaning of the tables: where each segment begins, which way it
runs, and about which of its axes each radius of gyration counts.
"""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exo_pin.anatomy import SIDES, Body
from exo_pin.anatomy.anthropometry import DE_LEVA, DESIGN_LENGTHS
from exo_pin.anatomy.inertia import Inertial, link_inertias, total

STATURES = st.floats(1.2, 2.1)
MASSES = st.floats(30.0, 150.0)
SEXES = st.sampled_from(["male", "female"])
ROUNDING = 1e-9  # sums of a dozen doubles; sizes and masses of a body are rounded to 1e-6

FORWARD, LEFT, UP = np.eye(3)


def about_origin(parts):
    """Mass [kg], first moment (3,) [kg m] and inertia (3, 3) [kg m^2] about the origin: three plain sums."""
    mass, moment, inertia = 0.0, np.zeros(3), np.zeros((3, 3))
    for m, c, own in parts:
        mass, moment = mass + m, moment + m * c
        inertia = inertia + own + m * (c @ c * np.eye(3) - np.outer(c, c))
    return mass, moment, inertia


def segment(table, mass, length, proximal, along):
    """A segment of de Leva's table that runs `along` an axis from its proximal end."""
    sagittal, transverse, longitudinal = (length * np.array(table.gyration)) ** 2
    across = {"sagittal": FORWARD if along @ FORWARD == 0 else UP, "transverse": LEFT}
    own = mass * (
        sagittal * np.outer(across["sagittal"], across["sagittal"])
        + transverse * np.outer(LEFT, LEFT)
        + longitudinal * np.outer(along, along)
    )
    return mass, proximal + table.centre * length * along, own


def wearer(body):
    """Segments of the standing person seen from the mid-hip, x forward, y left, z up."""
    table = DE_LEVA[body.sex]
    size = {name: share * body.stature for name, share in DESIGN_LENGTHS.items()}
    names = ("head", "trunk", *2 * ("upper_arm", "forearm", "hand"))
    scale = body.upper_mass / sum(table[name].mass for name in names)
    top = size["trunk"] * UP
    yield segment(table["trunk"], scale * table["trunk"].mass, size["trunk"], top, -UP)
    yield segment(table["head"], scale * table["head"].mass, size["head"], top + size["head"] * UP, -UP)
    for side, s in zip(SIDES, (1.0, -1.0), strict=True):
        joint = top + s * size["shoulder"] * LEFT
        for name in ("upper_arm", "forearm", "hand"):
            yield segment(table[name], scale * table[name].mass, size[name], joint, -UP)
            joint = joint - size[name] * UP
        leg, joint = body.leg(side), s * body.hip_width / 2 * LEFT
        for name in ("thigh", "shank"):
            length = getattr(leg, name)
            yield segment(table[name], getattr(leg, f"{name}_mass"), length, joint, -UP)
            joint = joint - length * UP
        heel = joint - leg.heel * FORWARD - leg.ankle_height / 2 * UP
        yield segment(table["foot"], leg.foot_mass, leg.foot_length, heel, FORWARD)


def links_in_pelvis(body, *, toes=False):
    """The links at q = 0 as (mass, centre, inertia) in the pelvis's frame."""
    for name, part in link_inertias(body, toes=toes).items():
        origin = np.zeros(3)
        if name != "pelvis":
            side, _, link = name.partition("_")
            leg = body.leg(side)
            below = {"shank": leg.thigh, "ankle": leg.thigh + leg.shank, "sole_plate": leg.thigh + leg.shank}
            below["toe_plate"] = leg.length
            origin = (1 if side == "left" else -1) * body.hip_width / 2 * LEFT - below.get(link, 0.0) * UP
            if link == "toe_plate":
                origin = origin + leg.ball * FORWARD
        yield part.mass, origin + part.centre, part.inertia


@given(STATURES, MASSES, SEXES)
def test_the_wearer_is_the_plain_sum_of_the_segments(stature, mass, sex):
    """Total mass, centre of mass and inertia of the whole body; the hardware is the same with and without."""
    body = Body.from_stature(stature, mass=mass, sex=sex)
    worn, bare = (
        about_origin(links_in_pelvis(dataclasses.replace(body, wearer=wearer))) for wearer in (True, False)
    )
    for with_device, device, person in zip(worn, bare, about_origin(wearer(body)), strict=True):
        np.testing.assert_allclose(with_device - device, person, atol=1e-9 * mass)


@given(STATURES, MASSES)
def test_centre_of_mass_and_inertia_of_the_whole_person_are_those_of_people(stature, mass):
    """Over the ground the centre is at 54 to 60 % of the stature; a tall thin body turns easiest about z."""
    body = Body.from_stature(stature, mass=mass, wearer=True)
    m, moment, inertia = about_origin(wearer(body))
    assert m == pytest.approx(mass)
    assert 0.54 < (moment[2] / m + body.leg_length) / stature < 0.60
    assert moment[1] == pytest.approx(0.0, abs=ROUNDING * mass)
    centre = moment / m
    own = inertia - m * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    x, y, z = np.diag(own)
    assert z < 0.2 * min(x, y)


def test_the_arms_hang_from_the_shoulders():
    """Longer arms carry the pelvis link's centre down: their mass is scaled with head and trunk."""
    body = Body.from_stature(mass=70.0)
    pelvis = link_inertias(body)["pelvis"]
    trunk = DESIGN_LENGTHS["trunk"] * body.stature
    assert (
        0.4 * trunk < pelvis.centre[2] < 0.75 * trunk
    )  # arms stacked upwards would lift it over the trunk's 0.8


def test_the_foots_own_inertia_is_least_about_its_long_axis():
    links = link_inertias(Body.from_stature(foot_hardware=0.01))
    for side in SIDES:
        x, y, z = np.diag(links[f"{side}_sole_plate"].inertia)
        assert x < 0.5 * min(y, z)


@pytest.mark.parametrize("heel", [0.02, 0.06])
def test_the_bare_sole_plate_lies_midway_between_heel_and_toe_tip_on_the_sole(heel):
    body = Body.from_stature(wearer=False, heel=heel)
    for side in SIDES:
        leg, plate = body.leg(side), link_inertias(body)[f"{side}_sole_plate"]
        toe_tip = leg.foot_length - leg.heel
        assert plate.centre[0] == pytest.approx((toe_tip - leg.heel) / 2)
        assert plate.centre[0] > 0  # ahead of the ankle
        assert -leg.ankle_height < plate.centre[2] < -leg.ankle_height + 0.02


@given(STATURES, MASSES, st.booleans())
def test_a_plate_cut_at_the_ball_is_the_whole_plate(stature, mass, worn):
    body = Body.from_stature(stature, mass=mass, wearer=worn)
    for cut, one in zip(
        about_origin(links_in_pelvis(body, toes=True)), about_origin(links_in_pelvis(body)), strict=True
    ):
        np.testing.assert_allclose(cut, one, atol=1e-9 * mass)


@given(st.lists(st.tuples(st.floats(0.1, 50.0), *[st.floats(-1.0, 1.0)] * 3), min_size=1, max_size=6))
def test_parts_together_have_the_mass_the_centre_and_the_inertia_of_the_sum(places):
    parts = [Inertial(m, np.array([x, y, z]), np.diag([0.1, 0.2, 0.25]) * m) for m, x, y, z in places]
    whole = total(parts)
    for sum_, one in zip(about_origin(parts), about_origin([whole]), strict=True):
        np.testing.assert_allclose(sum_, one, atol=1e-9)


def test_the_thigh_and_shank_hardware_runs_down_its_segment():
    body = Body.from_stature(wearer=False)
    for side, s in zip(SIDES, (1.0, -1.0), strict=True):
        links, leg = link_inertias(body), body.leg(side)
        for name in ("thigh", "shank"):
            x, y, z = links[f"{side}_{name}"].centre
            assert z == pytest.approx(-getattr(leg, name) / 2)
            assert s * y > 0  # beside the leg, on its outside
            assert x == pytest.approx(0.0)
