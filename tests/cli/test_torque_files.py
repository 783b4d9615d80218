"""Files that `exo-pin torques` writes for OpenSim: its own inverse dynamics tool runs on them as they are."""

from __future__ import annotations

import shutil

import numpy as np
import pytest

from exo_pin.anatomy import JOINTS, SIDES
from exo_pin.cli import main
from exo_pin.formats import load_forces, load_gait, load_torques
from exo_pin.safe.xml_reader import load_xml


def words(folder, angles, model, forces):
    return [
        "torques",
        str(folder / angles),
        "--model",
        str(folder / model),
        "--forces",
        str(folder / forces),
    ]


@pytest.fixture(scope="module")
def trials(shared):
    """Name of a trial -> words that compute its torques."""
    treadmill, ground = shared / "opensim_subject01_walk", shared.parent / "trials" / "lai_arnold_walk"
    names = ("subject01_walk1_ik.mot", "subject01_simbody.osim", "subject01_walk1_grf.mot")
    return {
        "subject01": words(treadmill, *names),
        "lai_arnold": words(ground, "walking1_ik.mot", "scaled.osim", "walking1_forces.mot"),
    }


@pytest.fixture(scope="module", params=["subject01", "lai_arnold"])
def written(request, trials, tmp_path_factory):
    """Words and the file of the torques of each trial."""
    path = tmp_path_factory.mktemp(request.param) / "t.sto"
    assert main([*trials[request.param], "-o", str(path)]) == 0
    return trials[request.param], path


def test_the_forces_on_the_feet_are_those_of_the_plates_and_give_the_same_torques(written, tmp_path):
    given, path = written
    forces = path.with_name("t_forces.mot")
    left, right = load_forces(forces)
    for plate in load_forces(given[-1]):  # each plate is one foot's here
        loaded = plate.force[:, 2] > 50.0
        foot = min((left, right), key=lambda f: np.abs(f.point[0, 1] - plate.point[loaded][0, 1]))
        for k in range(3):
            ours = np.interp(plate.time[loaded], foot.time, foot.force[:, k])
            inside = (plate.time[loaded] >= foot.time[0]) & (plate.time[loaded] <= foot.time[-1])
            off = np.abs(ours - plate.force[loaded, k])[inside]
            assert np.sqrt((off**2).mean()) < 12.0  # straight lines between the samples of the walk
    again = tmp_path / "again.sto"
    assert main([*given[:-1], str(forces), "-o", str(again)]) == 0
    first, second = load_torques(path), load_torques(again)
    assert second.joints == JOINTS
    np.testing.assert_allclose(
        second.tau, first.at(second.time), atol=1.5
    )  # contacts end where 20 N are left


def test_the_xml_beside_them_names_the_files_relative_to_its_own_folder(written):
    given, path = written
    loads = load_xml(path.with_name("t_loads.xml"))
    assert loads.findtext(".//datafile") == "t_forces.mot"
    names = {force.findtext("applied_to_body"): force for force in loads.iter("ExternalForce")}
    assert set(names) == {"calcn_l", "calcn_r"}
    columns = path.with_name("t_forces.mot").read_text().split("endheader\n")[1].split("\n")[0].split("\t")
    for force in names.values():
        for entry in ("force", "point", "torque"):
            start = force.findtext(f"{entry}_identifier")
            assert {start + axis for axis in "xyz"} <= set(columns)
    setup = load_xml(path.with_name("t_setup.xml"))
    assert (path.parent / setup.findtext(".//coordinates_file")).samefile(given[1])
    assert (path.parent / setup.findtext(".//model_file")).samefile(given[3])


def test_frames_that_are_not_valid_are_in_no_file_of_forces(written):
    _, path = written
    torques, setup = load_torques(path), path.with_name("t_setup.xml").read_text()
    known = torques.time[np.isfinite(torques.tau[:, 0])]
    left, right = load_forces(path.with_name("t_forces.mot"))
    for plate in (left, right):
        assert np.isin(plate.time, known).all()
        assert all(np.isfinite(values).all() for values in (plate.force, plate.point, plate.moment))
    assert f"<time_range>{left.time[0]!s} {left.time[-1]!s}</time_range>" in setup


def test_a_walk_of_another_format_gets_its_coordinates_too(capsys, tmp_path):
    path = tmp_path / "t.mot"
    assert main(["torques", "slow", "-o", str(path)]) == 0
    lines = capsys.readouterr().out.splitlines()
    for file in tmp_path.iterdir():
        assert sum(line.startswith(f"{file}: ") for line in lines) == 1
    walk = load_gait(tmp_path / "t_coordinates.mot")
    assert walk.base is not None
    assert np.ptp(walk.base[:, 2, 3]) > 0.01  # the carried pelvis
    assert {plate.name.split()[-1] for plate in load_forces(tmp_path / "t_forces.mot")} == {
        side[0] for side in SIDES
    }


def test_a_file_beside_the_torques_that_the_command_reads_is_not_written_over(capsys, trials, tmp_path):
    given = trials["subject01"]
    forces = tmp_path / "t_forces.mot"
    shutil.copy(given[-1], forces)
    before = forces.read_bytes()
    assert main([*given[:-1], str(forces), "-o", str(tmp_path / "t.sto")]) == 2
    assert "is read by this command" in capsys.readouterr().err
    assert forces.read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == [forces.name]


def test_opensim_s_tool_runs_on_the_files_and_finds_the_torques(written, monkeypatch, tmp_path):
    """Goals for hip, knee and ankle flexion: 8, 8 and 5 % of the range; its model has its own inertias."""
    opensim = pytest.importorskip("opensim", reason="OpenSim is not installed (extra `oracle`)")
    given, path = written
    monkeypatch.chdir(tmp_path)  # its log goes here; it finds the files by those that name them
    opensim.Logger.setLevelString("off")
    assert opensim.InverseDynamicsTool(str(path.with_name("t_setup.xml"))).run()
    ours = load_torques(path)
    walk = "opensim-gait2392" if "subject01" in given[1] else "opensim-rajagopal"
    theirs = load_torques(path.with_name("t_setup_result.sto"), preset=walk).at(ours.time)
    for movement, most in (("hip_flexion", 0.08), ("knee_flexion", 0.08), ("ankle_dorsiflexion", 0.05)):
        for side in SIDES:
            k = JOINTS.index(f"{side}_{movement}")
            both = np.isfinite(ours.tau[:, k]) & np.isfinite(theirs[:, k])
            assert both.sum() >= 0.9 * np.isfinite(ours.tau[:, k]).sum()
            a, b = ours.tau[both, k], theirs[both, k]
            assert np.sqrt(np.mean((a - b) ** 2)) <= most * np.ptp(b), (side, movement)
