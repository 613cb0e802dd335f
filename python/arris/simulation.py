# SPDX-License-Identifier: GPL-3.0-or-later
"""The class Simulation."""

import json
import operator
import os
import sys
import warnings
from pathlib import Path

from . import _arris
from ._arris import InputError
from .toml_text import to_document, to_toml

# An embedded Python may not know its program.
_PYTHON = sys.executable or f"{sys.exec_prefix}/bin/python{sys.version_info[0]}.{sys.version_info[1]}"
_IMPORTER = [_PYTHON, "-S", str(Path(__file__).with_name("import_obstacle.py"))]

# Columns of steps.csv that the parts of a step sum to; of the others, a step has those of its last part.
_SUMMED = {"dt", "factorisations", "nlopt_evaluations", "solves", "rewound", "yielded", "energy_rise",
           "friction_sweeps", "friction_work", "remeshed", "remesh_energy"}


class SceneWarning(UserWarning):
    """A warning of `arris check` or `arris run`: a valid key without effect, strain that cloth does not bear, ..."""


class StepError(RuntimeError):
    """A step that cannot be made. `status`: infeasible, not_converged, penetration or not_finite."""

    def __init__(self, status, message):
        super().__init__(f"{status}: {message}")
        self.status = status


class Simulation:
    """A scene being simulated in memory. Steps give the bytes of `arris run`.

    scene: the path of a scene file, or a dict with the keys of one; NumPy arrays may stand for arrays.
    set: keys to override, as {"time.step": 0.001, "obstacle.0.translate": [0, 0, 1]}.
    folder: of a dict, the folder that its paths start at (default: the working directory).
    threads: as many threads, in the whole process (default: one a core).

    Raises InputError with one line that names key, value and what is allowed. Warnings about the scene are
    SceneWarnings of the module `warnings`.

    Arrays (positions, velocities, material, faces, ...) are read-only views on the state, without a copy. They keep
    their values when the simulation goes on; ask for them again after a step. The mesh may change in any step.
    """

    def __init__(self, scene, *, set=None, folder=None, threads=None):
        if isinstance(scene, dict):
            path, text = os.path.join(folder or "", "dict"), to_document(scene)
        elif folder is not None:
            raise InputError(f"folder = {folder!r}: contradicts a scene from a file; allowed: with a dict")
        else:
            path = os.fspath(scene)
            text = _arris.read_scene_text(path)
        if set is not None and not isinstance(set, dict):
            raise InputError(f"set = {_words(set)}: allowed: a dict of keys and values")
        overrides = [f"{key}={to_toml(value, key)}" for key, value in (set or {}).items()]
        if threads is not None:
            _arris.set_threads(_integer("threads", threads, 1, 1024))
        self._core = _arris.Core(path, text, overrides, _IMPORTER)
        self._columns = _arris.row_header().split(",")
        self._warn(self._core.warnings)

    # Time

    def step(self):
        """Makes one planned step; returns its report: a dict with the columns of steps.csv (docs/output.md), None where
        an effect is absent. A step that was made in parts has the sums of their counts and seconds, and `parts`.

        Raises StepError where the step fails: the state is then that of the last part that was made. Ctrl-C raises
        KeyboardInterrupt; the state is then that before the step, or after it if that was just done.
        """
        stepped = self._core.step()
        if stepped.status:
            raise StepError(stepped.status, stepped.message)
        if self.is_over:
            self._warn(self._core.warnings_at_end())
        return _join([dict(zip(self._columns, map(_number, row.split(",")))) for row in stepped.rows])

    def run_until(self, time):
        """Steps until `time` (s) is reached: steps end at frames and events, so it may be passed by less than a step.
        Returns the report of the last step; None if `time` is not later than now."""
        if not time <= self.duration:
            raise InputError(f"run_until: time = {time!r}: allowed: at most the scene's duration, {self.duration} s")
        report = None
        while self.time < time and not self.is_over:
            report = self.step()
        return report

    def __iter__(self):
        """Steps to the end of the scene, and gives the report of each step."""
        while not self.is_over:
            yield self.step()

    @property
    def time(self):
        """s."""
        return self._core.time

    @property
    def duration(self):
        """s, of the scene."""
        return self._core.duration

    @property
    def is_over(self):
        """Whether the scene's duration is reached."""
        return self._core.is_over

    # The state

    @property
    def positions(self):
        """n x 3, m: of the vertices in the world."""
        return self._core.positions

    @property
    def velocities(self):
        """n x 3, m/s: of the vertices. At EOL vertices the material flows through them."""
        return self._core.velocities

    @property
    def material(self):
        """n x 2, m: of the vertices in the material. With several pieces, all lie side by side in one plane; vertices
        on seams have further coordinates (material_points)."""
        return self._core.material

    @property
    def faces(self):
        """m x 3: vertices of the triangles, counter-clockwise in the material."""
        return self._core.faces

    @property
    def material_points(self):
        """p x 2, m: of the points of the material: those of the vertices, then the further ones of seams."""
        return self._core.material_points

    @property
    def face_points(self):
        """m x 3: points of the material at the corners of the triangles; without seams equal to `faces`."""
        return self._core.face_points

    @property
    def eol(self):
        """n numbers: 0 for ordinary vertices, 1 for those on an edge or wire, 2 on a corner or point."""
        return self._core.eol

    def contacts(self):
        """Contacts that press, as a dict of arrays: `vertices` (k x 4, -1 where there are fewer), `with` (names of
        obstacles, "cloth" for the cloth itself), `force` and `friction` (k x 3, N, on the cloth; where it meets
        itself, on the part with the first vertex). Empty at time 0.

        At an EOL vertex `force` is all that its edge or corner exerts, but for the part along the edge, which is
        `friction`."""
        import numpy as np

        contacts = self._core.contacts()
        return contacts | {"with": np.array(contacts["with"], dtype=str)}

    def energies(self):
        """J: kinetic, gravity (zero at the origin), stretch, bending; gravity is 0 without [gravity]."""
        return self._core.energies()

    def probes(self):
        """Position (m) and velocity (m/s) of the material point of each probe: 2 x 3, by its name."""
        return self._core.probes()

    @property
    def obstacles(self):
        """Names of the obstacles."""
        return self._core.obstacle_names

    @property
    def scene(self):
        """The scene as a dict with every default filled in."""
        return json.loads(self._core.scene_as_run())

    def save_state(self):
        """The state as bytes: all that the rest of the simulation depends on."""
        return self._core.save()

    def load_state(self, state):
        """Goes to a state that a simulation of the same scene has saved, in this process or another."""
        if not isinstance(state, (bytes, bytearray, memoryview)):
            raise InputError(f"state: is of type {type(state).__name__}; allowed: bytes of save_state")
        self._core.load(bytes(state))

    def write_frame(self, path):
        """Writes the cloth as a PLY file, as `arris run` does."""
        self._core.write_frame(os.fspath(path))

    # Motion

    def set_pin(self, index, translate=None, rotate=None, *, velocity=None, angular_velocity=None, pivot=None):
        """Moves a pin (0 is the first) to a placement x = translate + R x(0) at the end of the next step, where it then
        stays; on the way as between two keyframes. rotate: {"axis": [x, y, z], "degrees": d}, or a 3 x 3 matrix.

        Or moves it from now on with `velocity` (m/s) and `angular_velocity` (rad/s) about `pivot` (world, m; it moves
        along; default: the placement's origin). This replaces the motion that the scene gives.
        """
        self._move(self._pin(index), f"pin {index}", translate, rotate, velocity, angular_velocity, pivot)

    def set_obstacle(self, name, translate=None, rotate=None, *, velocity=None, angular_velocity=None, pivot=None):
        """Moves a rigid obstacle, as set_pin a pin. The placement is that of its own coordinates, after `scale`, `up`
        and `units`: x = translate + R p."""
        self._move(self._obstacle(name), f"obstacle '{name}'", translate, rotate, velocity, angular_velocity, pivot)

    def pin_placement(self, index):
        """The current placement of a pin: rotation matrix and translation (m)."""
        return self._core.placement(self._pin(index))

    def obstacle_placement(self, name):
        """The current placement of a rigid obstacle: rotation matrix and translation (m)."""
        return self._core.placement(self._obstacle(name))

    def _pin(self, index):
        return self._core.pin(_integer("pin", index, -1, 1 << 30))

    def _obstacle(self, name):
        if not isinstance(name, str):
            raise InputError(f"obstacle {_words(name)}: allowed: a name, a str")
        return self._core.obstacle(name)

    def _move(self, mover, name, translate, rotate, velocity, angular_velocity, pivot):
        is_placed = translate is not None or rotate is not None
        is_driven = velocity is not None or angular_velocity is not None
        if is_placed == is_driven:
            raise InputError(f"{name}: allowed: either translate and rotate, or velocity and angular_velocity")
        if is_placed:
            if pivot is not None:
                raise InputError(f"{name}: pivot = {_words(pivot)}: allowed: with angular_velocity")
            self._core.place(mover, _rotation(name, rotate), _vector(name, "translate", translate))
            return
        if pivot is None:
            pivot = self._core.placement(mover)[1]
        self._core.drive(mover, _vector(name, "velocity", velocity),
                         _vector(name, "angular_velocity", angular_velocity), _vector(name, "pivot", pivot))

    def _warn(self, lines):
        level, frame = 1, sys._getframe()
        while frame.f_back is not None and frame.f_code.co_filename == __file__:  # at the caller's line
            level, frame = level + 1, frame.f_back
        for line in lines:
            warnings.warn(line, SceneWarning, stacklevel=level)


