// What takes long can be cancelled: loading a file, sending one.
import { readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { gzipSync } from "node:zlib";
import { expect } from "@playwright/test";
import { test, zeolite } from "./viewer";

/** So many atoms on a lattice, as XYZ. */
function atoms(count: number): string {
  const side = Math.ceil(Math.cbrt(count));
  const lines = Array.from(
    { length: count },
    (_, i) => `O ${i % side} ${Math.floor(i / side) % side} ${Math.floor(i / side ** 2)}`,
  );
  return `${count}\n\n${lines.join("\n")}\n`;
}

test("cancels loading", async ({ screen, view, folder }) => {
  const { page } = screen;
  writeFileSync(join(folder, "large.xyz.gz"), gzipSync(atoms(3_000_000), { level: 1 }));
  await screen.open(await view([zeolite, "--folder", folder]));
  await page.keyboard.press("Control+o");
  await page.getByRole("dialog").getByText("large.xyz.gz").click();
  const status = page.getByRole("status").filter({ has: page.locator(".work") });
  await expect(status).toContainText("large.xyz.gz");
  await status.getByRole("button", { name: "Cancel" }).click();
  await expect(page.locator(".work")).toHaveCount(0);
  // What was shown still is.
  await screen.change(() => screen.drag([200, 200], [260, 240]));
  await expect(screen.canvas).toHaveAccessibleName(/3494 particles/);
  await expect(page.locator(".banner.error")).toHaveCount(0);
});

test("cancels sending", async ({ screen, view, folder }) => {
  const { page } = screen;
  await screen.open(await view([zeolite], { TMPDIR: folder }));
  const network = await page.context().newCDPSession(page);
  await network.send("Network.enable");
  await network.send("Network.emulateNetworkConditions", {
    offline: false,
    latency: 0,
    downloadThroughput: -1,
    uploadThroughput: 200_000,
  });
  const sent = () => {
    const [uploads = ""] = readdirSync(folder).filter((name) => name.startsWith("motes-view-"));
    return readdirSync(join(folder, uploads), { recursive: true });
  };
  await page.keyboard.press("Control+o");
  await page.getByLabel("File from this computer").setInputFiles({
    name: "large.xyz",
    mimeType: "text/plain",
    buffer: Buffer.from(atoms(500_000)),
  });
  const status = page.getByRole("status").filter({ has: page.locator(".work") });
  await expect(status).toContainText("Sending large.xyz");
  await expect.poll(sent).toHaveLength(2);
  await status.getByRole("button", { name: "Cancel" }).click();
  await expect(page.locator(".work")).toHaveCount(0);
  // Nothing of it stays on the server.
  await expect.poll(sent).toHaveLength(0);
  await expect(screen.canvas).toHaveAccessibleName(/3494 particles/);
  await expect(page.locator(".banner.error")).toHaveCount(0);
});
