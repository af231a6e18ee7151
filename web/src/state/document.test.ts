import { beforeEach, expect, it, vi } from "vitest";
import type { ClientMessage, ServerMessage } from "../protocol/messages";
import type { Scene } from "../protocol/scene";

// A server that answers when the test says so.
const server = vi.hoisted(() => ({
  sent: [] as ClientMessage[],
  handlers: new Map<string, (message: never) => void>(),
  sequence: 0,
}));
vi.mock("../protocol/connection", async () => {
  const { signal } = await import("@preact/signals");
  return {
    connectionState: signal({ kind: "open" }),
    nextSequence: () => ++server.sequence,
    onMessage: (type: string, handler: (message: never) => void) =>
      server.handlers.set(type, handler),
    send: (message: ClientMessage) => server.sent.push(message) > 0,
  };
});
vi.stubGlobal("requestAnimationFrame", () => 1);
vi.stubGlobal("cancelAnimationFrame", () => undefined);
vi.stubGlobal("window", { setTimeout });

const own = 3;
const data = { file: "a.xyz" };

function receive(message: object & { type: ServerMessage["type"] }): void {
  server.handlers.get(message.type)!(message as never);
}

/** Scenes that were sent, by what the tests change in them. */
function sentSteps(): (number | undefined)[] {
  return scenes().map(({ scene }) => scene.render?.step_size);
}

function scenes() {
  return server.sent.filter((message) => message.type === "scene");
}

function scene(step_size: number): Scene {
  return { version: 1, data: { path: "/a.xyz", frame: 0 }, render: { step_size } };
}

/** The answer to the newest scene that was sent. */
function answer(step_size: number): void {
  const { sequence } = scenes().at(-1)!;
  receive({ type: "scene", sequence, client: own, scene: scene(step_size), data } as never);
}

async function load() {
  vi.resetModules();
  server.sent.length = 0;
  const document = await import("./document");
  receive({ type: "hello", client: own } as never);
  receive({ type: "scene", sequence: null, client: null, scene: scene(1), data } as never);
  const set = (step_size: number) =>
    document.edit((old) => ({ ...old, render: { ...old.render, step_size } }));
  const shown = () => document.scene.value?.render?.step_size;
  return { ...document, set, shown };
}

let page: Awaited<ReturnType<typeof load>>;
beforeEach(async () => {
  page = await load();
});

it("shows an edit at once and takes what the server makes of it", () => {
  page.set(2);
  expect(page.shown()).toBe(2);
  expect(page.settled.value).toBe(false);
  answer(2.5);
  expect(page.shown()).toBe(2.5);
  expect(page.settled.value).toBe(true);
});

it("has one edit under way and sends the newest of those that wait", () => {
  for (const step of [2, 3, 4]) page.set(step);
  expect(sentSteps()).toEqual([2]);
  answer(2);
  expect(sentSteps()).toEqual([2, 4]);
  expect(page.shown()).toBe(4);
  answer(4);
  expect(page.settled.value).toBe(true);
});

it("goes back to what was agreed when an edit is refused", () => {
  page.set(2);
  answer(2);
  page.set(3);
  const { sequence } = scenes().at(-1)!;
  receive({ type: "error", sequence, message: "no" } as never);
  expect(page.shown()).toBe(2);
  expect(page.settled.value).toBe(true);
  page.undoEdit();
  expect(page.shown()).toBe(1);
});

it("keeps the edit before a refused one, though the second was sent late", () => {
  page.set(2);
  page.set(-1);
  answer(2);
  const { sequence } = scenes().at(-1)!;
  receive({ type: "error", sequence, message: "no" } as never);
  expect(page.shown()).toBe(2);
});

it("does not lose an edit to the refusal of a time step", () => {
  page.set(2);
  answer(2);
  page.showFrame(7);
  const { sequence } = scenes().at(-1)!;
  receive({ type: "error", sequence, message: "no such frame" } as never);
  expect(page.scene.value?.data?.frame).toBe(0);
  expect(page.shown()).toBe(2);
});

it("undoes edits, not time", () => {
  page.set(2);
  answer(2);
  page.showFrame(7);
  page.undoEdit();
  expect(page.shown()).toBe(1);
  expect(page.scene.value?.data?.frame).toBe(7);
});

it("takes over what others edit, as a step, but not while its own edit is under way", () => {
  const others = (step_size: number) =>
    receive({ type: "scene", sequence: 5, client: 4, scene: scene(step_size), data } as never);
  others(5);
  expect(page.shown()).toBe(5);
  page.undoEdit();
  expect(page.shown()).toBe(1);
  others(6);
  expect(page.shown()).toBe(1);
  answer(1);
  others(6);
  expect(page.shown()).toBe(6);
});

it("keeps its history when a restarted server opens the same data", () => {
  page.set(2);
  answer(2);
  const again = { type: "scene", sequence: null, client: null, new_data: true };
  receive({ ...again, scene: scene(1), data } as never);
  expect(page.shown()).toBe(1);
  page.undoEdit();
  expect(page.shown()).toBe(2);
});

it("forgets its history with other data", () => {
  page.set(2);
  answer(2);
  receive({
    type: "scene",
    sequence: null,
    client: own,
    scene: scene(9),
    data: { file: "b" },
  } as never);
  expect(page.shown()).toBe(9);
  expect(page.canUndo.value).toBe(false);
});
