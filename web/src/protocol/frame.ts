// The binary message of one picture: a header of 40 bytes, then JPEG or PNG.

const magic = 0x3146544d; // "MTF1"
const headerBytes = 40;

export interface Frame {
  id: number;
  /** Of the newest "view" that it shows. */
  viewSequence: number;
  /** Of this page's newest "scene" that it shows; 0: none. */
  sceneSequence: number;
  mediaType: "image/jpeg" | "image/png";
  /** The full picture, losslessly; others are on the way to it. */
  final: boolean;
  width: number;
  height: number;
  renderMs: number;
  encodeMs: number;
  image: Uint8Array<ArrayBuffer>;
  /** Not all of the image has come: the server has recalled it, as something newer is to be shown. */
  recalled: boolean;
}

/** Null for what is no such message. */
export function parseFrame(message: ArrayBuffer): Frame | null {
  if (message.byteLength < headerBytes) return null;
  const view = new DataView(message);
  if (view.getUint32(0, true) !== magic) return null;
  const format = view.getUint16(16, true);
  if (format > 1) return null;
  const bytes = view.getUint32(36, true);
  return {
    id: view.getUint32(4, true),
    viewSequence: view.getUint32(8, true),
    sceneSequence: view.getUint32(12, true),
    mediaType: format === 0 ? "image/jpeg" : "image/png",
    final: (view.getUint16(18, true) & 1) !== 0,
    width: view.getUint32(20, true),
    height: view.getUint32(24, true),
    renderMs: view.getFloat32(28, true),
    encodeMs: view.getFloat32(32, true),
    image: new Uint8Array(message, headerBytes),
    recalled: message.byteLength < headerBytes + bytes,
  };
}
