// What the page remembers in this browser: appearance, and what is drawn over the picture.
import { effect, signal, type Signal } from "@preact/signals";

export type Theme = "system" | "light" | "dark";

/** A signal that is kept in the browser where it allows that. */
function remembered<T>(name: string, initial: T): Signal<T> {
  const key = `motes.${name}`;
  let value = initial;
  try {
    const stored = localStorage.getItem(key);
    if (stored !== null) value = JSON.parse(stored) as T;
  } catch {
    // Storage may be forbidden or hold something else: the default will do.
  }
  const kept = signal(value);
  effect(() => {
    const text = JSON.stringify(kept.value);
    try {
      localStorage.setItem(key, text);
    } catch {
      // Then it lasts as long as the page.
    }
  });
  return kept;
}

const narrow = matchMedia("(max-width: 48rem)").matches;

export const theme = remembered<Theme>("theme", "system");
export const panelOpen = remembered("panel", !narrow);
export const tab = remembered("tab", "fields");
export const showAxes = remembered("axes", true);
export const showScaleBar = remembered("scale_bar", true);
export const showColorBars = remembered("color_bars", true);
export const showStatistics = remembered("statistics", false);
/** Whether the first hint has done its work. */
export const hintSeen = remembered("hint_seen", false);

effect(() => {
  const root = document.documentElement;
  if (theme.value === "system") delete root.dataset.theme;
  else root.dataset.theme = theme.value;
});
