"""Names and numbers as people type them: understood, or answered with the right form."""

import argparse
import contextlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from exo_pin import devices
from exo_pin.cli import main, measures
from exo_pin.errors import UnknownNameError
from exo_pin.retarget import biped, target_robots


def out(capsys, *words):
    assert main(list(words)) == 0
    return capsys.readouterr().out


def refused(capsys, *words):
    try:
        code = main(list(words))
    except SystemExit as stop:
        code = int(str(stop.code))
    err = capsys.readouterr().err
    assert code == 2
    assert len(err.strip().splitlines()) == 1
    return err


@pytest.mark.parametrize("name", devices.DEVICES)
def test_a_device_is_known_in_any_capitals(name):
    assert devices.find(name.upper()) is devices.find(f" {name.title()}") is devices.DEVICES[name]


@pytest.mark.parametrize(
    ("said", "name"), [("Exo-H2", "h2"), ("exo h2", "h2"), ("ReWalk", "hk4"), ("EKSO", "hk4")]
)
def test_a_product_s_name_is_its_device(said, name):
    assert devices.find(said).name == name


@pytest.mark.parametrize("name", target_robots.TARGETS)
def test_a_robot_is_known_in_any_capitals(name):
    assert biped.find(name.upper().replace("_", "-")).name == name


def test_a_name_that_could_be_two_devices_is_answered_with_both():
    with pytest.raises(UnknownNameError, match="'lopes7' or 'lopes8'"):
        devices.find("LOPES")


@pytest.mark.parametrize("said", ["Free", "FREE", "very-fast", "Very Fast"])
def test_a_speed_is_known_in_any_capitals(capsys, said):
    right = said.lower().replace("-", "_").replace(" ", "_")
    assert out(capsys, "cycles", said, "--json") == out(capsys, "cycles", right, "--json")


@pytest.mark.parametrize("said", ["f", "F", "Female", "fem"])
def test_a_choice_is_known_by_its_beginning(capsys, said):
    assert out(capsys, "body", "--sex", said) == out(capsys, "body", "--sex", "female")


@pytest.mark.parametrize("said", ["1.58", "1,58", "1.58m", "1,58 m", "158cm", "1580 MM"])
def test_a_stature_is_known_with_comma_and_unit(capsys, said):
    assert out(capsys, "body", "--stature", said) == out(capsys, "body", "--stature", "1.58")
    assert out(capsys, "urdf", f"stature:={said}") == out(capsys, "urdf", "--stature", "1.58")
    assert out(capsys, "body", "--set", f"stature={said}") == out(capsys, "body", "--stature", "1.58")


@pytest.mark.parametrize(
    ("words", "answer"),
    [
        (["body", "--stature", "158"], "did you mean 1.58 m"),
        (["body", "--stature", "1580"], "did you mean 1.58 m"),
        (["body", "--mass", "70000"], "did you mean 70 kg"),
        (["body", "--set", "thigh=43"], "did you mean 0.43 m"),
        (["body", "--stature", "5ft"], "1.75m"),
        (["body", "--mass", "heavy"], "70kg"),
        (["body", "--sex", "femlae"], "'female'"),
        (["body", "--sex", "x"], "male, female"),
        (["body", "--statur", "1,7", "--wiast-width", "0.4"], "'--waist-width'"),
        (["devices", "lokomta"], "'lokomat'"),
        (["replay", "--device", "lokomat", "--peliv", "device"], "'--pelvis'"),
        (["compare", "fre"], "'free'"),
        (["compare", "--passive", "relased"], "'released'"),
        (["compare", "--devices", "lokomat,h3"], "h2"),
        (["retarget", "--robot", "tlaos"], "'talos'"),
        (["chekc", "free"], "'check'"),
        (["feasible", "--gap", "wide"], "wide"),
        (["check", "free", "fast"], "'fast'"),
    ],
    ids=lambda x: " ".join(x) if isinstance(x, list) else "",
)
def test_what_is_not_clear_is_answered_with_the_right_form_in_one_line(capsys, words, answer):
    assert answer in refused(capsys, *words)


@given(st.floats(0.5, 2.6).map(lambda x: round(x, 3)))
def test_every_spelling_of_a_length_is_the_same_number(metres):
    for text in (f"{metres}", f"{metres}m", f"{metres}".replace(".", ","), f"{1000 * metres:.0f} mm"):
        assert measures.metres(text) == pytest.approx(metres, abs=1e-9)


@given(st.text(max_size=8))
def test_any_text_is_a_length_or_refused(text):
    with contextlib.suppress(argparse.ArgumentTypeError):  # any other error leaves the test
        assert isinstance(measures.metres(text), float)


def test_names_in_a_list_are_parted_by_commas_or_spaces(tmp_path, monkeypatch):
    assert measures.listed(["a,b", "c,", "d"]) == ["a", "b", "c", "d"]
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine,too.toml").write_text("")
    assert measures.listed(["mine,too.toml", "a"]) == ["mine,too.toml", "a"]


def test_devices_of_a_comparison_are_parted_by_commas(capsys):
    said = out(capsys, "compare", "--devices", "Lokomat,h2", "exo12", "--json")
    assert said == out(capsys, "compare", "--devices", "lokomat", "h2", "exo12", "--json")


@pytest.mark.parametrize(
    ("text", "value"), [("0.3", 0.3), ("30%", 0.3), ("30 %", 0.3), ("0,3", 0.3), ("1", 1.0)]
)
def test_a_part_of_a_whole_is_a_number_or_per_cent(text, value):
    assert measures.share(text) == pytest.approx(value)


@pytest.mark.parametrize("text", ["130%", "-0.1", "nan", "half", "3"])
def test_what_is_no_part_of_a_whole_is_refused(text):
    with pytest.raises(argparse.ArgumentTypeError):
        measures.share(text)


@pytest.mark.parametrize(
    "words",
    [
        ["replay", "--html", "out.pdf"],
        ["replay", "--html", "nowhere/out.html"],
        ["edit", "free", "out.pdf", "--cycles", "3"],
        ["edit", "free", "nowhere/out.csv", "--cycles", "3"],
        ["edit", "free", "out.csv", "--cycles", "3", "--for", "20s"],
        ["report", "-o", "nowhere/out.html"],
    ],
)
def test_files_that_cannot_be_written_are_refused_before_the_work(words, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("exo_pin.cli.options.gait_from", lambda *args: pytest.fail("it worked first"))
    assert main(words) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_an_unknown_option_shows_the_usage_of_the_command(capsys):
    with pytest.raises(SystemExit):
        main(["edit", "free", "out.csv", "--nothing"])
    assert "usage: exo-pin edit GAIT OUT [options]" in capsys.readouterr().err


def test_a_narrow_window_shows_a_table_as_a_list(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    assert main(["devices"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 40
    assert "  motors: 4" in lines
