// Files that were sent to the server have temporary paths there, DIR/NUMBER/NAME. People know them by
// their names, beside which a saved scene lies, too.
import type { Scene } from "../protocol/scene";

/** The text with all such paths made names. `folder`: DIR; empty: there are none. */
export function plainNames(text: string, folder: string): string {
  if (!folder) return text;
  const [first = "", ...others] = text.split(`${folder}/`);
  return [first, ...others.map((part) => part.replace(/^\d+\//, ""))].join("");
}

export function withPlainNames(scene: Scene, folder: string): Scene {
  return JSON.parse(JSON.stringify(scene), (_, value: unknown) =>
    typeof value === "string" ? plainNames(value, folder) : value,
  ) as Scene;
}
