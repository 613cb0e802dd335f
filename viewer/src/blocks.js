// SPDX-License-Identifier: MIT
// Decodes the blocks of data in the page: base64 of zlib of differences and planes of bytes. The layout is described
// in ../README.md.

/** An error in the data, in words for the person who opened the page. */
export class BrokenData extends Error {}

export function require(condition, what) {
  if (!condition) throw new BrokenData(what);
}

function fromBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** Decompresses `compressed`, which must hold exactly `length` bytes. */
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

export async function readBlock(document, id, length) {
  const element = document.getElementById(id);
  require(element, "its data are missing; the file may be cut off");
  return inflate(fromBase64(element.textContent), length);
}

/** Decodes 16-bit numbers stored as differences, with all high bytes before all low bytes. */
function unpack16(bytes, offset, count, result) {
  let value = 0;
  for (let i = 0; i < count; ++i) {
    value = (value + ((bytes[offset + i] << 8) | bytes[offset + count + i])) & 0xffff;
    result[i] = value;
  }
}

const kLevels = 65535;

/** Decodes `values.length` levels as values of their range. */
export function unpackLevels(bytes, offset, least, size, values) {
  const levels = new Uint16Array(values.length);
  unpack16(bytes, offset, levels.length, levels);
  for (let i = 0; i < levels.length; ++i) values[i] = least + (size / kLevels) * levels[i];
}

/** Decodes x of all points, y, z: levels in the box { least, size }. */
export function unpackPoints(bytes, { least, size }, count) {
  const positions = new Float32Array(3 * count);
  const values = new Float32Array(count);
  for (let axis = 0; axis < 3; ++axis) {
    unpackLevels(bytes, 2 * count * axis, least[axis], size[axis], values);
    for (let p = 0; p < count; ++p) positions[3 * p + axis] = values[p];
  }
  return positions;
}

/** Decodes bytes stored as differences, times `scale`. */
export function unpack8(bytes, offset, count, scale) {
  const result = new Float32Array(count);
  let value = 0;
  for (let i = 0; i < count; ++i) {
    value = (value + bytes[offset + i]) & 0xff;
    result[i] = scale * value;
  }
  return result;
}

/** Decodes 32-bit numbers stored in four planes of bytes, the highest first. */
export function unpack32(bytes, count) {
  const result = new Uint32Array(count);
  for (let i = 0; i < count; ++i)
    result[i] = (bytes[i] << 24) | (bytes[count + i] << 16) | (bytes[2 * count + i] << 8) | bytes[3 * count + i];
  return result;
}

/** Decodes vertex numbers stored as zigzag differences. */
export function unpackIndices(bytes, count) {
  const result = unpack32(bytes, count);
  let value = 0;
  for (let i = 0; i < count; ++i) {
    value += (result[i] >>> 1) ^ -(result[i] & 1);
    result[i] = value;
  }
  return result;
}
