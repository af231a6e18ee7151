// Who may look, and what happens when the server goes away.
import { expect } from "@playwright/test";
import { test, zeolite } from "./viewer";

test("is refused without the token", async ({ page, view }) => {
  const { address } = await view([zeolite]);
  for (const search of ["", "?token=", "?token=0123456789abcdef"]) {
    const answer = await page.goto(new URL(search, address.origin + address.pathname).href);
    expect(answer!.status()).toBe(403);
    await expect(page.getByRole("application")).toHaveCount(0);
  }
  for (const path of ["picture", "socket"]) {
    const answer = await page.request.get(new URL(path, address).href);
    expect(answer.status()).toBe(403);
  }
});

test("connects again after the server has been restarted", async ({ screen, view }) => {
  const { page } = screen;
  const environment = { MOTES_VIEW_TOKEN: "0123456789abcdef0123456789abcdef" };
  const first = await view([zeolite], environment);
  await screen.open(first);
  await screen.change(() => screen.drag([200, 200], [300, 230]));
  const { camera } = (await screen.savedScene()).scene;
  const picture = await screen.picture();

  await first.stop();
  await expect(page.getByRole("status")).toContainText("Trying again");
  await screen.change(() => view([zeolite, "--port", first.address.port], environment));
  await expect(page.getByRole("status")).not.toContainText("Trying again");
  // The page still looks from where it did.
  expect((await screen.savedScene()).scene.camera).toEqual(camera);
  expect((await screen.picture()).equals(picture)).toBe(true);
});
