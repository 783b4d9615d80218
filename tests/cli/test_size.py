"""`exo-pin size`: its table, its JSON, and one line for what is not accepted."""

import json
from xml.etree import ElementTree

import pytest

from exo_pin.cli import main


def test_the_walk_is_sized_and_its_ground_reaction_labelled(capsys):
    assert main(["size", "--motor", "maxon-ec-90-flat-48v", "--gear", "50:1", "--bws", "0.3", "--json"]) == 1
    facts = json.loads(capsys.readouterr().out)
    assert facts["ground_reaction"] == "predicted"
    knee = facts["joints"]["left_knee_flexion"]
    assert knee["motor"]["given"]["ratio"] == 50.0
    assert knee["motor"]["given"]["reflected_inertia_kgm2"] == pytest.approx(50**2 * 3.06e-4)
    assert knee["energy_J_per_stride"] > knee["energy_with_recovery_J_per_stride"]
    assert not facts["fits"]


def test_without_a_motor_the_table_says_that_the_limit_is_a_rectangle(capsys):
    assert main(["size"]) == 0
    out = capsys.readouterr().out
    assert "ground reaction predicted" in out
    assert "rectangle" in out
    assert "every joint fits" in out


def test_the_figure_has_a_plane_for_every_movement_and_says_predicted(tmp_path, capsys):
    path = tmp_path / "planes.svg"
    assert main(["size", "--device", "lokomat", "-o", str(path)]) == 0
    drawn = ElementTree.fromstring(path.read_text(encoding="utf-8"))
    titles = [node.text for node in drawn.iter() if node.tag.endswith("title")]
    assert titles == [
        "free on lokomat, ground reaction predicted",
        "hip flexion: torque [N m]",
        "knee flexion: torque [N m]",
    ]


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["--gear", "50:1"], "--motor"),
        (["--motor", "maxon-ec-90-flat-48v", "--gear", "fast"], "--gear 'fast'"),
        (["--motor", "maxon-ec-90-flat-48v", "--gear=-50"], "--gear"),
        (["--motor", "maxon-ec-90-flat-48v", "--gear", "50:0"], "--gear"),
        (["--motor", "nothing"], "maxon"),
        (["--motor", "nothing.toml"], "nothing.toml"),
        (["--bws", "1.5"], "0 to 1"),
        (["-o", "planes.png"], ".svg"),
        (["--worst", "--bws", "0.3"], "--worst"),
    ],
)
def test_bad_input_is_one_line(capsys, words, why):
    assert main(["size", *words]) == 2
    err = [line for line in capsys.readouterr().err.splitlines() if not line.startswith("note:")]
    assert len(err) == 1
    assert why in err[0]


@pytest.mark.parametrize("command", ["size", "torques"])
def test_forces_of_plates_are_not_said_to_be_those_of_a_motion_that_the_device_changes(
    capsys, shared, command
):
    folder = shared / "opensim_subject01_walk"
    files = [folder / f"subject01_{name}" for name in ("walk1_ik.mot", "simbody.osim", "walk1_grf.mot")]
    words = [str(files[0]), "--model", str(files[1]), "--forces", str(files[2]), "--json"]
    for more, reaction in ((["--pelvis", "device"], "predicted"), ([], "measured")):
        assert main([command, *words, *more]) in (0, 1)
        out, err = capsys.readouterr()
        assert json.loads(out)["ground_reaction"] == reaction
        assert ("their forces are not used" in err) == (reaction == "predicted")
