// How the camera moves: a turntable about the target that keeps `up`, shifts, zooms towards a point, rolls.
import type { Camera, Vector } from "../protocol/scene";
import {
  add,
  cross,
  dot,
  length,
  mixed,
  normalized,
  rotated,
  scaled,
  slerp,
  subtract,
} from "./vector";

/** A place in the picture, in heights of the picture: x to the right and y upwards from the middle. */
export interface Place {
  x: number;
  y: number;
}

export interface Basis {
  right: Vector;
  up: Vector;
  forward: Vector;
  distance: number;
}

const defaultFov = 45;
const radians = Math.PI / 180;
// `up` and the view may not be parallel: the turntable stops this short of its poles.
const leastPolarAngle = 0.5 * radians;

export const centre: Place = { x: 0, y: 0 };

export function basisOf(camera: Camera): Basis {
  const view = subtract(camera.target, camera.eye);
  const forward = normalized(view);
  const right = normalized(cross(forward, camera.up));
  return { right, up: cross(right, forward), forward, distance: length(view) };
}

/** Height of what is seen at the target's depth, in the data's unit of length. */
export function viewHeight(camera: Camera): number {
  if (camera.orthographic !== undefined) return camera.orthographic;
  const distance = length(subtract(camera.target, camera.eye));
  return 2 * distance * Math.tan(((camera.fov ?? defaultFov) * radians) / 2);
}

/** The point under a place of the picture, at the target's depth. */
export function pointAt(camera: Camera, place: Place): Vector {
  const { right, up } = basisOf(camera);
  const height = viewHeight(camera);
  return add(camera.target, add(scaled(right, place.x * height), scaled(up, place.y * height)));
}

/** Turns by angles in radians: what is seen follows a pointer that moves to the right and down. */
export function orbit(camera: Camera, toRight: number, down: number): Camera {
  const axis = normalized(camera.up);
  const turned = rotated(subtract(camera.eye, camera.target), axis, -toRight);
  const polar = Math.acos(Math.min(1, Math.max(-1, dot(normalized(turned), axis))));
  const wanted = Math.min(Math.PI - leastPolarAngle, Math.max(leastPolarAngle, polar - down));
  const right = normalized(cross(axis, turned));
  return { ...camera, eye: add(camera.target, rotated(turned, right, wanted - polar)) };
}

/** Turns the picture about its middle, counterclockwise, by an angle in radians. */
export function roll(camera: Camera, angle: number): Camera {
  const { forward } = basisOf(camera);
  return { ...camera, up: rotated(normalized(camera.up), forward, angle) };
}

/** Shifts so that what is at the target's depth follows the pointer. */
export function pan(camera: Camera, from: Place, to: Place): Camera {
  const shift = subtract(pointAt(camera, from), pointAt(camera, to));
  return { ...camera, eye: add(camera.eye, shift), target: add(camera.target, shift) };
}

/** Scales what is seen by 1/factor; the point under `place` stays there. */
export function zoom(camera: Camera, factor: number, place: Place): Camera {
  const point = pointAt(camera, place);
  if (camera.orthographic !== undefined) {
    const shift = scaled(subtract(point, camera.target), 1 - factor);
    return {
      ...camera,
      eye: add(camera.eye, shift),
      target: add(camera.target, shift),
      orthographic: camera.orthographic * factor,
    };
  }
  return {
    ...camera,
    eye: mixed(point, camera.eye, factor),
    target: mixed(point, camera.target, factor),
  };
}

/** Looks at another point from the same side and distance. */
export function lookAt(camera: Camera, target: Vector): Camera {
  const shift = subtract(target, camera.target);
  return { ...camera, eye: add(camera.eye, shift), target };
}

/** Looks along a unit direction at the same target. */
export function lookAlong(camera: Camera, direction: Vector, up: Vector): Camera {
  const { distance } = basisOf(camera);
  return { ...camera, eye: subtract(camera.target, scaled(direction, distance)), up };
}

/** The other projection, with what is at the target's depth as large as before. */
export function withOtherProjection(camera: Camera): Camera {
  const { eye, target, up } = camera;
  if (camera.orthographic === undefined) {
    return { eye, target, up, orthographic: viewHeight(camera) };
  }
  const distance = camera.orthographic / (2 * Math.tan((defaultFov * radians) / 2));
  const { forward } = basisOf(camera);
  return { eye: subtract(target, scaled(forward, distance)), target, up, fov: defaultFov };
}

/** Another field of view, with what is at the target's depth as large as before. */
export function withFov(camera: Camera, fov: number): Camera {
  const distance = viewHeight(camera) / (2 * Math.tan((fov * radians) / 2));
  const { forward } = basisOf(camera);
  return { ...camera, fov, eye: subtract(camera.target, scaled(forward, distance)) };
}

/** On the way from a to b: the target straight, the view along a great circle. */
export function between(a: Camera, b: Camera, t: number): Camera {
  if (t >= 1) return b;
  const from = basisOf(a);
  const to = basisOf(b);
  const target = mixed(a.target, b.target, t);
  const forward = slerp(from.forward, to.forward, t);
  const distance = from.distance ** (1 - t) * to.distance ** t;
  // From the vectors that are upright in the picture: they cannot become parallel to the view.
  const up = slerp(from.up, to.up, t);
  const camera: Camera = { ...b, eye: subtract(target, scaled(forward, distance)), target, up };
  if (a.orthographic !== undefined && b.orthographic !== undefined) {
    camera.orthographic = a.orthographic ** (1 - t) * b.orthographic ** t;
  }
  return camera;
}

/** Where a point is seen; null behind the eye. */
export function project(camera: Camera, point: Vector): Place | null {
  const { right, up, forward } = basisOf(camera);
  const offset = subtract(point, camera.eye);
  const depth = dot(offset, forward);
  if (depth <= 0) return null;
  const height =
    camera.orthographic ?? 2 * depth * Math.tan(((camera.fov ?? defaultFov) * radians) / 2);
  return { x: dot(offset, right) / height, y: dot(offset, up) / height };
}
