// Looking: the picture comes, turns, zooms; particles are picked; trajectories play.
import { expect } from "@playwright/test";
import { demo, test, zeolite } from "./viewer";

function distance(a: number[], b: number[]): number {
  return Math.hypot(...a.map((c, i) => c - b[i]!));
}

test("shows the data and how to begin", async ({ screen, view }) => {
  await screen.open(await view([zeolite]));
  await expect(screen.page).toHaveTitle(/zeolite_mfi_3494\.xyz/);
  await expect(screen.page.getByText("Drag to turn")).toBeVisible();
  await expect(screen.canvas).toHaveAccessibleName(/3494 particles/);
  // Not one colour: something is drawn.
  const colors = await screen.canvas.evaluate((canvas: HTMLCanvasElement) => {
    const { data } = canvas.getContext("2d")!.getImageData(0, 0, canvas.width, canvas.height);
    return new Set(new Uint32Array(data.buffer)).size;
  });
  expect(colors).toBeGreaterThan(100);
});

test("turns, zooms, shifts and rolls", async ({ screen, view }) => {
  await screen.open(await view([zeolite]));
  const cameraNow = async () => (await screen.savedScene()).scene.camera;
  const start = await cameraNow();
  const first = await screen.picture();

  await screen.change(() => screen.drag([200, 200], [300, 230]));
  await expect(screen.page.getByText("Drag to turn")).toBeHidden();
  const turned = await cameraNow();
  expect(turned.target).toEqual(start.target);
  expect(turned.up).toEqual(start.up);
  expect(distance(turned.eye, turned.target)).toBeCloseTo(distance(start.eye, start.target), 4);
  expect(distance(turned.eye, start.eye)).toBeGreaterThan(1);
  expect((await screen.picture()).equals(first)).toBe(false);

  await screen.change(async () => {
    await screen.page.mouse.move(200, 200);
    await screen.page.mouse.wheel(0, -300);
  });
  const closer = await cameraNow();
  const ratio = distance(closer.eye, closer.target) / distance(turned.eye, turned.target);
  expect(ratio).toBeLessThan(0.8);

  await screen.page.keyboard.down("Shift");
  await screen.change(() => screen.drag([200, 200], [260, 200]));
  await screen.page.keyboard.up("Shift");
  expect(distance((await cameraNow()).target, closer.target)).toBeGreaterThan(0.1);

  await screen.canvas.focus();
  await screen.change(() => screen.page.keyboard.press("["));
  expect((await cameraNow()).up).not.toEqual(start.up);
  await screen.change(() => screen.page.keyboard.press("f"));
});

test("zooms and turns by two fingers", async ({ screen, view }) => {
  await screen.open(await view([zeolite]));
  const cameraNow = async () => (await screen.savedScene()).scene.camera;
  const start = await cameraNow();
  const client = await screen.page.context().newCDPSession(screen.page);
  const touch = (type: "touchStart" | "touchMove" | "touchEnd", places: [number, number][]) =>
    client.send("Input.dispatchTouchEvent", {
      type,
      touchPoints: places.map(([x, y], id) => ({ x, y, id })),
    });
  // About their middle, a quarter of a turn, clockwise, and twice as far apart.
  await screen.change(async () => {
    await touch("touchStart", [[280, 240]]);
    await touch("touchStart", [
      [280, 240],
      [360, 240],
    ]);
    for (let i = 1; i <= 10; ++i) {
      const x = 40 * (1 + i / 10) * Math.cos((i / 10) * (Math.PI / 2));
      const y = 40 * (1 + i / 10) * Math.sin((i / 10) * (Math.PI / 2));
      await touch("touchMove", [
        [320 - x, 240 - y],
        [320 + x, 240 + y],
      ]);
    }
    await touch("touchEnd", []);
  });
  const end = await cameraNow();
  const ratio = distance(end.eye, end.target) / distance(start.eye, start.target);
  expect(ratio).toBeCloseTo(0.5, 2);
  const forward = start.target.map(
    (c, i) => (c - start.eye[i]!) / distance(start.eye, start.target),
  );
  // What was up is at the right now.
  const along = (a: number[], b: number[]) => a.reduce((sum, c, i) => sum + c * b[i]!, 0);
  expect(along(end.up, forward)).toBeCloseTo(along(start.up, forward), 2);
  const across = (a: number[]) => a.map((c, i) => c - along(a, forward) * forward[i]!);
  expect(along(across(end.up), across(start.up))).toBeCloseTo(0, 1);
});

