"""A controller of your own walks a patient whose right leg gives half of the torque."""

import numpy as np

import exo_pin
from exo_pin.simulation import simulate


class Damped:
    """A servo that also gives half of what the person lacks."""

    def reset(self, robot, gait):
        """Note the motors' limit."""
        self.effort = float(robot.effort.max())

    def __call__(self, time, q, dq, reference):
        """Torques [N m], in the order of the robot's joints."""
        tau = 2000.0 * (reference.q - q) + 50.0 * (reference.dq - dq) + 0.5 * reference.missing
        return np.clip(tau, -self.effort, self.effort)


walk = exo_pin.normative_gait("slow")
run = simulate(exo_pin.load_robot(), walk, Damped(), patient="paretic_right", cycles=2)
numbers = run.numbers
print(f"verdict: {run.verdict.word}")
print(f"motors give {100 * numbers.motor_share:.0f} % of the torque")
