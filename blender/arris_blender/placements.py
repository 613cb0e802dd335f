# SPDX-License-Identifier: MIT
"""Placements of objects in time, in double precision: which are rigid, and the keyframes that repeat them.

A matrix is 3 x 4 and leads from an object's own space to the world in metres. Quaternions are (w, x, y, z).
"""

import numpy as np

SHAPE_TOLERANCE = 1e-5  # of a matrix against a rotation times a constant scale; Blender's matrices are good to 1e-6
KEY_TOLERANCE = 1e-7    # of a point against its own distance from the origin; Blender's floats are good to 6e-8


def place(matrix, points):
    """`points` (n x 3) in the world, in metres."""
    return np.asarray(points, float) @ matrix[:, :3].T + matrix[:, 3]


def place_back(matrix, points):
    """World `points` in the object's own space; the matrix must not be singular."""
    return np.linalg.solve(matrix[:, :3], (np.asarray(points, float) - matrix[:, 3]).T).T


def nearest_rotation(linear):
    """Rotation R and symmetric K with linear = R K; K mirrors if `linear` does."""
    u, _, vt = np.linalg.svd(linear)
    rotation = u @ vt
    if np.linalg.det(rotation) < 0.0:
        rotation = -rotation
    return rotation, rotation.T @ linear


def is_singular(linear):
    sizes = np.linalg.svd(linear, compute_uv=False)
    return not sizes[2] > 1e-9 * sizes[0]


def split_rigid(matrices):
    """Rotations (n x 3 x 3) and translations (n x 3) of matrices whose scale stays, and that scale (3 x 3); or None."""
    first = matrices[0][:, :3]
    if is_singular(first):
        return None
    scale = nearest_rotation(first)[1]
    rotations = []
    for matrix in matrices:
        rotation, rest = nearest_rotation(matrix[:, :3] @ np.linalg.inv(scale))
        if np.abs(rest - np.eye(3)).max() > SHAPE_TOLERANCE:
            return None
        rotations.append(rotation)
    return np.array(rotations), np.array([matrix[:, 3] for matrix in matrices]), scale


def quaternion_of(rotation):
    """A unit quaternion of a rotation; from the largest of its squares, so without cancellation."""
    r = rotation
    squares = np.array([1 + r[0, 0] + r[1, 1] + r[2, 2], 1 + r[0, 0] - r[1, 1] - r[2, 2],
                        1 - r[0, 0] + r[1, 1] - r[2, 2], 1 - r[0, 0] - r[1, 1] + r[2, 2]])
    products = np.array([[0, r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
                         [r[2, 1] - r[1, 2], 0, r[0, 1] + r[1, 0], r[0, 2] + r[2, 0]],
                         [r[0, 2] - r[2, 0], r[0, 1] + r[1, 0], 0, r[1, 2] + r[2, 1]],
                         [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], 0]])
    largest = int(np.argmax(squares))
    q = products[largest]
    q[largest] = squares[largest]
    return q / np.linalg.norm(q)


def axis_and_degrees(rotation):
    q = quaternion_of(rotation)
    sine = np.linalg.norm(q[1:])
    if sine < 1e-15:
        return np.array([0.0, 0.0, 1.0]), 0.0
    return q[1:] / sine, float(np.degrees(2.0 * np.arctan2(sine, q[0])))


def slerp(first, last, shares):
    """Quaternions (n x 4) between two, along the shorter arc."""
    cosine = first @ last
    if cosine < 0.0:
        last, cosine = -last, -cosine
    angle = np.arctan2(np.linalg.norm(last - cosine * first), cosine)
    if angle < 1e-9:
        return np.repeat(first[None], len(shares), axis=0)
    shares = np.asarray(shares)[:, None]
    return (np.sin((1 - shares) * angle) * first + np.sin(shares * angle) * last) / np.sin(angle)


def choose_keys(rotations, translations, radius):
    """Indices of the placements that are needed: linear interpolation (slerp) between them repeats all others.

    `radius` (m) is the distance of the farthest point that is placed. One index: nothing moves.
    """
    quaternions = np.array([quaternion_of(r) for r in rotations])
    tolerance = KEY_TOLERANCE * max(radius + np.abs(translations).max(), 1e-3)

    def errors(at, wanted_translations, wanted_quaternions):
        turned = np.minimum(np.linalg.norm(quaternions[at] - wanted_quaternions, axis=1),
                            np.linalg.norm(quaternions[at] + wanted_quaternions, axis=1))
        return np.linalg.norm(translations[at] - wanted_translations, axis=1) + 2.0 * radius * turned

    def is_repeated(first, last):
        at = np.arange(first + 1, last)
        shares = (at - first) / (last - first)
        between = translations[first] + shares[:, None] * (translations[last] - translations[first])
        return (errors(at, between, slerp(quaternions[first], quaternions[last], shares)) <= tolerance).all()

    everywhere = np.arange(len(translations))
    if (errors(everywhere, translations[0], quaternions[0]) <= tolerance).all():
        return [0]
    keys, last = [0], 1
    while last < len(translations) - 1:
        if is_repeated(keys[-1], last + 1):
            last += 1
        else:
            keys.append(last)
            last += 1
    return keys + [last]
