"""PlaCo, in an environment of its own: reads a job from a file, writes angles and times back.

Usage: python placo_worker.py JOB.npz ANSWER.npz
"""

import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import placo


def main(job, answer):
    data = np.load(job)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "robot.urdf"
        path.write_text(str(data["urdf"]))
        robot = placo.RobotWrapper(str(path), placo.Flags.ignore_collisions)
    names = [str(name) for name in data["joints"]]
    robot.set_T_world_fbase(data["placement"])
    for name, low, high in zip(names, data["lower"], data["upper"], strict=True):
        robot.set_joint_limits(name, low, high)
    solver = robot.make_solver()
    solver.mask_fbase(True)
    solver.enable_joint_limits(True)
    tasks = [solver.add_frame_task(f"{side}_foot", np.eye(4)) for side in ("left", "right")]
    for task, side in zip(tasks, ("left", "right"), strict=True):
        task.configure(f"{side}_foot", "soft", 1.0, 1.0)
    offsets = [robot.get_joint_offset(name) for name in names]
    cold, budget, tolerance = bool(data["cold"]), float(data["budget"]), float(data["tolerance"])
    seed, q, times = data["seed"], [], []
    begin = time.perf_counter()
    for left, right in zip(data["left"], data["right"], strict=True):
        start = time.perf_counter()
        if cold or not q:
            robot.state.q[offsets] = seed
        tasks[0].T_world_frame, tasks[1].T_world_frame = left, right
        for _ in range(100):
            robot.update_kinematics()
            solver.solve(True)
            if max(_error(task) for task in tasks) < tolerance:  # the error before this step
                break
        times.append(time.perf_counter() - start)
        q.append(robot.state.q[offsets].copy())
        if time.perf_counter() - begin > budget:
            break
    np.savez(answer, q=np.array(q), times=np.array(times))


def _error(task):
    return max(task.position().error_norm(), task.orientation().error_norm())


if __name__ == "__main__":
    main(*sys.argv[1:])
