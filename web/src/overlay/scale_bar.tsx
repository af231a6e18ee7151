// How long a round length is in the picture, at the depth of the target.
import { viewHeight } from "../camera/camera";
import { formatNumber, roundedDown, unitSign } from "../scene/format";
import { data } from "../state/document";
import { camera, size } from "../state/view";

const longestPixels = 150;

export function ScaleBar() {
  const view = camera.value;
  const { height } = size.value;
  if (!view || height === 0 || !data.value) return null;
  const perPixel = viewHeight(view) / (height / devicePixelRatio);
  const barLength = roundedDown(longestPixels * perPixel);
  const where = view.fov === undefined ? "" : " at the centre's depth";
  const text = `${formatNumber(barLength)} ${unitSign(data.value.length_unit)}`.trim();
  return (
    <div
      class="scale-bar"
      title={`Length${where}`}
      role="img"
      aria-label={`Scale: ${text}${where}`}
    >
      <span>{text}</span>
      <div style={{ width: `${barLength / perPixel}px` }} />
    </div>
  );
}
