// The wall's live picture, and what a person does on it: drags, pinches, the wheel, and the operator's panel.

import {getPicture} from "./api.js";
import {Motion, degreesPerPx, moveHint} from "./motion.js";
import {PanelPointer} from "./panel.js";

const byId = id => document.getElementById(id);
const wait = ms => new Promise(done => setTimeout(done, ms));

const kWidths = [320, 640, 960, 1280, 1920];
const kAskAgain = 5000;  // ms until a size that the server refused is asked for again
const kHeldAfter = 400, kHeldAgain = 150;  // ms after which a button that is held acts again
const kTellAgain = 500;  // ms after which a button that is held is reported to the panel again
const kPxOfDelta = [1, 33, 300];  // of a wheel, by its deltaMode: pixels, lines, pages

// Calls `act` when the button is pressed, and again and again while it is held.
function repeatWhileHeld(button, act) {
  let timer = 0, pressed = false;
  const again = () => {
    if (button.disabled) return;
    act();
    timer = setTimeout(again, kHeldAgain);
  };
  button.addEventListener("pointerdown", event => {
    if (event.button !== 0) return;
    pressed = true;
    act();
    timer = setTimeout(again, kHeldAfter);
  });
  for (const end of ["pointerup", "pointercancel", "pointerleave"])
    button.addEventListener(end, () => clearTimeout(timer));
  button.addEventListener("contextmenu", event => event.preventDefault());  // a resting finger would open the menu
  // A click of the keyboard or a screen reader comes without a press.
  button.onclick = event => {
    if (!pressed || event.detail === 0) act();
    pressed = false;
  };
}

export class Picture {
  // `run`: sends a command. `page`: functions that return the page's state: {open, online, kind (of the content)}.
  constructor(run, page) {
    this.run = run;
    this.page = page;
    this.screen = byId("screen");
    this.view = "wall";
    this.size = [1, 1];       // of the view [px], before the server made it smaller
    this.refused_until = {};  // by view and width
    this.url = "";
    this.seen = true;
    this.motion = new Motion();
    this.panel = new PanelPointer();
    this.sending = false;
    new IntersectionObserver(entries => { this.seen = entries.at(-1).isIntersecting; }).observe(this.screen);
    this.makeButtons();
    this.makePointer();
    setInterval(() => this.send(), kTellAgain);
  }

  showHint() { byId("move-hint").textContent = moveHint(this.page.kind(), this.page.open()); }

  // ---- what is shown ----

  width() {
    const wanted = this.screen.clientWidth * Math.min(devicePixelRatio || 1, 2);
    return kWidths.find(width => width >= wanted) || kWidths.at(-1);
  }

  // The next picture, in a smaller size while the server refuses this one because others look at too many sizes. Fails
  // with the server's reason if it refuses even the smallest.
  async next(view, after) {
    const widths = kWidths.slice(0, kWidths.indexOf(this.width()) + 1), least = widths[0];
    for (const width of widths.reverse()) {
      const size = view + " " + width;
      if (width !== least && Date.now() < (this.refused_until[size] || 0)) continue;
      try {
        return await getPicture(view, width, after);
      } catch (error) {
        if (error.status !== 503 || width === least) throw error;
        this.refused_until[size] = Date.now() + kAskAgain;
      }
    }
  }

  showFault(text) {
    byId("picture-fault").textContent = text;
    byId("picture-fault").hidden = !text;
  }

  async show() {
    let after = 0;  // no two pictures have the same number, whatever their view and size
    for (;;) {
      if (document.hidden || !this.seen || !this.page.online()) {
        await wait(300);
        continue;
      }
      const view = this.view;
      try {
        const picture = await this.next(view, after);
        this.showFault("");
        if (!picture) continue;
        await this.draw(picture.blob);
        after = picture.number;
        this.size = picture.size;
        this.panel.place(view === this.view ? picture.panel : null);
      } catch (error) {
        if (error.status === 503) this.showFault(error.message);
        await wait(1000);
      }
    }
  }

  async draw(blob) {
    const url = URL.createObjectURL(blob), image = new Image();
    image.src = url;
    await image.decode();
    byId("picture").src = url;
    this.screen.style.aspectRatio = `${image.naturalWidth} / ${image.naturalHeight}`;
    if (this.url) URL.revokeObjectURL(this.url);
    this.url = url;
  }

  // ---- what a person does ----

  makeButtons() {
    for (const button of byId("views").children) {
      button.onclick = () => {
        this.view = button.dataset.view;
        this.panel.place(null);  // until the view's own picture is there
        for (const other of byId("views").children) other.setAttribute("aria-pressed", String(other === button));
      };
    }
    for (const button of document.querySelectorAll("[data-notch]")) {
      repeatWhileHeld(button, () => {
        this.motion.notch(Number(button.dataset.notch));
        this.send();
      });
    }
  }

  makePointer() {
    const on = (type, act, options) => this.screen.addEventListener(type, event => {
      if (!this.page.open()) return;
      act(event);
      this.send();
    }, options);
    on("pointerdown", event => {
      if (event.button !== 0) return;
      event.preventDefault();
      this.screen.setPointerCapture(event.pointerId);
      if (!this.panelTakes(event)) this.motion.press(event.pointerId, event.clientX, event.clientY);
    });
    on("pointermove", event => {
      if (this.panelTakes(event)) return;
      const scale = degreesPerPx(this.page.kind(), this.screen.clientHeight);
      this.motion.drag(event.pointerId, event.clientX, event.clientY, scale);
    });
    for (const end of ["pointerup", "pointercancel"]) {
      this.screen.addEventListener(end, event => this.motion.release(event.pointerId));
      on(end, event => {
        this.panelTakes(event);
        if (event.pointerType !== "mouse") this.panel.leave();
      });
    }
    on("pointerleave", () => this.panel.leave());
    on("wheel", event => {
      event.preventDefault();
      this.motion.wheel(event.deltaY * kPxOfDelta[event.deltaMode]);
    }, {passive: false});
  }

  // Whether the operator's panel takes an event of the pointer.
  panelTakes(event) {
    if (!event.isPrimary) return false;
    const box = this.screen.getBoundingClientRect();
    return this.panel.point(Math.floor((event.clientX - box.left) / box.width * this.size[0]),
                            Math.floor((event.clientY - box.top) / box.height * this.size[1]), (event.buttons & 1) !== 0);
  }

  // Sends what is to be moved and told, one command after another, so that nothing piles up.
  async send() {
    if (this.sending) return;
    this.sending = true;
    for (let next; this.page.open() && (next = this.nextCommand());)
      if (await this.run(...next) === undefined) this.motion.clear();
    this.sending = false;
  }

  nextCommand() {
    const told = this.panel.take(Date.now());
    if (told) return ["operator_pointer", told];
    const moved = this.motion.take();
    return moved ? ["move", moved] : null;
  }
}
