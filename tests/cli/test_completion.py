"""Completion, asked of bash itself."""

import shutil
import subprocess

import pytest

from exo_pin.cli import COMMANDS, main

BASH = shutil.which("bash") or ""


@pytest.fixture(scope="module")
def completions(tmp_path_factory):
    """What bash offers behind some words."""
    import contextlib
    import io

    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        assert main(["completion", "bash"]) == 0
    path = tmp_path_factory.mktemp("shell") / "exo-pin.bash"
    path.write_text(out.getvalue())

    def behind(*words):
        line = (
            f"source {path}; COMP_WORDS=({' '.join(repr(w) for w in words)}); COMP_CWORD={len(words) - 1}; "
        )
        done = subprocess.run(
            [BASH, "-c", f'{line} _exo_pin; printf "%s\\n" "${{COMPREPLY[@]}}"'],
            capture_output=True, text=True, check=True, cwd=path.parent,
        )  # fmt: skip
        return done.stdout.split()

    return behind


@pytest.mark.skipif(not BASH, reason="no bash")
def test_bash_completes_commands_options_and_names(completions):
    assert set(COMMANDS) <= set(completions("exo-pin", ""))
    assert completions("exo-pin", "rep") == ["replay", "report", "reproduce"]
    assert "--html" in completions("exo-pin", "replay", "--")
    assert completions("exo-pin", "check", "--pelvis", "") == ["recorded", "device"]
    assert completions("exo-pin", "check", "--device", "lo") == ["lokomat", "lopes7", "lopes8"]
    assert completions("exo-pin", "simulate", "--controller", "pd_s") == ["pd_stabilised"]
    assert completions("exo-pin", "check", "very_f") == ["very_fast"]


@pytest.mark.parametrize("shell", ["zsh", "fish"])
def test_the_scripts_of_other_shells_name_every_command(shell, capsys):
    assert main(["completion", shell]) == 0
    printed = capsys.readouterr().out
    assert all(name in printed for name in COMMANDS)
    if shutil.which(shell):
        subprocess.run([shell, "-n"], input=printed, text=True, check=True)


def test_another_shell_is_refused(capsys):
    with pytest.raises(SystemExit, match="2"):
        main(["completion", "powershell"])
    assert "bash" in capsys.readouterr().err
