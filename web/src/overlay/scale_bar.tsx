// How long a round length is in the picture, at the depth of the target.
import { viewHeight } from "../camera/camera";
import { formatNumber, roundedDown, unitSign } from "../scene/format";
import { data } from "../state/document";
import { camera, size } from "../state/view";

const longest = 10; // rem

export function ScaleBar() {
  const view = camera.value;
  const { height } = size.value;
  if (!view || height === 0 || !data.value) return null;
  const rem = parseFloat(getComputedStyle(document.documentElement).fontSize);
  const perRem = (viewHeight(view) / (height / devicePixelRatio)) * rem;
  const barLength = roundedDown(longest * perRem);
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
      <div style={{ width: `${barLength / perRem}rem` }} />
    </div>
  );
}
