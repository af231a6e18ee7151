// What the page and the server say to each other as JSON (docs/viewer.md, "Protocol").
import type { Camera, Scene, Vector } from "./scene";

export interface Species {
  name: string;
  count: number;
  color: string;
}

export interface Property {
  name: string;
  min: number;
  max: number;
}

/** What the server knows of the opened file. */
export interface Data {
  file: string;
  format: string;
  particles: number;
  /** Null while they are being counted. */
  frames: number | null;
  time: number | null;
  length_unit: string;
  bounds: { min: Vector; max: Vector };
  species: Species[];
  properties: Property[];
  cell: [Vector, Vector, Vector] | null;
  grids: { name: string; size: Vector }[];
  fields: { name: string; particles: number; default_radius: number | null }[];
}

export interface Histogram {
  name: string;
  min: number;
  max: number;
  /** Empty where the view shows no values. */
  counts: number[];
  /** Over the logarithm of the value, from `positive_min` to `max`. */
  log_counts: number[] | null;
  positive_min: number | null;
}

export interface Statistics {
  frame_ms: number;
  encode_ms: number;
  samples: number;
  kernel_evaluations: number;
  particles: number;
  particle_bytes: number;
  tree_bytes: number;
  rss_bytes: number;
  threads: number;
  engine: string;
  instruction_set: string;
  clients: number;
}

export interface Hit {
  index: number;
  /** Null where the file has none. */
  id: number | null;
  /** Empty where there are none. */
  species: string;
  position: Vector;
  distance: number;
  properties: Record<string, number>;
  values: Record<string, number>;
}

export interface FolderEntry {
  name: string;
  folder: boolean;
  size: number;
}

export interface ClientState {
  client: number;
  following: number | null;
}

export type ServerMessage =
  | {
      type: "hello";
      protocol: number;
      version: string;
      client: number;
      /** Folder of the files that were sent to the server, each in a numbered one. */
      uploads: string;
      color_maps: Record<string, string[]>;
      styles: string[];
      engines: string[];
    }
  | {
      type: "scene";
      sequence: number | null;
      client: number | null;
      scene: Scene;
      data: Data;
      new_data?: boolean;
      /** Its camera was fitted to the data. */
      fitted?: boolean;
    }
  | { type: "progress"; activity: string; fraction: number | null }
  | { type: "ready" }
  | { type: "error"; sequence: number | null; message: string }
  | { type: "warnings"; lines: string[] }
  | { type: "picked"; sequence: number; hit: Hit | null }
  | { type: "camera"; client: number; camera: Camera }
  | { type: "clients"; clients: ClientState[] }
  | { type: "histogram"; fields: Histogram[] }
  | ({ type: "statistics" } & Statistics)
  | { type: "listing"; path: string; entries: FolderEntry[] };

export type ServerMessageOf<T extends ServerMessage["type"]> = Extract<ServerMessage, { type: T }>;

export type ClientMessage =
  | { type: "size"; width: number; height: number }
  | { type: "view"; sequence: number; camera: Camera; moving: boolean }
  | { type: "scene"; sequence: number; scene: Scene }
  | { type: "pick"; sequence: number; x: number; y: number }
  | { type: "fit" }
  | { type: "histogram" }
  | { type: "statistics" }
  | { type: "ack"; frame: number }
  | { type: "list"; path: string }
  | { type: "open"; path: string }
  | { type: "cancel" }
  | { type: "follow"; client: number | null };
