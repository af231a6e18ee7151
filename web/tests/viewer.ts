// `motes view` for a test, and the page that shows it.
import { type ChildProcess, execFileSync, spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { type Locator, type Page, expect, test as base } from "@playwright/test";

export const program = resolve(process.env.MOTES_PROGRAM ?? "../build/release/motes");
export const demo = resolve("../data/demo");
export const zeolite = `${demo}/zeolite_mfi_3494.xyz`;

/** A server that has begun to listen. */
export class Viewer {
  private constructor(
    private readonly server: ChildProcess,
    readonly address: URL,
  ) {}

  static async start(args: string[], environment: Record<string, string> = {}): Promise<Viewer> {
    const server = spawn(program, ["view", ...args], {
      env: { ...process.env, ...environment },
      stdio: ["ignore", "pipe", "inherit"],
    });
    let printed = "";
    const address = await new Promise<string>((found, failed) => {
      server.once("exit", (code) => failed(new Error(`motes view ended with ${code}`)));
      server.stdout.on("data", (text: Buffer) => {
        printed += text.toString();
        const match = /http:\/\/\S+(?=\s)/.exec(printed);
        if (match) found(match[0]);
      });
    });
    return new Viewer(server, new URL(address));
  }

  async stop(): Promise<void> {
    if (this.server.exitCode !== null || this.server.signalCode !== null) return;
    const ended = new Promise((done) => this.server.once("exit", done));
    this.server.kill("SIGINT");
    await ended;
  }
}

export interface SavedScene {
  data: { path: string; frame: number };
  camera: { eye: number[]; target: number[]; up: number[]; fov?: number; orthographic?: number };
  fields: {
    name: string;
    visible?: boolean;
    transfer_function: { points: { value: number; color: string; extinction: number }[] };
  }[];
  geometry?: { type: string }[];
  render: {
    size: number[];
    background: string;
    lighting: { lights?: { direction?: number[]; intensity?: number }[] };
  };
}

/** Has another page answered for the program's, under the same nonce. */
async function replacePage(page: Page, file: string): Promise<void> {
  await page.route(/\/\?token=/, async (route) => {
    const response = await route.fetch().catch(() => null);
    if (!response) return route.abort();
    const nonce = /nonce-([^']+)/.exec(response.headers()["content-security-policy"] ?? "")?.[1];
    const body = readFileSync(file, "utf8").replaceAll("{{nonce}}", nonce ?? "");
    return route.fulfill(response.ok() ? { response, body } : { response });
  });
}

/** The page as its user meets it. */
export class Screen {
  /** The lossless pictures that came through the present socket, as PNG by their numbers. */
  private readonly pictures = new Map<number, Buffer>();
  readonly faults: string[] = [];
  readonly canvas: Locator;

  constructor(readonly page: Page) {
    this.canvas = page.getByRole("application");
    page.on("pageerror", (error) => this.faults.push(error.message));
    page.on("console", (message) => {
      // What the browser says of a server that is gone is no fault of the page.
      if (message.type() === "error" && !message.text().includes("net::ERR")) {
        this.faults.push(message.text());
      }
    });
    page.on("websocket", (socket) => {
      this.pictures.clear();
      socket.on("framereceived", ({ payload }) => {
        if (typeof payload === "string" || payload.readUInt16LE(18) !== 1) return;
        this.pictures.set(payload.readUInt32LE(4), Buffer.from(payload.subarray(40)));
      });
    });
  }

  async open(viewer: Viewer): Promise<void> {
    if (process.env.MOTES_PAGE) await replacePage(this.page, process.env.MOTES_PAGE);
    await this.page.goto(viewer.address.href);
    await this.atRest();
  }

  /** Waits until the full picture is there and nothing follows it. */
  async atRest(): Promise<void> {
    let before = "";
    const isSettled = async () => {
      const now = await this.shown();
      const same = now === before;
      before = now;
      return same && now.startsWith("false");
    };
    await expect.poll(isSettled, { intervals: [400], timeout: 150_000 }).toBe(true);
  }

  /** Whether a fuller or newer picture is to come, and the number of the one that is shown. */
  private shown(): Promise<string> {
    return this.canvas.evaluate(({ ariaBusy, dataset }) => `${ariaBusy} ${dataset.frame}`);
  }

  /** The picture that is shown, at rest, as the server sent it: of that one hears later than the page. */
  async picture(): Promise<Buffer> {
    const id = Number(await this.canvas.getAttribute("data-frame"));
    await expect.poll(() => this.pictures.has(id)).toBe(true);
    return this.pictures.get(id)!;
  }

  /** Does something that changes the picture and waits for the new one. */
  async change(deed: () => Promise<unknown>): Promise<void> {
    const before = await this.shown();
    await deed();
    await expect.poll(() => this.shown()).not.toBe(before);
    await this.atRest();
  }

  async drag(from: [number, number], to: [number, number]): Promise<void> {
    await this.page.mouse.move(...from);
    await this.page.mouse.down();
    await this.page.mouse.move(...to, { steps: 8 });
    await this.page.mouse.up();
  }

  async savedScene(): Promise<{ path: string; scene: SavedScene }> {
    await this.page.getByRole("button", { name: "Save and share" }).click();
    const download = this.page.waitForEvent("download");
    await this.page.getByRole("menuitem", { name: "Save scene" }).click();
    const path = await (await download).path();
    return { path, scene: JSON.parse(readFileSync(path, "utf8")) as SavedScene };
  }
}

export function renderScene(scene: string, picture: string): void {
  execFileSync(program, ["render", scene, "-o", picture], { stdio: "inherit" });
}

interface Fixtures {
  screen: Screen;
  /** Starts a server, which ends with the test. */
  view: (args: string[], environment?: Record<string, string>) => Promise<Viewer>;
  /** Of this test alone. */
  folder: string;
}

export const test = base.extend<Fixtures>({
  screen: async ({ page }, use) => {
    const screen = new Screen(page);
    await use(screen);
    expect(screen.faults).toEqual([]);
  },
  view: async ({}, use) => {
    const started: Viewer[] = [];
    await use(async (args, environment) => {
      const viewer = await Viewer.start(args, environment);
      started.push(viewer);
      return viewer;
    });
    await Promise.all(started.map((viewer) => viewer.stop()));
  },
  folder: async ({}, use) => {
    const folder = mkdtempSync(join(tmpdir(), "motes-page-"));
    await use(folder);
    rmSync(folder, { recursive: true });
  },
});
