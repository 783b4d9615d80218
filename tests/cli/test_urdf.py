"""`exo-pin urdf`: options and assignments mean the same, and do not contradict each other."""

import pytest

from exo_pin.cli import main


def text(capsys, *words):
    assert main(["urdf", *words]) == 0
    return capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "assignments"),
    [
        (["--device", "lopes8"], ["device:=lopes8"]),
        (["--hip-order", "yaw_roll_pitch"], ["hip_order:=yaw_roll_pitch"]),
        (
            ["--stature", "1.82", "--mass", "80", "--sex", "female"],
            ["stature:=1.82", "mass:=80", "sex:=female"],
        ),
        (["--waist-width", "0.4", "--no-wearer"], ["waist_width:=0.4", "wearer:=false"]),
        (["--device", "exo12", "--hip-order", "clinical"], []),
    ],
    ids=lambda words: " ".join(words) or "defaults",
)
def test_an_option_is_the_assignment_of_its_name(capsys, options, assignments):
    assert text(capsys, *options) == text(capsys, *assignments)


def test_a_given_device_and_hip_order_are_in_the_text(capsys):
    made = text(capsys, "--device", "lopes8", "--hip-order", "yaw_roll_pitch", "--stature", "1.6")
    assert '<robot name="lopes8">' in made
    assert 'name="pelvis_left_carriage"' in made
    assert made != text(capsys, "--device", "lopes8", "--stature", "1.6")


@pytest.mark.parametrize(
    "words",
    [
        ["--device", "h2", "device:=hk4"],
        ["--hip-order", "clinical", "hip_order:=yaw_roll_pitch"],
        ["--stature", "1.6", "stature:=1.7"],
        ["--sex", "female", "sex:=male"],
    ],
)
def test_an_option_and_another_assignment_contradict_each_other(capsys, words):
    assert main(["urdf", *words]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert words[1] in err
    assert words[2] in err
    assert main(["urdf", *words[:2], words[2].replace(words[2].partition(":=")[2], words[1])]) == 0
