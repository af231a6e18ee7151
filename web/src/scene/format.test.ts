import { expect, it } from "vitest";
import { formatBytes, formatNumber, logTicks, roundedDown, ticks } from "./format";

it.each([
  [0, "0"],
  [1.5, "1.5"],
  [0.33000001311302185, "0.33"],
  [-12345.6, "-12346"],
  [1e-5, "1e-5"],
  [2.5e10, "2.5e10"],
  [Number.NaN, "–"],
])("writes %d as %s", (value, text) => {
  expect(formatNumber(value)).toBe(text);
});

it("writes bytes", () => {
  expect(formatBytes(100)).toBe("100 B");
  expect(formatBytes(3.5 * 1024 ** 2)).toBe("3.50 MiB");
});

it("rounds down to 1, 2 or 5", () => {
  expect([0.19, 0.2, 7, 10, 4.99].map(roundedDown)).toEqual([0.1, 0.2, 5, 10, 2]);
});

it("finds round numbers of a range", () => {
  expect(ticks(0, 2.5, 5)).toEqual([0, 0.5, 1, 1.5, 2, 2.5]);
  expect(ticks(-0.13, 0.31, 4)).toEqual([0, 0.2]);
  expect(ticks(3, 3, 4)).toEqual([3]);
  expect(logTicks(0.05, 20)).toEqual([0.1, 1, 10]);
  expect(logTicks(1, 20)).toEqual([1, 2, 5, 10, 20]);
});
