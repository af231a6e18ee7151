// Undo and redo: the states before and after the present one.

export interface History<T> {
  past: T[];
  present: T;
  future: T[];
  /** What was being edited last and when: one drag is one step. */
  group: string | null;
  time: number;
}

const longestPauseMs = 1000;
const longestPast = 200;

export function begin<T>(present: T): History<T> {
  return { past: [], present, future: [], group: null, time: 0 };
}

/** Goes on to a new state; edits of one group that follow each other closely are one step. */
export function record<T>(
  history: History<T>,
  present: T,
  group: string | null,
  time: number,
): History<T> {
  const same = group !== null && group === history.group && time - history.time < longestPauseMs;
  const past = same ? history.past : [...history.past, history.present].slice(-longestPast);
  return { past, present, future: [], group, time };
}

/** The present state with more filled in, or corrected: no step of its own. */
export function amend<T>(history: History<T>, present: T): History<T> {
  return { ...history, present };
}

export function undo<T>(history: History<T>): History<T> {
  const previous = history.past.at(-1);
  if (previous === undefined) return history;
  return {
    past: history.past.slice(0, -1),
    present: previous,
    future: [history.present, ...history.future],
    group: null,
    time: 0,
  };
}

export function redo<T>(history: History<T>): History<T> {
  const [next, ...future] = history.future;
  if (next === undefined) return history;
  return { past: [...history.past, history.present], present: next, future, group: null, time: 0 };
}
