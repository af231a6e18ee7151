// Lists with one item more, fewer or changed; the given ones stay as they are.

export function withItem<T>(items: T[], index: number, item: T): T[] {
  return [...items.slice(0, index), item, ...items.slice(index)];
}

export function withoutItem<T>(items: T[], index: number): T[] {
  return items.filter((_, i) => i !== index);
}

/** The item at an index changed, or taken out by null. */
export function replaced<T extends object>(items: T[], index: number, patch: Partial<T> | null) {
  if (patch === null) return withoutItem(items, index);
  return items.map((item, i) => (i === index ? { ...item, ...patch } : item));
}
