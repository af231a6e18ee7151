// Line drawings of 24 × 24, in the colour of the text around them.

const paths = {
  add: "M12 5v14M5 12h14",
  back: "M15 5l-7 7 7 7",
  balls: "M9 14a5 5 0 1 0 0-.01M18 8a3 3 0 1 0 0-.01",
  ballAndStick: "M6 15.5a2.8 2.8 0 1 0 0 .01M18 6.5a2.8 2.8 0 1 0 0 .01M9.5 14.2l5.6-5.2",
  both: "M12 4a8 8 0 1 0 0 16 8 8 0 0 0 0-16ZM9.5 13.5a2 2 0 1 0 0 .01M15.5 10a1.5 1.5 0 1 0 0 .01",
  camera: "M4 8h3l2-3h6l2 3h3v11H4ZM12 16.5a3.5 3.5 0 1 0 0-7 3.5 3.5 0 0 0 0 7Z",
  chart: "M4 20h16M6 16v-4M11 16V6M16 16v-7",
  check: "M5 12.5l4.5 4.5L19 7.5",
  chevronDown: "M6 9l6 6 6-6",
  chevronRight: "M9 6l6 6-6 6",
  close: "M6 6l12 12M18 6L6 18",
  command: "M4 5h16v14H4ZM7.5 9.5l3 2.5-3 2.5M12.5 15h4",
  copy: "M9 9h11v11H9ZM15 9V4H4v11h5",
  cube: "M12 3l8 4.5v9L12 21l-8-4.5v-9ZM4 7.5l8 4.5 8-4.5M12 12v9",
  zoom: "M10.5 17a6.5 6.5 0 1 0 0-13 6.5 6.5 0 0 0 0 13ZM15.5 15.5L20 20M8 10.5h5M10.5 8v5",
  edit: "M4 20l1-4.5L16 4.5l3.5 3.5L8.5 19 4 20ZM13.5 7l3.5 3.5",
  download: "M12 4v11M7.5 11l4.5 4.5 4.5-4.5M5 20h14",
  duplicate: "M8 8h12v12H8ZM16 8V4H4v12h4",
  eye: "M2.5 12S6 5.5 12 5.5 21.5 12 21.5 12 18 18.5 12 18.5 2.5 12 2.5 12ZM12 15a3 3 0 1 0 0-6 3 3 0 0 0 0 6Z",
  eyeOff:
    "M4 4l16 16M9.5 5.8A9 9 0 0 1 12 5.5c6 0 9.5 6.5 9.5 6.5a17 17 0 0 1-3 3.7M6 7.7A17 17 0 0 0 2.5 12S6 18.5 12 18.5a9 9 0 0 0 4-.9",
  file: "M6 3h8l4 4v14H6ZM14 3v4h4",
  fit: "M4 9V4h5M15 4h5v5M20 15v5h-5M9 20H4v-5M12 14.5a2.5 2.5 0 1 0 0-5 2.5 2.5 0 0 0 0 5Z",
  folder: "M3 6h6l2 2.5h10V19H3Z",
  help: "M12 21a9 9 0 1 0 0-18 9 9 0 0 0 0 18ZM9.5 9.5a2.5 2.5 0 1 1 3.6 2.3c-.8.4-1.1.9-1.1 1.7M12 16.6v.1",
  loop: "M4 11V9.5A3.5 3.5 0 0 1 7.5 6H20M17 3l3 3-3 3M20 13v1.5A3.5 3.5 0 0 1 16.5 18H4M7 21l-3-3 3-3",
  minus: "M5 12h14",
  moon: "M20 14.5A8.5 8.5 0 0 1 9.5 4 8.5 8.5 0 1 0 20 14.5Z",
  more: "M6 12a1 1 0 1 0 0-.01M13 12a1 1 0 1 0 0-.01M20 12a1 1 0 1 0 0-.01",
  panel: "M3.5 5h17v14h-17ZM14.5 5v14",
  pause: "M8 5v14M16 5v14",
  people:
    "M9 11.5a3.5 3.5 0 1 0 0-7 3.5 3.5 0 0 0 0 7ZM2.5 20c0-3.6 2.9-6 6.5-6s6.5 2.4 6.5 6M16 4.8a3.5 3.5 0 0 1 0 6.4M18 14.5c2.200.8 3.5 2.8 3.5 5.5",
  play: "M7 4.5v15l12-7.5Z",
  redo: "M20 8H9.5a5.5 5.5 0 0 0 0 11H14M16 4l4 4-4 4",
  save: "M12 3v11M8 10.5l4 4 4-4M4 15v5h16v-5",
  slice: "M4 17L20 7M12 3l8 4.5v9L12 21l-8-4.5v-9Z",
  stepBack: "M18 5v14l-9-7ZM6 5v14",
  stepOn: "M6 5v14l9-7ZM18 5v14",
  sun: "M12 16a4 4 0 1 0 0-8 4 4 0 0 0 0 8ZM12 2.5v2M12 19.5v2M2.5 12h2M19.5 12h2M5.3 5.3l1.4 1.4M17.3 17.3l1.4 1.4M5.3 18.7l1.4-1.4M17.3 6.7l1.4-1.4",
  surface: "M4 14c0-5 4-6 5.5-8.5C11 3 17 3.5 17.5 8c.3 2.5 3 3 2.5 7-.5 4.5-5 5.5-8 5s-8-.5-8-6Z",
  trash: "M5 7h14M10 4h4M7 7l1 13h8l1-13M10.5 11v5M13.5 11v5",
  undo: "M4 8h10.5a5.5 5.5 0 0 1 0 11H10M8 4L4 8l4 4",
  upload: "M12 16V5M7.5 9L12 4.5 16.5 9M5 20h14",
  volume: "M12 4a8 8 0 1 0 0 16 8 8 0 0 0 0-16ZM12 8a4 4 0 1 0 0 8 4 4 0 0 0 0-8Z",
  warning: "M12 4l9 16H3ZM12 10v4.5M12 17v.1",
};

export type IconName = keyof typeof paths;

export function Icon({ name }: { name: IconName }) {
  return (
    <svg class="icon" viewBox="0 0 24 24" aria-hidden="true">
      <path d={paths[name]} />
    </svg>
  );
}
