// Editing: transfer functions, styles, light; undo and redo; faults lead back; others see it.
import { expect } from "@playwright/test";
import { Screen, demo, test, zeolite } from "./viewer";

const zeoliteScene = `${demo}/zeolite.json`;

// Wide enough for the panel.
test.use({ viewport: { width: 1100, height: 700 } });

test("edits a transfer function", async ({ screen, view }) => {
  const { page } = screen;
  await screen.open(await view([zeoliteScene]));
  const points = async () => (await screen.savedScene()).scene.fields[0]!.transfer_function.points;
  const before = await points();
  const first = await screen.picture();

  // A press beside the curve adds a point, which the same press drags.
  const editor = (await page.locator(".editor").first().boundingBox())!;
  const x = editor.x + editor.width * 0.73;
  await screen.change(() => screen.drag([x, editor.y + 30], [x + 5, editor.y + 20]));
  const added = await points();
  const second = await screen.picture();
  expect(added).toHaveLength(before.length + 1);
  expect(second.equals(first)).toBe(false);

  // By keyboard.
  await page.locator(".editor-point.selected").first().focus();
  await screen.change(() => page.keyboard.press("ArrowDown"));
  expect(await points()).not.toEqual(added);
  await page.locator(".editor-point.selected").first().focus();
  await screen.change(() => page.keyboard.press("Delete"));
  expect(await points()).toHaveLength(before.length);

  await screen.canvas.focus();
  await screen.change(() => page.keyboard.press("Control+z"));
  await screen.change(() => page.keyboard.press("Control+z"));
  expect(await points()).toEqual(added);
  expect((await screen.picture()).equals(second)).toBe(true);
  await screen.canvas.focus();
  await screen.change(() => page.keyboard.press("Control+z"));
  expect(await points()).toEqual(before);
  expect((await screen.picture()).equals(first)).toBe(true);
  await screen.canvas.focus();
  await screen.change(() => page.keyboard.press("Control+Shift+Z"));
  expect(await points()).toEqual(added);
});

test("takes a colour map and hides a field", async ({ screen, view }) => {
  const { page } = screen;
  await screen.open(await view([zeoliteScene]));
  await page.getByRole("button", { name: "Colours" }).first().click();
  await screen.change(() => page.getByRole("menuitem", { name: "magma" }).click());
  const { points } = (await screen.savedScene()).scene.fields[0]!.transfer_function;
  expect(points[0]!.color).toMatch(/^#00000[34]$/);

  const shown = await screen.picture();
  await screen.change(() =>
    page
      .getByRole("button", { name: /^Hide / })
      .and(page.locator(".section *"))
      .first()
      .click(),
  );
  expect((await screen.savedScene()).scene.fields[0]!.visible).toBe(false);
  expect((await screen.picture()).equals(shown)).toBe(false);
  await screen.change(() =>
    page
      .getByRole("button", { name: /^Show / })
      .last()
      .click(),
  );
  expect((await screen.picture()).equals(shown)).toBe(true);
});

test("changes the style and comes back", async ({ screen, view }) => {
  const { page } = screen;
  await screen.open(await view([zeoliteScene]));
  const before = (await screen.savedScene()).scene;
  await screen.change(() => page.getByRole("button", { name: "Sticks" }).click());
  const types = (await screen.savedScene()).scene.geometry!.map(({ type }) => type);
  expect(new Set(types)).toEqual(new Set(["spheres", "sticks"]));
  await screen.change(() => page.getByRole("button", { name: "Volume" }).click());
  const after = (await screen.savedScene()).scene;
  expect(after.geometry ?? []).toEqual([]);
  expect(after.fields.map(({ transfer_function }) => transfer_function)).toEqual(
    before.fields.map(({ transfer_function }) => transfer_function),
  );
});

test("says what is wrong with an expression and goes back", async ({ screen, view }) => {
  const { page } = screen;
  await screen.open(await view([zeoliteScene]));
  const expression = page.getByLabel("Only particles for which this holds").first();
  await expression.fill("z >");
  await expression.press("Enter");
  await expect(page.getByRole("status").getByText(/expression/)).toBeVisible();
  await expect(expression).toHaveValue("");
  await screen.change(async () => {
    await expression.fill("z > 20");
    await expression.press("Enter");
  });
  await expect(expression).toHaveValue("z > 20");
});

test("changes background and light", async ({ screen, view }) => {
  const { page } = screen;
  await screen.open(await view([zeolite]));
  await page.getByRole("tab", { name: "Light" }).click();
  await screen.change(() => page.getByRole("button", { name: "White" }).click());
  expect((await screen.savedScene()).scene.render.background).toMatch(/^(#ffffff|white)$/);
  await screen.change(() => page.getByRole("slider", { name: "Ambient", exact: true }).fill("300"));
  const lights = async () => (await screen.savedScene()).scene.render.lighting.lights;
  const one = await screen.picture();
  await screen.change(() => page.getByRole("button", { name: "Another light" }).click());
  expect(await lights()).toEqual([{}, { direction: expect.any(Array), intensity: 0.5 }]);
  expect((await screen.picture()).equals(one)).toBe(false);
  await screen.change(() => page.getByText("at the camera").last().click());
  expect(await lights()).toEqual([{}, { intensity: 0.5 }]);
  await screen.change(() => page.getByRole("button", { name: "Remove light 2" }).click());
  expect((await screen.picture()).equals(one)).toBe(true);
  await screen.change(() => page.getByRole("switch", { name: "Lighting" }).click());
});

test("shares a scene between viewers, each with its own camera", async ({
  screen,
  view,
  context,
}) => {
  const viewer = await view([zeolite]);
  await screen.open(viewer);
  const other = new Screen(await context.newPage());
  await other.open(viewer);
  const isWhite = async () => (await other.savedScene()).scene.render.background !== "#000000";

  await screen.page.bringToFront();
  await screen.change(() => screen.drag([200, 200], [300, 200]));
  await screen.page.getByRole("tab", { name: "Light" }).click();
  await screen.change(() => screen.page.getByRole("button", { name: "White" }).click());
  const mine = await screen.savedScene();

  await other.page.bringToFront();
  await expect.poll(isWhite).toBe(true);
  expect((await other.savedScene()).scene.camera.eye).not.toEqual(mine.scene.camera.eye);

  // Following shows the other's view.
  await other.page.getByRole("tab", { name: "Info" }).click();
  await other.change(() => other.page.getByRole("button", { name: "Follow" }).click());
  expect((await other.savedScene()).scene.camera).toEqual(mine.scene.camera);
  expect(other.faults).toEqual([]);
});

test("edits the scene as text", async ({ screen, view }) => {
  const { page } = screen;
  await screen.open(await view([zeolite]));
  const open = async () => {
    await page.getByRole("button", { name: "Save and share" }).click();
    await page.getByRole("menuitem", { name: "Edit scene as text" }).click();
  };
  await open();
  const text = page.getByRole("textbox", { name: "Scene" });
  const scene = JSON.parse(await text.inputValue()) as { kernel: { support_factor: number } };
  await text.fill("{");
  await page.getByRole("button", { name: "Apply" }).click();
  await expect(page.getByRole("alert")).toBeVisible();
  scene.kernel.support_factor = 3;
  await text.fill(JSON.stringify(scene));
  await screen.change(() => page.getByRole("button", { name: "Apply" }).click());
  await open();
  expect(JSON.parse(await text.inputValue())).toMatchObject({ kernel: { support_factor: 3 } });
});
