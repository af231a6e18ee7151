import { describe, expect, it } from "vitest";
import { parseFrame } from "./frame";

/** As docs/viewer.md lays it out, by hand. */
function message(format: number, flags: number): ArrayBuffer {
  const bytes = new Uint8Array(40 + 3);
  bytes.set([0x4d, 0x54, 0x46, 0x31, 12, 0, 0, 0, 7, 1, 0, 0, 8, 0, 0, 0, format, 0, flags, 0]);
  bytes.set([0, 4, 0, 0, 0, 3, 0, 0], 20);
  bytes.set([0, 0, 0x20, 0x41, 0, 0, 0, 0x3f], 28); // 10 and 0.5
  bytes.set([3, 0, 0, 0, 1, 2, 3], 36);
  return bytes.buffer;
}

describe("parseFrame", () => {
  it("reads all of the header", () => {
    expect(parseFrame(message(1, 1))).toEqual({
      id: 12,
      viewSequence: 263,
      sceneSequence: 8,
      mediaType: "image/png",
      final: true,
      width: 1024,
      height: 768,
      renderMs: 10,
      encodeMs: 0.5,
      image: new Uint8Array([1, 2, 3]),
      recalled: false,
    });
    expect(parseFrame(message(0, 0))).toMatchObject({ mediaType: "image/jpeg", final: false });
  });

  it("tells what was recalled", () => {
    expect(parseFrame(message(1, 1).slice(0, 42))).toMatchObject({ id: 12, recalled: true });
  });

  it("refuses what is no frame", () => {
    const other = message(0, 0);
    new DataView(other).setUint32(0, 0);
    expect(parseFrame(other)).toBeNull();
    expect(parseFrame(message(2, 0))).toBeNull();
    expect(parseFrame(message(0, 0).slice(0, 39))).toBeNull();
    expect(parseFrame(new ArrayBuffer(0))).toBeNull();
  });
});
