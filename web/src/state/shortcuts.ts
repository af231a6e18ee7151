// Keys: one table for what they do and for the help that lists them.
import { withOtherProjection } from "../camera/camera";
import { orbitBy, panBy, rollBy, viewFrom, zoomBy } from "../camera/navigation";
import { redoEdit, undoEdit } from "./document";
import { saveScene } from "./files";
import { dialog } from "./interface";
import { isTrajectory, step, togglePlaying } from "./player";
import { hintSeen, panelOpen, showStatistics } from "./preferences";
import { camera, fit, glideTo } from "./view";

interface Shortcut {
  /** As KeyboardEvent.key has it, "Shift+" and "Control+" (or ⌘) before it. */
  keys: string[];
  /** For the help; those with the same text are one line there. */
  label: string;
  shown: string;
  run: () => void;
}

const turn = Math.PI / 36;
const shift = 0.05;
const zoomStep = 1.1;

const move = (keys: string[], run: () => void, label: string, shown: string): Shortcut => ({
  keys,
  label,
  shown,
  run: () => {
    hintSeen.value = true;
    run();
  },
});
const pan = (x: number, y: number) => panBy({ x: 0, y: 0 }, { x, y });

export function toggleProjection(): void {
  if (camera.peek()) glideTo(withOtherProjection(camera.peek()!));
}

export const shortcuts: Shortcut[] = [
  move(["ArrowLeft"], () => orbitBy(-turn, 0), "Turn", "← → ↑ ↓"),
  move(["ArrowRight"], () => orbitBy(turn, 0), "Turn", ""),
  move(["ArrowUp"], () => orbitBy(0, -turn), "Turn", ""),
  move(["ArrowDown"], () => orbitBy(0, turn), "Turn", ""),
  move(["Shift+ArrowLeft"], () => pan(-shift, 0), "Shift", "Shift + ← → ↑ ↓"),
  move(["Shift+ArrowRight"], () => pan(shift, 0), "Shift", ""),
  move(["Shift+ArrowUp"], () => pan(0, shift), "Shift", ""),
  move(["Shift+ArrowDown"], () => pan(0, -shift), "Shift", ""),
  move(["+", "=", "Shift++"], () => zoomBy(1 / zoomStep), "Zoom", "+ −"),
  move(["-", "Shift+_"], () => zoomBy(zoomStep), "Zoom", ""),
  move(["["], () => rollBy(turn), "Roll", "[ ]"),
  move(["]"], () => rollBy(-turn), "Roll", ""),
  { keys: ["f", "Home"], label: "Show everything", shown: "F", run: fit },
  { keys: ["x"], label: "Look along an axis", shown: "X Y Z", run: () => viewFrom(0, 1) },
  { keys: ["y"], label: "Look along an axis", shown: "", run: () => viewFrom(1, 1) },
  { keys: ["z"], label: "Look along an axis", shown: "", run: () => viewFrom(2, 1) },
  {
    keys: ["Shift+X"],
    label: "From the other side",
    shown: "Shift + X Y Z",
    run: () => viewFrom(0, -1),
  },
  { keys: ["Shift+Y"], label: "From the other side", shown: "", run: () => viewFrom(1, -1) },
  { keys: ["Shift+Z"], label: "From the other side", shown: "", run: () => viewFrom(2, -1) },
  { keys: ["p"], label: "Perspective or parallel", shown: "P", run: toggleProjection },
  {
    keys: [" "],
    label: "Play or pause",
    shown: "Space",
    run: () => isTrajectory.peek() && togglePlaying(),
  },
  { keys: [","], label: "Time step back, on", shown: ", .", run: () => step(-1) },
  { keys: ["."], label: "Time step back, on", shown: "", run: () => step(1) },
  { keys: ["Control+z"], label: "Undo", shown: "Ctrl + Z", run: undoEdit },
  {
    keys: ["Control+Shift+Z", "Control+y"],
    label: "Redo",
    shown: "Ctrl + Shift + Z",
    run: redoEdit,
  },
  {
    keys: ["Control+o"],
    label: "Open a file",
    shown: "Ctrl + O",
    run: () => (dialog.value = "files"),
  },
  { keys: ["Control+s"], label: "Save the scene", shown: "Ctrl + S", run: saveScene },
  {
    keys: ["h"],
    label: "Show or hide the panel",
    shown: "H",
    run: () => (panelOpen.value = !panelOpen.peek()),
  },
  {
    keys: ["s"],
    label: "Show or hide statistics",
    shown: "S",
    run: () => (showStatistics.value = !showStatistics.peek()),
  },
  { keys: ["?", "Shift+?"], label: "This help", shown: "?", run: () => (dialog.value = "help") },
];

function nameOf(event: KeyboardEvent): string {
  const control = event.ctrlKey || event.metaKey ? "Control+" : "";
  return `${control}${event.shiftKey ? "Shift+" : ""}${event.key}`;
}

/** What the mouse has pressed: it keeps the focus, but nobody means it by a key. */
let clicked: Element | null = null;

/** Whether an element uses keys itself. */
function takesKeys(target: EventTarget | null, key: string): boolean {
  if (!(target instanceof Element)) return false;
  if (target.closest("dialog, input, select, textarea, [role=menu], [role=slider], [role=tab]")) {
    return true;
  }
  const button = target.closest("button, a");
  return (key === " " || key === "Enter") && button !== null && button !== clicked;
}

export function listenForKeys(): void {
  window.addEventListener("focusin", () => (clicked = null));
  window.addEventListener("click", ({ target, detail }) => {
    if (detail > 0 && target instanceof Element) clicked = target.closest("button, a");
  });
  window.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.altKey) return;
    const name = nameOf(event);
    // Undoing and saving are the page's everywhere but where text is being typed.
    const typing =
      event.target instanceof Element && event.target.matches("input:not([type=range]), textarea");
    if (name.startsWith("Control+") ? typing : takesKeys(event.target, event.key)) return;
    const shortcut = shortcuts.find(({ keys }) => keys.includes(name));
    if (!shortcut) return;
    event.preventDefault();
    shortcut.run();
  });
}
