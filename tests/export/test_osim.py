"""The OpenSim model against Pinocchio, read and moved by OpenSim itself."""

import dataclasses

import numpy as np
import pytest

from exo_pin import Body, load_robot, normative_gait
from exo_pin.errors import UnknownNameError
from exo_pin.export import osim
from exo_pin.formats import load_gait, save_gait
from exo_pin.formats.opensim.pelvis_axes import FROM_OPENSIM
from exo_pin.formats.sign_presets import PRESETS
from exo_pin.ground import place_walk
from exo_pin.kinematics import poses

EQUAL = 1e-9
"""OpenSim reads 17 digits; rotations about three axes one after the other lose a few."""

ODD = Body.from_stature(1.7133, mass=63.217, left_thigh=0.4011, right_shank=0.4173)


@pytest.fixture(scope="module")
def walk():
    gait = normative_gait("slow")
    placed = place_walk(load_robot(ODD), gait)
    return dataclasses.replace(gait, base=placed.base)


def written(folder, walk, device, preset):
    robot = load_robot(ODD, device=device, base="floating")
    (folder / "exo.osim").write_text(osim(load_robot(ODD, device=device), preset=preset), encoding="utf-8")
    save_gait(walk, folder / "walk.mot", preset=preset)
    return robot


def put(opensim, model, state, columns, row):
    """A row of a `.mot` into the model's coordinates."""
    for coordinate in model.getCoordinateSet():
        name = coordinate.getName()
        if columns.hasColumn(name):
            value = columns.getDependentColumn(name)[row]
            turns = coordinate.getMotionType() == opensim.Coordinate.Rotational
            coordinate.setValue(state, np.radians(value) if turns else value, False)
    model.realizePosition(state)


@pytest.mark.parametrize(
    ("device", "preset"),
    [("exo12", "opensim-rajagopal"), ("exo12", "opensim-gait2392"), ("lopes8", "opensim-rajagopal")],
)
def test_a_walk_as_mot_moves_every_link_as_pinocchio_does(tmp_path, device, preset, walk):
    opensim = pytest.importorskip("opensim")
    robot = written(tmp_path, walk, device, preset)
    model = opensim.Model(str(tmp_path / "exo.osim"))
    state = model.initSystem()
    assert model.getTotalMass(state) == pytest.approx(91.4 - 70 + 63.217, abs=EQUAL)
    columns = opensim.TimeSeriesTable(str(tmp_path / "walk.mot"))
    wanted = poses(robot, robot.from_gait(walk), robot.frames)
    for row in (0, 31):
        put(opensim, model, state, columns, row)
        for k, name in enumerate(robot.frames):
            body = model.getBodySet().get(name)
            origin = PRESETS[preset].mid_hip if name == "pelvis" else (0.0, 0.0, 0.0)
            place = body.findStationLocationInGround(state, opensim.Vec3(*origin)).to_numpy()
            R = body.getTransformInGround(state).R()
            turned = np.array([[R.get(i, j) for j in range(3)] for i in range(3)])
            T = wanted[row, k]
            np.testing.assert_allclose(FROM_OPENSIM @ place, T[:3, 3], atol=EQUAL)
            np.testing.assert_allclose(FROM_OPENSIM @ turned @ FROM_OPENSIM.T, T[:3, :3], atol=EQUAL)


@pytest.mark.parametrize("preset", ["opensim-rajagopal", "opensim-gait2392"])
def test_the_model_tells_the_signs_of_its_own_walks(tmp_path, preset, walk):
    """By `--model` a `.mot` is read as the .osim file has its joints, not by a guess."""
    written(tmp_path, walk, "exo12", preset)
    back = load_gait(tmp_path / "walk.mot", model=tmp_path / "exo.osim")
    np.testing.assert_allclose(back.q, walk.q, atol=EQUAL)
    np.testing.assert_allclose(back.base, walk.base, atol=EQUAL)


def test_other_models_than_those_of_the_presets_are_refused():
    with pytest.raises(UnknownNameError):
        osim(load_robot(), preset="vicon-pig")
