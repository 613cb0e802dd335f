// SPDX-License-Identifier: MIT
// The run inside the page: a JSON element that lists the frames, and one element for each block of data. Blocks are
// decoded on demand (blocks.js) and cached. The layout is described in ../README.md.

import {
  BrokenData, readBlock, require, unpack32, unpack8, unpackIndices, unpackLevels, unpackPoints,
} from "./blocks.js";
import { clipped, diagonal, grown, joined } from "./boxes.js";
import { readMeta } from "./meta.js";

const kCacheBytes = 64e6;
const kNear = 0.2; // margin around the cloth within which obstacles are shown, over the box's diagonal
const kWhole = 1.5; // diagonal of an obstacle that a view contains whole, over that of the cloth's boxes
const kLit = 4; // the same of an obstacle whose whole shadow is drawn
const kFloor = 1.5; // horizontal sizes of an obstacle that is the ground, over those of the cloth's boxes
const kFall = 1; // distance below the view down to which the ground follows falling cloth, over the view's diagonal
const kWay = 2; // distance from its start, in cloth sizes, up to which cloth without obstacles is followed

/**
 * Groups the corners of faces that share a normal: the corners of one vertex, except across an EOL edge, where the
 * cloth is bent sharply. Returns one group for each corner (the vertex itself, or a number above all vertices) and the
 * number of groups.
 */
export function normalGroups(faces, edges, vertexCount) {
  const groups = faces.slice();
  if (edges.length === 0) return { groups, groupCount: vertexCount };
  const key = (a, b) => (a < b ? a * vertexCount + b : b * vertexCount + a);
  const sharp = new Set();
  const onSharp = new Uint8Array(vertexCount);
  for (let e = 0; e < edges.length; e += 2) {
    sharp.add(key(edges[e], edges[e + 1]));
    onSharp[edges[e]] = onSharp[edges[e + 1]] = 1;
  }

  // Corners that meet in an edge that is not sharp are in one group (union by the lower corner).
  const parent = new Map();
  const find = (corner) => {
    while (parent.get(corner) !== corner) corner = parent.get(corner);
    return corner;
  };
  const waiting = new Map();
  for (let c = 0; c < faces.length; ++c) if (onSharp[faces[c]]) parent.set(c, c);
  for (let face = 0; face < faces.length; face += 3) {
    for (let k = 0; k < 3; ++k) {
      const ends = [face + k, face + ((k + 1) % 3)];
      if (!ends.some((corner) => onSharp[faces[corner]])) continue;
      const edge = key(faces[ends[0]], faces[ends[1]]);
      if (sharp.has(edge)) continue;
      const other = waiting.get(edge);
      if (!other) {
        waiting.set(edge, ends);
        continue;
      }
      for (const corner of ends) {
        if (!onSharp[faces[corner]]) continue;
        const match = faces[other[0]] === faces[corner] ? other[0] : other[1];
        const [low, high] = [find(corner), find(match)].sort((a, b) => a - b);
        parent.set(high, low);
      }
    }
  }

  let groupCount = vertexCount;
  const groupOf = new Map();
  for (const corner of parent.keys()) {
    const root = find(corner);
    if (!groupOf.has(root)) groupOf.set(root, groupCount++);
    groups[corner] = groupOf.get(root);
  }
  return { groups, groupCount };
}

/** Writes the material coordinates u v of the listed `vertices`, m, relative to the least ones of the mesh. */
function unpackMaterial(bytes, offset, { size }, vertices, material) {
  const values = new Float32Array(vertices.length);
  for (let axis = 0; axis < 2; ++axis) {
    unpackLevels(bytes, offset + 2 * axis * vertices.length, 0, size[axis], values);
    vertices.forEach((vertex, i) => (material[2 * vertex + axis] = values[i]));
  }
}

/** Keeps decoded data up to a number of bytes and drops the least recently used data first. */
class Cache {
  #entries = new Map();
  #bytes = 0;

  get(key) {
    const entry = this.#entries.get(key);
    if (!entry) return undefined;
    this.#entries.delete(key);
    this.#entries.set(key, entry);
    return entry.value;
  }

  set(key, value, bytes) {
    this.#entries.set(key, { value, bytes });
    this.#bytes += bytes;
    for (const [old, entry] of this.#entries) {
      if (this.#bytes <= kCacheBytes || old === key) break;
      this.#entries.delete(old);
      this.#bytes -= entry.bytes;
    }
  }
}

export class Run {
  #document;
  #topologies;
  #cache = new Cache();
  #pending = new Map();

