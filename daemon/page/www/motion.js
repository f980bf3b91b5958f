// Turns drags, pinches, the wheel and buttons into arguments of the command move. Uses no document.

const kDegreesPerHeight = 180;  // for a drag over the picture's height; merlind moves a picture by 1.5 radii for them
// Least height [px] that a drag of a model or a panorama is measured by: the picture of a wide wall is a low strip, on
// which a swipe of a thumb would otherwise turn a model round. A picture follows the finger whatever the height.
const kLeastHeight = 300;
const kRadiiPerNotch = 0.1, kPxPerNotch = 100;  // of the wheel, as for windows and VNC clients
const kRadiiPerSpread = 2;  // for the logarithm of a pinch: at the default distance of two radii the model grows as it does
const kMostRadii = 10, kMostDegrees = 360;  // of a command

const kDragDoes = {model: "turn the model", picture: "move the picture", panorama: "look around"};

// What a person may do on the picture of a content of this kind.
export function moveHint(kind, open) {
  const does = kDragDoes[kind] || "move what is shown";
  return open ? `Drag to ${does}; pinch or turn the wheel to zoom.` : `Unlock to ${does}.`;
}

export const degreesPerPx = (kind, height) =>
    kDegreesPerHeight / (kind === "picture" ? Math.max(height, 1) : Math.max(height, kLeastHeight));

// The motion that no command has asked for yet. What is added while a command is under way goes into the next one.
export class Motion {
  constructor() {
    this.fingers = new Map();  // by pointer: its place [px]
    this.clear();
  }

  clear() { this.right = this.down = this.nearer = 0; }

  // A finger, or the mouse's button, is pressed there; release() ends that.
  press(id, x, y) { this.fingers.set(id, [x, y]); }
  release(id) { this.fingers.delete(id); }

  // The finger has moved there. One finger drags, two pinch; more have no effect.
  drag(id, x, y, degrees_per_px) {
    const from = this.fingers.get(id);
    if (!from) return;
    const before = this.apart();
    this.fingers.set(id, [x, y]);
    if (this.fingers.size === 1) {
      this.right += (x - from[0]) * degrees_per_px;
      this.down += (y - from[1]) * degrees_per_px;
    } else if (before > 0 && this.apart() > 0) {
      this.nearer += kRadiiPerSpread * Math.log(this.apart() / before);
    }
  }

  // The distance between two fingers; 0 if there are not two.
  apart() {
    if (this.fingers.size !== 2) return 0;
    const [[ax, ay], [bx, by]] = this.fingers.values();
    return Math.hypot(ax - bx, ay - by);
  }

  // The wheel was turned such that it would scroll a page down by so many pixels.
  wheel(px) { this.notch(-px / kPxPerNotch); }
  notch(count) { this.nearer += kRadiiPerNotch * count; }

  // The argument of the next command; empty if there is nothing to move.
  take() {
    const text = (value, most, digits) => Math.min(Math.max(value, -most), most).toFixed(digits);
    if (!this.right && !this.down && !this.nearer) return "";
    const argument = `0 0 ${text(this.nearer, kMostRadii, 4)} ${text(this.down, kMostDegrees, 2)} ` +
        `${text(this.right, kMostDegrees, 2)} 0`;
    this.clear();
    return argument;
  }
}
