// SPDX-License-Identifier: MIT
// The run inside the page: a JSON element that lists the frames, and one element a block of data, base64 of zlib.
// Blocks are decoded when they are asked for and kept while they fit. The layout is described in ../README.md.

const kFormat = 1;
const kCacheBytes = 64e6;
const kLevels = 65535;
const kNear = 0.2; // of the cloth's diagonal: obstacles are shown that far around it

/** What is wrong with the data, in words for the person who opened the page. */
export class BrokenData extends Error {}

function require(condition, what) {
  if (!condition) throw new BrokenData(what);
}

const isCount = (value) => Number.isSafeInteger(value) && value >= 0;
const isNumbers = (value, count) =>
  Array.isArray(value) && value.length === count && value.every((number) => Number.isFinite(number));

/** An obstacle: one placement where it never moves, else one a frame. */
function isMesh(mesh, frameCount) {
  return typeof mesh?.name === "string" && isCount(mesh.points) && mesh.points > 0 && isCount(mesh.faces) &&
    isCount(mesh.segments) && isCount(mesh.lone_points) && isNumbers(mesh.size, 3) && Array.isArray(mesh.placements) &&
    (mesh.placements.length === 1 || mesh.placements.length === frameCount) &&
    mesh.placements.every((placement) => isNumbers(placement, 12));
}

/** The JSON element, checked: nothing behind this function meets a value of another kind than the format says. */
function readMeta(document) {
  const element = document.getElementById("arris-meta");
  require(element, "There is no run in this page: it is the viewer's template, or it was cut off.");
  let meta;
  try {
    meta = JSON.parse(element.textContent);
  } catch (error) {
    throw new BrokenData(`The list of frames is not valid JSON (${error.message}).`);
  }
  require(meta.format === kFormat, `The data have format ${meta.format}; this page reads format ${kFormat}.`);
  require(typeof meta.title === "string", "The run has no title.");
  require(meta.frames_per_second > 0, "The number of frames a second is not positive.");
  require(isCount(meta.run_frames) && isCount(meta.stride), "The number of frames is missing.");
  require(Number.isFinite(meta.strain?.least) && Number.isFinite(meta.strain.greatest) &&
          Number.isFinite(meta.strain.typical), "The range of strains is missing.");
  require(Array.isArray(meta.topologies) && meta.topologies.every((topology) =>
    isCount(topology.id) && isCount(topology.vertices) && isCount(topology.faces) && isCount(topology.edges) && isCount(topology.corners)),
  "The list of meshes is damaged.");
  require(Array.isArray(meta.frames) && meta.frames.length > 0, "The run has no frames.");
  const known = new Set(meta.topologies.map((topology) => topology.id));
  for (const frame of meta.frames)
    require(isCount(frame.index) && known.has(frame.topology) &&
            isNumbers(frame.least, 3) && isNumbers(frame.size, 3) && isNumbers(frame.strain, 2),
    "The list of frames is damaged.");
  meta.meshes ??= [];
  meta.left_out ??= [];
  require(Array.isArray(meta.meshes) && meta.meshes.every((mesh) => isMesh(mesh, meta.frames.length)) &&
          Array.isArray(meta.left_out) && meta.left_out.every((name) => typeof name === "string"),
  "The list of obstacles is damaged.");
  return meta;
}

function fromBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** The `length` bytes that `compressed` must hold, no more and no less. */
async function inflate(compressed, length) {
  const bytes = new Uint8Array(length);
  const stream = new Blob([compressed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const reader = stream.getReader();
  let filled = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    require(filled + value.length <= length, "it holds more than its list says");
    bytes.set(value, filled);
    filled += value.length;
  }
  require(filled === length, "it holds less than its list says");
  return bytes;
}

async function readBlock(document, id, length) {
  const element = document.getElementById(id);
  require(element, "its data are missing; the file may be cut off");
  return inflate(fromBase64(element.textContent), length);
}

/** Differences of 16-bit numbers, high bytes before low ones; returns the numbers. */
function unpack16(bytes, offset, count, result) {
  let value = 0;
  for (let i = 0; i < count; ++i) {
    value = (value + ((bytes[offset + i] << 8) | bytes[offset + count + i])) & 0xffff;
    result[i] = value;
  }
}

/** Numbers of 32 bits in four planes of bytes, the highest first. */
function unpack32(bytes, count) {
  const result = new Uint32Array(count);
  for (let i = 0; i < count; ++i)
    result[i] = (bytes[i] << 24) | (bytes[count + i] << 16) | (bytes[2 * count + i] << 8) | bytes[3 * count + i];
  return result;
}

/** Zigzag differences of vertex numbers. */
function unpackIndices(bytes, count) {
  const result = unpack32(bytes, count);
  let value = 0;
  for (let i = 0; i < count; ++i) {
    value += (result[i] >>> 1) ^ -(result[i] & 1);
    result[i] = value;
  }
  return result;
}

/**
 * Which corners of faces share a normal: those of one vertex, except across an EOL edge, where the cloth is bent
 * sharply. Returns one group for each corner (the vertex itself, or a number above all vertices) and their number.
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

  // Corners that meet in an edge that is not sharp are of one group (union by the lower corner).
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

/** Keeps what was decoded while it fits into a number of bytes; drops first what was used longest ago. */
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
    this.frames = meta.frames;
    this.#topologies = new Map(meta.topologies.map((topology) => [topology.id, topology]));
    this.bounds = this.#computeBounds();
    this.origin = this.bounds.least.map((least, axis) => least + this.bounds.size[axis] / 2);
    this.meshes = meta.meshes;
    this.leftOut = meta.left_out;
    this.surroundings = this.#computeSurroundings();
  }

  /** The box { least, size } of an obstacle's box where the `position`-th frame has it. */
  #meshBox(mesh, position) {
    const placement = mesh.placements[mesh.placements.length === 1 ? 0 : position];
    const half = [0, 1, 2].map((row) =>
      mesh.size.reduce((sum, size, column) => sum + (Math.abs(placement[4 * row + column]) * size) / 2, 0));
    return { least: half.map((value, row) => placement[4 * row + 3] - value), size: half.map((value) => 2 * value) };
  }

  /** The cloth's box with what is near of the obstacles, at the first frame and at the last: all that a view shows. */
  #computeSurroundings() {
    const reach = kNear * Math.hypot(...this.bounds.size);
    const least = [...this.bounds.least];
    const most = least.map((value, axis) => value + this.bounds.size[axis]);
    const [low, high] = [least.map((value) => value - reach), most.map((value) => value + reach)];
    for (const mesh of this.meshes) {
      for (const position of [0, this.frames.length - 1]) {
        const box = this.#meshBox(mesh, position);
        const isNear = low.every((value, axis) =>
          box.least[axis] < high[axis] && box.least[axis] + box.size[axis] > value);
        if (!isNear) continue;
        for (let axis = 0; axis < 3; ++axis) {
          least[axis] = Math.min(least[axis], Math.max(box.least[axis], low[axis]));
          most[axis] = Math.max(most[axis], Math.min(box.least[axis] + box.size[axis], high[axis]));
        }
      }
    }
    return { least, size: most.map((value, axis) => value - least[axis]) };
  }

  /** Where the `position`-th frame has an obstacle: 3 x 4 numbers by rows, relative to `origin`. */
  placement(mesh, position) {
    const placement = [...mesh.placements[mesh.placements.length === 1 ? 0 : position]];
    for (let row = 0; row < 3; ++row) placement[4 * row + 3] -= this.origin[row];
    return placement;
  }

  /** An obstacle's points about the middle of its box, and its faces, segments and lone points; BrokenData names it. */
  async loadMesh(index) {
    const { name, points, faces, segments, lone_points: lonePoints } = this.meshes[index];
    try {
      const indexCount = 3 * faces + 2 * segments + lonePoints;
      const bytes = await readBlock(this.#document, `arris-mesh-${index}`, 4 * (3 * points + indexCount));
      const axes = new Float32Array(unpack32(bytes, 3 * points).buffer);
      const positions = new Float32Array(3 * points);
      for (let p = 0; p < points; ++p)
        for (let axis = 0; axis < 3; ++axis) positions[3 * p + axis] = axes[axis * points + p];
      const indices = unpackIndices(bytes.subarray(12 * points), indexCount);
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

  #computeBounds() {
    const least = [Infinity, Infinity, Infinity];
    const most = [-Infinity, -Infinity, -Infinity];
    for (const frame of this.frames) {
      for (let axis = 0; axis < 3; ++axis) {
        least[axis] = Math.min(least[axis], frame.least[axis]);
        most[axis] = Math.max(most[axis], frame.least[axis] + frame.size[axis]);
      }
    }
    return { least, size: most.map((value, axis) => value - least[axis]) };
  }

  time(position) {
    return this.frames[position].index / this.framesPerSecond;
  }

  /** The last kept frame not after `time`. */
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

  /** The kept frame that is nearest to the run's frame `index`. */
  positionOf(index) {
    const position = this.positionAt(index / this.framesPerSecond);
    const next = this.frames[position + 1];
    return next && next.index - index < index - this.frames[position].index ? position + 1 : position;
  }

  /** A decoded frame if it is there already, else undefined. */
  peek(position) {
    return this.#cache.get(`f${position}`);
  }

  /** A decoded frame. Rejects with BrokenData that names it. */
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
    const bytes = await readBlock(this.#document, `arris-frame-${entry.index}`, 6 * n + 2 * m + ((n + 7) >> 3));

    const positions = new Float32Array(3 * n);
    const levels = new Uint16Array(Math.max(n, m));
    for (let axis = 0; axis < 3; ++axis) {
      unpack16(bytes, 2 * n * axis, n, levels);
      const least = entry.least[axis] - this.origin[axis];
      const step = entry.size[axis] / kLevels;
      for (let v = 0; v < n; ++v) positions[3 * v + axis] = least + step * levels[v];
    }
    const strain = new Float32Array(m);
    unpack16(bytes, 6 * n, m, levels);
    for (let f = 0; f < m; ++f) strain[f] = entry.strain[0] + (entry.strain[1] / kLevels) * levels[f];
    const contact = bytes.slice(6 * n + 2 * m);

    const frame = { topology, positions, strain, contact };
    this.#cache.set(`f${position}`, frame, positions.byteLength + strain.byteLength + contact.byteLength);
    return frame;
  }

  async #topology(id) {
    const there = this.#cache.get(`t${id}`);
    if (there) return there;
    return this.#once(`t${id}`, async () => {
      const entry = this.#topologies.get(id);
      const [faces, edges] = [3 * entry.faces, 2 * entry.edges];
      const count = faces + edges + entry.corners;
      const indices = unpackIndices(await readBlock(this.#document, `arris-topology-${id}`, 4 * count), count);
      require(indices.every((vertex) => vertex < entry.vertices), "its mesh names vertices that do not exist");
      const topology = {
        vertices: entry.vertices,
        faces: indices.subarray(0, faces),
        edges: indices.subarray(faces, faces + edges),
        corners: indices.subarray(faces + edges),
      };
      Object.assign(topology, normalGroups(topology.faces, topology.edges, entry.vertices));
      this.#cache.set(`t${id}`, topology, indices.byteLength + topology.groups.byteLength);
      return topology;
    });
  }
}