  constructor(document) {
    this.#document = document;
    const meta = readMeta(document);
    this.title = meta.title;
    this.framesPerSecond = meta.frames_per_second;
    this.runFrames = meta.run_frames;
    this.stride = meta.stride;
    this.strain = meta.strain;
    this.speed = { greatest: Math.max(...meta.frames.map(({ speed }) => speed)), typical: meta.typical_speed };
    this.hasEol = meta.topologies.some(({ edges, corners }) => edges + corners > 0);
    this.frames = meta.frames;
    this.#topologies = new Map(meta.topologies.map((topology) => [topology.id, topology]));
    this.bounds = meta.frames.reduce(joined);
    this.origin = this.bounds.least.map((least, axis) => least + this.bounds.size[axis] / 2);
    this.meshes = meta.meshes;
    this.obstacles = this.meshes.filter(({ mark }) => !mark);
    this.hasMarks = this.obstacles.length < this.meshes.length;
    this.leftOut = meta.left_out;
    this.stage = this.#computeStage();
    this.surroundings = this.#computeSurroundings();
  }

  /** The bounding box { least, size } of an obstacle in the `position`-th frame. */
  #meshBox(mesh, position) {
    const placement = mesh.placements[mesh.placements.length === 1 ? 0 : position];
    const { least, size } = mesh.poses?.[position] ?? { least: mesh.size.map((value) => -value / 2), size: mesh.size };
    const rows = [0, 1, 2].map((row) => placement.slice(4 * row, 4 * row + 4));
    const half = rows.map((row) => size.reduce((sum, value, axis) => sum + (Math.abs(row[axis]) * value) / 2, 0));
    const middle = rows.map((row) => least.reduce((sum, value, axis) => sum + row[axis] * (value + size[axis] / 2), row[3]));
    return { least: half.map((value, axis) => middle[axis] - value), size: half.map((value) => 2 * value) };
  }

  /** The last frame in which the cloth's box is within `reach` of an obstacle's box; -1 if there is none. */
  #lastNear(reach) {
    for (let position = this.frames.length - 1; position >= 0; --position) {
      const around = grown(this.frames[position], reach);
      if (this.obstacles.some((mesh) => clipped(this.#meshBox(mesh, position), around))) return position;
    }
    return -1;
  }

  /**
   * The box that the view shows of the cloth: its boxes in all frames until it has left the obstacles for good. If the
   * cloth never met an obstacle: its boxes near the first one. With the whole way of cloth that falls or flies off,
   * everything would be a dot.
   */
  #computeStage() {
    const sizes = this.frames.map((frame) => Math.hypot(...frame.size)).sort((a, b) => a - b);
    const size = sizes[sizes.length >> 1];
    const last = this.#lastNear(kNear * size);
    if (last >= 0) return this.frames.slice(0, last + 1).reduce(joined);
    const around = grown(this.frames[0], kWay * size);
    return this.frames.map((frame) => clipped(frame, around)).filter((box) => box).reduce(joined);
  }

  /** The stage and the parts of obstacles near it, in the first and the last frame: everything that a view shows. */
  #computeSurroundings() {
    const around = grown(this.stage, kNear * Math.hypot(...this.stage.size));
    return [0, this.frames.length - 1].flatMap((position) => this.#obstaclesNear(around, position))
      .reduce(joined, this.stage);
  }

  /** Boxes of the `meshes` near `around`: whole up to `whole` times the cloth's diagonal, else the near part. */
  #obstaclesNear(around, position, meshes = this.obstacles, whole = kWhole) {
    return meshes.flatMap((mesh) => {
      const box = this.#meshBox(mesh, position);
      const near = clipped(box, around);
      if (!near) return [];
      return [diagonal(box) < whole * diagonal(this.stage) ? box : near];
    });
  }

