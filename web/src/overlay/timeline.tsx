// Time steps of a trajectory: play, step, slide.
import { useLayoutEffect, useRef } from "preact/hooks";
import { Icon } from "../controls/icon";
import { IconButton } from "../controls/button";
import { Menu, MenuItem } from "../controls/menu";
import { formatNumber } from "../scene/format";
import { data, showFrame } from "../state/document";
import {
  currentFrame,
  frameCount,
  isTrajectory,
  loop,
  playing,
  speed,
  step,
  togglePlaying,
} from "../state/player";
import { coveredBelow } from "../state/view";

const speeds = [1, 2, 5, 10, 15, 30];

/** While the slider is there, what is fitted to the picture leaves its place free. */
function useCover(bar: { current: HTMLElement | null }, isThere: boolean): void {
  useLayoutEffect(() => {
    if (!isThere || !bar.current) return;
    const { top } = bar.current.getBoundingClientRect();
    coveredBelow.value = innerHeight - top;
    return () => {
      coveredBelow.value = 0;
    };
  }, [isThere]);
}

export function Timeline() {
  const bar = useRef<HTMLDivElement>(null);
  const count = frameCount.value;
  useCover(bar, count !== null && count > 1 && data.value !== null);
  if (!isTrajectory.value || !data.value) return null;
  if (count === null) {
    return (
      <div class="counting bar" role="status">
        <span class="spinner" /> Counting time steps…
      </div>
    );
  }
  const frame = currentFrame.value;
  const time = data.value.time;
  const label = `Step ${frame + 1} of ${count}${time === null ? "" : `, time ${formatNumber(time)}`}`;
  return (
    <div ref={bar} class="timeline bar" role="group" aria-label="Trajectory">
      <IconButton
        class="large"
        icon={playing.value ? "pause" : "play"}
        label={playing.value ? "Pause" : "Play"}
        shortcut="Space"
        onClick={togglePlaying}
      />
      <IconButton
        class="wide-only"
        icon="stepBack"
        label="Step back"
        shortcut=","
        onClick={() => step(-1)}
      />
      <IconButton
        class="wide-only"
        icon="stepOn"
        label="Step on"
        shortcut="."
        onClick={() => step(1)}
      />
      <input
        type="range"
        aria-label="Time step"
        aria-valuetext={label}
        min={0}
        max={count - 1}
        step={1}
        value={frame}
        style={{ "--filled": `${(100 * frame) / (count - 1)}%` }}
        onInput={(event) => showFrame(Number(event.currentTarget.value))}
      />
      <span class="timeline-label" title={label}>
        {frame + 1}
        <span class="quiet"> / {count}</span>
        {time !== null && <span class="quiet timeline-time">t {formatNumber(time)}</span>}
      </span>
      <IconButton
        icon="loop"
        label="Loop"
        pressed={loop.value}
        onClick={() => (loop.value = !loop.value)}
      />
      <Menu
        class="up"
        label={`Speed: ${speed.value}/s`}
        face={
          <>
            {speed.value}/s <Icon name="chevronDown" />
          </>
        }
      >
        {speeds.map((candidate) => (
          <MenuItem
            key={candidate}
            label={`${candidate} step${candidate > 1 ? "s" : ""} a second`}
            checked={candidate === speed.value}
            onClick={() => (speed.value = candidate)}
          />
        ))}
      </Menu>
    </div>
  );
}
