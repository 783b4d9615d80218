"""The tables that the benchmark prints."""

from __future__ import annotations

import importlib.metadata
import os
import platform

import numpy as np

NOT_HERE = "not installed"


def table(rows):
    lines = [
        "| solver | gait fr/s | x EAIK | hit % | 1 frame per call: median / p99.9 us | cold fr/s | x EAIK "
        "| hit % | hard hit % |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    lines += [
        (
            f"| {row.name} | {rate(row, 'gait')} | {ratio(rows, row, 'gait')} | {share(row, 'gait')} | "
            f"{micro(row)} | {rate(row, 'cold')} | {ratio(rows, row, 'cold')} | {share(row, 'cold')} | "
            f"{share(row, 'hard')} |"
        )
        for row in sorted(rows, key=lambda r: r.cells.get("gait", (0,))[0])
    ]
    return "\n".join(lines)


def rate(row, job):
    return f"{row.cells[job][0]:,.0f}" if job in row.cells else "-"


def share(row, job):
    return f"{row.cells[job][1]:.4g}" if job in row.cells else "-"


def micro(row):
    return "{:.1f} / {:.0f}".format(*row.cells["online"]) if "online" in row.cells else "-"


def reference(rows, name, job):
    if name == "EAIK call":
        return next((r.call for r in rows if r.call), None)
    found = [r for r in rows if r.name.startswith(name) and job in r.cells]
    return found[0].cells[job][0] if found else None


def ratio(rows, row, job):
    base = reference(rows, "EAIK batch", job)
    return f"{row.cells[job][0] / base:.2f}" if base and job in row.cells else "-"


def goals(rows):
    """The ratios that were promised, side by side with what this run measured."""
    auto, formula, online_row, dls = (
        "**exo_pin Auto",
        "exo_pin closed form",
        "**exo_pin Online",
        "exo_pin Dls",
    )
    wanted = [
        ("gait, verified, against EAIK batch", auto, "EAIK batch", "gait", 12),
        ("gait, verified, against Pink", auto, "Pink", "gait", 250),
        ("the same against EAIK's bare call, no answer chosen", auto, "EAIK call", "gait", None),
        ("closed form alone against EAIK batch", formula, "EAIK batch", "gait", 40),
        ("the same against EAIK's bare call, no answer chosen", formula, "EAIK call", "gait", None),
        ("cold, verified, against EAIK batch", auto, "EAIK batch", "cold", 10),
        ("Dls alone against Pink, cold", dls, "Pink", "cold", 4),
    ]
    lines = ["| ratio of speeds | goal | this run |", "|---|---|---|"]
    for label, ours_name, theirs, job, goal in wanted:
        a, b = reference(rows, ours_name, job), reference(rows, theirs, job)
        promised = f">= {goal}" if goal else "-"
        lines.append(f"| {label} | {promised} | {f'{a / b:.1f}' if a and b else NOT_HERE} |")
    mine = next(r for r in rows if r.name.startswith(online_row)).cells["online"]
    for theirs in ("PlaCo", "Robotics Toolbox"):
        found = [r for r in rows if r.name.startswith(theirs) and "online" in r.cells]
        value = NOT_HERE
        if found:
            other = found[0].cells["online"]
            value = f"{other[0] / mine[0]:.1f} (p99.9: {other[1] / mine[1]:.1f})"
        lines.append(f"| one frame per call, median, against {theirs} | >= 3 (p99.9: >= 1) | {value} |")
    return "\n".join(lines)


def head(short, missing):
    lines = [
        f"Measured by `scripts/benchmark{' --short' if short else ''}` on {os.cpu_count()} cores, Python "
        f"{platform.python_version()}, pin {version('pin')}, numpy {np.__version__}. Compare ratios only: "
        "the machine was shared, so batches show the shortest of several runs, and single frames the best "
        "median and the best 99.9 % of twelve rounds in turns.",
        "Gait: 10 000 frames at 100 Hz, warm start, hit = 1e-6 m and 1e-6 rad on both feet, limits kept. "
        "Cold: uniform joint angles, seeded at mid-range, hit = 1e-5 m and 1e-3 rad. Hard: two thirds of the "
        "joints exactly on a limit, a third of the knees exactly straight. EAIK returns up to "
        "eight answers a leg; its time includes choosing the one within the limits (vectorised), and the "
        "ratio to its bare call stands in the second table. The referee's forward kinematics is the paper's "
        "recursion.",
    ]
    if missing:
        lines.append("Not installed in this run: " + ", ".join(missing) + ".")
    return "\n\n".join(lines)


def version(package):
    names = {
        "roboticstoolbox": "roboticstoolbox-python",
        "pink": "pin-pink",
        "trac_ik": "pytracik",
        "pinocchio": "pin",
    }
    try:
        return importlib.metadata.version(names.get(package, package))
    except importlib.metadata.PackageNotFoundError:
        return ""
