// The socket to the server: sends and receives messages, and connects again by itself.
import { signal } from "@preact/signals";
import { address, socketAddress } from "./address";
import { type Frame, parseFrame } from "./frame";
import type { ClientMessage, ServerMessage, ServerMessageOf } from "./messages";

export type ConnectionState =
  | { kind: "connecting" }
  | { kind: "open" }
  | { kind: "waiting"; reason: string; retryAt: number }
  | { kind: "ended"; reason: string };

const firstDelayMs = 500;
const longestDelayMs = 8000;

export const connectionState = signal<ConnectionState>({ kind: "connecting" });

type Handler<T extends ServerMessage["type"]> = (message: ServerMessageOf<T>) => void;
const handlers = new Map<string, ((message: never) => void)[]>();
const frameHandlers: ((frame: Frame) => void)[] = [];

let socket: WebSocket | null = null;
let delayMs = firstDelayMs;
let retryTimer = 0;
let lastSequence = 0;

/** Views, scenes and picks are numbered together, upwards. */
export function nextSequence(): number {
  return ++lastSequence;
}

export function onMessage<T extends ServerMessage["type"]>(type: T, handler: Handler<T>): void {
  handlers.set(type, [...(handlers.get(type) ?? []), handler]);
}

export function onFrame(handler: (frame: Frame) => void): void {
  frameHandlers.push(handler);
}

/** Whether it went out: what is said without a connection is lost. */
export function send(message: ClientMessage): boolean {
  if (socket?.readyState !== WebSocket.OPEN) return false;
  socket.send(JSON.stringify(message));
  return true;
}

function receive(data: string | ArrayBuffer): void {
  if (typeof data === "string") {
    const message = JSON.parse(data) as ServerMessage;
    for (const handler of handlers.get(message.type) ?? []) handler(message as never);
    return;
  }
  const frame = parseFrame(data);
  if (!frame) return;
  // At once, before it is decoded: the server sends the next while this one is being drawn.
  send({ type: "ack", frame: frame.id });
  for (const handler of frameHandlers) handler(frame);
}

/** A refused socket looks like any other failure; asking for the page tells which it was. */
async function tokenIsRefused(): Promise<boolean> {
  try {
    const answer = await fetch(address(""), { cache: "no-store" });
    return answer.status === 401 || answer.status === 403;
  } catch {
    return false;
  }
}

function end(reason: string): void {
  connectionState.value = { kind: "ended", reason };
}

function wait(reason: string): void {
  connectionState.value = { kind: "waiting", reason, retryAt: Date.now() + delayMs };
  retryTimer = window.setTimeout(connect, delayMs);
  delayMs = Math.min(2 * delayMs, longestDelayMs);
}

async function closed(code: number, wasOpen: boolean): Promise<void> {
  const refused = "This address is not valid any more. Use the one that “motes view” has printed.";
  if (code === 4000) {
    end(
      wasOpen ? "The server has closed the connection: it did not understand this page." : refused,
    );
  } else if (code === 4001) {
    end("The server has as many viewers as it takes.");
  } else if (!wasOpen && (await tokenIsRefused())) {
    end(refused);
  } else {
    wait(code === 1001 ? "The server has ended." : "The server does not answer.");
  }
}

export function connect(): void {
  clearTimeout(retryTimer);
  connectionState.value = { kind: "connecting" };
  const current = new WebSocket(socketAddress());
  current.binaryType = "arraybuffer";
  socket = current;
  let wasOpen = false;
  current.onopen = () => {
    wasOpen = true;
    delayMs = firstDelayMs;
    connectionState.value = { kind: "open" };
  };
  current.onmessage = (event: MessageEvent<string | ArrayBuffer>) => receive(event.data);
  current.onclose = (event) => {
    if (socket !== current) return;
    socket = null;
    void closed(event.code, wasOpen);
  };
}
