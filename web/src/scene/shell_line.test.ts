import { execFileSync } from "node:child_process";
import { expect, it } from "vitest";
import type { Scene } from "../protocol/scene";
import { quoted, renderLine, sceneText } from "./shell_line";

const scene: Scene = {
  version: 1,
  data: { path: 'it\'s $HOME `pwd` \\ "x" EOF\nEOF.xyz' },
  camera: { eye: [0, -1.5, 1e-7], target: [0, 0, 0], up: [0, 1, 0], fov: 45 },
  fields: [{ name: "[ 1, 2 ]", select: { expression: "z > 3 && species == 'Si'" } }],
};

it.each(["picture.png", "two words", "it's", "$HOME", "", "a;b"])("quotes %j", (word) => {
  // The empty word is no word unless quoted.
  expect(execFileSync("sh", ["-c", `printf %s ${quoted(word)}`], { encoding: "utf8" })).toBe(word);
});

it("keeps the scene and puts numbers on one line", () => {
  expect(JSON.parse(sceneText(scene))).toEqual(scene);
  expect(sceneText(scene)).toContain('"eye": [0, -1.5, 1e-7]');
});

it("gives the shell the scene as it is", () => {
  const line = renderLine(scene, "my picture.png");
  const shown = execFileSync("sh", ["-c", `motes() { printf '%s\\n' "$@"; cat; }\n${line}`], {
    encoding: "utf8",
  });
  const [command, input, option, picture, ...text] = shown.split("\n");
  expect([command, input, option, picture]).toEqual(["render", "-", "-o", "my picture.png"]);
  expect(JSON.parse(text.join("\n"))).toEqual(scene);
});
