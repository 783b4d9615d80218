"""ros2_control of a ROS 2 package: command interfaces with limits, controllers, joint limits."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import NamedTuple
from xml.sax.saxutils import quoteattr

from exo_pin.demand import acceleration_limits
from exo_pin.robot import Robot


class Drive(NamedTuple):
    """A driven joint.

    Attributes:
        name: Of the joint.
        lower: Least position [rad or m].
        upper: Greatest position [rad or m].
        velocity: Largest speed [rad/s or m/s].
        acceleration: Largest acceleration [rad/s^2 or m/s^2]; infinite where there is no limit.
        effort: Largest torque or force [N m or N].
    """

    name: str
    lower: float
    upper: float
    velocity: float
    acceleration: float
    effort: float


def drives(robot: Robot) -> list[Drive]:
    """The joints of a robot that have a motor, in its order."""
    numbers = (robot.lower, robot.upper, robot.velocity, acceleration_limits(robot), robot.effort)
    rows = zip(robot.joints, *(values.tolist() for values in numbers), strict=True)
    return [drive for row in rows if (drive := Drive(*row)).effort > 0.0]


def control_xacro(driven: Iterable[Drive], main: str, name: str) -> str:
    """A xacro of the robot with its `<ros2_control>`; the argument `hardware` names the plugin.

    Args:
        driven: Of `drives`.
        main: The xacro of the robot, in the same folder.
        name: Of the robot.
    """
    joints = "".join(line for drive in driven for line in _interfaces(drive))
    return f"""<?xml version="1.0"?>
<!-- The robot with ros2_control: position and effort commands, within the limits of its motors. -->
<robot name={quoteattr(name)} xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="hardware" default="mock_components/GenericSystem"/>
  <xacro:include filename="{main}"/>

  <ros2_control name={quoteattr(name)} type="system">
    <hardware>
      <plugin>$(arg hardware)</plugin>
    </hardware>
{joints}  </ros2_control>
</robot>
"""


def _interfaces(drive: Drive) -> Iterator[str]:
    yield f'    <joint name="{drive.name}">\n'
    commands = {"position": (drive.lower, drive.upper), "effort": (-drive.effort, drive.effort)}
    for kind, (least, most) in commands.items():
        yield f'      <command_interface name="{kind}">\n'
        yield f'        <param name="min">{least!r}</param>\n'
        yield f'        <param name="max">{most!r}</param>\n'
        yield "      </command_interface>\n"
    for kind in ("position", "velocity", "effort"):
        yield f'      <state_interface name="{kind}"/>\n'
    yield "    </joint>\n"


def controllers(driven: Iterable[Drive]) -> str:
    """Parameters of the controller manager and its controllers."""
    names = "".join(f"      - {drive.name}\n" for drive in driven)
    return f"""controller_manager:
  ros__parameters:
    update_rate: 1000
    joint_state_broadcaster:
      type: joint_state_broadcaster/JointStateBroadcaster
    joint_trajectory_controller:
      type: joint_trajectory_controller/JointTrajectoryController

joint_trajectory_controller:
  ros__parameters:
    joints:
{names}    command_interfaces: [position]
    state_interfaces: [position, velocity]
"""


def joint_limits(driven: Iterable[Drive]) -> str:
    """Limits of speed, acceleration and effort as ROS's `joint_limits` reads them."""
    return "joint_limits:\n" + "".join(line for drive in driven for line in _limits(drive))


def _limits(drive: Drive) -> Iterator[str]:
    yield f"  {drive.name}:\n"
    bounds = {"velocity": drive.velocity, "acceleration": drive.acceleration, "effort": drive.effort}
    yield "    has_position_limits: true\n"
    yield f"    min_position: {drive.lower!r}\n    max_position: {drive.upper!r}\n"
    for kind, most in bounds.items():
        limited = math.isfinite(most)
        yield f"    has_{kind}_limits: {str(limited).lower()}\n"
        if limited:
            yield f"    max_{kind}: {most!r}\n"
