// Tests of the page in Chromium against the real program: npm run test:browser
//   MOTES_PROGRAM   the program; default: ../build/release/motes
//   MOTES_PAGE      a page in place of the one that the program was built with, such as dist/index.html
//   MOTES_CHROMIUM  the browser; default: Debian's
import { defineConfig } from "@playwright/test";

export default defineConfig({
  testDir: "tests",
  // The renderer takes all cores.
  workers: 1,
  timeout: 90_000,
  expect: { timeout: 20_000 },
  reporter: "list",
  use: {
    viewport: { width: 640, height: 480 },
    launchOptions: {
      executablePath: process.env.MOTES_CHROMIUM ?? "/usr/bin/chromium",
      // A replaced page counts as one from outside, which may not open sockets to this machine.
      args: [
        "--no-sandbox",
        ...(process.env.MOTES_PAGE ? ["--disable-features=LocalNetworkAccessChecks"] : []),
      ],
    },
  },
});
