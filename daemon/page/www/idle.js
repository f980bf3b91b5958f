// What the wall does by itself: the playlist, black and frozen pictures, projectors.

const byId = id => document.getElementById(id);

// "42 s", "3 min", "2 h 10 min".
export function timeText(seconds) {
  if (seconds < 100) return Math.ceil(seconds) + " s";
  const minutes = Math.round(seconds / 60);
  if (minutes < 100) return minutes + " min";
  return `${Math.floor(minutes / 60)} h` + (minutes % 60 ? ` ${minutes % 60} min` : "");
}

// What the playlist does now, for a person.
export function playlistText(wall) {
  const known = value => typeof value === "number";
  const parts = [];
  if (wall.playlist === "running")
    parts.push("Plays" + (known(wall.next_in_s) ? `; the next in ${timeText(wall.next_in_s)}` : ""));
  else if (wall.playlist === "waiting")
    parts.push("Waits" + (known(wall.playlist_in_s) ? `; begins in ${timeText(wall.playlist_in_s)}` : ""));
  else parts.push("Off");
  if (wall.shown !== "blank" && wall.light < 1) parts.push(`dimmed to ${Math.round(100 * wall.light)} %`);
  else if (known(wall.dim_in_s)) parts.push(`dims in ${timeText(wall.dim_in_s)}`);
  return parts.join(" · ");
}

// The state of a projector, for a person: [words, more, health of its dot].
export function projectorText(p) {
  const becomes = p.wanted && p.wanted !== p.power;
  const target = p.wanted || {warming: "on", cooling: "off"}[p.power];
  const change = typeof p.within_s === "number" && target ? `, ${target} within ${timeText(p.within_s)}` :
      becomes ? ", to be " + p.wanted : "";
  const power = p.power === "unknown" ? "state unknown" : p.power;
  const works = p.health === "ok";
  const lamps = (p.lamp_hours || []).map(h => h + " h").join(", ");
  const words = works ? power + change : p.health.replace(/_/g, " ");
  const more = [p.reason, !works && p.power !== "unknown" ? power : "", !works && becomes ? "is to be " + p.wanted : "",
                lamps ? "lamp " + lamps : "", p.identity || p.address].filter(Boolean).join(" · ");
  const busy = p.power === "warming" || p.power === "cooling" || becomes;
  return [words, more, !works ? (p.health === "opening" ? "opening" : "failed") : busy ? "stale" : p.power === "on" ? "ok" : "off"];
}

// "Next by the schedule: off, today at 18:00", "Next by the schedule: on, Monday at 09:00".
export function scheduleText(next, now = new Date()) {
  const [day, time] = next.at.split("T"), two = n => String(n).padStart(2, "0");
  const dateOf = d => `${d.getFullYear()}-${two(d.getMonth() + 1)}-${two(d.getDate())}`;
  const tomorrow = new Date(now.getFullYear(), now.getMonth(), now.getDate() + 1);
  const when = day === dateOf(now) ? "today" : day === dateOf(tomorrow) ? "tomorrow" :
      new Date(day + "T12:00").toLocaleDateString("en", {weekday: "long"});
  return `Next by the schedule: ${next.on ? "on" : "off"}, ${when} at ${time}`;
}

// `wall`: null while no wall runs.
export function showIdle(wall) {
  byId("playlist-state").textContent = wall ? playlistText(wall) : "–";
  for (const button of document.querySelectorAll("[data-playlist]")) {
    const now = wall && (wall.playlist === "off" ? "off" : "on");
    if (button.dataset.playlist !== "next")
      button.setAttribute("aria-pressed", String(button.dataset.playlist === now));
  }
  byId("command-blank").setAttribute("aria-pressed", String(Boolean(wall) && wall.shown === "blank"));
  byId("command-freeze").setAttribute("aria-pressed", String(Boolean(wall) && wall.shown === "frozen"));
}

// `item`: makes a line of a list.
export function showProjectors(status, item) {
  const all = Object.entries(status && status.projectors || {});
  byId("projectors").replaceChildren(...all.map(([name, p]) => {
    const [words, more, health] = projectorText(p);
    return item(health, name, words, more);
  }));
  byId("projectors-none").hidden = !status || all.length > 0;
  byId("projector-buttons").hidden = all.length === 0;
  const next = status && status.projector_schedule;
  byId("projectors-next").textContent = next ? scheduleText(next) : "";
}
