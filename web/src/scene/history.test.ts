import { expect, it } from "vitest";
import { amend, begin, record, redo, undo } from "./history";

it("goes back and forth", () => {
  let history = record(record(begin("a"), "b", null, 0), "c", null, 0);
  history = undo(history);
  expect(history.present).toBe("b");
  history = undo(undo(history));
  expect(history.present).toBe("a");
  history = redo(redo(redo(history)));
  expect(history.present).toBe("c");
});

it("forgets what was undone after a new edit", () => {
  const history = record(undo(record(begin("a"), "b", null, 0)), "c", null, 0);
  expect(redo(history).present).toBe("c");
  expect(undo(history).present).toBe("a");
});

it("takes a drag as one step", () => {
  let history = record(begin(0), 1, "slider", 0);
  history = record(history, 2, "slider", 500);
  history = record(history, 3, "slider", 1400);
  expect(undo(history).present).toBe(0);
});

it("takes drags apart by what is dragged and by pauses", () => {
  expect(undo(record(record(begin(0), 1, "a", 0), 2, "b", 10)).present).toBe(1);
  expect(undo(record(record(begin(0), 1, "a", 0), 2, "a", 1000)).present).toBe(1);
});

it("does not join a drag to one that was undone", () => {
  const history = record(undo(record(begin(0), 1, "a", 0)), 2, "a", 10);
  expect(undo(history).present).toBe(0);
});

it("amends without a step", () => {
  const history = record(begin("a"), "b", null, 0);
  expect(undo(amend(history, "B")).present).toBe("a");
});
