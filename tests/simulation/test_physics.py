"""The engine: pendulums have their period, a mass on a spring its frequency, forces their accelerations."""

import dataclasses

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from exo_pin.anatomy import JOINTS
from exo_pin.control.held_legs import ARMATURE, with_rotors
from exo_pin.gait import normative_gait
from exo_pin.robot import load_robot
from exo_pin.simulation import Floor, PelvisSupport, mujoco_model, mujoco_spec, simulate
from exo_pin.simulation.engine_forces import SOLES
from exo_pin.simulation.mujoco_model import FLOOR
from exo_pin.simulation.reference_motion import ReferenceMotion
from exo_pin.simulation.support_force import SupportForce

FREQUENCY = 0.005
"""Largest relative error of a frequency."""

WITNESS = 1e-10
"""Largest relative difference of accelerations: rounding is 1e-13."""


@pytest.fixture(scope="module")
def floating():
    return load_robot(base="floating")


def oscillations(values):
    """Frequency [Hz] from the first to the last upward crossing of zero, at 1 ms."""
    up = np.flatnonzero((values[:-1] < 0.0) & (values[1:] >= 0.0))
    exact = up - values[up] / (values[up + 1] - values[up])
    return (len(exact) - 1) / ((exact[-1] - exact[0]) * 0.001)


def test_a_hanging_leg_has_its_pendulum_s_period(floating):
    """A stiff leg on the hip's flexion axis alone, against Pinocchio's inertia and weight about that axis."""
    fixed, k = load_robot(), 0
    heavy = with_rotors(fixed)
    data, q = heavy.createData(), np.zeros(12)
    for _ in range(20):  # Newton's method: where it hangs
        stiffness = pin.computeGeneralizedGravityDerivatives(heavy, data, q)[k, k]
        q[k] -= pin.computeGeneralizedGravity(heavy, data, q)[k] / stiffness
    frequency = np.sqrt(stiffness / pin.crba(heavy, data, q)[k, k]) / (2 * np.pi)
    spec = mujoco_spec(floating)
    for joint in list(spec.joints):
        if joint.name != fixed.joints[k]:
            spec.delete(joint)
    spec.delete(spec.geom(FLOOR))
    model = spec.compile()
    engine = mujoco.MjData(model)
    engine.qpos[:] = q[k] + 1e-3
    swing = []
    for _ in range(6000):
        swing.append(engine.qpos[0] - q[k])
        mujoco.mj_step(model, engine)
    assert oscillations(np.array(swing)) == pytest.approx(frequency, rel=FREQUENCY)


def test_a_mass_on_the_support_has_its_frequency(floating):
    """Rigid legs, no floor, the other directions held: the robot bounces on the vertical spring."""
    stiffness, steps = 2e4, 2000
    spec = mujoco_spec(floating)
    for joint in list(spec.joints):
        if joint.type != mujoco.mjtJoint.mjJNT_FREE:
            spec.delete(joint)
    spec.delete(spec.geom(FLOOR))
    model = spec.compile()
    engine = mujoco.MjData(model)
    spring = PelvisSupport("spring", (1e6, 1e6, stiffness, *[1e6] * 3), (1e4, 1e4, 0.0, *[1e3] * 3))
    zeros = np.zeros((steps, len(JOINTS)))
    walk = ReferenceMotion(
        time=np.arange(steps) * 1e-3,
        phase=zeros[:, 0],
        q=zeros,
        dq=zeros,
        ddq=zeros,
        torque=zeros,
        base=np.tile(np.eye(4), (steps, 1, 1)),
        base_velocity=zeros[:, :6],
        belt_speed=0.0,
    )
    support = SupportForce(spring, walk, 0.0, np.zeros((steps, 2)))
    height = []
    for k in range(steps):
        height.append(engine.qpos[2])
        engine.qfrc_applied[:] = support.at(k, engine.qpos.tolist(), engine.qvel.tolist())[1]
        mujoco.mj_step(model, engine)
    alone = np.sqrt(stiffness / pin.computeTotalMass(floating.model)) / (2 * np.pi)
    assert oscillations(np.array(height) - np.mean(height)) == pytest.approx(alone, rel=FREQUENCY)


def test_the_model_is_the_urdf_s(floating):
    """Mass, and the mass matrix at random postures, rotors included."""
    model = mujoco_model(floating)
    data, heavy = mujoco.MjData(model), with_rotors(floating)
    assert model.body_mass.sum() == pytest.approx(pin.computeTotalMass(heavy), abs=1e-9)
    rng = np.random.default_rng(0)
    for _ in range(10):
        angles = rng.uniform(floating.lower, floating.upper)
        data.qpos[:] = np.r_[0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, angles]
        mujoco.mj_forward(model, data)
        full = np.zeros((18, 18))
        mujoco.mj_fullM(model, data, full)
        mine = np.triu(pin.crba(heavy, heavy.createData(), np.r_[0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, angles]))
        np.testing.assert_allclose(np.triu(full), mine, atol=1e-9)


@pytest.mark.parametrize(
    ("speed", "support", "options"),
    [
        ("free", 0.0, {}),
        ("slow", 0.4, {"controller": "impedance", "patient": "paretic_right"}),
        ("slow", 0.0, {"controller": "off"}),  # it hangs: the joint stops act
    ],
)
def test_pinocchio_finds_the_engine_s_accelerations_from_its_forces(speed, support, options):
    run = simulate(load_robot(), normative_gait(speed), body_weight_support=support, cycles=2, **options)
    assert run.witness < WITNESS
    if options.get("controller") == "off":
        assert run.record.sensed[:, SOLES:].max() > 0.0


def test_without_its_floor_forces_the_witness_objects():
    run = simulate(load_robot(), normative_gait(), cycles=1)
    wrong = dataclasses.replace(run)
    wrong.__dict__["floor"] = dataclasses.replace(run.floor, force=0.5 * run.floor.force)
    assert wrong.witness > 1e-3


def test_joints_that_a_device_lacks_are_not_simulated():
    robot = load_robot(device="lokomat", base="floating")
    model = mujoco_model(robot, floor=Floor(friction=0.5))
    assert model.nv == 6 + 4
    assert [model.joint(k).name for k in range(1, model.njnt)] == list(robot.joints)
    assert set(robot.joints) < set(JOINTS)
    np.testing.assert_allclose(model.dof_armature[6:], ARMATURE)
