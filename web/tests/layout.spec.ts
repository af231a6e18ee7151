// From phones to 4K, light and dark: everything is inside the window and large enough to be used.
// The pictures in test-results/ are for looking at.
import { expect } from "@playwright/test";
import { type Screen, demo, test } from "./viewer";

const windows = [
  { width: 390, height: 844, colorScheme: "dark" },
  { width: 844, height: 390, colorScheme: "light" },
  { width: 820, height: 1180, colorScheme: "light" },
  { width: 1280, height: 800, colorScheme: "dark" },
  { width: 1280, height: 800, colorScheme: "light" },
  { width: 3840, height: 2160, colorScheme: "dark" },
] as const;

/** Names of what is cut off by the window or has no room. */
function misplaced({ page }: Screen): Promise<string[]> {
  return page.evaluate(() => {
    const faults: string[] = [];
    for (const element of document.querySelectorAll("main button, main input, [role=tab]")) {
      const box = element.getBoundingClientRect();
      if (getComputedStyle(element).display === "none" || !element.checkVisibility()) continue;
      const inside =
        box.left >= 0 && box.top >= 0 && box.right <= innerWidth && box.bottom <= innerHeight;
      const name = element.getAttribute("aria-label") ?? element.textContent;
      if (!inside || box.width < 24 || box.height < 16) {
        faults.push(`${name}: ${box.x}, ${box.y}, ${box.width} x ${box.height}`);
      }
    }
    return faults;
  });
}

for (const { colorScheme, ...viewport } of windows) {
  const name = `${viewport.width}x${viewport.height}-${colorScheme}`;
  test.describe(name, () => {
    test.use({ viewport, colorScheme });

    test("has room for everything", async ({ screen, view }, info) => {
      const { page } = screen;
      // Of 4K the full picture may take its time.
      test.slow();
      await screen.open(await view([`${demo}/silica.json`]));
      for (const deed of ["Hide the panel", "Show the panel"]) {
        const button = page.locator(".toolbar").getByRole("button", { name: deed });
        if (await button.isVisible()) await button.click();
        // The picture follows the window's new division after a moment.
        await page.waitForTimeout(400);
        await screen.atRest();
        expect(await misplaced(screen)).toEqual([]);
        await page.screenshot({ path: info.outputPath(`${name}-${deed.slice(0, 4)}.png`) });
      }
      await expect(page.getByRole("tab", { name: "Fields" })).toBeVisible();
      const slider = (await page.getByRole("slider", { name: "Time step" }).boundingBox())!;
      expect(slider.width).toBeGreaterThan(60);
    });
  });
}
