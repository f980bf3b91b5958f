// Which events of the pointer belong to the operator's panel, and the command operator_pointer that tells merlind of them:
// daemon/base/panel_pointer.h for a browser. Uses no document.

const kRepeat = 500;  // ms after which a button that is held is reported again
const kMostWaiting = 32;

export class PanelPointer {
  constructor() {
    this.shown_at = null;
    this.pressed = false;  // the button
    this.held = false;     // since it was pressed on the panel
    this.last = {out: true, down: false, text: "out"};
    this.waiting = [];
    this.taken = 0;
  }

  // Where the picture shows the panel [px]: {x, y, width, height, to_frame_x, to_frame_y}; null: it does not.
  place(place) {
    if (JSON.stringify(place) === JSON.stringify(this.shown_at)) return;
    this.leave();
    this.shown_at = place;
  }

  tell(told) {
    if (told.text === this.last.text) return;
    const moves = told.down === this.last.down && told.out === this.last.out;
    this.last = told;
    if (moves && this.waiting.length && this.waiting.at(-1).moves) this.waiting.pop();
    this.waiting.push({...told, moves});
    if (this.waiting.length > kMostWaiting) this.waiting.shift();
  }

  // The pointer is at a pixel of the picture. True if the panel takes the event, which then must have no other effect.
  point(x, y, pressed) {
    const was = this.pressed, p = this.shown_at;
    this.pressed = pressed;
    if (!p) return false;
    const inside = x >= p.x && y >= p.y && x < p.x + p.width && y < p.y + p.height;
    if (pressed && !was) this.held = inside;
    const released = !pressed && this.held;
    if (released) this.held = false;
    if (!this.held && !released && (!inside || pressed)) {
      this.leave();
      return false;
    }
    this.tell({out: false, down: this.held, text: `${x + p.to_frame_x} ${y + p.to_frame_y} ${this.held ? 1 : 0}`});
    if (released && !inside) this.leave();
    return true;
  }

  // The pointer has left the picture, or the finger the screen.
  leave() {
    this.held = false;
    if (!this.last.out) this.tell({out: true, down: false, text: "out"});
  }

  // The argument of the next command; empty if there is none. `now`: ms.
  take(now) {
    const next = this.waiting.shift();
    if (!next && (!this.held || now - this.taken < kRepeat)) return "";
    this.taken = now;
    return (next || this.last).text;
  }
}
