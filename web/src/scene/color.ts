// Colours of scene files: "#rrggbb" and names are sRGB, [r, g, b] is linear.
import type { Color, Vector } from "../protocol/scene";

const names: Record<string, string> = { black: "#000000", white: "#ffffff" };

function toLinear(srgb: number): number {
  return srgb <= 0.04045 ? srgb / 12.92 : ((srgb + 0.055) / 1.055) ** 2.4;
}

function toSrgb(linear: number): number {
  const c = Math.min(1, Math.max(0, linear));
  return c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055;
}

export function linearOf(color: Color): Vector {
  if (typeof color !== "string") return color;
  const hex = Number.parseInt((names[color] ?? color).slice(1), 16);
  return [hex >> 16, (hex >> 8) & 255, hex & 255].map((c) => toLinear(c / 255)) as Vector;
}

export function hexOf(color: Color): string {
  if (typeof color === "string") return names[color] ?? color;
  const digits = color.map((c) =>
    Math.round(255 * toSrgb(c))
      .toString(16)
      .padStart(2, "0"),
  );
  return `#${digits.join("")}`;
}

/** As the renderer mixes: linearly in linear components. */
export function mixedColor(a: Color, b: Color, t: number): Vector {
  const from = linearOf(a);
  const to = linearOf(b);
  return from.map((c, i) => c + t * (to[i]! - c)) as Vector;
}

/** Whether what is drawn over it is better dark than light. */
export function isLight(color: Color): boolean {
  const [r, g, b] = linearOf(color);
  return 0.2126 * r + 0.7152 * g + 0.0722 * b > 0.18;
}
