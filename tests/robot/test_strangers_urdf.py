"""URDFs, meshes and xacro files of strangers: refused in one line that names the place, in bounded time."""

from __future__ import annotations

import re
import time
from pathlib import Path

import pytest

import exo_pin
from exo_pin.errors import DescriptionError
from exo_pin.robot import load_urdf
from exo_pin.robot.urdf_tree import DEEPEST

XMLNS = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'


def chain(links: int, *, backwards: bool = False) -> str:
    """Links that hang on each other; `backwards`: the file names the furthest first."""
    order = range(links - 1, -1, -1) if backwards else range(links)
    text = "".join(f'<link name="l{k}"/>' for k in order)
    text += "".join(
        f'<joint name="j{k}" type="revolute"><parent link="l{k - 1}"/><child link="l{k}"/><axis xyz="0 1 0"/>'
        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
        for k in order
        if k
    )
    return f'<robot name="chain">{text}</robot>'


TWO = chain(2).replace(
    '<link name="l1"/>',
    '<link name="l1"><inertial><origin xyz="0 0 0" rpy="0 0 0"/><mass value="1"/><inertia ixx="1" ixy="0" '
    'ixz="0" iyy="1" iyz="0" izz="1"/></inertial><visual><origin xyz="0 0 0"/><geometry><mesh '
    'filename="a.stl" scale="1 1 1"/></geometry></visual><collision><geometry><box size="1 1 1"/></geometry>'
    "</collision></link>",
)
WRONG = [  # what stands there, what stands there instead, what the message names
    ('<mass value="1"', '<mass value="nan"', "link 'l1': value of <mass> is 'nan'"),
    ('<mass value="1"', '<mass value="inf"', "link 'l1': value of <mass>"),
    ('<mass value="1"', '<mass value="-1"', "link 'l1': value of <mass> is '-1'"),
    ('<mass value="1"', '<mass value="1_0"', "link 'l1': value of <mass> is '1_0'"),
    ('<mass value="1"', '<mass value="\u0661"', "link 'l1': value of <mass>"),
    ('<mass value="1"', "<mass", "link 'l1': value of <mass> is missing"),
    ('ixx="1"', 'ixx="1e300"', "link 'l1': ixx of <inertia>"),
    ('xyz="0 0 0" rpy="0 0 0"', 'xyz="0 0 0" rpy="0 0"', "link 'l1': rpy of <origin> is '0 0'"),
    ('xyz="0 0 0" rpy', 'xyz="nan 0 0" rpy', "link 'l1': xyz of <origin>"),
    ('xyz="0 0 0" rpy', 'xyz="1e30 0 0" rpy', "from -1000 to 1000 m"),
    ('scale="1 1 1"', 'scale="1 0 1"', "link 'l1': scale of <mesh> is '1 0 1'"),
    ('scale="1 1 1"', 'scale="1e-320 1 1"', "link 'l1': scale of <mesh>"),
    ('scale="1 1 1"', 'scale="1e300 1 1"', "link 'l1': scale of <mesh>"),
    ('size="1 1 1"', 'size="1 inf 1"', "link 'l1': size of <box>"),
    ('<axis xyz="0 1 0"', '<axis xyz="nan 1 0"', "joint 'j1': xyz of <axis>"),
    ('<axis xyz="0 1 0"', '<axis xyz="0 0 0"', "joint 'j1': xyz of <axis>"),
    ('lower="-1"', 'lower="2"', "joint 'j1': its lower limit"),
    ('effort="1"', 'effort="-1"', "joint 'j1': effort of <limit>"),
    ('velocity="1"', 'velocity="nan"', "joint 'j1': velocity of <limit>"),
    ('<parent link="l0"/>', '<parent link="nobody"/>', "joint 'j1': there is no link 'nobody'"),
    ('<parent link="l0"/>', "", "joint 'j1' names no parent link"),
    ('<parent link="l0"/>', '<parent link="l1"/>', "hangs on itself"),
    ('<link name="l0"/>', '<link name="l0"/><link name="l0"/>', "link 'l0' occurs more than once"),
    ('<link name="l0"/>', '<link name="l0"/><link name="more"/>', "2 links hang on no joint"),
    ('<link name="l0"/>', f'<link name="l0"/><link name="{"a" * 5000}"/>', "printable characters"),
    ('<link name="l0"/>', '<link name="l0"/><link name="a&#x9b;31m"/>', r"control character U\+009B"),
    ('<link name="l0"/>', '<link name="l0"/>' + "<x>" * 200_000 + "</x>" * 200_000, "100 levels"),
    ("<robot", '<!DOCTYPE r [<!ENTITY a "b">]><robot', "document type"),
]


