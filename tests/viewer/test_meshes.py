"""Meshes of robots: read as others read them, thinned in their shape, found in their package alone."""

import struct

import coal
import numpy as np
import pytest

from exo_pin.errors import FormatError
from exo_pin.retarget import load
from exo_pin.viewer.meshes import mesh_files, solids
from exo_pin.viewer.meshes.thinning import shaded, thinned
from exo_pin.viewer.meshes.urdf_meshes import Meshes

CORNERS = np.array([[x, y, z] for x in (0.0, 0.2) for y in (0.0, 0.1) for z in (0.0, 0.3)])
SIDES = ([0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3])
FACES = np.array([[a, *pair] for a, b, c, d in SIDES for pair in ((b, c), (c, d))])


def binary_stl(vertices, faces):
    rows = b"".join(struct.pack("<12fH", 0, 0, 0, *vertices[face].ravel(), 0) for face in faces)
    return b"made for a test".ljust(80, b"\0") + struct.pack("<I", len(faces)) + rows


def text_stl(vertices, faces):
    lines = ["solid box"]
    for face in faces:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex {} {} {}".format(*vertices[k]) for k in face]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid box"]).encode()


def obj(vertices, faces):
    return "\n".join(
        ["v {} {} {}".format(*v) for v in vertices] + ["f {}//1 {}//1 {}//1".format(*(f + 1)) for f in faces]
    ).encode()


def dae(vertices, faces, *, up="Z_UP", kind="polylist"):
    numbers = " ".join(map(str, vertices.ravel()))
    rows = " ".join(f"{k} 0" for k in faces.ravel())
    counts = "<vcount>" + "3 " * len(faces) + "</vcount>" if kind == "polylist" else ""
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.01"/><up_axis>{up}</up_axis></asset>
<library_effects><effect id="e"><profile_COMMON><technique sid="t"><phong><diffuse>
<color>0.1 0.2 0.3 1</color></diffuse></phong></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="24">{numbers}</float_array>
<technique_common><accessor source="#a" count="8" stride="3"/></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<{kind} material="s" count="{len(faces)}"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="NORMAL" source="#p" offset="1"/>{counts}<p>{rows}</p></{kind}>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w">
<node><translate>0 0 1</translate><rotate>0 0 1 90</rotate><scale>100 100 100</scale>
<instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="s" target="#m"/></technique_common></bind_material></instance_geometry></node>
</visual_scene></library_visual_scenes></COLLADA>""".encode()


def volume(vertices, faces):
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return float(np.einsum("fk,fk->f", a, np.cross(b, c)).sum() / 6)


@pytest.mark.parametrize(
    ("name", "content"),
    [("a.stl", binary_stl), ("a.STL", text_stl), ("a.obj", obj)],
)
def test_a_box_is_read_whole_from_every_kind_of_file(tmp_path, name, content):
    (tmp_path / name).write_bytes(content(CORNERS, FACES))
    (part,) = mesh_files.read(tmp_path / name)
    assert len(part.vertices) == 8
    assert volume(part.vertices, part.faces) == pytest.approx(0.2 * 0.1 * 0.3)


@pytest.mark.parametrize("kind", ["triangles", "polylist"])
def test_collada_is_placed_scaled_and_coloured_as_its_scene_says(tmp_path, kind):
    (tmp_path / "a.dae").write_bytes(dae(CORNERS, FACES, kind=kind))
    (part,) = mesh_files.read(tmp_path / "a.dae")
    assert part.color == (0.1, 0.2, 0.3, 1.0)
    assert volume(part.vertices, part.faces) == pytest.approx(0.2 * 0.1 * 0.3)
    assert part.vertices.min(axis=0) == pytest.approx([-0.1, 0, 0.01])  # turned by 90 degrees, raised by 1 cm
    assert not part.y_up


def test_the_robots_meshes_are_read_as_coal_reads_them():
    """Against assimp, which puts the scene's nodes together: the same extent."""
    folder = load("romeo").robot.path.parent.parent / "meshes" / "V1" / "visual"
    for path in [folder / "Torso.dae", folder / "LHipPitch.dae"]:
        theirs = np.array(coal.MeshLoader().load(str(path), np.ones(3)).vertices()).reshape(-1, 3)
        ours = np.concatenate([part.vertices for part in mesh_files.read(path)])
        assert ours.min(axis=0) == pytest.approx(theirs.min(axis=0), abs=1e-6)
        assert ours.max(axis=0) == pytest.approx(theirs.max(axis=0), abs=1e-6)


