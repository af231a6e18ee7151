// The command line that makes the picture on the page: the scene goes to it as a here-document.
import type { Scene } from "../protocol/scene";

/** A word for a POSIX shell. */
export function quoted(word: string): string {
  return /^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", `'\\''`)}'`;
}

/** The scene as a file, arrays of numbers on one line. */
export function sceneText(scene: Scene): string {
  // Only the layout has line breaks: in texts JSON escapes them.
  const numbers = /\[\n\s*((?:-?\d[\d.e+-]*,\n\s*)*-?\d[\d.e+-]*)\n\s*\]/g;
  return JSON.stringify(scene, null, 2).replace(
    numbers,
    (_, list: string) => `[${list.replace(/\s+/g, " ")}]`,
  );
}

export function renderLine(scene: Scene, picture: string): string {
  // JSON has no line that is EOF, and quoting EOF keeps the shell from reading into the text.
  return `motes render - -o ${quoted(picture)} <<'EOF'\n${sceneText(scene)}\nEOF\n`;
}
