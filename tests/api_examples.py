"""A right value for every argument of the public functions, small enough to call each many times."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

import exo_pin
from exo_pin import (
    compare,
    description,
    devices,
    dh,
    dynamics,
    feasible,
    formats,
    ground,
    ik,
    kinematics,
    retarget,
    simulation,
    sizing,
    study,
    walking,
)
from exo_pin.anatomy import CORNERS, FEET, JOINTS, Body
from exo_pin.crosscheck.dynamics_witnesses import link_inertials
from exo_pin.formats import Markers, ReadOptions
from exo_pin.gait import Gait, Number, StrideEstimate, Torques, normative_gait
from exo_pin.markers.marker_sets import SETS

_SAMPLES = 18
_TRIANGLE = np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]])
SIZING = Path(sizing.__file__).parent


class Examples:
    """Right values, made when they are first used; files lie in one folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def of(self, function: str, argument: str) -> Any:
        """The value for an argument: the function's own entry, else what the argument's name means.

        Raises:
            KeyError: There is none; add one.
        """
        if function == "anatomy.Body":
            return getattr(self.body, argument)
        own = _OWN.get(f"{function}.{argument}")
        return (own or _BY_NAME[argument])(self)

    def has(self, function: str, argument: str) -> bool:
        return function == "anatomy.Body" or f"{function}.{argument}" in _OWN or argument in _BY_NAME

    def instance(self, owner: type) -> Any:
        """A record whose methods are called."""
        return _INSTANCES[owner.__name__](self)

    @functools.cached_property
    def body(self) -> Body:
        return Body.from_stature()

    @functools.cached_property
    def robot(self) -> Any:
        return exo_pin.load_robot()

    @functools.cached_property
    def gait(self) -> Gait:
        return normative_gait(samples=_SAMPLES)

    @functools.cached_property
    def q(self) -> Any:
        return self.robot.from_gait(self.gait)[:3]

    @functools.cached_property
    def feet(self) -> Any:
        return exo_pin.poses(self.robot, self.q, base=self.gait.base[:3])

    @functools.cached_property
    def placed(self) -> Any:
        return ground.place_walk(self.robot, self.gait)

    @functools.cached_property
    def com_pelvis(self) -> Any:
        return kinematics.center_of_mass(self.robot, self.robot.from_gait(self.gait)).position

    @functools.cached_property
    def feet_in_pelvis(self) -> Any:
        return exo_pin.poses(self.robot, self.robot.from_gait(self.gait), (*FEET, *CORNERS))

    @functools.cached_property
    def curves(self) -> Any:
        """Time (n,) and heels (n, 2, 3) of a long even recording."""
        walk = normative_gait(samples=50).repeated(3)
        feet = exo_pin.poses(self.robot, self.robot.from_gait(walk), base=walk.base)[..., :3, 3]
        feet[..., 0] += 1.2 * walk.time[:, None]
        return walk.time, feet, walk.events, walk.base[:, :3, 3]

    @functools.cached_property
    def along(self) -> Any:
        """Heels and toes (n, 2) ahead of the pelvis."""
        time, heels, _, _ = self.curves
        ahead = heels[..., 0] - 1.2 * time[:, None]
        return ahead, ahead + 0.2

    @functools.cached_property
    def trial(self) -> Markers:
        names = (
            tuple(SETS["gait2392"].spots) if "gait2392" in SETS else tuple(next(iter(SETS.values())).spots)
        )
        places = np.arange(3.0 * len(names)).reshape(1, -1, 3) / 100 + np.zeros((3, 1, 1))
        return Markers(np.arange(3.0) / 100, names, places)

    @functools.cached_property
    def torques(self) -> Torques:
        return Torques(self.gait.time, np.ones((_SAMPLES, len(JOINTS))))

    @functools.cached_property
    def loss(self) -> Any:
        return compare.compare(self.gait, ["planar5"]).best[0]

    @functools.cached_property
    def feasibility(self) -> Any:
        return feasible.feasible(self.gait)

    @functools.cached_property
    def stride(self) -> StrideEstimate:
        return StrideEstimate("left", 0.0, 1.0, "heel strikes")

    @functools.cached_property
    def walk_file(self) -> Path:
        path = self.folder / "walk.csv"
        formats.save_gait(self.gait, path)
        return path

    @functools.cached_property
    def poses(self) -> Any:
        return formats.Poses(self.gait.time[:3], self.gait.base[:3], {"left_foot": self.feet[:, 0]})

    @functools.cached_property
    def pose_file(self) -> Path:
        path = self.folder / "poses.csv"
        formats.save_poses(self.poses, path)
        return path

    @functools.cached_property
    def body_file(self) -> Path:
        path = self.folder / "body.toml"
        self.body.save(path)
        return path

    @functools.cached_property
    def device_file(self) -> Path:
        path = self.folder / "device.toml"
        path.write_text('name = "own"\njoints = ["left_knee_flexion"]\nsource = "an example"\n')
        return path

    @functools.cached_property
    def urdf_file(self) -> Path:
        path = self.folder / "robot.urdf"
        path.write_text(self.robot.urdf)
        return path

    @functools.cached_property
    def marker_file(self) -> Path:
        path, names = self.folder / "walk.trc", self.trial.names
        head = ["PathFileType\t4\t(X/Y/Z)\twalk.trc", "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits"]
        head += [f"100\t100\t3\t{len(names)}\tm", "Frame#\tTime\t" + "\t\t\t".join(names)]
        head += ["\t\t" + "\t".join(f"X{k}\tY{k}\tZ{k}" for k in range(1, len(names) + 1)), ""]
        rows = zip(self.trial.time, self.trial.position, strict=True)
        lines = ["\t".join(map(str, (k + 1, t, *p.ravel()))) for k, (t, p) in enumerate(rows)]
        path.write_text("\n".join([*head, *lines, ""]))
        return path

    @functools.cached_property
    def named_file(self) -> Path:
        """A table whose columns have names of their own."""
        path = self.folder / "named.csv"
        rows = np.column_stack([self.gait.time, np.degrees(self.gait.q)])
        lines = [",".join(f"{x:.6f}" for x in row) for row in rows]
        path.write_text("\n".join([",".join(_COLUMNS), *lines, ""]))
        return path

    @functools.cached_property
    def force_file(self) -> Path:
        path = self.folder / "forces.mot"
        names = [f"ground_force_{what}{axis}" for what in "vp" for axis in "xyz"]
        names += [f"ground_torque_{axis}" for axis in "xyz"]
        rows = (f"{k / 100}\t0\t700\t0\t0\t0\t0\t0\t0\t0" for k in range(20))
        path.write_text("\n".join(["endheader", "\t".join(["time", *names]), *rows]) + "\n")
        return path

    @functools.cached_property
    def torque_file(self) -> Path:
        path = self.folder / "torques.csv"
        formats.save_torques(self.torques, path)
        return path

    @functools.cached_property
    def set_file(self) -> Path:
        path = self.folder / "set.toml"
        path.write_text((SIZING.parent / "markers/sets/plug-in-gait.toml").read_text())
        return path

    @functools.cached_property
    def study_file(self) -> Path:
        path = self.folder / "study.csv"
        study.save((), path)
        return path

    @functools.cached_property
    def patient_file(self) -> Path:
        path = self.folder / "patient.toml"
        path.write_text("[activity]\nright = 0.5\n")
        return path

    @functools.cached_property
    def motor_file(self) -> Path:
        path = self.folder / "motor.toml"
        path.write_text((SIZING / "motors" / f"{sizing.example_motors()[0]}.toml").read_text())
        return path

    @functools.cached_property
    def controller_file(self) -> Path:
        path = self.folder / "controller.py"
        path.write_text("def answer(time, q, dq, reference):\n    return 0 * q\n")
        return path

    @functools.cached_property
    def dynamics(self) -> dynamics.Dynamics:
        return dynamics.torques(self.robot, self.gait)

    @functools.cached_property
    def load(self) -> sizing.JointLoad:
        return sizing.joint_loads(self.dynamics, 1.1)["left_hip_flexion"]

    @functools.cached_property
    def footsteps(self) -> walking.Footsteps:
        return walking.footsteps(3, 0.2)

    @functools.cached_property
    def footstep_file(self) -> Path:
        walking.save_footsteps(self.footsteps, self.folder / "steps.csv")
        return self.folder / "steps.csv"

    @functools.cached_property
    def planned(self) -> walking.Plan:
        return walking.plan_walk(self.robot, self.footsteps, rate=50.0)

    @functools.cached_property
    def run(self) -> simulation.Run:
        return simulation.simulate(self.robot, self.gait, cycles=1, timestep=5e-3)

    @functools.cached_property
    def compared(self) -> Any:
        return compare.compare(self.gait, ["planar5"])

    @functools.cached_property
    def retargeted(self) -> Any:
        return retarget.retarget(self.gait, "talos")


