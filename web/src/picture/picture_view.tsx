// The picture: as many pixels as the screen has there, always the newest that has come.
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";
import { listen } from "../camera/pointer_input";
import { data, settled, takenSequence } from "../state/document";
import { type Picture, picture } from "../state/picture";
import { sentView, size } from "../state/view";

// While the window is being dragged to another size the old picture is shown, scaled.
const sizePauseMs = 120;

function draw(canvas: HTMLCanvasElement, shown: Picture): void {
  const context = canvas.getContext("2d", { alpha: false });
  if (!context) return;
  const { bitmap } = shown;
  // Pictures keep their vertical field of view, so that another width only shows more or less.
  const scale = canvas.height / bitmap.height;
  const width =
    Math.abs(bitmap.width * scale - canvas.width) < scale + 1 ? canvas.width : bitmap.width * scale;
  context.imageSmoothingQuality = "high";
  context.imageSmoothingEnabled = scale !== 1;
  context.drawImage(bitmap, (canvas.width - width) / 2, 0, width, canvas.height);
}

/** Keeps the canvas' pixels those of the screen. */
function watchSize(canvas: HTMLCanvasElement): () => void {
  let timer = 0;
  const observer = new ResizeObserver(([entry]) => {
    const pixels = entry?.devicePixelContentBoxSize?.[0];
    const width = pixels?.inlineSize ?? Math.round(canvas.clientWidth * devicePixelRatio);
    const height = pixels?.blockSize ?? Math.round(canvas.clientHeight * devicePixelRatio);
    if (width === 0 || height === 0) return;
    canvas.width = width;
    canvas.height = height;
    if (picture.peek()) draw(canvas, picture.peek()!);
    clearTimeout(timer);
    const pause = size.peek().width === 0 ? 0 : sizePauseMs;
    timer = window.setTimeout(() => (size.value = { width, height }), pause);
  });
  try {
    observer.observe(canvas, { box: "device-pixel-content-box" });
  } catch {
    observer.observe(canvas);
  }
  return () => observer.disconnect();
}

/** Whether it is the full picture of all that was asked for. */
function isComplete(shown: Picture | null): boolean {
  const view = sentView.value;
  const scene = takenSequence.value;
  if (!settled.value || !shown?.frame.final) return false;
  return shown.frame.viewSequence >= view && shown.frame.sceneSequence >= scene;
}

export function PictureView() {
  const canvas = useRef<HTMLCanvasElement>(null);
  const shown = picture.value;
  useEffect(() => watchSize(canvas.current!), []);
  useEffect(() => listen(canvas.current!), []);
  useLayoutEffect(() => {
    if (shown) draw(canvas.current!, shown);
  }, [shown]);
  const what = data.value ? `${data.value.file}, ${data.value.particles} particles` : "no data yet";
  return (
    <canvas
      ref={canvas}
      class="picture"
      tabIndex={0}
      role="application"
      aria-roledescription="three-dimensional view"
      aria-label={`Picture of ${what}`}
      aria-description="Arrow keys turn, with Shift they shift, plus and minus zoom, F shows everything."
      aria-busy={!isComplete(shown)}
      data-frame={shown?.frame.id}
    />
  );
}
