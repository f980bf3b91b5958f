// A code by which a phone's camera opens this page, unlocked.

import {phoneCode} from "./api.js";

const byId = id => document.getElementById(id);
const kShown = 60000;  // ms, because whoever sees the code may command the wall
const kMargin = 4;     // modules, as the standard requires

// The dark modules of rows "1011..." as one path.
const pathOf = rows => rows.map((row, y) => [...row.matchAll(/1+/g)].map(run =>
    `M${run.index + kMargin} ${y + kMargin}h${run[0].length}v1h-${run[0].length}z`).join("")).join("");

function draw(answer) {
  const code = byId("phone-code"), side = answer.rows.length + 2 * kMargin;
  code.toggleAttribute("hidden", answer.rows.length === 0);
  code.setAttribute("viewBox", `0 0 ${side} ${side}`);
  byId("phone-path").setAttribute("d", pathOf(answer.rows));
  byId("phone-address").textContent = answer.address || "";
  byId("phone-why").textContent = answer.why ||
      "Point the phone's camera at it. Whoever sees this code may command the wall; it goes away after a minute.";
}

// `failed`: says why there is no code.
export function makePhone(failed) {
  const dialog = byId("phone-dialog");
  let timer = 0;
  const forget = () => {
    clearTimeout(timer);
    byId("phone-path").setAttribute("d", "");
  };
  dialog.addEventListener("close", forget);
  byId("phone-close").onclick = () => dialog.close();
  byId("phone").onclick = async () => {
    try {
      draw(await phoneCode());
    } catch (error) {
      return failed(error);
    }
    dialog.showModal();
    timer = setTimeout(() => dialog.close(), kShown);
  };
}
