// Files: what is saved is what is shown, on the command line too; opening, sending.
import { execFileSync } from "node:child_process";
import { copyFileSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { type Page, expect } from "@playwright/test";
import { demo, program, renderScene, test, zeolite } from "./viewer";

async function choose(page: Page, item: string): Promise<void> {
  await page.getByRole("button", { name: "Save and share" }).click();
  await page.getByRole("menuitem", { name: item }).click();
}

async function savePicture(page: Page): Promise<Buffer> {
  const download = page.waitForEvent("download");
  await page.getByRole("dialog").getByRole("button", { name: "Save", exact: true }).click();
  return readFileSync(await (await download).path());
}

test("saves a scene and a picture that the command line makes too", async ({
  screen,
  view,
  folder,
}) => {
  await screen.open(await view([zeolite]));
  await screen.change(() => screen.drag([200, 200], [280, 260]));
  const scene = join(folder, "saved.json");
  copyFileSync((await screen.savedScene()).path, scene);
  const rendered = join(folder, "rendered.png");
  renderScene(scene, rendered);
  expect((await screen.picture()).equals(readFileSync(rendered))).toBe(true);

  await choose(screen.page, "Save picture");
  const picture = await savePicture(screen.page);
  expect(picture.equals(readFileSync(rendered))).toBe(true);
});

test("saves a picture of another size", async ({ screen, view }) => {
  await screen.open(await view([zeolite]));
  await choose(screen.page, "Save picture");
  const dialog = screen.page.getByRole("dialog");
  await dialog.getByRole("textbox", { name: "Width" }).fill("300");
  await dialog.getByRole("textbox", { name: "Height" }).fill("200");
  await dialog.getByText("NPY").click();
  const array = (await savePicture(screen.page)).toString("latin1");
  expect(array.slice(0, 200)).toContain("(200, 300, 4)");
});

test("gives the line for a terminal", async ({ screen, view, folder }) => {
  await screen.open(await view([zeolite]));
  await choose(screen.page, "Copy command line");
  const line = await screen.page.getByRole("textbox", { name: "Command line" }).inputValue();
  const shell = `motes() { ${JSON.stringify(program)} "$@"; }\n${line}`;
  execFileSync("sh", ["-c", shell], { cwd: folder, stdio: "inherit" });
  const rendered = readFileSync(join(folder, "zeolite_mfi_3494.png"));
  expect((await screen.picture()).equals(rendered)).toBe(true);
});

test("loads a scene", async ({ screen, view, folder }) => {
  const { page } = screen;
  await screen.open(await view([zeolite]));
  const { scene } = await screen.savedScene();
  scene.render.background = "#ffffff";
  scene.camera.eye[0]! += 10;
  const path = join(folder, "changed.json");
  writeFileSync(path, JSON.stringify(scene));
  await page.getByRole("button", { name: "zeolite_mfi_3494.xyz" }).click();
  await screen.change(() => page.getByLabel("File from this computer").setInputFiles(path));
  const loaded = (await screen.savedScene()).scene;
  expect(loaded.render.background).not.toBe("#000000");
  expect(loaded.camera.eye[0]).toBeCloseTo(scene.camera.eye[0]!, 4);
});

test("opens a file of the folder", async ({ screen, view }) => {
  const { page } = screen;
  await screen.open(await view([zeolite]));
  await page.keyboard.press("Control+o");
  await page.getByRole("dialog").getByText("silica.json").click();
  await expect(page).toHaveTitle(/silica/, { timeout: 60_000 });
  await screen.atRest();
  const slider = page.getByRole("slider", { name: "Time step" });
  await expect(slider).toHaveAttribute("max", "9");
});

test("takes a file that is sent to it", async ({ screen, view, folder }) => {
  const { page } = screen;
  await screen.open(await view([`${demo}/silica.json`]));
  await page.keyboard.press("Control+o");
  await page.getByLabel("File from this computer").setInputFiles(zeolite);
  await expect(page).toHaveTitle(/zeolite_mfi_3494/, { timeout: 60_000 });
  await screen.atRest();
  await expect(screen.canvas).toHaveAccessibleName(/3494 particles/);
  // What is kept of it works beside the user's own file, and here.
  const { path, scene } = await screen.savedScene();
  expect(scene.data.path).toBe("zeolite_mfi_3494.xyz");
  copyFileSync(path, join(folder, "scene.json"));
  copyFileSync(zeolite, join(folder, "zeolite_mfi_3494.xyz"));
  renderScene(join(folder, "scene.json"), join(folder, "rendered.png"));
  const rendered = readFileSync(join(folder, "rendered.png"));
  expect((await screen.picture()).equals(rendered)).toBe(true);
  await page.getByRole("button", { name: "zeolite_mfi_3494.xyz" }).click();
  scene.render.background = "#ffffff";
  writeFileSync(join(folder, "scene.json"), JSON.stringify(scene));
  await screen.change(() =>
    page.getByLabel("File from this computer").setInputFiles(join(folder, "scene.json")),
  );
  expect((await screen.savedScene()).scene.render.background).toBe("#ffffff");
});

test("names a file that was sent as its user does", async ({ screen, view, folder }) => {
  const { page } = screen;
  await screen.open(await view([zeolite]));
  const broken = join(folder, "broken.xyz");
  writeFileSync(broken, "3\n\nC 0 0 0\n");
  await page.keyboard.press("Control+o");
  await page.getByLabel("File from this computer").setInputFiles(broken);
  const status = page.getByRole("status").filter({ hasText: "broken.xyz:" });
  await expect(status).toBeVisible();
  await expect(status).not.toContainText("/");
});

test("takes a scene that is dropped on it", async ({ screen, view }) => {
  const { page } = screen;
  await screen.open(await view([zeolite]));
  const { scene } = await screen.savedScene();
  scene.render.background = "#ffffff";
  const drop = async (text: string) => {
    const transfer = await page.evaluateHandle((content) => {
      const files = new DataTransfer();
      files.items.add(new File([content], "scene.json", { type: "application/json" }));
      return files;
    }, text);
    await page.dispatchEvent("body", "dragover", { dataTransfer: transfer });
    await expect(page.getByText("Drop to open")).toBeVisible();
    await page.dispatchEvent("body", "drop", { dataTransfer: transfer });
  };
  await drop("no scene");
  await expect(page.getByRole("status")).toContainText("expected a scene");
  await screen.change(() => drop(JSON.stringify(scene)));
  expect((await screen.savedScene()).scene.render.background).not.toBe("#000000");
});
