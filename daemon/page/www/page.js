// The operator's page: shows what both roles report, and sends commands.

import {Alignment} from "./align.js";
import {command, getJson, setToken, takeTokenFromAddress, token, tokenIsGood} from "./api.js";
import {FrameChart, drawHistogram} from "./chart.js";
import {Contents} from "./contents.js";
import {showIdle, showProjectors} from "./idle.js";
import {makePhone} from "./phone.js";
import {Picture} from "./picture.js";
import {failedServices} from "./services.js";

const byId = id => document.getElementById(id);
const wait = ms => new Promise(done => setTimeout(done, ms));

const state = {
  open: false,        // the server accepts the token
  status: null,       // /api/status
  online: true,
  refused: "",        // why reading was refused
  crowded: false,     // others ask so much that this page was not answered
  events: 0,          // number of the newest event
  used: {},           // sliders that are being used, and until when they stay where they are [ms]
};
const chart = new FrameChart(byId("frames"), 150);

// ---- messages ---------------------------------------------------------------------------------

let toast_timer = 0;
function toast(text, bad = false) {
  const box = byId("toast");
  box.textContent = text;
  box.className = bad ? "shown bad" : "shown";
  clearTimeout(toast_timer);
  toast_timer = setTimeout(() => { box.className = ""; }, bad ? 6000 : 1800);
}

function showBanners() {
  const banners = [];
  const roles = state.status ? state.status.roles : {};
  if (!state.online) banners.push(["bad", "The page's server does not answer. This page tries again."]);
  else if (state.refused) banners.push(["bad", state.refused]);
  else {
    if (state.crowded)
      banners.push(["warn", "Others ask the page's server for too much, and it did not answer this page; what is shown may be old. This page tries again."]);
    if (roles.wall && !roles.wall.running)
      banners.push(["bad", "The role wall does not run: no merlind shows a wall. The page shows it again as soon as it runs."]);
    else if (roles.wall && roles.wall.status && roles.wall.age_s > 4)
      banners.push(["warn", `The role wall has reported nothing for ${roles.wall.age_s.toFixed(0)} s.`]);
    if (wallStatus() && wallStatus().notice) banners.push(["note", wallStatus().notice]);
    if (roles.devices && !roles.devices.running && !devicesOfWall())
      banners.push(["bad", "The role devices does not run: no merlind reads glove, tracker and ball."]);
    for (const sentence of failedServices(roles)) banners.push(["bad", sentence]);
  }
  const text = JSON.stringify(banners), box = byId("banners");
  if (box.dataset.text === text) return;
  box.dataset.text = text;
  box.replaceChildren(...banners.map(([kind, what]) => {
    const line = document.createElement("p");
    line.className = "banner " + kind;
    line.textContent = what;
    return line;
  }));
}

// ---- the token --------------------------------------------------------------------------------

function setOpen(open) {
  state.open = open;
  byId("lock").textContent = open ? "Unlocked" : "Locked";
  byId("lock").classList.toggle("open", open);
  for (const control of document.querySelectorAll(".command")) control.disabled = !open;
  byId("screen").classList.toggle("open", open);
  byId("align-plane").classList.toggle("locked", !open);
  picture.showHint();
}

async function checkToken() {
  try {
    setOpen(await tokenIsGood());
  } catch { /* the server is away; the next status says so */ }
  return state.open;
}

function askForToken() {
  byId("token-fault").textContent = "";
  byId("token").value = "";
  if (state.status) byId("token-place").textContent = "cat " + state.status.page.token_file;
  byId("token-dialog").showModal();
}

function makeTokenDialog() {
  byId("lock").onclick = () => {
    if (!state.open) return askForToken();
    setToken("");
    setOpen(false);
  };
  byId("token-cancel").onclick = () => byId("token-dialog").close();
  byId("token-form").onsubmit = async event => {
    event.preventDefault();
    setToken(byId("token").value.trim());
    if (await checkToken()) {
      byId("token-dialog").close();
      readStatus();
      return;
    }
    setToken("");
    byId("token").value = "";
    byId("token").focus();
    byId("token-fault").textContent = state.online ? "The token is wrong." : "The page's server does not answer.";
  };
}

// ---- commands ---------------------------------------------------------------------------------

// Sends a command; says why it failed. Returns its result, or undefined.
async function run(name, argument = "") {
  try {
    const result = await command(name, argument);
    return result === undefined || result === null ? true : result;
  } catch (error) {
    if (error.status === 401) setOpen(false);
    toast(error.message, true);
    return undefined;
  }
}

