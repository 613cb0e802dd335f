// SPDX-License-Identifier: MIT
// Operations on boxes { least, size }: the box around both; one enlarged by a margin; the intersection, or null; one read.

export function joined(a, b) {
  const least = a.least.map((value, axis) => Math.min(value, b.least[axis]));
  const size = least.map((value, axis) =>
    Math.max(a.least[axis] + a.size[axis], b.least[axis] + b.size[axis]) - value);
  return { least, size };
}

export function grown({ least, size }, margin) {
  return { least: least.map((value) => value - margin), size: size.map((value) => value + 2 * margin) };
}

export const diagonal = ({ size }) => Math.hypot(...size);

export function clipped(a, b) {
  const least = a.least.map((value, axis) => Math.max(value, b.least[axis]));
  const size = least.map((value, axis) =>
    Math.min(a.least[axis] + a.size[axis], b.least[axis] + b.size[axis]) - value);
  return size.every((value) => value >= 0) ? { least, size } : null;
}

/** The box around two opposite corners, given as the text "x,y,z,x,y,z"; undefined if it is not that. */
export function boxOf(text) {
  const words = (text ?? "").split(",");
  if (words.length !== 6 || words.some((word) => word.trim() === "" || !Number.isFinite(Number(word)))) return undefined;
  const [one, other] = [words.slice(0, 3).map(Number), words.slice(3).map(Number)];
  const least = one.map((value, axis) => Math.min(value, other[axis]));
  return { least, size: least.map((value, axis) => Math.max(one[axis], other[axis]) - value) };
}
