// The server's folder, files that are sent to it, and scenes and pictures that are saved.
import { computed, signal } from "@preact/signals";
import { address } from "../protocol/address";
import { onMessage, send } from "../protocol/connection";
import type { FolderEntry } from "../protocol/messages";
import type { Scene } from "../protocol/scene";
import { plainNames, withPlainNames } from "../scene/sent_files";
import { renderLine, sceneText } from "../scene/shell_line";
import { data, loadScene, presentScene } from "./document";
import { notify, sentFolder } from "./notices";
import { hello } from "./session";

export const listing = signal<{ path: string; entries: FolderEntry[] } | null>(null);
export const upload = signal<{ name: string; fraction: number; cancel: () => void } | null>(null);

onMessage("listing", ({ path, entries }) => {
  listing.value = { path, entries };
});

/** The opened file's name without its suffixes, for the names of what is saved. */
export const baseName = computed(() => {
  const name = data.value?.file.split("/").at(-1) ?? "";
  return name.replace(/(\.\w{1,12})+$/, "") || "motes";
});

export const list = (path: string): boolean => send({ type: "list", path });
export const open = (path: string): boolean => send({ type: "open", path });
export const cancelOpening = (): boolean => send({ type: "cancel" });

export function saveBlob(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  // The browser has to have begun saving before the address may end.
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

/** What is shown, for the command line. */
function sceneToKeep(): Scene | null {
  const scene = presentScene();
  return scene && withPlainNames(scene, sentFolder.peek());
}

export function saveScene(): void {
  const scene = sceneToKeep();
  if (!scene) return;
  saveBlob(
    new Blob([`${sceneText(scene)}\n`], { type: "application/json" }),
    `${baseName.value}.json`,
  );
}

export function presentRenderLine(): string {
  const scene = sceneToKeep();
  return scene ? renderLine(scene, `${baseName.value}.png`) : "";
}

/** The picture as this page sees it, at full quality. Throws what the server says against it. */
export async function fetchPicture(
  size: { width: number; height: number },
  format: string,
  signal: AbortSignal,
): Promise<Blob> {
  const client = hello.value?.client ?? 0;
  const answer = await fetch(address("picture", { client, ...size, format }), { signal });
  if (!answer.ok) {
    const why = (await answer.text()).trim() || answer.statusText;
    throw new Error(plainNames(why, sentFolder.peek()));
  }
  return answer.blob();
}

/** A scene that was saved is taken as it is; everything else goes to the server. */
export async function openLocalFile(file: File): Promise<void> {
  if (file.name.toLowerCase().endsWith(".json")) {
    try {
      loadScene(JSON.parse(await file.text()) as Scene);
    } catch {
      notify("error", `${file.name}: expected a scene in JSON.`);
    }
    return;
  }
  sendFile(file);
}

function sendFile(file: File): void {
  upload.peek()?.cancel();
  const request = new XMLHttpRequest();
  const cancel = () => {
    request.abort();
    upload.value = null;
  };
  const fail = () => {
    upload.value = null;
    notify("error", `${file.name}: ${request.responseText.trim() || "sending failed"}.`);
  };
  request.upload.onprogress = ({ loaded, total }) => {
    upload.value = { name: file.name, fraction: loaded / Math.max(1, total), cancel };
  };
  request.onload = () => {
    if (request.status !== 200) return fail();
    upload.value = null;
    open((JSON.parse(request.responseText) as { path: string }).path);
  };
  request.onerror = fail;
  request.open("POST", address("upload", { name: file.name }));
  upload.value = { name: file.name, fraction: 0, cancel };
  request.send(file);
}
