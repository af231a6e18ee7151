// Short messages to the user; they go away by themselves, faults later than news.
import { signal } from "@preact/signals";
import { plainNames } from "../scene/sent_files";

export interface Notice {
  id: number;
  kind: "news" | "warning" | "error";
  text: string;
}

const lifeMs = { news: 4000, warning: 10000, error: 10000 };
const mostShown = 4;

export const notices = signal<Notice[]>([]);
let lastId = 0;

export function dismiss(id: number): void {
  notices.value = notices.value.filter((notice) => notice.id !== id);
}

/** Where the server keeps what was sent to it: not a name that anybody knows. */
export const sentFolder = signal("");

export function notify(kind: Notice["kind"], message: string): void {
  const text = plainNames(message, sentFolder.peek());
  const id = ++lastId;
  const others = notices.value.filter((notice) => notice.text !== text);
  notices.value = [...others, { id, kind, text }].slice(-mostShown);
  setTimeout(() => dismiss(id), lifeMs[kind]);
}
