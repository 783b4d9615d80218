from __future__ import annotations

import numpy as np
import pytest
import umsgpack
from hypothesis import given
from hypothesis import strategies as st

from exo_pin.viewer import drawing_commands
from exo_pin.viewer.drawing_commands import Material
from exo_pin.viewer.meshes.solids import translation

GRAIN = 2e-5  # [m]: vertices are rounded, so that they compress


@given(st.tuples(*[st.floats(0, 1)] * 3))
def test_hexadecimal_colours_keep_every_part_to_half_a_step(color):
    number = drawing_commands.hexadecimal(color)
    parts = [(number >> shift & 255) / 255 for shift in (16, 8, 0)]
    assert np.abs(np.subtract(parts, color)).max() <= 0.5 / 255 + 1e-12


def test_colours_outside_the_range_are_clipped_not_wrapped():
    assert drawing_commands.hexadecimal((2.0, -1.0, 0.0)) == 0xFF0000


def test_the_same_drawing_is_the_same_command():
    def ball():
        return drawing_commands.draw("/a", drawing_commands.sphere(0.1), Material((1, 0, 0, 1)))

    assert ball() == ball()


def test_different_nodes_have_different_identifiers():
    names = {
        drawing_commands.draw(f"/{k}", drawing_commands.box((1, 1, 1)), Material((1, 1, 1, 1)))["object"][
            "object"
        ]["uuid"]
        for k in range(500)
    }
    assert len(names) == 500


def test_a_cylinder_stands_along_z():
    matrix = np.array(drawing_commands.cylinder(0.1, 0.5).matrix).reshape(4, 4).T
    assert matrix @ [0, 1, 0, 0] == pytest.approx([0, 0, 1, 0])  # three.js's own axis is y


def test_a_placement_is_written_column_by_column():
    T = translation(1, 2, 3)
    assert drawing_commands.place("/a", T)["matrix"][12:15] == [1, 2, 3]


def test_only_translucent_materials_are_marked_so():
    assert Material((1, 1, 1, 0.5)).command()["transparent"]
    assert not Material((1, 1, 1, 1.0)).command()["transparent"]


def test_a_mesh_survives_packing(rng):
    vertices, faces = rng.normal(size=(7, 3)), rng.integers(0, 7, size=(5, 3))
    command = drawing_commands.draw("/m", drawing_commands.mesh(vertices, faces), Material((1, 1, 1, 1)))
    data = umsgpack.unpackb(umsgpack.packb(command))["object"]["geometries"][0]["data"]
    position = np.frombuffer(data["attributes"]["position"]["array"].data, "<f4").reshape(-1, 3)
    index = np.frombuffer(data["index"]["array"].data, "<u2").reshape(-1, 3)
    assert np.abs(position - vertices).max() < GRAIN
    assert np.array_equal(index, faces)