@pytest.mark.parametrize(("old", "new", "said"), WRONG)
def test_what_is_wrong_is_said_in_one_short_line_with_its_place(tmp_path, old, new, said):
    assert old in TWO
    path = tmp_path / "mine.urdf"
    path.write_text(TWO.replace(old, new, 1), "utf-8")
    with pytest.raises(DescriptionError, match=said) as refusal:
        load_urdf(path)
    message = str(refusal.value)
    assert message.startswith(str(path))
    assert message.isprintable()
    assert len(message) - len(str(path)) < 250


def test_what_is_right_is_accepted():
    load_urdf(TWO)
    load_urdf(TWO.replace('scale="1 1 1"', 'scale="-1 1 1"'))  # which mirrors
    load_urdf("\n" + TWO)


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("links", [DEEPEST + 2, 5000, 50_000])
def test_chains_that_recursion_could_not_follow_are_refused_quickly(links, backwards):
    text, start = chain(links, backwards=backwards), time.process_time()
    with pytest.raises(DescriptionError, match=r"at most|chain|elements"):
        load_urdf(text)
    assert time.process_time() - start < 5


def test_the_longest_chain_is_built_and_drawn():
    from exo_pin.viewer.scenes.link_nodes import linkage

    robot = load_urdf(chain(DEEPEST + 1))
    assert robot.nq == DEEPEST
    assert len(linkage(robot.urdf, "/r").joints) == DEEPEST


def test_xml_is_parsed_by_the_safe_reader_alone():
    parser = re.compile(r"fromstring|ET\.parse|etree\.parse|minidom|XMLParser|iterparse|expat\.|lxml")
    package = Path(exo_pin.__file__).parent
    found = {p.name for p in package.rglob("*.py") if parser.search(p.read_text("utf-8"))}
    assert found == {"xml_reader.py"}


ESCAPES = {  # expressions and elements that reach out of a xacro file
    "lambda": '<link name="${(lambda: ().__class__)()}"/>',
    "frame": '<link name="${[g.gi_frame.f_back for g in [(x for x in [1])]]}"/>',
    "eval": "<link name=\"$(eval open('{out}', 'w').write('x'))\"/>",
    "import": "<link name=\"$(eval exec('import os'))\"/>",
    "yaml": "<link name=\"${xacro.load_yaml('{secret}')['a']}\"/>",
    "include": '<xacro:include filename="{secret}"/><link name="a"/>',
    "power": '<link name="${2**10**10}"/>',
    "memory": "<link name=\"${len('a' * 10**10)}\"/>",
    "macro": '<xacro:macro name="m"><xacro:m/><xacro:m/></xacro:macro><xacro:m/><link name="a"/>',
    "bomb": "".join(
        f'<xacro:macro name="m{k}"><xacro:m{k + 1}/><xacro:m{k + 1}/></xacro:macro>' for k in range(40)
    )
    + '<xacro:macro name="m40"><link name="a"/></xacro:macro><xacro:m0/>',
}


@pytest.mark.parametrize("name", ESCAPES)
def test_xacro_files_reach_nothing_outside_and_end(tmp_path, name):
    secret, out = tmp_path / "secret.yaml", tmp_path / "written"
    secret.write_text("a: private words", "utf-8")
    path = tmp_path / "package" / "mine.xacro"
    path.parent.mkdir()
    body = ESCAPES[name].replace("{secret}", str(secret)).replace("{out}", str(out))
    path.write_text(f'<robot name="r" {XMLNS}>{body}</robot>', "utf-8")
    with pytest.raises(DescriptionError) as refusal:
        load_urdf(path)
    assert "private words" not in str(refusal.value)
    assert str(path) in str(refusal.value)
    assert str(refusal.value).isprintable()
    assert not out.exists()
