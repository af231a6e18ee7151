import { describe, expect, it } from "vitest";
import type { Scene } from "../protocol/scene";
import { plainNames, withPlainNames } from "./sent_files";

const folder = "/tmp/motes-view-a.b";

describe("plainNames", () => {
  it("leaves the names of files that were sent", () => {
    const text = `${folder}/12/run 7.xyz:3: expected 4, ${folder}/1/2/x`;
    expect(plainNames(text, folder)).toBe("run 7.xyz:3: expected 4, 2/x");
  });

  it("leaves other paths alone", () => {
    for (const text of ["/tmp/motes-view-aXb/1/x.xyz", "/data/1/x.xyz", ""]) {
      expect(plainNames(text, folder)).toBe(text);
    }
    expect(plainNames("/1/x", "")).toBe("/1/x");
  });
});

describe("withPlainNames", () => {
  it("reaches all paths of a scene", () => {
    const scene = {
      data: { path: `${folder}/1/a.xyz`, frame: 2 },
      fields: [{ name: "f", grid: { path: `${folder}/2/b.cube` } }],
    } as unknown as Scene;
    expect(withPlainNames(scene, folder)).toEqual({
      data: { path: "a.xyz", frame: 2 },
      fields: [{ name: "f", grid: { path: "b.cube" } }],
    });
  });
});