const readable = name => {
  const text = name.replace(/_/g, " ");
  return text[0].toUpperCase() + text.slice(1);
};

function commandButton(info) {
  const button = document.createElement("button");
  button.type = "button";
  button.className = "command";
  button.id = "command-" + info.name;
  button.title = info.help;
  button.textContent = readable(info.name);
  button.disabled = !state.open;
  button.onclick = async () => {
    await press(button, info.name, "", readable(info.name));
    if (info.name.startsWith("align_") || info.name === "next_testcard") alignment.refresh();
  };
  return button;
}

// Sends a command for a button; `done` is said when it was executed.
async function press(button, name, argument, done) {
  button.classList.add("busy");
  if (await run(name, argument) !== undefined && done) toast(done);
  button.classList.remove("busy");
  readStatus();
}

// Buttons of commands that have a place of their own on the page.
const kPlaced = ["blank", "freeze", "projector_on", "projector_off"];
function makePlacedButtons() {
  for (const name of kPlaced) {
    const button = byId("command-" + name);
    button.onclick = () => press(button, name, "", name.startsWith("projector") ? readable(name) : "");
  }
  for (const button of document.querySelectorAll("[data-playlist]"))
    button.onclick = () => press(button, "playlist", button.dataset.playlist, "Playlist: " + button.dataset.playlist);
}

// A button for each further command of the daemon's one list that needs no argument.
function makeButtons(commands) {
  const place = info => info.role !== "wall" ? "panel" :
      info.name.startsWith("align_") || info.name === "next_testcard" ? "align" : "wall";
  for (const id of ["wall", "panel", "align"])
    byId("buttons-" + id).replaceChildren(
        ...commands.filter(info => info.button && !kPlaced.includes(info.name) && place(info) === id).map(commandButton));
  const card = commands.find(info => info.name === "testcard");
  if (card) alignment.setCards(card.choices || []);
}

// ---- state ------------------------------------------------------------------------------------

function facts(box, pairs) {
  box.replaceChildren(...pairs.filter(([, value]) => value !== undefined).map(([name, value]) => {
    const line = document.createElement("div"), small = document.createElement("small"), b = document.createElement("b");
    small.textContent = name;
    b.textContent = value;
    line.append(small, b);
    return line;
  }));
}

function item(health, name, value, more) {
  const line = document.createElement("div"), dot = document.createElement("span"), label = document.createElement("span"),
        right = document.createElement("span");
  line.className = "item";
  dot.className = "dot " + health;
  dot.title = health;
  label.textContent = name;
  right.className = "value";
  right.textContent = value;
  line.append(dot, label, right);
  if (more) {
    const small = document.createElement("small");
    small.textContent = more;
    line.append(small);
  }
  return line;
}

const number = (value, digits = 0) => typeof value === "number" ? value.toFixed(digits) : "–";
const grouped = value => typeof value === "number" ? value.toLocaleString("en") : "–";
const wallStatus = () => state.status && state.status.roles.wall.status;
// A wall that uses another machine's devices reports them itself.
const devicesOfWall = () => wallStatus() && wallStatus().devices ? wallStatus() : null;
const devicesStatus = () => state.status && state.status.roles.devices.status || devicesOfWall();

function showDevices() {
  const status = devicesStatus(), devices = status ? Object.entries(status.devices || {}) : [];
  byId("devices").replaceChildren(...devices.map(([name, d]) =>
      item(d.health, readable(name), d.health === "ok" ? number(d.rate_hz, 1) + " Hz" : d.health,
           d.reason || d.identity || d.port)));
  if (devices.length === 0) byId("devices").textContent = "Nothing is known of the devices.";
  byId("head-posture").textContent = status && status.posture || "";
}

function showOutputs(wall) {
  const outputs = wall ? Object.entries(wall.outputs || {}) : [];
  byId("outputs").replaceChildren(...outputs.map(([name, o]) =>
      item(o.picture_reason ? "failed" : o.health, name,
           `${number(o.shown_hz, 1)} Hz, ${number(o.late_percent, 2)} % late`,
           o.reason || o.picture_reason || (o.kind === name ? "" : o.kind))));
}

const kLeastArgument = 4;  // of the command triangles
const leastCost = detail => Math.max(kLeastArgument, Math.min(detail.least_cost, detail.full_cost));