def _number(cell):
    """A cell of steps.csv."""
    if not cell:
        return None
    try:
        return int(cell)
    except ValueError:
        return float(cell)


def _join(rows):
    """The report of a step from its parts."""
    report = dict(rows[-1], parts=len(rows))
    for column in report:
        if len(rows) > 1 and (column in _SUMMED or column.endswith("_s")):
            report[column] = sum(row[column] for row in rows if row[column] is not None)
    return report


def _integer(name, value, least, most):
    """An int of Python or NumPy."""
    try:
        number = operator.index(value)
    except TypeError:
        number = None
    if number is None or isinstance(value, bool) or not least <= number <= most:
        raise InputError(f"{name} = {_words(value)}: allowed: an integer from {max(least, 0)} to {most}")
    return number


def _words(value):
    """A value in one line."""
    return " ".join(repr(value).split())


def _vector(name, key, value):
    """Three finite numbers; None is zero."""
    import numpy as np

    if value is None:
        return np.zeros(3)
    try:
        vector = np.asarray(value, float)
    except (TypeError, ValueError):
        vector = np.empty(0)
    if vector.shape != (3,) or not (np.abs(vector) <= 1e6).all():
        raise InputError(f"{name}: {key} = {_words(value)}: allowed: 3 numbers from -1000000 to 1000000")
    return vector


def _rotation(name, rotate):
    """The matrix of a rotation; None is the identity."""
    import numpy as np

    if rotate is None:
        return np.eye(3)
    refused = (f"{name}: rotate = {_words(rotate)}: "
               'allowed: {"axis": [x, y, z], "degrees": d}, or a 3 x 3 matrix of a rotation')
    if isinstance(rotate, dict):
        if rotate.keys() != {"axis", "degrees"}:
            raise InputError(refused)
        axis = _vector(name, "rotate.axis", rotate["axis"])
        degrees = _vector(name, "rotate.degrees", [rotate["degrees"]] * 3)[0]
        if not np.linalg.norm(axis) > 1e-9:
            raise InputError(f"{name}: rotate.axis = {_words(rotate['axis'])}: has no direction")
        return _arris.rotation_about(axis, degrees)
    try:
        matrix = np.asarray(rotate, float)
    except (TypeError, ValueError):
        matrix = np.empty(0)
    is_rotation = matrix.shape == (3, 3) and np.isfinite(matrix).all() and \
        np.abs(matrix @ matrix.T - np.eye(3)).max() < 1e-9 and np.linalg.det(matrix) > 0
    if not is_rotation:
        raise InputError(refused)
    return matrix
