import { describe, expect, it } from "vitest";
import type { Camera, Vector } from "../protocol/scene";
import {
  basisOf,
  between,
  lookAlong,
  orbit,
  pan,
  pointAt,
  project,
  roll,
  viewHeight,
  withFov,
  withOtherProjection,
  zoom,
} from "./camera";
import { cross, dot, length, subtract } from "./vector";

const perspective: Camera = { eye: [3, 4, -10], target: [1, 2, 3], up: [0, 1, 0], fov: 40 };
const parallel: Camera = { eye: [3, 4, -10], target: [1, 2, 3], up: [0, 1, 0], orthographic: 8 };
const place = { x: 0.3, y: -0.2 };

function expectNear(a: Vector, b: Vector) {
  expect(length(subtract(a, b))).toBeLessThan(1e-9);
}

function expectSeenAt(camera: Camera, point: Vector, where: { x: number; y: number }) {
  const seen = project(camera, point);
  expect(seen?.x).toBeCloseTo(where.x, 9);
  expect(seen?.y).toBeCloseTo(where.y, 9);
}

describe("basis", () => {
  it("is that of the renderer: X = F x up, Y = X x F", () => {
    const { right, up, forward } = basisOf(perspective);
    expectNear(cross(right, forward), up);
    expect(dot(up, [0, 1, 0])).toBeGreaterThan(0);
    expect(dot(right, cross(forward, [0, 1, 0]))).toBeGreaterThan(0);
  });
});

describe("orbit", () => {
  it("keeps the target, the distance and up", () => {
    const turned = orbit(perspective, 0.7, 0.3);
    expect(turned.target).toEqual(perspective.target);
    expect(turned.up).toEqual(perspective.up);
    expect(basisOf(turned).distance).toBeCloseTo(basisOf(perspective).distance, 9);
  });

  it("moves what is in front with the pointer", () => {
    // A point nearer than the target goes where the pointer goes.
    const front: Vector = [1.5, 2.5, -2];
    const before = project(perspective, front)!;
    const right = project(orbit(perspective, 0.1, 0), front)!;
    expect(right.x).toBeGreaterThan(before.x);
    const down = project(orbit(perspective, 0, 0.1), front)!;
    expect(down.y).toBeLessThan(before.y);
  });

  it("stops at the poles and comes back", () => {
    let camera = perspective;
    for (let i = 0; i < 50; ++i) camera = orbit(camera, 0.01, 0.2);
    const { forward, right } = basisOf(camera);
    expect(forward[1]).toBeCloseTo(-1, 3);
    expect(length(right)).toBeCloseTo(1, 9);
    expect(basisOf(orbit(camera, 0, -1)).forward[1]).toBeGreaterThan(-0.6);
  });
});

describe("roll", () => {
  it("turns the picture counterclockwise", () => {
    const point = pointAt(perspective, { x: 0.2, y: 0 });
    expectSeenAt(roll(perspective, Math.PI / 2), point, { x: 0, y: 0.2 });
  });
});

describe.each([
  ["perspective", perspective],
  ["parallel", parallel],
])("%s", (_, camera) => {
  it("projects where it points", () => {
    expectSeenAt(camera, pointAt(camera, place), place);
  });

  it("zooms towards the pointer", () => {
    const point = pointAt(camera, place);
    const closer = zoom(camera, 0.5, place);
    expectSeenAt(closer, point, place);
    expect(viewHeight(closer)).toBeCloseTo(0.5 * viewHeight(camera), 9);
  });

  it("pans with the pointer", () => {
    const point = pointAt(camera, place);
    const to = { x: -0.1, y: 0.4 };
    expectSeenAt(pan(camera, place, to), point, to);
  });

  it("changes its projection without changing its size", () => {
    const other = withOtherProjection(camera);
    expect(viewHeight(other)).toBeCloseTo(viewHeight(camera), 9);
    expect((other.fov === undefined) !== (camera.fov === undefined)).toBe(true);
  });

  it("interpolates from end to end", () => {
    const end = lookAlong(camera, [0, 0, 1], [0, 1, 0]);
    expect(between(camera, end, 1)).toBe(end);
    expectNear(between(camera, end, 0).eye, camera.eye);
    expect(basisOf(between(camera, end, 0.4)).distance).toBeCloseTo(basisOf(camera).distance, 9);
  });
});

it("changes the field of view without changing the size", () => {
  const wide = withFov(perspective, 90);
  expect(wide.fov).toBe(90);
  expect(viewHeight(wide)).toBeCloseTo(viewHeight(perspective), 9);
});

it("sees nothing behind the eye", () => {
  expect(project(perspective, [3, 4, -20])).toBeNull();
});
