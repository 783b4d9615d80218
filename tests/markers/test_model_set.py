"""An OpenSim model as marker set: its marker places and lengths, against its own inverse kinematics."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS
from exo_pin.errors import FormatError
from exo_pin.formats import load_gait, load_markers
from exo_pin.markers import load_walk, model_set, reconstruct

FOLDER = "lai_arnold_walk"
ANGLE = 5.0  # [deg] rms: the model's ankle turns about oblique axes, ours about two of the foot
OWN_RMS = 0.038  # [m] of its own inverse kinematics, arms included
MOVEMENTS = ("hip_flexion", "knee_flexion", "ankle_dorsiflexion")

MODEL = """<OpenSimDocument Version="{version}"><Model name="m">
<BodySet><objects>{bodies}</objects></BodySet>
<MarkerSet><objects>{markers}</objects></MarkerSet></Model></OpenSimDocument>"""
BODY = """<Body name="{name}"><mass>1</mass><Joint><CustomJoint name="{name}_joint">
<parent_body>{parent}</parent_body><location_in_parent>{at}</location_in_parent>
<CoordinateSet><objects><Coordinate name="{coordinate}"/></objects></CoordinateSet>
<SpatialTransform><TransformAxis name="rotation1"><coordinates>{coordinate}</coordinates><axis>0 0 1</axis>
<LinearFunction><coefficients>1 0</coefficients></LinearFunction></TransformAxis></SpatialTransform>
</CustomJoint></Joint></Body>"""
MARKER = '<Marker name="{name}"><body> {body} </body><location>{at}</location></Marker>'


def model_text(markers):
    """A model of version 3 whose bodies hang straight down; x forward, y up, z right."""
    rows = [("pelvis", "ground", "0 1 0", "pelvis_tilt")]
    for s, z in (("l", -0.08), ("r", 0.08)):
        rows += [
            (f"femur_{s}", "pelvis", f"-0.07 -0.06 {z}", f"hip_flexion_{s}"),
            (f"tibia_{s}", f"femur_{s}", "0 -0.4 0", f"knee_angle_{s}"),
            (f"talus_{s}", f"tibia_{s}", "-0.01 -0.41 0", f"ankle_angle_{s}"),
        ]
    bodies = "".join(BODY.format(name=n, parent=p, at=at, coordinate=c) for n, p, at, c in rows)
    text = "".join(MARKER.format(name=n, body=b, at=at) for n, b, at in markers)
    return MODEL.format(version=30000, bodies=bodies, markers=text)


def test_a_model_says_where_its_markers_sit(tmp_path):
    path = tmp_path / "m.osim"
    rows = [("A", "pelvis", "0.03 0.02 0.12"), ("K", "femur_r", "0.01 -0.4 0.05"), ("C7", "torso", "0 0 0")]
    path.write_text(model_text([*rows, ("H", "talus_l", "-0.05 -0.04 0")]))
    chosen = model_set(path)
    assert list(chosen.spots) == ["A", "K", "H"]
    sizes = chosen.sizes
    assert (sizes.hip_width, *sizes.thigh, *sizes.shank) == pytest.approx((0.16, 0.4, 0.4, 0.41, 0.41))
    np.testing.assert_allclose(sizes.ankle_aside, [[-0.01, 0], [-0.01, 0]], atol=1e-12)
    places = {
        name: np.array(spot.place) * sizes.length(spot.segment, spot.side)
        for name, spot in chosen.spots.items()
    }
    np.testing.assert_allclose(places["A"], [0.10, -0.12, 0.08], atol=1e-12)  # from midway between the hips
    np.testing.assert_allclose(places["K"], [0.01, -0.05, -0.40], atol=1e-12)
    np.testing.assert_allclose(places["H"], [-0.05, 0, -0.04], atol=1e-12)


def test_a_model_without_markers_or_legs_is_refused_in_one_line(tmp_path):
    path = tmp_path / "m.osim"
    path.write_text(model_text([("C7", "torso", "0 0 0")]))
    with pytest.raises(FormatError, match="no markers on pelvis"):
        model_set(path)
    path.write_text(model_text([]).replace("ankle_angle_r", "other"))
    with pytest.raises(FormatError, match=r"ankle_angle_r from the pelvis to the right foot"):
        model_set(path)


@pytest.fixture(scope="module")
def trial(shared_trials):
    whole = load_markers(shared_trials / FOLDER / "walking1.trc")
    return dataclasses.replace(whole, time=whole.time[::4], position=whole.position[::4])


@pytest.fixture(scope="module")
def shared_trials(shared):
    return shared.parent / "trials"


def differences(found, folder):
    """Rms difference from the laboratory's own inverse kinematics [deg], by joint."""
    own = load_gait(folder / "walking1_ik.mot", model=folder / "scaled.osim")
    q = np.stack([np.interp(found.gait.time, own.time, own.q[:, k]) for k in range(12)], axis=1)
    return dict(zip(JOINTS, np.degrees(np.sqrt(((found.gait.q - q) ** 2).mean(axis=0))), strict=True))


@pytest.mark.parametrize("by", ["model", "set"])
def test_the_lai_arnold_walk_agrees_with_its_own_inverse_kinematics(trial, shared_trials, by):
    folder = shared_trials / FOLDER
    found = reconstruct(trial, markers=model_set(folder / "scaled.osim") if by == "model" else None)
    assert found.marker_set == ("scaled.osim" if by == "model" else "stanford")
    assert found.total_rms <= OWN_RMS
    difference = differences(found, folder)
    for movement in MOVEMENTS:
        for side in ("left", "right"):
            assert difference[f"{side}_{movement}"] <= ANGLE, movement
    left_out = [remark for remark in found.gait.remarks if "are left out: L_thigh1" in remark]
    assert bool(left_out) == (by == "model")  # that cluster was put on anew after the model was scaled


def test_a_model_of_another_size_is_noticed(trial, shared_trials):
    larger = dataclasses.replace(trial, position=1.2 * trial.position)
    found = reconstruct(larger, markers=model_set(shared_trials / FOLDER / "scaled.osim"))
    assert any("1.2" in remark and "scaled to this person" in remark for remark in found.gait.remarks)


def test_a_set_and_a_model_exclude_each_other(shared_trials):
    folder = shared_trials / FOLDER
    with pytest.raises(FormatError, match=r"a marker set \(cgm2\) and a model \(scaled\.osim\) are given"):
        load_walk(folder / "walking1.trc", markers="cgm2", model=folder / "scaled.osim")
