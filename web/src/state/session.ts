// Who this page is to the server, who else is there, and what the server is at.
import { computed, signal } from "@preact/signals";
import { connectionState, onMessage, send } from "../protocol/connection";
import type { ClientState, ServerMessageOf } from "../protocol/messages";
import { plainNames } from "../scene/sent_files";
import { notify, sentFolder } from "./notices";

export const hello = signal<ServerMessageOf<"hello"> | null>(null);
export const clients = signal<ClientState[]>([]);
/** What the server is working at for long enough to say so. */
export const progress = signal<{ activity: string; fraction: number | null } | null>(null);

export const colorMaps = computed(() => hello.value?.color_maps ?? {});
export const connected = computed(() => connectionState.value.kind === "open");

/** The client whose view this page shows in place of its own. */
export const following = computed(
  () => clients.value.find(({ client }) => client === hello.value?.client)?.following ?? null,
);

export function follow(client: number | null): void {
  send({ type: "follow", client });
}

onMessage("hello", (message) => {
  hello.value = message;
  sentFolder.value = message.uploads;
  progress.value = null;
});
onMessage("clients", (message) => {
  clients.value = message.clients;
});
onMessage("progress", ({ activity, fraction }) => {
  progress.value = { activity: plainNames(activity, sentFolder.peek()), fraction };
});
onMessage("ready", () => {
  progress.value = null;
});
onMessage("warnings", ({ lines }) => {
  for (const line of lines) notify("warning", line);
});