DAMAGED = {
    "empty.stl": b"",
    "short.stl": binary_stl(CORNERS, FACES)[:200],
    "nan.stl": binary_stl(CORNERS * np.nan, FACES),
    "words.stl": b"solid a vertex one two three",
    "beyond.obj": b"v 0 0 0\nf 1 2 3",
    "words.obj": b"v a b c",
    "cut.dae": dae(CORNERS, FACES)[:900],
    "wrong.dae": dae(CORNERS, FACES).replace(b'url="#g"', b'url="#nothing"'),
    "counts.dae": dae(CORNERS, FACES).replace(b"<vcount>3 ", b"<vcount>4 "),
    "bomb.dae": b'<!DOCTYPE a [<!ENTITY b "bb"><!ENTITY c "&b;&b;">]><COLLADA>&nothing;</COLLADA>',
    "walk.txt": b"no mesh",
}


@pytest.mark.parametrize("name", DAMAGED)
def test_damaged_files_are_refused_in_one_line(tmp_path, name):
    (tmp_path / name).write_bytes(DAMAGED[name])
    with pytest.raises(FormatError) as raised:
        mesh_files.read(tmp_path / name)
    assert len(str(raised.value).splitlines()) == 1


def test_deeply_nested_collada_is_refused(tmp_path):
    nodes = b"<node>" * 200 + b"</node>" * 200
    text = dae(CORNERS, FACES).replace(b"<node>", nodes + b"<node>")
    (tmp_path / "deep.dae").write_bytes(text)
    with pytest.raises(FormatError, match="nested"):
        mesh_files.read(tmp_path / "deep.dae")


def _sphere():
    ball = solids.sphere(0.1)
    keys = np.unique(np.round(ball.vertices, 9), axis=0, return_inverse=True)
    return keys[0], keys[1].reshape(-1)[ball.faces]


def test_thinning_keeps_flat_walls_edges_and_volume():
    k = np.linspace(0, 1, 21)
    x, y = np.meshgrid(k, k, indexing="ij")
    side = np.arange(441).reshape(21, 21)
    quads = np.stack([side[:-1, :-1], side[1:, :-1], side[1:, 1:], side[:-1, 1:]], axis=-1).reshape(-1, 4)
    faces = quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    wall = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3)
    vertices, fewer = thinned(wall, faces, 0.21)
    assert len(fewer) < len(faces) / 5
    assert np.abs(vertices[:, 2]).max() < 1e-9
    ball, round_faces = _sphere()
    less, left = thinned(ball, round_faces, 0.02)
    assert len(left) < 0.7 * len(round_faces)
    assert volume(less, left) == pytest.approx(volume(ball, round_faces), rel=0.05)