test("works by keyboard alone", async ({ screen, view }) => {
  const { page } = screen;
  await screen.open(await view([zeolite]));
  const press = async (...keys: string[]) => {
    for (const key of keys) await page.keyboard.press(key);
  };
  // From the picture through the tools to the second item of the menu "View".
  await screen.canvas.focus();
  for (let i = 0; i < 20; ++i) {
    await press("Tab");
    if (await page.getByRole("button", { name: "View" }).evaluate((b) => b.matches(":focus")))
      break;
  }
  await screen.change(() => press("Enter", "ArrowDown", "Enter"));
  const { camera } = (await screen.savedScene()).scene;
  expect(camera.fov).toBeUndefined();
  expect(camera.orthographic).toBeGreaterThan(0);
});

test("picks a particle and makes it the centre", async ({ screen, view }) => {
  await screen.open(await view([zeolite, "--style", "spheres"]));
  const box = (await screen.canvas.boundingBox())!;
  const start = (await screen.savedScene()).scene.camera;
  await screen.change(() =>
    screen.page.mouse.dblclick(box.x + box.width / 2 + 30, box.y + box.height / 2 + 20),
  );
  const card = screen.page.getByRole("region", { name: "Picked particle" });
  await expect(card.getByRole("heading", { level: 2 })).toHaveText(/^(Si|O|C|H) (id|place) \d+$/);
  const centred = (await screen.savedScene()).scene.camera;
  expect(distance(centred.target, start.target)).toBeGreaterThan(0.1);
  const shown = await card.locator("dd").first().textContent();
  expect(distance(shown!.split(", ").map(Number), centred.target)).toBeLessThan(0.05);
});

test("plays a trajectory", async ({ screen, view }) => {
  await screen.open(await view([`${demo}/silica.json`]));
  const slider = screen.page.getByRole("slider", { name: "Time step" });
  await expect(slider).toHaveAttribute("max", "9");
  await screen.change(() => slider.fill("0"));
  await screen.page.getByRole("button", { name: "Play" }).click();
  await expect.poll(async () => Number(await slider.inputValue())).toBeGreaterThan(2);
  await screen.page.getByRole("button", { name: "Pause" }).click();
  await screen.atRest();
  const frame = Number(await slider.inputValue());
  expect((await screen.savedScene()).scene.data.frame).toBe(frame);
});

test("plays by the space bar whatever the mouse has pressed", async ({ screen, view }) => {
  await screen.open(await view([`${demo}/silica.json`]));
  const loop = screen.page.getByRole("button", { name: "Loop" });
  const looped = await loop.getAttribute("aria-pressed");
  await loop.click();
  expect(await loop.getAttribute("aria-pressed")).not.toBe(looped);
  for (const shown of ["Pause", "Play"]) {
    await screen.page.keyboard.press("Space");
    await expect(screen.page.getByRole("button", { name: shown })).toBeVisible();
  }
  expect(await loop.getAttribute("aria-pressed")).not.toBe(looped);
  // Reached by keys, it is what they press.
  await screen.page.keyboard.press("Tab");
  await screen.page.keyboard.press("Shift+Tab");
  await screen.page.keyboard.press("Space");
  await expect(loop).toHaveAttribute("aria-pressed", looped!);
});

test("shows statistics on demand", async ({ screen, view }) => {
  await screen.open(await view([zeolite]));
  await screen.canvas.focus();
  await screen.page.keyboard.press("s");
  const card = screen.page.getByRole("region", { name: "Statistics" });
  await expect(card).toContainText("sweep");
  await expect(card).toContainText(/3.494/);
});
