// Frame rate, samples and memory, on demand.
import { useEffect, useState } from "preact/hooks";
import { IconButton } from "../controls/button";
import { formatBytes, formatCount, formatNumber, formatShort } from "../scene/format";
import { statistics } from "../state/measurements";
import { frameRate, picture } from "../state/picture";
import { showStatistics } from "../state/preferences";

/** Frames come only while something changes: the rate falls to 0 by itself. */
function useFrameRate(): number {
  const [rate, setRate] = useState(frameRate());
  useEffect(() => {
    const timer = setInterval(() => setRate(frameRate()), 500);
    return () => clearInterval(timer);
  }, []);
  return rate;
}

export function StatisticsCard() {
  const rate = useFrameRate();
  const server = statistics.value;
  const frame = picture.value?.frame;
  const rows: [string, string][] = [["pictures", `${formatNumber(rate)} /s`]];
  if (frame) {
    rows.push(["picture", `${frame.width} × ${frame.height}${frame.final ? "" : ", not final"}`]);
    rows.push(["rendering", `${formatNumber(frame.renderMs)} ms`]);
    rows.push([
      "encoding",
      `${formatNumber(frame.encodeMs)} ms, ${formatBytes(frame.image.length)}`,
    ]);
  }
  if (server) {
    rows.push(
      ["samples", formatShort(server.samples)],
      ["kernels", formatShort(server.kernel_evaluations)],
      ["particles", formatCount(server.particles)],
      ["memory", formatBytes(server.rss_bytes)],
      ["of it particles", formatBytes(server.particle_bytes)],
      ["of it tree", formatBytes(server.tree_bytes)],
      ["engine", `${server.engine}, ${server.instruction_set}`],
      ["threads", String(server.threads)],
      ["viewers", String(server.clients)],
    );
  }
  return (
    <section class="card statistics" aria-label="Statistics">
      <header>
        <h2>Statistics</h2>
        <IconButton icon="close" label="Close" onClick={() => (showStatistics.value = false)} />
      </header>
      <dl>
        {rows.map(([name, value]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd>{value}</dd>
          </div>
        ))}
      </dl>
    </section>
  );
}