def test_thinning_keeps_the_corners_of_a_box():
    faces, vertices = FACES, CORNERS
    for _ in range(3):  # each triangle into four
        middles = np.concatenate([vertices[faces[:, [k, (k + 1) % 3]]].mean(axis=1) for k in range(3)])
        n, m = len(vertices), len(faces)
        ab, bc, ca = (n + k * m + np.arange(m) for k in range(3))
        a, b, c = faces.T
        faces = np.concatenate(
            [np.stack(t, axis=1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        )
        vertices = np.concatenate([vertices, middles])
    less, left = thinned(vertices, faces, 0.045)
    assert len(left) < len(faces) / 2
    assert less[np.unique(left)].min(axis=0) == pytest.approx(CORNERS.min(axis=0), abs=1e-6)
    assert less[np.unique(left)].max(axis=0) == pytest.approx(CORNERS.max(axis=0), abs=1e-6)
    assert volume(less, left) == pytest.approx(0.2 * 0.1 * 0.3, rel=0.02)


def test_normals_are_sharp_at_creases_and_smooth_elsewhere():
    box = shaded(CORNERS, FACES)
    assert np.abs(box.normals).max(axis=1) == pytest.approx(1.0)  # each along an axis
    assert len(box.vertices) == 24
    ball = shaded(*_sphere())
    straight = np.einsum("vk,vk->v", ball.normals, ball.vertices) / np.linalg.norm(ball.vertices, axis=1)
    assert straight.min() > 0.98


def package(tmp_path, name="mine"):
    """A package with a URDF in urdf/ and a mesh in meshes/."""
    root = tmp_path / name
    (root / "urdf").mkdir(parents=True)
    (root / "meshes").mkdir()
    (root / "package.xml").write_text("<package/>")
    (root / "meshes" / "box.stl").write_bytes(binary_stl(CORNERS, FACES))
    urdf = root / "urdf" / "mine.urdf"
    urdf.write_text("<robot/>")
    return urdf


@pytest.mark.parametrize(
    "name",
    ["package://mine/meshes/box.stl", "package:///mine/meshes/box.stl", "../meshes/box.stl"],
)
def test_meshes_are_found_in_the_urdf_s_package(tmp_path, name):
    urdf = package(tmp_path)
    found = Meshes(urdf, 1.0).find(name)
    assert found == (tmp_path / "mine" / "meshes" / "box.stl").resolve()
    assert Meshes(urdf, 1.0).find(f"file://{found}") == found


def test_a_package_beside_and_on_ros_s_path_is_found(tmp_path, monkeypatch):
    urdf = package(tmp_path)
    package(tmp_path, "beside")
    assert Meshes(urdf, 1.0).find("package://beside/meshes/box.stl") is not None
    package(tmp_path / "far", "away")
    assert Meshes(urdf, 1.0).find("package://away/meshes/box.stl") is None
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "far"))
    assert Meshes(urdf, 1.0).find("package://away/meshes/box.stl") is not None


@pytest.mark.parametrize(
    "name",
    [
        "package://mine/../secret.stl",
        "../../secret.stl",
        "{tmp}/secret.stl",
        "file://{tmp}/secret.stl",
        "package://../secret.stl",
        "package://./secret.stl",
        "package:///secret.stl",
        "package://other/secret.stl",
        "../meshes/link.stl",
        "http://localhost/box.stl",
        "//localhost/box.stl",
        "a\0b.stl",
        "",
    ],
)
def test_no_name_in_a_urdf_leads_out_of_its_package(tmp_path, name):
    urdf = package(tmp_path)
    (tmp_path / "secret.stl").write_bytes(binary_stl(CORNERS, FACES))
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "secret.stl").write_bytes(binary_stl(CORNERS, FACES))  # no package: no package.xml
    (urdf.parent.parent / "meshes" / "link.stl").symlink_to(tmp_path / "secret.stl")
    meshes = Meshes(urdf, 1.0)
    assert meshes.find(name.format(tmp=tmp_path)) is None
    assert meshes.solids(name.format(tmp=tmp_path), (1, 1, 1)) == []
    assert len(meshes.missing) == 1


def test_a_urdf_without_a_file_has_no_meshes():
    assert Meshes(None, 1.0).find("package://example-robot-data/robots/bolt.stl") is None


def test_mirrored_meshes_keep_their_outside_outside(tmp_path):
    urdf = package(tmp_path)
    for scale in ((1, 1, 1), (1, -1, 1), (-2, 1, 1)):
        ((solid, _),) = Meshes(urdf, 10.0).solids("../meshes/box.stl", scale)
        assert volume(solid.vertices, solid.faces) == pytest.approx(0.006 * abs(np.prod(scale)), rel=0.05)


def test_too_many_triangles_are_left_away_with_a_reason(tmp_path, monkeypatch):
    from exo_pin.viewer.meshes import urdf_meshes as module

    monkeypatch.setattr(module, "_MOST_TRIANGLES", 20)
    meshes = Meshes(package(tmp_path), 1.0)
    assert meshes.solids("../meshes/box.stl", (1, 1, 1))
    assert meshes.solids("../meshes/box.stl", (1, 1, 1)) == []
    assert "20 triangles" in meshes.missing["../meshes/box.stl"]