_NUMBERS = {"speed": Number(1.2, 0.1, 4, "m/s")}
_TIME = np.arange(40.0) / 100
_WAVES = np.stack([np.sin(9 * _TIME), np.cos(7 * _TIME)], axis=1)

_COLUMNS = ("t", *(f"angle{k}" for k in range(len(JOINTS))))

_BY_NAME: Mapping[str, Any] = {
    "acceleration": lambda e: 150.0,
    "assist": lambda e: 0.5,
    "after": lambda e: 1.0,
    "base": lambda e: e.gait.base[:3],
    "before": lambda e: 1.0,
    "body": lambda e: e.body,
    "body_weight_support": lambda e: 0.2,
    "clearance": lambda e: 1.05,
    "columns": lambda e: ("time",),
    "content": lambda e: "gait",
    "conditions": lambda e: compare.Conditions(),
    "cutoff": lambda e: 6.0,
    "cycles": lambda e: 2.0,
    "damping": lambda e: 0.01,
    "ddq": lambda e: np.ones((3, e.robot.model.nv)),
    "device": lambda e: "exo12",
    "devices": lambda e: ("planar5",),
    "dq": lambda e: np.ones((3, e.robot.model.nv)),
    "dt": lambda e: 1e-3,
    "dynamics": lambda e: e.dynamics,
    "double_support": lambda e: 0.2,
    "efficiency": lambda e: 0.8,
    "events": lambda e: e.gait.events,
    "factor": lambda e: 1.1,
    "factors": lambda e: {"knee_flexion": 0.9},
    "first": lambda e: e.gait,
    "found": lambda e: e.dynamics,
    "frame": lambda e: "left_foot",
    "frames": lambda e: ("left_foot", "right_foot"),
    "gait": lambda e: e.gait,
    "gap": lambda e: 0.01,
    "ground": lambda e: 0.0,
    "height": lambda e: 640,
    "hip_order": lambda e: "clinical",
    "joint": lambda e: "left_knee_flexion",
    "knee": lambda e: "stop",
    "landmark": lambda e: "lateral_epicondyle",
    "least": lambda e: 0.01,
    "leg_length": lambda e: 0.9,
    "like": lambda e: e.gait,
    "limit": lambda e: 0.2,
    "load": lambda e: e.load,
    "loads": lambda e: e.load,
    "mapping": lambda e: {},
    "masses": lambda e: "both",
    "mass": lambda e: 70.0,
    "model": lambda e: None,
    "motor": lambda e: sizing.find_motor(e.motor_file),
    "movement": lambda e: "knee_flexion",
    "name": lambda e: "some_name",
    "numbers": lambda e: _NUMBERS,
    "order": lambda e: 4,
    "passive": lambda e: "held",
    "patient": lambda e: None,
    "path": lambda e: e.walk_file,
    "pelvis": lambda e: "recorded",
    "preset": lambda e: "exo_pin",
    "q": lambda e: e.q,
    "q0": lambda e: e.q[0],
    "rate": lambda e: 100.0,
    "ratio": lambda e: 50.0,
    "robot": lambda e: e.robot,
    "run": lambda e: e.run,
    "second": lambda e: e.gait,
    "seconds": lambda e: 1.0,
    "seed": lambda e: 1,
    "sex": lambda e: "male",
    "share": lambda e: 0.4,
    "side": lambda e: "left",
    "smallest_excursion": lambda e: 0.05,
    "speed": lambda e: "free",
    "stature": lambda e: 1.8,
    "stride": lambda e: 1.05,
    "step_time": lambda e: 0.8,
    "style": lambda e: "carried",
    "subject": lambda e: "the gait",
    "support": lambda e: "carried",
    "timestep": lambda e: 1e-3,
    "tolerance": lambda e: 1e-6,
    "torques": lambda e: e.torques,
    "units": lambda e: "deg",
    "source": lambda e: "a source",
    "title": lambda e: "a title",
    "unit": lambda e: "m",
}
"""What an argument of that name takes."""

