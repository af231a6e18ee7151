// Vectors of three numbers, as scene files write them.
import type { Vector } from "../protocol/scene";

export const add = (a: Vector, b: Vector): Vector => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scaled = (a: Vector, s: number): Vector => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (a: Vector): number => Math.hypot(...a);
export const normalized = (a: Vector): Vector => scaled(a, 1 / length(a));

export const cross = (a: Vector, b: Vector): Vector => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

export const mixed = (a: Vector, b: Vector, t: number): Vector =>
  add(scaled(a, 1 - t), scaled(b, t));

/** About a unit axis, by the right-hand rule (Rodrigues' formula). */
export function rotated(a: Vector, axis: Vector, angle: number): Vector {
  const c = Math.cos(angle);
  return add(
    add(scaled(a, c), scaled(cross(axis, a), Math.sin(angle))),
    scaled(axis, dot(axis, a) * (1 - c)),
  );
}

/** Some unit vector across a. */
export function anyAcross(a: Vector): Vector {
  const other: Vector = Math.abs(a[0]) < 0.7 * length(a) ? [1, 0, 0] : [0, 1, 0];
  return normalized(cross(a, other));
}

/** Between two unit vectors along their great circle. */
export function slerp(a: Vector, b: Vector, t: number): Vector {
  const angle = Math.acos(Math.min(1, Math.max(-1, dot(a, b))));
  if (angle < 1e-6) return b;
  const axis = Math.PI - angle < 1e-6 ? anyAcross(a) : normalized(cross(a, b));
  return rotated(a, axis, t * angle);
}
