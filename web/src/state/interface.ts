// Which dialog is open.
import { signal } from "@preact/signals";

export type DialogName = "files" | "picture" | "command" | "text" | "help";

export const dialog = signal<DialogName | null>(null);