  /** The boxes that the first view contains: the cloth in some frames, and the obstacles near it but for a floor. */
  viewBoxes() {
    const step = Math.max(1, Math.floor(this.frames.length / 32));
    const cloth = this.frames.filter((_, position) => position % step === 0).map((box) => clipped(box, this.stage));
    const around = grown(this.stage, kNear * diagonal(this.stage));
    return [...cloth.filter((box) => box), ...[0, this.frames.length - 1].flatMap((position) =>
      this.#obstaclesNear(around, position, this.#standing()))];
  }

  /** Whether the cloth ends in a vessel, such as a bowl: within the box of an obstacle that is no taller than wide. */
  endsInVessel() {
    const last = this.frames.length - 1;
    const { least, size } = this.frames[last];
    return this.obstacles.some((mesh) => {
      const box = this.#meshBox(mesh, last);
      const isBelow = (axis) => least[axis] + size[axis] <= box.least[axis] + box.size[axis];
      const isTall = box.size[2] > Math.max(box.size[0], box.size[1]); // a body in its clothes
      return !isTall && [0, 1, 2].every((axis) => least[axis] >= box.least[axis] && isBelow(axis));
    });
  }

  /** The box of all that casts a shadow in view in the `position`-th frame. */
  litBox(position) {
    const around = grown(joined(this.frames[position], this.stage), kNear * diagonal(this.stage));
    return this.#obstaclesNear(around, position, this.#standing(), kLit).reduce(joined, this.frames[position]);
  }

  /** How far the cloth's middle has left the stage in the `position`-th frame: a vector, m. The view follows by it. */
  drift(position) {
    const { least, size } = this.frames[position];
    return least.map((value, axis) => {
      const middle = value + size[axis] / 2;
      const low = this.stage.least[axis];
      return middle - Math.min(Math.max(middle, low), low + this.stage.size[axis]);
    });
  }

  /** Whether an obstacle is flat and far wider than the cloth's stage. */
  #isFloor(mesh) {
    const { size } = this.#meshBox(mesh, 0);
    return [0, 1].every((axis) => size[axis] > kFloor * this.stage.size[axis]) &&
      size[2] < Math.min(size[0], size[1]) / 3;
  }

  /** The obstacles but for floors. */
  #standing() {
    return this.obstacles.filter((mesh) => !this.#isFloor(mesh));
  }

  /**
   * Height of the ground, m: the lowest point of the view, or of cloth that falls a little further. null if an
   * obstacle is the ground, or the cloth falls through every place where a ground could be.
   */
  groundHeight() {
    const view = this.surroundings;
    const lowest = this.bounds.least[2];
    if (this.obstacles.some((mesh) => this.#isFloor(mesh)) || lowest < view.least[2] - kFall * diagonal(view)) return null;
    return Math.min(lowest, view.least[2]);
  }

  /** An obstacle's placement in the `position`-th frame: 3 x 4 numbers by rows, relative to `origin`. */
  placement(mesh, position) {
    const placement = [...mesh.placements[mesh.placements.length === 1 ? 0 : position]];
    for (let row = 0; row < 3; ++row) placement[4 * row + 3] -= this.origin[row];
    return placement;
  }

  /**
   * An obstacle's points about the middle of its box, its faces, segments and lone points. One that deforms has its
   * points in the frames (load). BrokenData has its name.
   */
  async loadMesh(index) {
    const { name, points, faces, segments, lone_points: lonePoints, poses } = this.meshes[index];
    try {
      const indexCount = 3 * faces + 2 * segments + lonePoints;
      const stored = poses ? 0 : points;
      const bytes = await readBlock(this.#document, `arris-mesh-${index}`, 4 * (3 * stored + indexCount));
      const axes = new Float32Array(unpack32(bytes, 3 * stored).buffer);
      const positions = new Float32Array(3 * points);
      for (let p = 0; p < stored; ++p)
        for (let axis = 0; axis < 3; ++axis) positions[3 * p + axis] = axes[axis * points + p];
      const indices = unpackIndices(bytes.subarray(12 * stored), indexCount);
      require(indices.every((point) => point < points), "it names points that do not exist");
      return {
        name, positions, faces: indices.subarray(0, 3 * faces),
        segments: indices.subarray(3 * faces, 3 * faces + 2 * segments),
        lonePoints: indices.subarray(3 * faces + 2 * segments),
      };
    } catch (error) {
      const reason = error instanceof BrokenData ? error.message : `its data are damaged: ${error.message}`;
      throw new BrokenData(`The obstacle ${name} cannot be shown: ${reason}.`);
    }
  }

  time(position) {
    return this.frames[position].index / this.framesPerSecond;
  }

  /** Position of the last frame in the page that is not after `time`. */
  positionAt(time) {
    const index = time * this.framesPerSecond + 1e-6; // a frame's own time finds that frame
    let [low, high] = [0, this.frames.length - 1];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.frames[middle].index <= index) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  /** Position of the frame in the page that is nearest to the run's frame `index`. */
  positionOf(index) {
    const position = this.positionAt(index / this.framesPerSecond);
    const next = this.frames[position + 1];
    return next && next.index - index < index - this.frames[position].index ? position + 1 : position;
  }

  /** A decoded frame if it is in the cache, otherwise undefined. */
  peek(position) {
    return this.#cache.get(`f${position}`);
  }

  /** Decodes a frame. Rejects with a BrokenData that names the frame. */
  load(position) {
    const there = this.peek(position);
    if (there) return Promise.resolve(there);
    return this.#once(`f${position}`, async () => {
      try {
        return await this.#decode(position);
      } catch (error) {
        const reason = error instanceof BrokenData ? error.message : `its data are damaged: ${error.message}`;
        throw new BrokenData(`Frame ${this.frames[position].index} cannot be shown: ${reason}.`);
      }
    });
  }

  #once(key, make) {
    if (!this.#pending.has(key))
      this.#pending.set(key, make().finally(() => this.#pending.delete(key)));
    return this.#pending.get(key);
  }

  async #decode(position) {
    const entry = this.frames[position];
    const topology = await this.#topology(entry.topology);
    const n = topology.vertices;
    const m = topology.faces.length / 3;
    const bytes = await readBlock(this.#document, `arris-frame-${entry.index}`, 
      7 * n + 2 * m + ((n + 7) >> 3) + 4 * topology.moving.length);

    const least = entry.least.map((value, axis) => value - this.origin[axis]);
    const positions = unpackPoints(bytes, { least, size: entry.size }, n);
    const strain = new Float32Array(m);
    unpackLevels(bytes, 6 * n, entry.strain[0], entry.strain[1], strain);
    let at = 6 * n + 2 * m;
    const contact = bytes.slice(at, (at += (n + 7) >> 3));
    const material = topology.material.slice();
    unpackMaterial(bytes, at, topology, topology.moving, material);
    const speed = unpack8(bytes, at + 4 * topology.moving.length, n, entry.speed / 255);

    const poses = await Promise.all(this.meshes.map((_, index) => this.#decodePose(index, position)));
    const frame = { topology, positions, strain, contact, material, speed, poses };
    const arrays = [positions, strain, contact, material, speed, ...poses.filter((pose) => pose)];
    this.#cache.set(`f${position}`, frame, arrays.reduce((sum, { byteLength }) => sum + byteLength, 0));
    return frame;
  }

  /** Points of an obstacle about the point that its placement maps; null if it does not deform. */
  async #decodePose(index, position) {
    const { name, points, poses } = this.meshes[index];
    if (!poses) return null;
    try {
      const id = `arris-pose-${index}-${this.frames[position].index}`;
      return unpackPoints(await readBlock(this.#document, id, 6 * points), poses[position], points);
    } catch (error) {
      throw new BrokenData(`the points of the obstacle ${name} are damaged: ${error.message}`);
    }
  }

  async #topology(id) {
    const there = this.#cache.get(`t${id}`);
    if (there) return there;
    return this.#once(`t${id}`, async () => {
      const entry = this.#topologies.get(id);
      const [faces, edges] = [3 * entry.faces, 2 * entry.edges];
      const count = faces + edges + entry.corners;
      const bytes = await readBlock(this.#document, `arris-topology-${id}`, 4 * (count + entry.vertices));
      const indices = unpackIndices(bytes, count);
      require(indices.every((vertex) => vertex < entry.vertices), "its mesh names vertices that do not exist");
      const topology = {
        vertices: entry.vertices,
        faces: indices.subarray(0, faces),
        edges: indices.subarray(faces, faces + edges),
        corners: indices.subarray(faces + edges),
        moving: [...new Set(indices.subarray(faces))].sort((a, b) => a - b),
        material: new Float32Array(2 * entry.vertices),
        least: entry.least,
        size: entry.size,
      };
      const all = Array.from({ length: entry.vertices }, (_, vertex) => vertex);
      unpackMaterial(bytes, 4 * count, topology, all, topology.material);
      Object.assign(topology, normalGroups(topology.faces, topology.edges, entry.vertices));
      this.#cache.set(`t${id}`, topology, 2 * indices.byteLength + topology.material.byteLength);
      return topology;
    });
  }
}