_OWN: Mapping[str, Any] = {
    "control.Patient.activity": lambda e: np.full(len(JOINTS), 0.5),
    "control.Patient.stiffness": lambda e: np.full(len(JOINTS), 30.0),
    "control.Patient.damping": lambda e: np.full(len(JOINTS), 2.0),
    "control.Patient.spasticity": lambda e: np.full(len(JOINTS), 1.0),
    "control.Patient.spastic_threshold": lambda e: 1.0,
    "control.Patient.delay": lambda e: 0.05,
    "control.find_controller.controller": lambda e: "pd",
    "control.find_patient.patient": lambda e: "healthy",
    "control.load_controller.text": lambda e: f"{e.controller_file}:answer",
    "control.load_patient.path": lambda e: e.patient_file,
    "control.shares.tau": lambda e: e.dynamics.torque,
    "control.shares.q": lambda e: e.gait.q,
    "control.shares.dq": lambda e: e.dynamics.velocity,
    "control.stride_work.power": lambda e: e.dynamics.power[:, 0],
    "dynamics.generalized_forces.motion": lambda e: e.dynamics.motion,
    "dynamics.generalized_forces.robot": lambda e: e.dynamics.robot,
    "dynamics.generalized_forces.wrench": lambda e: e.dynamics.ground.wrench,
    "dynamics.in_pelvis_axes.T": lambda e: e.dynamics.motion.base,
    "dynamics.in_pelvis_axes.velocity": lambda e: np.ones((_SAMPLES, 6)),
    "dynamics.in_pelvis_axes.acceleration": lambda e: np.ones((_SAMPLES, 6)),
    "dynamics.in_world_axes.base": lambda e: e.dynamics.motion.base,
    "dynamics.in_world_axes.tau": lambda e: e.dynamics.motion.v,
    "dynamics.motion.robot": lambda e: e.dynamics.robot,
    "simulation.Floor.friction": lambda e: 0.8,
    "simulation.Floor.time_constant": lambda e: 0.01,
    "simulation.Floor.damping_ratio": lambda e: 1.0,
    "simulation.PelvisSupport.stiffness": lambda e: (1e4,) * 6,
    "simulation.PelvisSupport.damping": lambda e: (1e3,) * 6,
    "simulation.Plant.mass_error": lambda e: 0.1,
    "simulation.Plant.length_error": lambda e: 0.1,
    "simulation.Plant.floor_friction": lambda e: 0.8,
    "simulation.Plant.floor_time_constant": lambda e: 0.01,
    "simulation.Plant.joint_friction": lambda e: 1.0,
    "simulation.Plant.joint_damping": lambda e: 1.0,
    "simulation.Plant.encoder_step": lambda e: 1e-3,
    "simulation.Plant.noise": lambda e: 1e-3,
    "simulation.Plant.rate": lambda e: 500.0,
    "simulation.Plant.delay": lambda e: 0.01,
    "walking.Footstep.x": lambda e: 0.1,
    "walking.Footstep.y": lambda e: 0.1,
    "walking.Footstep.heading": lambda e: 0.1,
    "walking.Footsteps.start": lambda e: e.footsteps.start,
    "walking.Footsteps.steps": lambda e: e.footsteps.steps,
    "walking.Footsteps.step_time": lambda e: 0.8,
    "walking.Footsteps.double_support": lambda e: 0.2,
    "walking.Footsteps.clearance": lambda e: 0.05,
    "walking.Footsteps.shortened.factor": lambda e: 0.5,
    "walking.Preview.dt": lambda e: 0.02,
    "walking.Preview.height": lambda e: 0.9,
    "walking.Preview.horizon": lambda e: 0.2,
    "walking.Preview.tracking": lambda e: 1.0,
    "walking.Preview.jerk": lambda e: 1e-6,
    "walking.Preview.com.zmp": lambda e: np.ones((_SAMPLES, 2)),
    "walking.com_of_zmp.zmp": lambda e: np.ones((_SAMPLES, 2)),
    "walking.com_of_zmp.dt": lambda e: 0.02,
    "walking.convex_hull.points": lambda e: _TRIANGLE,
    "walking.divergent_component.position": lambda e: np.ones((3, 2)),
    "walking.divergent_component.velocity": lambda e: np.ones((3, 2)),
    "walking.fall.position": lambda e: np.ones(2),
    "walking.fall.velocity": lambda e: np.ones(2),
    "walking.fall.zmp": lambda e: np.zeros(2),
    "walking.fall.time": lambda e: np.ones(3),
    "walking.footsteps.start": lambda e: "left",
    "walking.footsteps.steps": lambda e: 2,
    "walking.footsteps.length": lambda e: 0.2,
    "walking.footsteps.width": lambda e: 0.2,
    "walking.footsteps.turn": lambda e: 0.1,
    "walking.footsteps.step_time": lambda e: 0.8,
    "walking.footsteps.double_support": lambda e: 0.2,
    "walking.footsteps.clearance": lambda e: 0.05,
    "walking.load_footsteps.path": lambda e: e.footstep_file,
    "walking.load_footsteps.step_time": lambda e: 0.8,
    "walking.load_footsteps.double_support": lambda e: 0.2,
    "walking.load_footsteps.clearance": lambda e: 0.05,
    "walking.margin.polygon": lambda e: _TRIANGLE,
    "walking.margin.point": lambda e: np.ones((3, 2)),
    "walking.orbital_energy.position": lambda e: np.ones((3, 2)),
    "walking.orbital_energy.velocity": lambda e: np.ones((3, 2)),
    "walking.orbital_energy.zmp": lambda e: np.zeros((3, 2)),
    "walking.plan_walk.walk": lambda e: e.footsteps,
    "walking.plan_walk.rate": lambda e: 50.0,
    "walking.plan_walk.rest": lambda e: 0.5,
    "walking.plan_walk.pitch": lambda e: 0.3,
    "walking.plan_walk.passes": lambda e: 1,
    "walking.recorded_footsteps.gait": lambda e: e.planned.gait,
    "walking.recorded_footsteps.clearance": lambda e: 0.05,
    "walking.save_footsteps.walk": lambda e: e.footsteps,
    "walking.save_footsteps.path": lambda e: e.folder / "written_steps.csv",
    "walking.zmp_of_com.com": lambda e: np.ones((_SAMPLES, 2)),
    "walking.zmp_of_com.dt": lambda e: 0.02,
    "simulation.Push.forward": lambda e: 60.0,
    "simulation.Push.left": lambda e: 0.0,
    "simulation.Push.duration": lambda e: 0.1,
    "simulation.Push.start": lambda e: 0.5,
    "simulation.simulate.pushes": lambda e: (simulation.Push(60.0, 0.0, 0.1, 0.5),),
    "simulation.simulate.after": lambda e: lambda done, steps: None,
    "simulation.simulate.controller": lambda e: "pd",
    "simulation.simulate.cycles": lambda e: 1,
    "simulation.simulate.patient": lambda e: "healthy",
    "simulation.simulate.support": lambda e: "soft",
    "sizing.JointLoad.angle": lambda e: e.load.angle,
    "sizing.JointLoad.speed": lambda e: e.load.speed,
    "sizing.JointLoad.acceleration": lambda e: e.load.acceleration,
    "sizing.JointLoad.torque": lambda e: e.load.torque,
    "sizing.JointLoad.share": lambda e: e.load.share,
    "sizing.JointLoad.stride": lambda e: 1.1,
    "sizing.JointLoad.mean.values": lambda e: e.load.angle,
    "sizing.JointLoad.rms.values": lambda e: e.load.angle,
    "sizing.Motor.line_use.torque": lambda e: e.load.torque,
    "sizing.Motor.line_use.speed": lambda e: e.load.speed,
    "sizing.Motor.no_load_speed": lambda e: 300.0,
    "sizing.Motor.peak_torque": lambda e: 5.0,
    "sizing.Motor.continuous_torque": lambda e: 1.0,
    "sizing.Motor.rotor_inertia": lambda e: 1e-4,
    "sizing.Spring.stiffness": lambda e: 100.0,
    "sizing.Spring.rest": lambda e: 0.1,
    "sizing.Spring.torque.angle": lambda e: e.load.angle,
    "sizing.WorstCase.worst.quantity": lambda e: "peak_torque",
    "sizing.find_motor.motor": lambda e: e.motor_file,
    "sizing.joint_loads.stride": lambda e: 1.1,
    "sizing.load_motor.path": lambda e: e.motor_file,
    "sizing.size.stride": lambda e: 1.1,
    "sizing.worst_cases.people": lambda e: (e.body,),
    "dh.inverse_dynamics.inertias": lambda e: link_inertials(e.robot),
    "dh.inverse_dynamics.pelvis": lambda e: dh.PelvisState(e.gait.base[:3], np.ones((3, 6)), np.ones((3, 6))),
    "dh.inverse_dynamics.joints": lambda e: {"left_knee_flexion": dh.JointState(*np.ones((3, 3)))},
    "dh.inverse_dynamics.wrenches": lambda e: {"left_foot": np.ones((3, 6))},
    "formats.TrialFile.with_length_unit.unit": lambda e: "mm",
    "formats.load_forces.path": lambda e: e.force_file,
    "formats.load_gait.columns": lambda e: (),
    "formats.load_gait.mapping": lambda e: dict(zip(_COLUMNS, ("time", *JOINTS), strict=True)),
    "formats.load_gait.path": lambda e: e.named_file,
    "formats.load_gait.pelvis_order": lambda e: None,
    "formats.load_gait.row_rate": lambda e: None,
    "formats.load_gait.preset": lambda e: None,
    "formats.load_gait.units": lambda e: "deg",
    "formats.load_markers.path": lambda e: e.marker_file,
    "formats.load_torques.path": lambda e: e.torque_file,
    "formats.load_torques.preset": lambda e: None,
    "formats.open_trial.content": lambda e: "angles",
    "formats.save_gait.preset": lambda e: None,
    "formats.save_torques.path": lambda e: e.folder / "saved_torques.csv",
    "formats.save_torques.preset": lambda e: None,
    "markers.load_set.path": lambda e: e.set_file,
    "markers.load_walk.path": lambda e: e.marker_file,
    "markers.load_walk.static": lambda e: None,
    "markers.load_walk.markers": lambda e: None,
    "markers.load_walk.mapping": lambda e: None,
    "markers.reconstruct.markers": lambda e: None,
    "markers.reconstruct.static": lambda e: None,
    "markers.model_set.path": lambda e: e.marker_file,
    "markers.reconstruct.mass": lambda e: 70.0,
    "study.load.path": lambda e: e.study_file,
    "study.recordings.folder": lambda e: e.walk_file.parent,
    "study.recordings.conditions": lambda e: (compare.Conditions(),),
    "study.recordings.preset": lambda e: None,
    "study.run.cases": lambda e: (),
    "study.run.jobs": lambda e: 1,
    "study.run.path": lambda e: e.folder / "study_run.csv",
    "study.save.path": lambda e: e.folder / "study_saved.csv",
    "study.save.rows": lambda e: (),
    "walking.com_of_zmp.height": lambda e: 0.9,
    "walking.divergent_component.height": lambda e: 0.9,
    "walking.fall.height": lambda e: 0.9,
    "walking.orbital_energy.height": lambda e: 0.9,
    "walking.time_constant.height": lambda e: 0.9,
    "walking.zmp_of_com.height": lambda e: 0.9,
    "anatomy.Body.load.path": lambda e: e.body_file,
    "anatomy.Body.save.path": lambda e: e.folder / "saved.toml",
    "compare.Loss.in_phases.errors": lambda e: np.ones((_SAMPLES, 2)),
    "crosscheck.errors_by_step.sample": lambda e: 1,
    "crosscheck.recover_noisy.sd": lambda e: 0.001,
    "demand.peak_demands.joints": lambda e: JOINTS[:2],
    "demand.peak_demands.required": lambda e: np.ones((3, 2)),
    "demand.peak_demands.available": lambda e: np.ones(2),
    "description.arguments_xacro.values": lambda e: description.arguments(e.body),
    "description.arguments_xacro.comment": lambda e: "a comment",
    "description.expand.values": lambda e: description.arguments(e.body),
    "devices.Actuator.effort": lambda e: 100.0,
    "devices.Actuator.velocity": lambda e: 5.0,
    "devices.Device.joints": lambda e: JOINTS[:2],
    "devices.Device.passive": lambda e: JOINTS[2:3],
    "devices.Device.pelvis": lambda e: "held",
    "devices.Device.actuators": lambda e: {"hip_flexion": devices.Actuator(100.0, 5.0)},
    "devices.Device.ranges": lambda e: {"hip_flexion": (-0.5, 1.0)},
    "devices.Device.treadmill": lambda e: (0.1, 1.0),
    "devices.Device.statures": lambda e: (1.5, 1.9),
    "devices.Device.masses": lambda e: (40.0, 100.0),
    "devices.Device.thighs": lambda e: (0.3, 0.5),
    "devices.Device.shanks": lambda e: (0.3, 0.5),
    "devices.Device.hip_breadths": lambda e: (0.2, 0.5),
    "devices.load.path": lambda e: e.device_file,
    "devices.Device.hip_widths": lambda e: (0.2, 0.3),
    "devices.Device.range_of.own": lambda e: (-0.5, 1.0),
    "devices.both.movements": lambda e: "knee_flexion",
    "devices.subset.movements": lambda e: ("knee_flexion",),
    "dh.of_device.angles": lambda e: {name: e.q[:, k] for k, name in enumerate(JOINTS)},
    "edit.filtered.gait": lambda e: e.gait,
    "edit.ramped.duration": lambda e: 4.0,
    "edit.ramped.start": lambda e: 1.0,
    "edit.ramped.stop": lambda e: 1.0,
    "edit.retimed.factor": lambda e: None,
    "edit.retimed.duration": lambda e: 1.1,
    "feasible.Feasibility.phases.mask": lambda e: np.ones(_SAMPLES, dtype=bool),
    "formats.Poses.time": lambda e: e.gait.time[:3],
    "formats.Poses.targets": lambda e: {"left_foot": e.feet[:, 0]},
    "formats.Poses.events": lambda e: (),
    "formats.load_poses.path": lambda e: e.pose_file,
    "formats.save_gait.path": lambda e: e.folder / "saved.csv",
    "formats.save_poses.poses": lambda e: e.poses,
    "formats.save_poses.path": lambda e: e.folder / "saved_poses.csv",
    "formats.ReadOptions.row_rate": lambda e: 100.0,
    "formats.ReadOptions.mapping": lambda e: {"a": "left_knee_flexion"},
    "formats.ReadOptions.pelvis_order": lambda e: ("tilt", "list", "rotation"),
    "gait.Event.time": lambda e: 0.5,
    "gait.Event.kind": lambda e: "heel_strike",
    "gait.ForcePlate.time": lambda e: np.arange(3.0),
    "gait.ForcePlate.force": lambda e: np.ones((3, 3)),
    "gait.ForcePlate.point": lambda e: np.ones((3, 3)),
    "gait.ForcePlate.moment": lambda e: np.ones((3, 3)),
    "gait.Gait.time": lambda e: e.gait.time,
    "gait.Gait.q": lambda e: e.gait.q,
    "gait.Gait.base": lambda e: e.gait.base,
    "gait.Gait.resampled.n": lambda e: 20,
    "gait.Gait.sampled.rate": lambda e: 50.0,
    "gait.Gait.repeated.k": lambda e: 2,
    "gait.Gait.slowed.f": lambda e: 1.5,
    "gait.Markers.time": lambda e: e.trial.time,
    "gait.Markers.names": lambda e: e.trial.names,
    "gait.Markers.position": lambda e: e.trial.position,
    "gait.Markers.up": lambda e: "+z",
    "gait.Markers.angles": lambda e: {"LHipAngles": np.ones((3, 3))},
    "gait.Markers.events": lambda e: (),
    "gait.Markers.of.name": lambda e: e.trial.names[0],
    "gait.Markers.renamed.mapping": lambda e: {e.trial.names[0]: "NEW"},
    "gait.Markers.turned.R": lambda e: np.eye(3),
    "gait.Number.of.values": lambda e: np.arange(3.0),
    "gait.StrideEstimate.cycles.start": lambda e: 0.0,
    "gait.StrideEstimate.cycles.end": lambda e: 3.0,
    "gait.Torques.time": lambda e: e.gait.time,
    "gait.Torques.tau": lambda e: np.ones((_SAMPLES, 12)),
    "gait.Torques.at.time": lambda e: e.gait.time[:4],
    "gait.cycles.points": lambda e: 21,
    "gait.normative_gait.samples": lambda e: 20,
    "gait.normative_sd.samples": lambda e: 20,
    "gait.speed_named.name": lambda e: "free",
    "gait.spatiotemporal.time": lambda e: e.curves[0],
    "gait.spatiotemporal.heels": lambda e: e.curves[1],
    "gait.spatiotemporal.events": lambda e: e.curves[2],
    "gait.spatiotemporal.pelvis": lambda e: e.curves[3][:, :2],
    "gait.spatiotemporal.until": lambda e: 2.0,
    "gait.zeni.time": lambda e: e.curves[0],
    "gait.zeni.heel_forward": lambda e: e.along[0],
    "gait.zeni.toe_forward": lambda e: e.along[1],
    "ground.belt_speed.base": lambda e: e.placed.base,
    "ground.belt_speed.corners": lambda e: e.placed.corners,
    "ground.estimated_stance.heights": lambda e: ground.lowest_corners(e.placed.corners),
    "ground.lowest_corners.positions": lambda e: e.placed.corners,
    "ground.place.q": lambda e: e.robot.from_gait(e.gait),
    "ground.place.base": lambda e: e.gait.base,
    "ground.place.T_pelvis": lambda e: e.feet_in_pelvis,
    "ground.place.com_pelvis": lambda e: e.com_pelvis,
    "ground.standing.intervals": lambda e: e.placed.stance,
    "ground.standing.time": lambda e: e.gait.time,
    "ground.support.base": lambda e: e.placed.base,
    "ground.support.corners": lambda e: e.placed.corners,
    "ground.support.stance": lambda e: e.placed.stance,
    "ground.transformed.T": lambda e: e.feet[:, 0],
    "ground.transformed.points": lambda e: np.ones((3, 3)),
    "ik.Dls.max_iterations": lambda e: 50,
    "ik.Dls.restarts": lambda e: 1,
    "ik.Dls.position_weight": lambda e: 1.0,
    "ik.Dls.rotation_weight": lambda e: 1.0,
    "ik.Auto.dls": lambda e: ik.Dls(),
    "ik.Online.base": lambda e: e.gait.base[0],
    "ik.Online.max_iterations": lambda e: 8,
    "ik.Online.step.targets": lambda e: e.feet[0, 0],
    "ik.Online.step.base": lambda e: e.gait.base[0],
    "ik.Points.local": lambda e: np.eye(3),
    "ik.Points.p": lambda e: np.ones((3, 3, 3)),
    "ik.Points.weight": lambda e: np.ones(3),
    "ik.Pose.T": lambda e: e.feet[:, 0],
    "ik.Pose.position_weight": lambda e: 1.0,
    "ik.Pose.rotation_weight": lambda e: 1.0,
    "ik.Position.p": lambda e: np.ones((3, 3)),
    "ik.Position.weight": lambda e: 1.0,
    "ik.solve.targets": lambda e: {"left_foot": e.feet[0, 0]},
    "ik.solve.base": lambda e: e.gait.base[0],
    "ik.track.targets": lambda e: {"left_foot": e.feet[:, 0]},
    "kinematics.attitude.relative_to": lambda e: "pelvis",
    "kinematics.sole_slide.time": lambda e: e.gait.time,
    "kinematics.sole_slide.points": lambda e: e.placed.corners[:, :4].reshape(-1, 2, 2, 3),
    "kinematics.sole_slide.standing": lambda e: np.ones((_SAMPLES, 2), dtype=bool),
    "kinematics.sole_slide.ground": lambda e: np.zeros(2),
    "markers.MarkerSet.hips": lambda e: "davis",
    "markers.MarkerSet.spots": lambda e: dict(next(iter(SETS.values())).spots),
    "markers.MarkerSet.also": lambda e: {next(iter(next(iter(SETS.values())).spots)): ("OTHER",)},
    "markers.MarkerSet.names.marker": lambda e: e.trial.names[0],
    "markers.Spot.segment": lambda e: "thigh",
    "markers.Spot.place": lambda e: (0.1, 0.0, -0.5),
    "markers.Spot.spread": lambda e: 0.01,
    "markers.find_set.name": lambda e: next(iter(SETS)),
    "markers.recognise.names": lambda e: e.trial.names,
    "markers.reconstruct.trial": lambda e: e.trial,
    "report.comparison.compared": lambda e: e.compared,
    "report.comparison.speeds": lambda e: {"free": e.compared},
    "report.walk.normal": lambda e: "free",
    "retarget.Target.file": lambda e: e.urdf_file,
    "retarget.Target.feet": lambda e: ("left_foot", "right_foot"),
    "retarget.Target.forward": lambda e: "x",
    "retarget.Target.up": lambda e: "z",
    "retarget.Target.stand": lambda e: {"left_knee_flexion": 0.1},
    "retarget.Target.limits": lambda e: {"left_knee_flexion": (0.0, 1.0)},
    "retarget.Target.locked": lambda e: ("left_ankle_inversion",),
    "retarget.Target.paint": lambda e: (0.1, 0.2, 0.3, 1.0),
    "retarget.find.target": lambda e: "talos",
    "retarget.load.target": lambda e: "talos",
    "robot.Robot.q.angles": lambda e: {"left_knee_flexion": 0.3},
    "robot.load_robot.base": lambda e: "fixed",
    "robot.Robot.to_gait.q": lambda e: e.robot.from_gait(e.gait),
    "kinematics.smoothed_curves.q": lambda e: e.gait.q,
    "crosscheck.inverse_dynamics.n": lambda e: 2,
    "study.plan.conditions": lambda e: (compare.Conditions(),),
    "robot.load_urdf.source": lambda e: e.urdf_file,
    "robot.load_urdf.base": lambda e: "fixed",
    "robot.load_urdf.placement": lambda e: np.eye(4),
    "robot.load_urdf.path": lambda e: None,
    "signals.lowpass.time": lambda e: _TIME,
    "signals.lowpass.y": lambda e: _WAVES,
    "signals.filled.time": lambda e: _TIME,
    "signals.filled.y": lambda e: _WAVES,
    "signals.longest_run.good": lambda e: np.ones(5, dtype=bool),
    "signals.spikes.time": lambda e: _TIME,
    "signals.spikes.y": lambda e: _WAVES,
    "signals.outliers.time": lambda e: _TIME,
    "signals.outliers.y": lambda e: _WAVES,
    "signals.outliers.names": lambda e: ("a", "b"),
    "study.bodies.of": lambda e: (1.7,),
    "study.plan.of": lambda e: (1.7,),
    "study.plan.speeds": lambda e: ("free",),
    "study.simulations.speeds": lambda e: ("free",),
    "study.simulations.supports": lambda e: ("soft",),
    "study.simulations.body_weight_supports": lambda e: (0.3,),
    "study.simulations.controllers": lambda e: ("pd",),
    "study.simulations.patients": lambda e: ("plegic",),
    "study.simulations.delays": lambda e: (0.001,),
    "study.simulations.floor_frictions": lambda e: (0.8,),
    "study.simulations.mass_errors": lambda e: (0.1,),
    "study.simulations.runs": lambda e: 2,
    "study.simulations.spread": lambda e: 1.0,
    "study.statures.low": lambda e: 1.5,
    "study.statures.high": lambda e: 1.7,
    "study.statures.step": lambda e: 0.1,
    "viewer.SceneOptions.speed": lambda e: 1.0,
    "viewer.scene.speed": lambda e: 1.0,
    "viewer.retargeted.speed": lambda e: 1.0,
    "viewer.retargeted.walk": lambda e: e.retargeted,
}
"""Values that one function alone takes: `room.function.argument`."""

_INSTANCES: Mapping[str, Any] = {
    "Body": lambda e: e.body,
    "Device": lambda e: devices.find("exo12"),
    "Feasibility": lambda e: e.feasibility,
    "Gait": lambda e: e.gait,
    "Loss": lambda e: e.loss,
    "MarkerSet": lambda e: next(iter(SETS.values())),
    "Footsteps": lambda e: e.footsteps,
    "Markers": lambda e: e.trial,
    "Number": lambda e: _NUMBERS["speed"],
    "Online": lambda e: ik.Online(e.robot, frames=("left_foot",)),
    "ReadOptions": lambda e: ReadOptions(),
    "Robot": lambda e: e.robot,
    "JointLoad": lambda e: e.load,
    "Motor": lambda e: sizing.find_motor(e.motor_file),
    "Spring": lambda e: sizing.Spring(100.0, 0.1),
    "StrideEstimate": lambda e: e.stride,
    "Preview": lambda e: walking.Preview(0.02, 0.9, horizon=0.2),
    "WorstCase": lambda e: sizing.worst_cases("exo12", people=(e.body,))[0],
    "Torques": lambda e: e.torques,
}