// The slider of the cost has a logarithmic scale from the least cost to the full cost.
const range = detail => Math.max(detail.full_cost / leastCost(detail), 1.001);
const costOf = (place, detail) => Math.round(leastCost(detail) * range(detail) ** (place / 1000));
const placeOf = (cost, detail) => Math.round(1000 * Math.log(Math.max(cost / leastCost(detail), 1)) / Math.log(range(detail)));

// Does not ask for the keyboard's focus, because not every browser gives it to a slider that is dragged.
const isUsed = id => Date.now() < (state.used[id] || 0);

function showDetail(wall) {
  const detail = wall.detail || {};
  if (!isUsed("rate")) {
    byId("rate").max = Math.max(120, Math.ceil(wall.rate_asked));
    byId("rate").value = wall.rate_asked;
    byId("rate-value").textContent = number(wall.rate_asked) + " Hz";
  }
  byId("cost-name").textContent = readable(detail.unit || "detail");
  if (!isUsed("triangles")) {
    byId("triangles").value = placeOf(detail.held_cost || wall.budget || detail.cost, detail);
    byId("triangles-value").textContent = detail.held_cost ? grouped(detail.held_cost) + " by hand" : "auto";
  }
  byId("triangles-auto").setAttribute("aria-pressed", String(!detail.held_cost));
  facts(byId("detail-facts"), [
    ["drawn now", grouped(detail.cost)], ["of", grouped(detail.full_cost)],
    ["full detail", wall.full_detail ? "shown" : "no"], [wall.content && wall.content.kind || "the content", wall.moving ? "moves" : "stands still"],
    ["mode of the ball", wall.mode],
    ["drawn by", wall.renderer && (wall.renderer.software ? "CPU" : "GPU")]]);
}

// The content that is shown: what the wall says of it, or its number in the configuration.
function shownContent(wall) {
  return typeof wall.content === "object" ? wall.content : {index: wall.content, name: "content " + (wall.content + 1)};
}

function showContents(wall) {
  const now = shownContent(wall);
  byId("content-name").textContent = [now.name, now.slide, now.kind].filter(Boolean).join(" · ") +
      (now.refused ? " · refused: " + now.refused : "");
  contents.mark(now.name);
  picture.showHint();
}

// The names of the files in the wall's content folder, which `merlin show FILE` has shown.
const shownFiles = () => wallStatus() && wallStatus().shown_folder && wallStatus().shown_folder.names || [];

async function showContent(name) {
  if (await run("show", name) !== undefined) toast("Show " + name);
  readStatus();
}

function showFrames(wall) {
  chart.period_ms = wall.rate_now > 0 ? 1000 / wall.rate_now : 0;
  byId("frames-legend").textContent = `dashed: the period of ${chart.period_ms.toFixed(1)} ms; red: late`;
  facts(byId("frame-facts"), [
    ["rate", `${number(wall.rate_held, 1)} of ${number(wall.rate_asked)} Hz`],
    ["late, 1 s", number(wall.late_percent_1s, 1) + " %"], ["late, 1 min", number(wall.late_percent_1min, 2) + " %"],
    ["late, all", number(wall.late_percent, 2) + " %"], ["work, median", number(wall.work_median_ms, 1) + " ms"],
    ["longest late", wall.longest_late === 1 ? "1 frame" : wall.longest_late + " frames"]]);
  if (wall.work_histogram) drawHistogram(byId("work"), wall.work_histogram, 70);
}

// Clears what the page shows of a wall that is gone: it would be taken for the present state.
function showNoWall() {
  for (const id of ["rate-value", "triangles-value"]) byId(id).textContent = "–";
  for (const id of ["detail-facts", "content-name", "frames-legend", "frame-facts"]) byId(id).replaceChildren();
  byId("triangles-auto").setAttribute("aria-pressed", "false");
  contents.mark(null);
  chart.clear();
  drawHistogram(byId("work"), new Array(32).fill(0), 70);
  picture.showHint();
}

function showStatus() {
  const wall = wallStatus();
  showBanners();
  showDevices();
  showProjectors(devicesStatus(), item);
  showOutputs(wall);
  byId("instance").textContent = state.status.page.instance;
  byId("head-rate").textContent = wall ? number(wall.rate_held, 0) : "–";
  byId("head-late").textContent = wall ? number(wall.late_percent_1min, 1) : "–";
  if (byId("everything").open) byId("raw").textContent = JSON.stringify(state.status, null, 2);
  showIdle(wall);
  if (!wall) return showNoWall();
  showDetail(wall);
  showContents(wall);
  showFrames(wall);
}

