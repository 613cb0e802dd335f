// SPDX-License-Identifier: MIT
// Operations on boxes { least, size }: the box around both; one enlarged by a margin; the intersection, or null.

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
