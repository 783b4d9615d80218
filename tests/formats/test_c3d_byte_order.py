"""C3D files of DEC and MIPS machines hold the same numbers as those of Intel machines."""

from __future__ import annotations

import numpy as np
import pytest

from exo_pin.formats import load_gait, load_markers, save_gait
from exo_pin.gait import Gait, normative_gait

DEC, MIPS = 85, 86
WALK = "c3d_pig_walk_HC036A/HC036A10_walk.c3d"


def as_floats(raw, machine):
    """Intel's 32-bit numbers as another machine writes them."""
    x = np.frombuffer(raw, "<f4")
    if machine == MIPS:
        return x.astype(">f4").tobytes()
    vax = (x.astype(float) * 4 + 0.0).astype("<f4")  # the same bits mean a quarter; VAX has no minus zero
    return vax.view("<u2").reshape(-1, 2)[:, ::-1].tobytes()


def as_integers(raw, machine):
    return np.frombuffer(raw, "<u2").byteswap().tobytes() if machine == MIPS else bytes(raw)


def foreign(data, machine):
    """An Intel C3D file as the machine would have written it: the user guide's layout, walked once more."""
    out = bytearray(data)

    def word(at):
        return int.from_bytes(data[at : at + 2], "little")

    def turn(kind, start, count):
        turned, size = (as_floats, 4) if kind == 4 else (as_integers, 2)
        out[start : start + count * size] = turned(data[start : start + count * size], machine)

    for kind, start, count in ((2, 2, 5), (4, 12, 1), (2, 16, 2), (4, 20, 1), (2, 24, 140), (4, 304, 18)):
        turn(kind, start, count)
    at = (data[0] - 1) * 512
    out[at + 3] = machine
    at += 4
    while data[at]:
        name_end = at + 2 + abs(int.from_bytes(data[at : at + 1], signed=True))
        turn(2, name_end, 1)
        if data[at + 1] < 128:  # a parameter, not a group
            kind, dimensions = data[name_end + 2], data[name_end + 3]
            sizes = data[name_end + 4 : name_end + 4 + dimensions]
            if kind in (2, 4):
                turn(kind, name_end + 4 + dimensions, int(np.prod(list(sizes), dtype=int)))
        if not word(name_end):
            break
        at = name_end + word(name_end)
    scale = float(np.frombuffer(data, "<f4", 1, 12)[0])
    frames = word(8) - word(6) + 1
    turn(4 if scale < 0 else 2, (word(16) - 1) * 512, frames * (4 * word(2) + word(4)))
    return bytes(out)


@pytest.mark.parametrize("machine", [DEC, MIPS])
def test_the_recording_is_the_same_from_every_machine(shared, tmp_path, machine):
    path = tmp_path / "walk.c3d"
    path.write_bytes(foreign((shared / WALK).read_bytes(), machine))
    intel, other = load_markers(shared / WALK), load_markers(path)
    assert other.names == intel.names
    assert (other.events, other.up, other.time[0]) == (intel.events, intel.up, intel.time[0])
    np.testing.assert_array_equal(other.position, intel.position)
    for name, values in intel.angles.items():
        np.testing.assert_array_equal(other.angles[name], values)
    for plate, same in zip(other.plates, intel.plates, strict=True):
        np.testing.assert_array_equal(plate.force, same.force)
        np.testing.assert_array_equal(plate.point, same.point)


@pytest.mark.parametrize("machine", [DEC, MIPS])
def test_a_written_walk_is_the_same_from_every_machine(tmp_path, machine):
    walk = normative_gait("free", samples=51).resampled(50)
    gait = Gait(0.02 * np.arange(50), walk.q, base=walk.base, events=walk.events[:1])
    save_gait(gait, tmp_path / "intel.c3d")
    data = (tmp_path / "intel.c3d").read_bytes()
    other = tmp_path / "other.c3d"
    other.write_bytes(foreign(data, machine))
    np.testing.assert_array_equal(load_gait(other).q, load_gait(tmp_path / "intel.c3d").q)
    assert len(load_gait(other).events) == 1
