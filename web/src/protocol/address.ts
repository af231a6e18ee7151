// Addresses under the page's own, whatever the base URL: the token goes with each.

export const token = new URLSearchParams(location.search).get("token") ?? "";

export function address(path: string, parameters: Record<string, string | number> = {}): URL {
  const url = new URL(path, new URL(".", location.href));
  for (const [name, value] of Object.entries({ token, ...parameters })) {
    url.searchParams.set(name, String(value));
  }
  return url;
}

export function socketAddress(): URL {
  const url = address("socket");
  url.protocol = location.protocol === "https:" ? "wss:" : "ws:";
  return url;
}
