import { expect, it } from "vitest";
import type { Scene } from "../protocol/scene";
import { lightsOf, newFieldName, setGeometry, setLights, styleOf, withStyle } from "./edit";

const points = { points: [{ value: 0, color: "#000000", extinction: 1 }] };
const volume: Scene = {
  version: 1,
  fields: [{ name: "a", transfer_function: points, isosurfaces: [] }],
};
const balls: Scene = { version: 1, fields: [], geometry: [{ type: "spheres" }] };
const surface: Scene = { version: 1, fields: [{ name: "surface", isosurfaces: [{ value: 0.5 }] }] };
const both: Scene = { ...volume, geometry: [{ type: "spheres" }, { type: "sticks" }] };

it("knows styles", () => {
  expect([volume, balls, surface, both].map(styleOf)).toEqual([
    "volume",
    "spheres",
    "surface",
    "volume+balls",
  ]);
});

it("brings the fields back that a style had taken away", () => {
  expect(withStyle(volume, "spheres", [])).toEqual({ version: 1, style: "spheres" });
  const back = withStyle(balls, "volume", [surface, volume, surface]);
  expect(back).toEqual({
    version: 1,
    style: "volume",
    fields: [{ name: "a", transfer_function: points }],
  });
  expect(withStyle(balls, "volume", [surface])).toEqual({ version: 1, style: "volume" });
});

it("makes surfaces of the grids that there are", () => {
  const grid: Scene = { version: 1, fields: [{ grid: { array: "a" }, transfer_function: points }] };
  const style = "surface";
  expect(withStyle({ ...grid, fields: [...grid.fields!, { name: "b" }] }, style, [])).toEqual({
    ...grid,
    style,
  });
  expect(withStyle(balls, style, [grid])).toEqual({ ...grid, style });
  expect(withStyle(volume, style, [])).toEqual({ version: 1, style });
  const surfaces = { ...surface, fields: [{ grid: "a", isosurfaces: [{ value: 1 }] }] };
  expect(styleOf({ ...surfaces, geometry: both.geometry })).toBe(style);
  expect(styleOf({ ...surface, geometry: both.geometry })).toBe(null);
});

it("leaves no empty geometry", () => {
  expect(setGeometry(() => [])(balls)).toEqual({ version: 1, fields: [] });
});

it("makes a list of the lights whichever way they are written", () => {
  expect(lightsOf({})).toEqual([{}]);
  expect(lightsOf({ direction: [1, 0, 0] })).toEqual([{ direction: [1, 0, 0] }]);
  expect(lightsOf({ lights: [] })).toEqual([]);
  const one: Scene = { version: 1, render: { lighting: { diffuse: 1, direction: [1, 0, 0] } } };
  const two = setLights((lights) => [...lights, { intensity: 0.5 }])(one);
  expect(two.render!.lighting).toEqual({
    diffuse: 1,
    lights: [{ direction: [1, 0, 0] }, { intensity: 0.5 }],
  });
});

it("finds free names", () => {
  expect(newFieldName([{ name: "all" }, { name: "all 2" }], "all")).toBe("all 3");
});
