"""The run itself: every solver on every job, and the tables."""

from __future__ import annotations

import importlib.util
import subprocess
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from exo_pin import ik
from exo_pin.chunks import CHUNK
from exo_pin.ik.leg import closed_form
from exo_pin.ik.leg.geometry import exact_geometry
from exo_pin.robot import leg_forward as forward
from exo_pin.robot import load_robot
from peers import PEERS, calibrated, jobs
from peers import plots as drawn
from peers.tables import goals, head, reference, table, version

SEED = 20260101
TITLE = "# Inverse kinematics against its peers"
IN_THE_RACE = 100.0  # [us] slower solvers are not timed again


class Row:
    """One line of the main table.

    Attributes:
        name: The solver.
        cells: Column -> what the table shows of it.
        call: Frames per second of the peer's bare batch call, where it has one.
        again: Runs the gait job one frame per call once more.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self.cells: dict[str, Any] = {}
        self.call: float | None = None
        self.again: Callable[[], Any] | None = None


def run(*, short: bool, placo: Path | None, plots: Path | None = None) -> str:
    rng = np.random.default_rng(SEED)
    robot = load_robot()
    n, budget = (10_000, 1.0) if short else (10_000, 4.0)
    work = {
        "gait": jobs.gait(robot, n),
        "cold": jobs.cold(robot, n, rng),
        "hard": jobs.hard(robot, 2000, rng),
    }
    rows, missing = [], []
    for kind in PEERS:
        if importlib.util.find_spec(kind.package) is None:
            missing.append(kind.name)
            continue
        say(f"{kind.name} ...")
        rows.append(peer(robot, kind, work, budget))
    if placo is None:
        missing.append("PlaCo")
    else:
        say("PlaCo ...")
        rows.append(placo_row(robot, work, budget, placo))
    say("exo_pin ...")
    rows += ours(robot, work, budget)
    say("one frame per call, in turns ...")
    in_turns(rows)
    parts = [TITLE, head(short, missing), table(rows), goals(rows)]
    say("calibrated legs ...")
    parts.append(
        calibrated.section(
            robot, rng, n if not short else 4000, budget, reference(rows, "EAIK batch", "gait")
        )
    )
    if not short:
        say("a million poses ...")
        cost = flat(robot, rng)
        parts += [million(robot, rng), flat_table(cost)]
    if plots:
        drawn.noise(robot, rng, plots)
        if not short:
            drawn.flat(cost, plots)
            parts.append("![Cost per frame](ik_flat.svg)")
    text = "\n\n".join(parts)
    print("\n" + text, flush=True)
    return text


def say(what):
    print(what, flush=True)


def peer(robot, kind, work, budget):
    row = Row(f"{kind.name} {version(kind.package)}")
    middle = 0.5 * (robot.lower + robot.upper)
    for name, job in work.items():
        solver = kind(robot, 1e-7)
        if hasattr(solver, "batch"):
            took, q = jobs.best_time(lambda s=solver, j=job: s.batch(j.left, j.right), budget)
            rate = len(job.q) / took
            if name == "gait":
                took, _ = jobs.best_time(lambda s=solver, j=job: s.call(j.left, j.right), budget)
                row.call = len(job.q) / took
        else:
            q, times = jobs.loop(solver.single, job, middle if job.cold else job.q[0], budget)
            rate = 1 / np.median(times)
            if name == "gait":
                row.cells["online"] = online_cell(times)
                row.again = partial(jobs.loop, solver.single, job, job.q[0], budget / 8)
        row.cells[name] = (rate, *jobs.verdict(robot, job, q))
    return row


def placo_row(robot, work, budget, python):
    row = Row("PlaCo " + shell(python, "import importlib.metadata as m; print(m.version('placo'))"))
    for name, job in work.items():
        q, times = placo_run(robot, job, budget, python)
        row.cells[name] = (1 / np.median(times), *jobs.verdict(robot, job, q))
        if name == "gait":
            row.cells["online"] = online_cell(times)
            row.again = partial(placo_run, robot, job, budget / 8, python)
    return row


def placo_run(robot, job, budget, python):
    with tempfile.TemporaryDirectory() as folder:
        question, answer = Path(folder) / "job.npz", Path(folder) / "answer.npz"
        np.savez(
            question, urdf=robot.urdf, joints=robot.joints, placement=robot.placement,
            lower=robot.lower, upper=robot.upper, left=job.left, right=job.right, cold=job.cold,
            seed=0.5 * (robot.lower + robot.upper) if job.cold else job.q[0],
            budget=budget, tolerance=1e-7,
        )  # fmt: skip
        worker = Path(__file__).with_name("placo_worker.py")
        subprocess.run([str(python), str(worker), str(question), str(answer)], check=True)
        found = np.load(answer)
        return found["q"], found["times"]


def ours(robot, work, budget):
    settings = {
        "**exo_pin Auto** (verified)": ik.Auto(),
        "exo_pin ClosedForm (verified)": ik.ClosedForm(),
        "exo_pin Dls (no closed form)": ik.Dls(warm_start=False),
    }
    rows = []
    middle = 0.5 * (robot.lower + robot.upper)
    for label, chosen in settings.items():
        row = Row(label)
        for name, job in work.items():
            seed = middle if job.cold else job.q[0]
            took, track = jobs.best_time(
                lambda j=job, s=seed, c=chosen: ik.track(robot, j.targets, s, settings=c), budget
            )
            row.cells[name] = (len(job.q) / took, *jobs.verdict(robot, job, track.q))
        rows.append(row)
    rows.append(raw(robot, work, budget))
    rows.append(online(robot, work["gait"], budget))
    return rows


def raw(robot, work, budget):
    """The formula alone: neither the targets nor the answers are checked."""
    row = Row("exo_pin closed form alone, unchecked")
    legs = [robot.leg(foot) for foot in jobs.FEET]

    def formula(job):
        q = np.empty((len(job.q), 12))
        for own, T in zip(legs, (job.left, job.right), strict=True):
            geometry = exact_geometry(own)
            for a in range(0, len(q), CHUNK):
                part = slice(a, a + CHUNK)
                R, p = forward.components(T[part, :3, :3], T[part, :3, 3])
                for column, angles in zip(own.columns, closed_form.angles(geometry, R, p), strict=True):
                    q[part, column] = angles
        return q

    for name, job in work.items():
        took, q = jobs.best_time(lambda j=job: formula(j), budget)
        row.cells[name] = (len(job.q) / took, *jobs.verdict(robot, job, q))
    return row


def online(robot, job, budget):
    row = Row("**exo_pin Online** (verified, pure Python)")
    loop = ik.Online(robot, job.q[0])
    again = partial(jobs.loop, lambda left, right, _: loop.step(left, right), job, job.q[0], budget / 8)
    row.again = again
    q, times = again()
    row.cells["gait"] = (1 / np.median(times), *jobs.verdict(robot, job, q))
    row.cells["online"] = online_cell(times)
    return row


def in_turns(rows, rounds=12):
    """One frame per call, one solver after the other in rounds; each keeps its best median and tail."""
    for _ in range(rounds):
        for row in rows:
            if row.again and row.cells["online"][0] < IN_THE_RACE:
                row.cells["online"] = np.minimum(row.cells["online"], online_cell(row.again()[1]))


def online_cell(times):
    return np.median(times) * 1e6, np.percentile(times, 99.9) * 1e6


def million(robot, rng):
    """Success and exactness of the default over a million random and a million hard poses."""
    lines = ["| 1 000 000 poses | hit % | right branch % | worst position error m |", "|---|---|---|---|"]
    for name, make in (("random", jobs.cold), ("hard", jobs.hard)):
        hits, branch, worst = [], [], 0.0
        for _ in range(10):
            job = make(robot, 100_000, rng)
            track = ik.track(robot, job.targets)
            hit, error = jobs.verdict(robot, job, track.q)
            hits.append(hit)
            branch.append(100 * (np.abs(track.q - job.q).max(axis=1) < 1e-3).mean())
            worst = max(worst, error)
        lines.append(f"| {name} | {np.mean(hits):.5f} | {np.mean(branch):.5f} | {worst:.1e} |")
    return "\n".join(lines)


def flat(robot, rng):
    """Cost per frame from a thousand to a million frames."""
    job, cost = jobs.cold(robot, 1_000_000, rng), {}
    for n in (1000, 10_000, 100_000, 1_000_000):
        few = jobs.part(job, n)
        took, _ = jobs.best_time(lambda j=few: ik.track(robot, j.targets), 3.0, time.process_time)
        cost[n] = took / n * 1e6
    return cost


def flat_table(cost):
    lines = ["| frames in one call | CPU us per frame |", "|---|---|"]
    return "\n".join(lines + [f"| {n:,} | {value:.2f} |" for n, value in cost.items()])


def shell(python, code):
    return subprocess.run(
        [str(python), "-c", code], capture_output=True, text=True, check=True
    ).stdout.strip()
