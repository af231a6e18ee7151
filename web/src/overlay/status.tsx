// What goes on: connection, loading, following, notices. Read out by screen readers.
import { useEffect, useState } from "preact/hooks";
import { Button, IconButton } from "../controls/button";
import { Icon } from "../controls/icon";
import { connect, connectionState } from "../protocol/connection";
import { data } from "../state/document";
import { cancelOpening, upload } from "../state/files";
import { dialog } from "../state/interface";
import { dismiss, notices } from "../state/notices";
import { picture } from "../state/picture";
import { hintSeen } from "../state/preferences";
import { follow, following, progress } from "../state/session";

function useSecondsUntil(time: number): number {
  const [now, setNow] = useState(Date.now());
  useEffect(() => {
    const timer = setInterval(() => setNow(Date.now()), 250);
    return () => clearInterval(timer);
  }, []);
  return Math.max(0, Math.ceil((time - now) / 1000));
}

function Waiting({ reason, retryAt }: { reason: string; retryAt: number }) {
  const seconds = useSecondsUntil(retryAt);
  return (
    <div class="banner warning">
      <Icon name="warning" />
      <span>
        {reason} Trying again{seconds > 0 ? ` in ${seconds} s` : ""}…
      </span>
      <Button onClick={connect}>Try now</Button>
    </div>
  );
}

function ConnectionBanner() {
  const state = connectionState.value;
  if (state.kind === "waiting") return <Waiting {...state} />;
  if (state.kind === "ended") {
    return (
      <div class="banner error">
        <Icon name="warning" />
        <span>{state.reason}</span>
        <Button onClick={connect}>Try again</Button>
      </div>
    );
  }
  if (state.kind === "connecting" && picture.value) {
    return (
      <div class="banner">
        <span class="spinner" />
        <span>Connecting…</span>
      </div>
    );
  }
  return null;
}

function Work({
  text,
  fraction,
  onCancel,
}: {
  text: string;
  fraction: number | null;
  onCancel: () => void;
}) {
  return (
    <div class="banner work">
      <div class="work-text">
        <span>{text}</span>
        <span class="quiet">{fraction !== null && `${Math.floor(100 * fraction)} %`}</span>
      </div>
      <Button onClick={onCancel}>Cancel</Button>
      <progress aria-label={text} max={1} value={fraction ?? undefined} />
    </div>
  );
}

function FollowingBanner() {
  if (following.value === null) return null;
  return (
    <div class="banner">
      <Icon name="people" />
      <span>Following viewer {following.value}</span>
      <Button onClick={() => follow(null)}>Stop</Button>
    </div>
  );
}

export function Status() {
  const sent = upload.value;
  const work = progress.value;
  return (
    <div class="status" role="status" aria-live="polite">
      <ConnectionBanner />
      {sent && (
        <Work text={`Sending ${sent.name}`} fraction={sent.fraction} onCancel={sent.cancel} />
      )}
      {work && <Work text={work.activity} fraction={work.fraction} onCancel={cancelOpening} />}
      <FollowingBanner />
      {notices.value.map((notice) => (
        <div key={notice.id} class={`banner ${notice.kind}`}>
          {notice.kind !== "news" && <Icon name="warning" />}
          <span>{notice.text}</span>
          <IconButton icon="close" label="Dismiss" onClick={() => dismiss(notice.id)} />
        </div>
      ))}
    </div>
  );
}

/** Before the first picture. */
export function Opening() {
  if (picture.value || connectionState.value.kind !== "open" || progress.value) return null;
  if (data.value) {
    return (
      <div class="opening">
        <span class="spinner" /> Drawing the first picture…
      </div>
    );
  }
  return (
    <div class="opening late">
      Nothing is open yet.
      <Button icon="folder" onClick={() => (dialog.value = "files")}>
        Open a file
      </Button>
    </div>
  );
}

const touch = matchMedia("(pointer: coarse)").matches;

/** How to begin; goes away with the first use. */
export function Hint() {
  if (hintSeen.value || !picture.value) return null;
  const deeds = touch
    ? ["Drag to turn", "pinch to zoom", "double-tap a particle"]
    : ["Drag to turn", "scroll to zoom", "double-click a particle"];
  return (
    <p class="hint">
      {deeds.map((deed, i) => (
        <span key={deed}>
          {i > 0 && <i aria-hidden="true"> · </i>}
          {deed}
        </span>
      ))}
    </p>
  );
}
