// Numbers and units for people.

/** Four digits, without needless zeros. */
export function formatNumber(value: number): string {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-3) return value.toExponential(3).replace(/\.?0+e\+?/, "e");
  if (size >= 1e4) return String(Math.round(value));
  return String(Number(value.toPrecision(4)));
}

export function formatCount(value: number): string {
  return Math.round(value).toLocaleString("en").replaceAll(",", "\u202f");
}

export function formatShort(value: number): string {
  const steps: [number, string][] = [
    [1e12, "T"],
    [1e9, "G"],
    [1e6, "M"],
    [1e3, "k"],
  ];
  for (const [unit, letter] of steps) {
    if (value >= unit) return `${Number((value / unit).toPrecision(3))} ${letter}`;
  }
  return String(Number(value.toPrecision(3)));
}

export function formatBytes(bytes: number): string {
  if (bytes < 1024) return `${bytes} B`;
  const units = ["KiB", "MiB", "GiB", "TiB"];
  let value = bytes / 1024;
  let unit = 0;
  while (value >= 1024 && unit < units.length - 1) {
    value /= 1024;
    ++unit;
  }
  return `${value.toPrecision(3)} ${units[unit]}`;
}

const unitSigns: Record<string, string> = {
  angstrom: "Å",
  bohr: "a₀",
  nanometer: "nm",
  nanometre: "nm",
  unknown: "",
};

export function unitSign(unit: string): string {
  return unitSigns[unit.toLowerCase()] ?? unit;
}

/** The largest of 1, 2, 5 times a power of ten that is at most `limit`. */
export function roundedDown(limit: number): number {
  const power = 10 ** Math.floor(Math.log10(limit));
  const digit = [5, 2, 1].find((candidate) => candidate * power <= limit * (1 + 1e-9)) ?? 1;
  return digit * power;
}

/** About `count` round numbers of a range. */
export function ticks(min: number, max: number, count: number): number[] {
  if (!(min < max)) return [min];
  const steps = [1, 2, 5, 10].map(
    (digit) => digit * 10 ** Math.floor(Math.log10((max - min) / count)),
  );
  const step = steps.find((candidate) => (max - min) / candidate <= count) ?? steps[3]!;
  const first = Math.ceil(min / step - 1e-9);
  const last = Math.floor(max / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, i) =>
    Number(((first + i) * step).toPrecision(12)),
  );
}

/** Powers of ten of a range; where they are few, twos and fives too. */
export function logTicks(min: number, max: number): number[] {
  const all: number[] = [];
  const decades = Math.log10(max / min);
  const digits = decades > 2 ? [1] : [1, 2, 5];
  const stride = Math.max(1, Math.ceil(decades / 6));
  for (let e = Math.floor(Math.log10(min)); e <= Math.ceil(Math.log10(max)); ++e) {
    if (e % stride !== 0) continue;
    for (const digit of digits) all.push(Number((digit * 10 ** e).toPrecision(3)));
  }
  return all.filter((value) => value >= min * 0.999 && value <= max * 1.001);
}
