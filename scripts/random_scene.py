# SPDX-License-Identifier: GPL-3.0-or-later
"""Random scenes for scripts/fuzz: nested dictionaries with the keys of a scene file, and mesh files as texts.

The obstacles lie below z = 0, in a cloud of about a metre, and the cloth starts above them, so that no scene is refused.
"""
import dataclasses
import json
import math

NAME = "random.obj"  # of the mesh file that a scene may have


@dataclasses.dataclass
class RandomScene:
    scene: dict
    meshes: dict  # name -> text

    def write(self, folder, stem="scene"):
        """Writes the scene and its meshes into a folder; returns the scene's path."""
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in self.meshes.items():
            (folder / name).write_text(text)
        path = folder / f"{stem}.toml"
        path.write_text(toml_text(self.scene))
        return path


def toml_value(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml_value(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    return json.dumps(value)  # texts, numbers and booleans are spelt alike


def toml_lines(table, name):
    """Lines of a table: first its values, then its tables and arrays of tables."""
    is_table = lambda value: isinstance(value, dict) and name == ""
    is_array = lambda value: isinstance(value, list) and bool(value) and isinstance(value[0], dict) and name == ""
    lines = [f"{key} = {toml_value(value)}" for key, value in table.items()
             if not is_table(value) and not is_array(value)]
    for key, value in table.items():
        if is_table(value):
            lines += ["", f"[{key}]", *toml_lines(value, key)]
        if is_array(value):
            for item in value:
                lines += ["", f"[[{key}]]", *toml_lines(item, key)]
    return lines


def toml_text(scene):
    return "\n".join(toml_lines(scene, "")) + "\n"


class SceneMaker:
    def __init__(self, chance):
        self.chance = chance
        self.meshes = {}

    def is_true(self, share):
        return self.chance.random() < share

    def log(self, low, high):
        """A number whose logarithm is uniform, with three digits."""
        return float(f"{10 ** self.chance.uniform(math.log10(low), math.log10(high)):.3g}")

    def number(self, low, high):
        return round(self.chance.uniform(low, high), 4)

    def vector(self, size):
        return [self.number(-size, size) for _ in range(3)]

    def turn(self, degrees):
        axis = self.vector(1.0)
        axis[2] += 0.01 if max(map(abs, axis)) < 0.01 else 0.0
        return {"axis": axis, "degrees": self.number(-degrees, degrees)}

    # Shapes, of about 0.1 to 1 m, and points that bound them

    def box(self):
        sizes = [self.log(0.02, 1.0) for _ in range(3)]
        return {"box": sizes}, corners([-s / 2 for s in sizes], [s / 2 for s in sizes])

    def blade(self):
        height, width = self.number(0.1, 0.4), self.number(0.2, 1.2)
        teeth = {"count": 1, "pitch": height, "height": height, "width": width, "tip_degrees": self.log(1.0, 50.0)}
        return {"teeth": teeth}, corners([-height / 2, -width / 2, -height], [height / 2, width / 2, height])

    def teeth(self):
        count, tip, height = self.chance.randint(2, 7), self.number(20.0, 100.0), self.number(0.02, 0.15)
        pitch = round(2 * height * math.tan(math.radians(tip) / 2) * self.number(1.01, 2.0) + 1e-4, 4)
        width = self.number(0.2, 1.0)
        teeth = {"count": count, "pitch": pitch, "height": height, "width": width, "tip_degrees": tip}
        x, y = count * pitch / 2, width / 2
        return {"teeth": teeth}, corners([-x, -y, -height], [x, y, height])

    def wire(self):
        points, at = [], [-0.5, 0.0, 0.0]
        for _ in range(self.chance.randint(2, 6)):
            points.append([round(x, 4) for x in at])
            at = [at[0] + self.number(0.1, 0.5), at[1] + self.number(-0.2, 0.2), at[2] + self.number(-0.1, 0.1)]
        return {"wire": points}, points

    def loop(self):
        n, radius = self.chance.randint(3, 30), self.number(0.1, 0.5)
        points = [[round(radius * math.cos(2 * math.pi * k / n), 5), round(radius * math.sin(2 * math.pi * k / n), 5), 0.0]
                  for k in range(n)]
        return {"wire": points, "closed": True}, points

    def nails(self):
        count, spacing = self.chance.randint(1, 4), self.log(0.003, 0.3)
        points = [[round(spacing * (i - count / 2 + self.number(-0.2, 0.2)), 5), round(spacing * (j - count / 2), 5), 0.0]
                  for i in range(count) for j in range(count)]
        return {"points": points}, points

    def mesh_file(self):
        points, faces = self.chance.choice([self.ball, self.sheet, self.soup])()
        lines = ["v " + " ".join(f"{x:.6g}" for x in p) for p in points]
        self.meshes[NAME] = "\n".join(lines + ["f " + " ".join(str(k + 1) for k in f) for f in faces]) + "\n"
        return {"file": NAME}, points

    def ball(self):
        """A closed ball of uneven radius."""
        around, along, size, rough = self.chance.randint(3, 12), self.chance.randint(2, 7), self.number(0.1, 0.4), self.number(0, 0.5)
        radius = lambda: size * (1 - rough * self.chance.random())
        points = [[0.0, 0.0, -radius()]]
        for j in range(1, along):
            polar = math.pi * j / along
            for i in range(around):
                r, turn = radius(), 2 * math.pi * i / around
                points.append([r * math.sin(polar) * math.cos(turn), r * math.sin(polar) * math.sin(turn),
                               -r * math.cos(polar)])
        points.append([0.0, 0.0, radius()])
        at = lambda j, i: 1 + (j - 1) * around + i % around
        faces = [(0, at(1, i + 1), at(1, i)) for i in range(around)]
        faces += [(len(points) - 1, at(along - 1, i), at(along - 1, i + 1)) for i in range(around)]
        for j in range(1, along - 1):
            for i in range(around):
                faces += [(at(j, i), at(j, i + 1), at(j + 1, i + 1)), (at(j, i), at(j + 1, i + 1), at(j + 1, i))]
        return points, faces

    def sheet(self):
        """An open, rough sheet."""
        n, size, rough = self.chance.randint(2, 8), self.number(0.2, 0.8), self.number(0.0, 0.2)
        points = [[size * (i / n - 0.5), size * (j / n - 0.5), self.number(-rough, rough)]
                  for j in range(n + 1) for i in range(n + 1)]
        at = lambda i, j: j * (n + 1) + i
        return points, [face for j in range(n) for i in range(n) for face in
                        ((at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1)))]

    def soup(self):
        """Triangles that cross each other."""
        count = self.chance.randint(1, 8)
        return [self.vector(0.4) for _ in range(3 * count)], [(3 * k, 3 * k + 1, 3 * k + 2) for k in range(count)]

    # Parts of the scene

    def obstacle(self, name):
        shapes = [self.box, self.blade, self.wire, self.loop, self.nails, self.teeth]
        shape, points = self.chance.choice(shapes if self.meshes else [*shapes, self.mesh_file])()
        turn = {"rotate": self.turn(180)} if self.is_true(0.6) else {}
        top = max(rotated(p, turn["rotate"])[2] if turn else p[2] for p in points)
        depth = 1e-6 if self.is_true(0.6) else self.number(0.0, 0.15)
        at = [self.number(-0.25, 0.25), self.number(-0.25, 0.25), round(-top - depth, 6)]
        return {"name": name, **shape, **self.placement(at, turn)}

    def placement(self, at, turn):
        """Where an obstacle is at the start, and how it moves."""
        kind = self.chance.random()
        if kind < 0.6:
            return {"translate": at, **turn}
        if kind < 0.7:
            to = [round(a + d, 4) for a, d in zip(at, self.vector(0.4))]
            later = {"rotate": self.turn(120)} if self.is_true(0.5) else turn
            time = max(self.log(0.02, 0.5), 2.1 * self.step)  # a step may turn by a quarter turn, and no more
            return {"keyframes": [{"time": 0.0, "translate": at, **turn}, {"time": time, "translate": to, **later}]}
        start = self.log(0.01, 0.3)
        motion = {"velocity": self.vector(self.log(0.1, 5.0)), "angular_velocity": self.vector(self.log(0.1, 10.0)),
                  "pivot": at, "start": start, "stop": round(start + self.log(0.01, 1.0), 4)}
        if self.is_true(0.5):
            del motion["angular_velocity"]
        return {"translate": at, **turn, "motion": motion}

    def material(self):
        plate = {"bending_model": "plate"} if self.is_true(0.25) else {}
        return {**plate, "density": self.log(1e-3, 10.0), "youngs_modulus": self.log(1.0, 1e6),
                "poisson_ratio": self.number(0.0, 0.49),
                "bending_stiffness": self.log(1e-8, 1e-2) if self.is_true(0.9) else 0.0,
                "damping": self.log(1e-4, 1e-2) if self.is_true(0.3) else 0.0, "thickness": self.log(5e-5, 5e-3)}

    def cloth(self):
        size = [self.number(0.3, 1.2), self.number(0.3, 1.2)]
        cells = min(self.log(2, 40), 40)
        resolution = [max(2, round(cells * side / max(size))) for side in size]
        cloth = {"size": size, "resolution": resolution,
                 "pattern": self.chance.choice(["diagonal", "alternating", "cross", "unstructured"]),
                 "rotate": self.turn(180 if self.is_true(0.1) else 20), "material": self.material()}
        if self.is_true(0.3):
            cloth["pattern_angle"] = self.number(0, 90)
        if self.is_true(0.4):
            cloth["velocity"] = [*self.vector(1.0)[:2], -self.log(0.1, 20.0)]
        return self.put_above(cloth)

    def put_above(self, cloth):
        """Puts the cloth's lowest corner above z = 0, where the obstacles end."""
        ends = [rotated(p, cloth["rotate"]) for p in corners([0.0, 0.0, 0.0], [*cloth["size"], 0.0])]
        middle = [sum(p[d] for p in ends) / len(ends) for d in range(3)]
        lowest = min(p[2] for p in ends)
        cloth["translate"] = [round(self.number(-0.1, 0.1) - middle[0], 6), round(self.number(-0.1, 0.1) - middle[1], 6),
                              round(self.log(1e-5, 0.05) - lowest, 9)]
        return cloth

    def cut_out(self, cloth):
        """The cloth with a star-shaped outline inside its rectangle, with a hole in half of the cases."""
        (u, v), corners_out, corners_in = cloth["size"], self.chance.randint(3, 9), self.chance.randint(3, 6)
        star = lambda n, least, most: [
            [round(0.5 * u * (1 + r * math.cos(2 * math.pi * k / n)), 4), round(0.5 * v * (1 + r * math.sin(2 * math.pi * k / n)), 4)]
            for k, r in ((k, self.chance.uniform(least, most)) for k in range(n))]
        shape = {"outline": star(corners_out, 0.5, 1.0)}
        if self.is_true(0.5):
            shape["holes"] = [star(corners_in, 0.05, 0.2)]
        shape["edge_length"] = round(max(cloth["size"]) / max(cloth["resolution"]), 5)
        grid = ("size", "resolution", "pattern", "pattern_angle")
        return {**shape, **{key: value for key, value in cloth.items() if key not in grid}}

    def pinned_box(self, cloth):
        """A box of material that holds a vertex at least."""
        if "outline" in cloth:
            corner, reach = self.chance.choice(cloth["outline"]), cloth["edge_length"]  # a blunt corner may be left out
            return [[x - reach for x in corner], [x + reach for x in corner]]
        u, v = cloth["size"]
        box = self.chance.choice([[[0, 0], [0, 0]], [[u, v], [u, v]], [[0, 0], [0, v]], [[0, v], [u, v]],
                                  [[0.3 * u, 0.3 * v], [0.7 * u, 0.7 * v]]])
        if min(cloth["resolution"]) < 4:
            box = [[0, 0], [0, 0]]  # the box in the middle might hold no vertex
        return box

    def pin(self, cloth, names):
        box = self.pinned_box(cloth)
        pin = {"material": [[round(x, 4) for x in corner] for corner in box]}
        if self.is_true(0.3):
            pin["start"] = self.log(0.02, 0.5)
        if self.is_true(0.15):
            return {**pin, "follow": self.chance.choice(names)}
        if self.is_true(0.4):
            pin["velocity"] = self.vector(self.log(0.1, 3.0))
        if self.is_true(0.2):
            pin |= {"angular_velocity": self.vector(self.log(0.1, 5.0)), "pivot": self.vector(0.5)}
        if self.is_true(0.2):
            pin["directions"] = self.chance.choice([["x", "y"], ["z"], ["x", "z"]])
        if self.is_true(0.3):
            pin["release"] = pin.get("start", 0.0) + self.log(0.02, 1.0)
        return pin

    def remesh(self, cloth):
        """Edges from a third of the cells to thrice as long."""
        cell = cloth.get("edge_length") or max(map(lambda side, cells: side / cells, cloth["size"], cloth["resolution"]))
        shortest = self.number(0.3, 1.0) * cell
        return {"edge_length": [round(shortest, 6), round(self.number(1.2, 3.0) * cell, 6)],
                "angle": self.chance.choice([15, 30, 60]), "vertices": 4000}

    def make(self, title):
        names = [f"o{k}" for k in range(self.chance.choice([1, 1, 1, 2, 2, 3]))]
        self.step = step = self.log(1e-3, 0.05)
        obstacles, cloth = [self.obstacle(name) for name in names], self.cloth()
        if self.is_true(0.2):
            cloth = self.cut_out(cloth)
        duration = round(min(self.log(0.15, 1.5), 300 * step), 4)
        scene = {"title": title, "duration": duration,
                 "time": {"step": step, "integrator": self.chance.choice(["bdf2", "bdf2", "bdf2", "implicit_euler"])},
                 "cloth": cloth, "eol": {"enabled": self.is_true(0.75)}, "obstacle": obstacles}
        if self.is_true(0.4):
            scene["pin"] = [self.pin(cloth, names) for _ in range(self.chance.choice([1, 1, 2, 3]))]
        if self.is_true(0.85):
            scene["gravity"] = {} if self.is_true(0.8) else {"acceleration": self.vector(15.0)}
        if self.is_true(0.25):
            scene["wind"] = {"velocity": self.vector(self.log(0.5, 20.0))}
        if self.is_true(0.5):
            scene["friction"] = {"coefficient": self.log(0.02, 3.0)}
        if self.is_true(0.3):
            scene["self_contact"] = {}
        if self.is_true(0.2):
            scene["remesh"] = self.remesh(scene["cloth"])
        scene["output"] = {"frames_per_second": self.chance.choice([10, 24, 60]), "formats": []}
        return RandomScene(scene, self.meshes)

    def make_crumple(self, title):
        """Cloth thrown edge-on at a floor, at 2 to 8 m/s, with contact with itself."""
        cells, height = self.chance.choice([12, 16, 24]), self.chance.choice([0.1, 0.2, 0.4])
        about = self.chance.uniform(0.0, 2.0 * math.pi)
        cloth = {"size": [0.4, height], "resolution": [cells, max(3, round(cells * height / 0.4))],
                 "pattern": self.chance.choice(["diagonal", "alternating", "cross", "unstructured"]),
                 "rotate": {"axis": [round(math.cos(about), 4), round(math.sin(about), 4), 0.0],
                            "degrees": round(self.chance.gauss(90.0, 8.0), 2)},
                 "translate": [0.0, 0.0, 0.65],
                 "velocity": [self.number(-1.0, 1.0), self.number(-1.0, 1.0), -self.number(2.0, 8.0)],
                 "material": {"density": self.log(0.05, 0.4), "youngs_modulus": self.log(50.0, 5000.0),
                              "bending_stiffness": self.log(1e-6, 1e-4)}}
        scene = {"title": title, "duration": 0.6, "time": {"step": 0.005, "integrator": "bdf2"}, "cloth": cloth,
                 "gravity": {}, "self_contact": {},
                 "obstacle": [{"name": "floor", "box": [6.0, 6.0, 0.1], "translate": [0.0, 0.0, -0.05]}]}
        if self.is_true(0.5):
            scene["friction"] = {"coefficient": self.log(0.02, 1.0)}
        scene["output"] = {"frames_per_second": 50, "formats": []}
        return RandomScene(scene, self.meshes)


def corners(low, high):
    """Corners of the box between two points."""
    return [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]


def rotated(p, turn):
    """Rodrigues' formula: p cos a + (k x p) sin a + k (k . p) (1 - cos a)."""
    length, a = math.hypot(*turn["axis"]), math.radians(turn["degrees"])
    k = [x / length for x in turn["axis"]]
    dot = sum(x * y for x, y in zip(k, p))
    cross = [k[1] * p[2] - k[2] * p[1], k[2] * p[0] - k[0] * p[2], k[0] * p[1] - k[1] * p[0]]
    return [x * math.cos(a) + c * math.sin(a) + e * dot * (1 - math.cos(a)) for x, c, e in zip(p, cross, k)]
