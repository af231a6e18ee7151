import { describe, expect, it } from "vitest";
import type { TransferFunction } from "../protocol/scene";
import { linearOf } from "./color";
import {
  addPoint,
  extentOf,
  greatestExtinction,
  movePoint,
  removePoint,
  sample,
  withColorMap,
  widestGap,
  withGreatestExtinction,
  withRange,
  withScale,
} from "./transfer_function";

const ramp: TransferFunction = {
  points: [
    { value: 0, color: "#000000", extinction: 0 },
    { value: 1, color: "#ff0000", extinction: 2 },
    { value: 4, color: "#ffffff", extinction: 1 },
  ],
};
const axis = { min: 0, max: 4, scale: "linear" as const };

function values(transfer: TransferFunction) {
  return transfer.points.map((point) => point.value);
}

describe("sample", () => {
  it("is linear between points, colours in linear components", () => {
    const half = sample(ramp, 0.5);
    expect(half.extinction).toBeCloseTo(1, 12);
    expect(half.color[0]).toBeCloseTo(0.5, 12);
  });

  it("is linear in the logarithm on a logarithmic scale", () => {
    const log: TransferFunction = {
      scale: "log",
      points: [
        { value: 1, color: "#000000", extinction: 0 },
        { value: 100, color: "#ffffff", extinction: 2 },
      ],
    };
    expect(sample(log, 10).extinction).toBeCloseTo(1, 12);
  });

  it("stays beyond the ends", () => {
    expect(sample(ramp, -1).extinction).toBe(0);
    expect(sample(ramp, 9).extinction).toBe(1);
  });
});

describe("points", () => {
  it("stay in order when one is dragged past its neighbours", () => {
    const right = values(movePoint(ramp, 1, { value: 9, extinction: 1 }, axis));
    expect(right[1]).toBeLessThan(4);
    expect(right[1]).toBeGreaterThan(3.9);
    const left = values(movePoint(ramp, 1, { value: -9, extinction: 1 }, axis));
    expect(left[1]).toBeGreaterThan(0);
  });

  it("stay positive on a logarithmic scale", () => {
    const log = withScale(ramp, "log", 0.5);
    const moveTo = (value: number) =>
      values(movePoint(log, 0, { value, extinction: 0 }, extentOf(log)))[0];
    expect(moveTo(-2)).toBe(0.5);
    expect(moveTo(0.01)).toBe(0.01);
  });

  it("have no negative extinction", () => {
    const moved = movePoint(ramp, 1, { value: 1, extinction: -3 }, axis);
    expect(moved.points[1]!.extinction).toBe(0);
  });

  it("are added on the curve", () => {
    const added = addPoint(ramp, 2, axis)!;
    expect(added.index).toBe(2);
    expect(values(added.transfer)).toEqual([0, 1, 2, 4]);
    expect(sample(added.transfer, 1.5).extinction).toBeCloseTo(sample(ramp, 1.5).extinction, 12);
  });

  it("are added at both ends", () => {
    expect(addPoint(ramp, -1, axis)!.index).toBe(0);
    expect(addPoint(ramp, 5, axis)!.index).toBe(3);
  });

  it("are not added where there is one", () => {
    expect(addPoint(ramp, 1.0001, axis)).toBeNull();
  });

  it("are removed, but for the last", () => {
    expect(values(removePoint(ramp, 1))).toEqual([0, 4]);
    const one = { points: [ramp.points[0]!] };
    expect(removePoint(one, 0)).toBe(one);
  });

  it("have their widest gap found", () => {
    expect(widestGap(ramp, axis)).toBeCloseTo(2.5, 12);
  });
});

describe("as a whole", () => {
  it("is scaled to another greatest extinction", () => {
    const scaled = withGreatestExtinction(ramp, 6);
    expect(greatestExtinction(scaled)).toBe(6);
    expect(scaled.points[2]!.extinction).toBeCloseTo(3, 12);
  });

  it("becomes a ramp when it was 0", () => {
    const zero = withGreatestExtinction(ramp, 0);
    expect(withGreatestExtinction(zero, 2).points.map((p) => p.extinction)).toEqual([0, 1, 2]);
  });

  it("is stretched over another range", () => {
    expect(values(withRange(ramp, 10, 18))).toEqual([10, 12, 18]);
  });

  it("takes a map's colours and keeps its extinctions", () => {
    const map = Array.from(
      { length: 32 },
      (_, i) => `#0000${(8 * i).toString(16).padStart(2, "0")}`,
    );
    const colored = withColorMap(ramp, map);
    expect(colored.points.length).toBeGreaterThan(6);
    expect(colored.points[0]!.color).toBe(map[0]);
    expect(colored.points.at(-1)!.color).toBe(map[31]);
    for (const value of [0.2, 0.9, 1, 2, 3.3]) {
      expect(sample(colored, value).extinction).toBeCloseTo(sample(ramp, value).extinction, 9);
      // A map of 32 colours from 0 to 248: no place is off by more than its steps.
      const blue = linearOf(sample(colored, value).color)[2];
      expect(Math.abs(blue - linearOf(map[Math.round((value / 4) * 31)]!)[2])).toBeLessThan(0.06);
    }
  });

  it("has only positive values on a logarithmic scale", () => {
    const log = withScale(ramp, "log", 0.5);
    expect(values(log)).toEqual([0.5, 1, 4]);
    expect(log.points[0]!.extinction).toBeCloseTo(1, 12);
    expect(extentOf(log).scale).toBe("log");
    expect(values(withScale(log, "linear", 0))).toEqual([0.5, 1, 4]);
    expect(values(withScale(log, "log", 0.1))).toEqual([0.5, 1, 4]);
  });
});
