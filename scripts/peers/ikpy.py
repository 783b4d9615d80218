"""IKPy: optimisation in SciPy on a chain read from the URDF."""

import tempfile
from pathlib import Path

import numpy as np


class Ikpy:
    name = "IKPy"
    package = "ikpy"

    def __init__(self, robot, tolerance):
        from ikpy.chain import Chain

        self.legs = [robot.leg(f"{side}_foot") for side in ("left", "right")]
        self.world = np.linalg.inv(robot.placement)
        self.chains = []
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "exo.urdf"
            path.write_text(robot.urdf)
            for side, own in zip(("left", "right"), self.legs, strict=True):
                names = ["pelvis"]
                for column in own.columns:
                    names += [robot.joints[column], _child(robot.urdf, robot.joints[column])]
                names += [_joint_to(robot.urdf, f"{side}_foot"), f"{side}_foot"]
                mask = [False, *[True] * 6, False]
                self.chains.append(Chain.from_urdf_file(path, base_elements=names, active_links_mask=mask))

    def single(self, left, right, seed):
        q = np.empty(12)
        for own, chain, T in zip(self.legs, self.chains, (left, right), strict=True):
            start = np.concatenate([[0.0], np.clip(seed[own.columns], own.lower, own.upper), [0.0]])
            found = chain.inverse_kinematics_frame(
                self.world @ T, initial_position=start, orientation_mode="all"
            )
            q[own.columns] = found[1:7]
        return q


def _child(urdf, joint):
    import xml.etree.ElementTree as ET

    return ET.fromstring(urdf).find(f"joint[@name='{joint}']/child").get("link")


def _joint_to(urdf, link):
    import xml.etree.ElementTree as ET

    root = ET.fromstring(urdf)
    return next(j.get("name") for j in root.findall("joint") if j.find("child").get("link") == link)
