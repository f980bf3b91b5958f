// Talks to the page's server: reading, commands, and the token that commands need.

const kTokenKey = "merlin-token";

export class ApiError extends Error {
  constructor(status, text) {
    super(text);
    this.status = status;  // of HTTP; 0: the server does not answer
  }
}

// A token in the address (#token=...) is taken and removed from it, so that it gets into no bookmark.
export function takeTokenFromAddress() {
  const found = /^#token=([A-Za-z0-9_-]+)$/.exec(location.hash);
  if (!found) return;
  sessionStorage.setItem(kTokenKey, found[1]);
  history.replaceState(null, "", location.pathname + location.search);
}

export const token = () => sessionStorage.getItem(kTokenKey) || "";
export function setToken(text) {
  if (text) sessionStorage.setItem(kTokenKey, text);
  else sessionStorage.removeItem(kTokenKey);
}

async function request(path, options = {}) {
  const headers = {...options.headers};
  if (token()) headers.Authorization = "Bearer " + token();
  let response;
  try {
    response = await fetch(path, {cache: "no-store", credentials: "omit", ...options, headers,
                                  signal: AbortSignal.timeout(10000)});
  } catch {
    throw new ApiError(0, "The page's server does not answer.");
  }
  if (response.ok) return response;
  let text = "";
  try {
    text = (await response.json()).error;
  } catch { /* no answer of the page's server */ }
  throw new ApiError(response.status, text || "status " + response.status);
}

export const getJson = async path => (await request(path)).json();

// The place of the operator's panel in a picture, as the header X-Picture-Panel has it.
function panelOf(text) {
  if (!text) return null;
  const [x, y, width, height, to_frame_x, to_frame_y] = text.split(" ").map(Number);
  return {x, y, width, height, to_frame_x, to_frame_y};
}

// The next picture after number `after`: {blob, number, size of its view [px], where the view shows the operator's
// panel}, or null if none came within a second.
export async function getPicture(view, width, after) {
  const response = await request(`/picture.jpg?view=${encodeURIComponent(view)}&width=${width}&after=${after}`);
  if (response.status === 204) return null;
  const header = name => response.headers.get("X-Picture-" + name) || "";
  return {blob: await response.blob(), number: header("Number"), size: header("Size").split(" ").map(Number),
          panel: panelOf(header("Panel"))};
}

// The small picture of the content at this place of /api/contents.
export const getThumbnail = async place => (await request("/thumbnail.jpg?content=" + place)).blob();

const post = (path, value) => request(path, {
  method: "POST", headers: {"Content-Type": "application/json"}, body: JSON.stringify(value)});

// Sends a command of /api/commands; returns its result.
export async function command(name, argument = "") {
  const wanted = argument ? {command: name, argument} : {command: name};
  return (await (await post("/api/command", wanted)).json()).result;
}

// {address, why, rows}: a code by which a phone opens the page, or why there is none.
export const phoneCode = async () => (await post("/api/phone", {})).json();

// Whether the server accepts the token.
export async function tokenIsGood() {
  if (!token()) return false;
  try {
    await post("/api/token", {});
    return true;
  } catch (error) {
    if (error.status === 401) return false;
    throw error;
  }
}
