# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the program on a scene within a limit of CPU time, reads what the run has left, and says what is wrong with it.

For scripts/hard_cases and scripts/fuzz. Bounds of a sound run:
"""
import csv
import dataclasses
import json
import math
import os
import pathlib
import re
import signal
import subprocess

MOST_ENERGY_GAINED = 0.05  # of the greatest kinetic energy, where nothing drives the cloth
AREA_TOLERANCE = 1e-12     # of the cloth's area: the material is neither lost nor made
MOST_FACTORISATIONS = 400  # of one accepted step, failed attempts included
MOST_MEAN_FACTORISATIONS = 40  # a step, over a whole run
WALL_A_CPU_SECOND = 20     # greatest wall time of a run over its greatest CPU time
STILL = 1e-6  # m/s: cloth that never has the kinetic energy of this speed does not move, but for rounding
ENERGIES = ("kinetic_energy", "gravity_energy", "stretch_energy", "bending_energy")
STATUS_OF_EXIT = {0: {"finished"}, 130: {"interrupted"},
                  1: {"infeasible", "not_converged", "penetration", "not_finite", "io_error"}}


@dataclasses.dataclass
class Outcome:
    """How the program ended: its exit status (minus a signal; None where the time was up), and its errors."""
    exit: int | None
    errors: str

    @property
    def last_error(self):
        return (self.errors.strip().splitlines() or [""])[-1]


@dataclasses.dataclass
class Fault:
    """What is wrong with a run. Two faults are alike where their kinds are equal."""
    kind: str
    text: str


def run_program(program, arguments, seconds):
    """Runs the program on one thread, for at most `seconds` of CPU time. Wall time is bounded more generously: a busy
    machine is no fault of the program."""
    environment = dict(os.environ, OPENBLAS_NUM_THREADS="1")
    command = ["prlimit", f"--cpu={seconds}:{seconds + 5}", program, *map(str, arguments)]
    try:
        done = subprocess.run(command, env=environment, timeout=WALL_A_CPU_SECOND * seconds, text=True, errors="replace",
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    except subprocess.TimeoutExpired as late:
        return Outcome(None, (late.stderr or b"").decode(errors="replace"))
    return Outcome(None if done.returncode == -signal.SIGXCPU else done.returncode, done.stderr)


class RunFiles:
    """report.json and steps.csv of a run; None and empty where the run has left none."""

    def __init__(self, folder):
        folder = pathlib.Path(folder)
        report = folder / "report.json"
        self.report = json.loads(report.read_text()) if report.exists() else None
        self.steps = []
        if (folder / "steps.csv").exists():
            with open(folder / "steps.csv", newline="") as rows:
                self.steps = list(csv.DictReader(rows))

    def column(self, name):
        """Values of a column; 0 for the empty cells of an absent effect."""
        return [float(row[name] or 0.0) for row in self.steps]

    def greatest(self, name):
        return max(self.column(name), default=0.0)

    @property
    def status(self):
        return self.report["status"] if self.report else None

    @property
    def eol_share(self):
        return (self.report or {}).get("feature_contacts", {}).get("eol_share")

    def mean_factorisations(self):
        return sum(self.column("factorisations")) / max(len(self.steps) - 1, 1)

    def milliseconds_a_step(self):
        return 1e3 * sum(self.column("cpu_s")) / max(len(self.steps) - 1, 1)

    def energy_gained(self):
        """Greatest rise of the sum of the energies above its least earlier value, as a share of the greatest kinetic
        energy; None where something drives the cloth or nothing moves."""
        if self.report is None or is_driven(self.report["scene"]):
            return None
        kinetic = self.greatest("kinetic_energy")
        mass = self.report["scene"]["cloth"]["material"]["density"] * self.greatest("material_area")
        if kinetic < 0.5 * mass * STILL**2:
            return None
        least, rise = math.inf, 0.0
        for energy in map(sum, zip(*(self.column(name) for name in ENERGIES))):
            least = min(least, energy)
            rise = max(rise, energy - least)
        return rise / kinetic


def is_moving(thing):
    """Whether a pin or obstacle of a scene moves."""
    motion = thing.get("motion", thing)
    placements = [(key.get("translate"), key.get("rotate")) for key in thing.get("keyframes", [])]
    return "deform" in thing or any(any(motion.get(key, ())) for key in ("velocity", "angular_velocity")) or \
        any(p != placements[0] for p in placements)


def is_pin_moving(scene, pin):
    """Whether a pin moves, by itself or with the obstacle that it follows."""
    followed = [thing for thing in scene.get("obstacle", []) if thing["name"] == pin.get("follow")]
    return any(map(is_moving, [pin, *followed]))


def is_driven(scene):
    """Whether anything but gravity does work on the cloth of a scene. A pin that follows an obstacle moves with it."""
    return "wind" in scene or bool(scene.get("pull")) or any(map(is_moving, scene.get("pin", []))) or \
        any(map(is_moving, scene.get("obstacle", [])))


def find_numbers_not_finite(run):
    return [f"{name} of row {k}" for k, row in enumerate(run.steps)
            for name, cell in row.items() if cell and not math.isfinite(float(cell))]


def find_row_faults(run):
    """Faults of the rows of steps.csv, whatever the ending."""
    faults = [Fault("not finite", text) for text in find_numbers_not_finite(run)[:1]]
    if faults:
        return faults
    if run.greatest("max_penetration") > 0.0:
        faults.append(Fault("penetration", f"{run.greatest('max_penetration'):.3g} m"))
    if run.greatest("crossings") > 0:
        faults.append(Fault("crossings", f"{run.greatest('crossings'):.0f}"))
    area = run.column("material_area")
    worst = max((abs(a - area[0]) for a in area), default=0.0)
    if worst > AREA_TOLERANCE * area[0]:
        faults.append(Fault("area", f"changed by {worst / area[0]:.2g} of it"))
    if min(run.column("min_angle")) <= 0.0:
        faults.append(Fault("orientation", f"min_angle {min(run.column('min_angle')):.3g} degrees"))
    if run.greatest("kkt_residual") > run.report["scene"]["solver"]["tolerance"]:
        faults.append(Fault("residual", f"{run.greatest('kkt_residual'):.2g}"))
    if run.greatest("factorisations") > MOST_FACTORISATIONS:
        faults.append(Fault("factorisations", f"{run.greatest('factorisations'):.0f} in a step"))
    if run.mean_factorisations() > MOST_MEAN_FACTORISATIONS:
        faults.append(Fault("factorisations", f"{run.mean_factorisations():.0f} a step"))
    gained = run.energy_gained()
    if gained is not None and gained > MOST_ENERGY_GAINED:
        faults.append(Fault("energy", f"gained {100 * gained:.3g} % of the greatest kinetic energy"))
    return faults


def is_explained(run):
    """Whether a run ended as infeasible and names a vertex and what cannot be met together: a pin and an obstacle; two
    obstacles one of which moves; an obstacle that presses cloth against a pinned layer, or pins that press layers into
    each other, where one of those named moves."""
    if run.status != "infeasible":
        return False
    message, scene = run.report["message"], run.report["scene"]
    moving = [thing["name"] for thing in scene.get("obstacle", []) if is_moving(thing)]
    moving += [f"pin.{k}" for k, pin in enumerate(scene.get("pin", [])) if is_pin_moving(scene, pin)]
    if re.search(r"vertex \d+.*pin\.\d+ holds the vertex where \w+ is", message):
        return True
    pressed = re.search(r"vertex \d+.* out of (\w+) and (\w+) in the step.*leave it no room", message) or \
        re.search(r"vertex \d+.*: (\w+) presses another layer into it, and (pin\.\d+) holds it", message) or \
        re.search(r"vertex \d+.*: (pin\.\d+) and (pin\.\d+) press two layers into each other", message) or \
        re.search(r"vertex \d+.*: (pin\.\d+) presses it into another layer", message)
    return bool(pressed) and any(name in moving for name in pressed.groups())


def find_faults(outcome, run):
    """Faults of a run that should have come to its end. An infeasible end that is explained (is_explained) is none."""
    if outcome.exit is None:
        return [Fault("hang", "the time limit was reached")]
    if outcome.exit == 2:
        return [Fault("refused", outcome.last_error)]
    if run.report is None or run.status not in STATUS_OF_EXIT.get(outcome.exit, ()):
        return [Fault("crash", f"exit status {outcome.exit}, status {run.status}: {outcome.last_error}")]
    faults = find_row_faults(run)
    if run.status != "finished" and not is_explained(run):
        faults.insert(0, Fault(run.status, run.report["message"]))
    return faults
