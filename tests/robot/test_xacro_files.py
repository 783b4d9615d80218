"""Xacro files of one's own: expanded where a URDF is expected, packages found as meshes are."""

from __future__ import annotations

import pytest

from exo_pin.cli import main
from exo_pin.errors import DescriptionError
from exo_pin.robot import load_urdf
from exo_pin.ros_packages import named

XMLNS = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
PART = f"""<robot {XMLNS}><xacro:macro name="arm" params="name"><link name="${{name}}"/>
<joint name="${{name}}_joint" type="revolute"><parent link="base"/><child link="${{name}}"/>
<axis xyz="0 1 0"/><limit lower="${{-pi/2}}" upper="1" effort="1" velocity="1"/></joint>
</xacro:macro></robot>"""
WHOLE = f"""<robot name="r" {XMLNS}><xacro:include filename="$(find parts)/urdf/part.xacro"/>
<xacro:arg name="side" default="left"/><link name="base"/><xacro:arm name="$(arg side)"/></robot>"""


def package(folder, name, content, file):
    (folder / "urdf").mkdir(parents=True)
    (folder / "package.xml").write_text(f"<package><name>{name}</name></package>", "utf-8")
    (folder / "urdf" / file).write_text(content, "utf-8")
    return folder / "urdf" / file


@pytest.mark.parametrize("place", ["parts", "beside/parts", "clone-of-parts"])
def test_packages_above_and_beside_the_file_are_found(tmp_path, place):
    part = package(tmp_path / place.split("/")[-1], "parts", PART, "part.xacro")
    if place == "beside/parts":
        whole = package(tmp_path / "mine", "mine", WHOLE, "whole.urdf.xacro")
    else:
        whole = part.parent / "whole.urdf.xacro"
        whole.write_text(WHOLE, "utf-8")
    assert load_urdf(whole).joints == ("left_joint",)


@pytest.mark.parametrize(
    ("variable", "inside"), [("ROS_PACKAGE_PATH", "parts"), ("AMENT_PREFIX_PATH", "share/parts")]
)
def test_packages_on_the_search_paths_are_found(tmp_path, monkeypatch, variable, inside):
    package(tmp_path / "elsewhere" / inside, "parts", PART, "part.xacro")
    whole = tmp_path / "alone" / "whole.xacro"
    whole.parent.mkdir()
    whole.write_text(WHOLE, "utf-8")
    with pytest.raises(DescriptionError, match="no package 'parts'"):
        load_urdf(whole)
    monkeypatch.setenv(variable, str(tmp_path / "elsewhere"))
    assert load_urdf(whole).joints == ("left_joint",)


def test_a_name_that_is_no_package_leads_nowhere(tmp_path):
    file = tmp_path / "x.xacro"
    assert not [folder for name in ("", ".", "..", "../x", "a/b") for folder in named(file, name)]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (None, "no such file"),
        ("<robot", "no XML: unclosed token"),
        (WHOLE, "no package 'parts'"),
        (f'<robot name="r" {XMLNS}><link name="${{1/0}}"/></robot>', "xacro cannot expand it"),
        (f'<robot name="r" {XMLNS}><xacro:nothing/></robot>', "xacro cannot expand it"),
    ],
)
def test_what_xacro_refuses_is_one_line(tmp_path, capfd, content, said):
    path = tmp_path / "mine.urdf.xacro"
    if content is not None:
        path.write_text(content, "utf-8")
    assert main(["retarget", "--robot", str(path)]) == 2
    (line,) = capfd.readouterr().err.splitlines()
    assert said in line