// ---- reading ----------------------------------------------------------------------------------

// Notes why a request failed, and says so in a banner.
function failed(error) {
  state.online = error.status !== 0;
  state.crowded = error.status === 429;
  state.refused = error.status === 401 ? "At this address, reading needs the token, too: press Locked and enter it." :
      error.status >= 400 && error.status !== 429 && error.status !== 503 ? error.message : "";
  if (error.status === 401 && token()) setOpen(false);
  showBanners();
}

async function readStatus() {
  try {
    state.status = await getJson("/api/status");
    state.online = true;
    state.refused = "";
    state.crowded = false;
    showStatus();
    return true;
  } catch (error) {
    failed(error);
    return false;
  }
}

async function readFrames() {
  if (!wallStatus()) return;
  const answer = await getJson("/api/frames?since=" + chart.next);
  chart.add(answer);
  chart.draw();
}

async function readEvents() {
  const {next, events} = await getJson("/api/events?since=" + state.events);
  state.events = next - 1;
  const log = byId("log");
  for (const event of events) {
    const line = document.createElement("li"), time = document.createElement("time"),
          from = document.createElement("span"), what = document.createElement("span");
    const at = new Date(event.time_utc);
    time.textContent = isNaN(at) ? "" : at.toLocaleTimeString("en-GB");
    time.title = event.time_utc;
    from.className = "from";
    from.textContent = event.role;
    what.className = "what";
    what.textContent = event.what;
    line.append(time, from, what);
    log.prepend(line);
  }
  while (log.children.length > 200) log.lastChild.remove();
}

// ---- sliders ----------------------------------------------------------------------------------

// A slider that is pressed or was used just now stays where the person put it.
function makeSlider(id, name, argumentOf, textOf) {
  const slider = byId(id);
  slider.addEventListener("pointerdown", () => { state.used[id] = Infinity; });
  for (const end of ["pointerup", "pointercancel"])
    slider.addEventListener(end, () => { state.used[id] = Date.now() + 1500; });
  slider.oninput = () => {
    state.used[id] = Math.max(state.used[id] || 0, Date.now() + 3000);
    byId(id + "-value").textContent = textOf(Number(slider.value));
  };
  slider.onchange = async () => {
    state.used[id] = Date.now() + 1500;
    await run(name, argumentOf(Number(slider.value)));
    readStatus();
  };
  byId(id + "-auto").onclick = async () => {
    state.used[id] = 0;
    await run(name, "auto");
    readStatus();
  };
}

// ---- begin ------------------------------------------------------------------------------------

// Calls `read` every `period` ms while the page is seen, one call after another.
async function repeat(read, period) {
  for (;;) {
    if (!document.hidden) {
      try {
        await read();
      } catch (error) {
        failed(error);
        await wait(1500);
      }
    }
    await wait(period);
  }
}

const alignment = new Alignment(run);
const contents = new Contents(byId("contents"), showContent);
const picture = new Picture(run, {open: () => state.open, online: () => state.online,
                                  kind: () => wallStatus() ? shownContent(wallStatus()).kind : ""});
const shownDetail = () => wallStatus() && wallStatus().detail || {unit: "triangles", full_cost: kLeastArgument, least_cost: kLeastArgument};

async function begin() {
  takeTokenFromAddress();
  makeTokenDialog();
  makePlacedButtons();
  makePhone(error => {
    if (error.status === 401) setOpen(false);
    toast(error.message, true);
  });
  makeSlider("rate", "rate", String, value => value + " Hz");
  makeSlider("triangles", "triangles", place => String(costOf(place, shownDetail())),
             place => grouped(costOf(place, shownDetail())) + " by hand");
  setOpen(false);
  if (token()) await checkToken();
  let commands = null;
  repeat(async () => {
    if (!await readStatus()) return wait(1500);
    if (commands) return;
    commands = (await getJson("/api/commands")).commands;
    makeButtons(commands);
    setOpen(state.open);
  }, 1000);
  repeat(readFrames, 500);
  repeat(readEvents, 1000);
  repeat(async () => {
    await contents.refresh(state.open, shownFiles());
    if (wallStatus()) contents.mark(shownContent(wallStatus()).name);
  }, 3000);
  repeat(() => state.open ? alignment.refresh() : null, 2000);
  picture.show();
  addEventListener("resize", () => { chart.draw(); alignment.draw(); });
  addEventListener("hashchange", async () => {
    takeTokenFromAddress();
    await checkToken();
  });
}

begin();
