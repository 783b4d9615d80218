"""Damaged URDF, mesh, TOML and xacro files are read or refused in one line, quickly, never in a traceback."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hypothesis import given, settings

from exo_pin import description
from exo_pin.anatomy import Body
from exo_pin.devices import device_file
from exo_pin.errors import ExoPinError
from exo_pin.markers.set_file import load_set
from exo_pin.retarget import target_file
from exo_pin.robot import load_urdf
from exo_pin.robot.urdf_joints import followers
from exo_pin.viewer.meshes.urdf_meshes import Meshes
from exo_pin.viewer.scenes.link_nodes import linkage
from tests.damaged_files import FILES, SLOWEST, damaged, files_of_processes

FILES_XACRO = files_of_processes(10, 10)
PIECES = [  # what hurts readers
    *(
        b"",
        b"\0",
        b"\xff",
        b"\n",
        b" ",
        b'"',
        b"<",
        b">",
        b"&",
        b"/",
        b"[",
        b"]",
        b"=",
        b"#",
        b"{",
        b"}",
        b"$(",
    ),
    *(
        b"nan",
        b"inf",
        b"-inf",
        b"1e999",
        b"1e308",
        b"-1e308",
        b"1e-320",
        b"0",
        b"-1",
        b"9" * 400,
        b"9" * 5000,
    ),
    *(
        b"1_0",
        b"0x1p3",
        b"1 2",
        b"\xd9\xa1",
        b"\x1b[31m",
        b"\xc2\x9b31m",
        b"&#x9b;",
        b"&#0;",
        b"&x;",
        b"\\u001b",
    ),
    *(
        b"<!DOCTYPE a [<!ENTITY x 'y'>]>",
        b"<x>" * 5000,
        b"[" * 5000,
        b"a" * 5000,
        b"<link name='a'/>",
        b"1 " * 999,
    ),
    *(
        b"<instance_node url='#n'/>",
        b"<node id='n'>",
        b"f 1 2 -3\n",
        b"v 1 2\n",
        b"vertex",
        b"99999999999999999999",
    ),
    *(b"floating", b"continuous", b"prismatic", b"<mimic joint='j'/>", b"${2**10**9}", b"${", b"<xacro:m/>"),
]


LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
MESH = '<visual><origin xyz="0 0 1"/><geometry><mesh filename="{}" scale="1 1 1"/></geometry></visual>'
URDF = f"""<?xml version="1.0"?>
<robot name="r"><material name="m"><color rgba="1 0 0 1"/></material><link name="a"/>
<link name="b"><inertial><origin xyz="0 0 0"/><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>{MESH.format("mesh.obj")}
<visual><geometry><cylinder radius="0.1" length="1"/></geometry><material name="m"/></visual></link>
<link name="c"/>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 1"/>
<axis xyz="0 1 0"/>{LIMIT}
</joint><joint name="k" type="continuous"><parent link="b"/><child link="c"/><axis xyz="0 1 0"/>
<mimic joint="j" multiplier="2" offset="0"/></joint></robot>"""
XACRO = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:property name="size" value="${0.1 * 2}"/>
<xacro:macro name="leg" params="name side:=1"><link name="${name}"/><joint name="${name}_hip" type="revolute">
<parent link="base"/><child link="${name}"/><origin xyz="0 ${side * size} 0"/><axis xyz="0 1 0"/>
<limit lower="${-pi/2}" upper="1" effort="1" velocity="1"/></joint></xacro:macro><link name="base"/>
<xacro:leg name="left"/><xacro:leg name="right" side="-1"/></robot>"""
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1//1 2/1/1 4\nf -1 -2 -3 -4\n"
DAE = """<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="f" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#f" stride="3"/>
</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/>
<vcount>3</vcount><p>0 1 2</p>
</polylist></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s"><node>
<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix><rotate>1 0 0 90</rotate><scale>1 1 1</scale>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes></COLLADA>"""
DEVICE = """name = "mine"
title = "Mine"
joints = ["hip_flexion", "knee_flexion"]
source = "measured"
toes = false
treadmill_km_h = [0.5, 3]
[actuators.knee_flexion]
effort_nm = 40
velocity_rad_s = 5.5
[ranges_deg]
knee_flexion = [0, 90]
"""
ROBOT = """name = "mine"
urdf = "mine.urdf"
feet = ["l", "r"]
forward = "x"
locked = ["waist"]
[stand_deg]
knee = 12.5
[limits_deg]
knee = [0, 90]
"""
MARKERS = """name = "mine"
hips = 0.36
[markers]
"{S}ASI" = "asis"
"{S}XYZ" = { segment = "pelvis", place = [0.1, 0.2, 0.3], spread_mm = 10 }
"""


def stl(text=False):
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype="<f4")
    if text:
        words = " ".join("vertex {} {} {}".format(*c) for c in corners)
        return f"solid x facet normal 0 0 1 outer loop {words} endloop endfacet endsolid".encode()
    return b"\0" * 80 + (2).to_bytes(4, "little") + 2 * (b"\0" * 12 + corners.tobytes() + b"\0\0")


def draw_urdf(path):
    """Loaded and drawn, as the viewer does."""
    robot = load_urdf(path)
    followers(robot.urdf)
    linkage(robot.urdf, "/r", meshes=Meshes(path, 1.0))


def draw_mesh(path):
    """A mesh that a URDF names: what is wrong with it is a reason, no error."""
    meshes = Meshes(path.with_name("mine.urdf"), 1.0)
    meshes.solids(path.name, (1.0, -1.0, 1.0))
    assert all(len(why) < 200 and why.isprintable() for why in meshes.missing.values())


def describe(path):
    description.arguments(Body.from_stature(), device=device_file.load(path))


KINDS = {
    "mine.urdf": (URDF.encode(), draw_urdf),
    "mine.obj": (OBJ.encode(), draw_mesh),
    "mine.dae": (DAE.encode(), draw_mesh),
    "binary.stl": (stl(), draw_mesh),
    "text.stl": (stl(text=True), draw_mesh),
    "mine.xacro": (XACRO.encode(), load_urdf),
    "device.toml": (DEVICE.encode(), describe),
    "robot.toml": (ROBOT.encode(), target_file.load),
    "markers.toml": (MARKERS.encode(), load_set),
    "body.toml": (b"", Body.load),
}


@pytest.mark.parametrize("name", KINDS)
def test_damaged_files_of_strangers_are_read_or_refused_in_one_line(tmp_path_factory, name):
    """EXO_PIN_MUTATIONS=5000 tries as many of each kind (xacro: a tenth)."""
    folder = tmp_path_factory.mktemp("fuzz")
    whole, use = KINDS[name]
    path = folder / name
    (folder / "mesh.obj").write_text(OBJ)
    path.write_bytes(whole)
    if not whole:
        Body.from_stature().save(path)
        whole = path.read_bytes()
    use(path)

    @settings(max_examples=FILES_XACRO if name.endswith(".xacro") else FILES, deadline=None)
    @given(damaged(whole, PIECES, whole=2))
    def once(data):
        path.write_bytes(data)
        start = time.process_time()
        try:
            use(path)
        except ExoPinError as error:
            message = str(error)
            assert folder.name in message
            assert message.isprintable()
            assert len(message) - len(str(path)) < 300
        assert time.process_time() - start < SLOWEST

    once()
