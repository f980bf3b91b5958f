// Draws the frame times and the histogram of the frames' work.

const kBar = 3;  // width of a frame [CSS px]

function colours() {
  const style = getComputedStyle(document.documentElement);
  const of = name => style.getPropertyValue(name).trim();
  return {moving: of("--accent"), still: of("--button-edge"), late: of("--bad"), line: of("--warn"),
          text: of("--quiet")};
}

// Fits the canvas to its size on the screen; returns its context, scaled to CSS pixels.
function prepared(canvas, height) {
  const width = canvas.clientWidth, scale = Math.min(devicePixelRatio || 1, 2);
  canvas.width = Math.round(width * scale);
  canvas.height = Math.round(height * scale);
  canvas.style.height = height + "px";
  const context = canvas.getContext("2d");
  context.scale(scale, scale);
  context.clearRect(0, 0, width, height);
  context.font = "11px system-ui, sans-serif";
  return {context, width};
}

export class FrameChart {
  constructor(canvas, height) {
    this.canvas = canvas;
    this.height = height;
    this.frames = [];  // [number, work_ms, cost, flags]
    this.next = 0;     // number of the newest frame
    this.period_ms = 0;
  }

  // Adds what /api/frames answered.
  add(answer) {
    const newest = answer.next - 1;
    if (newest < this.next) this.frames = [];  // the page's server was restarted
    this.next = newest;
    this.frames = this.frames.concat(answer.frames).slice(-600);
  }

  // Shows no frames until new ones are added.
  clear() {
    this.frames = [];
    this.period_ms = 0;
    this.draw();
  }

  draw() {
    const {context, width} = prepared(this.canvas, this.height);
    const colour = colours(), height = this.height, base = height - 1;
    const count = Math.max(1, Math.floor((width - 44) / kBar));
    const frames = this.frames.slice(-count);
    const longest = Math.max(this.period_ms * 1.5, ...frames.map(f => f[1]), 1);
    const top = Math.min(longest, this.period_ms > 0 ? this.period_ms * 4 : longest);
    const y = ms => base - Math.min(ms, top) / top * (base - 12);
    frames.forEach((frame, i) => {
      const [, work_ms, , flags] = frame;
      context.fillStyle = flags & 2 ? colour.late : flags & 1 ? colour.moving : colour.still;
      const at = y(work_ms);
      context.fillRect(width - (frames.length - i) * kBar, at, kBar - 1, Math.max(1, base - at));
    });
    context.fillStyle = colour.text;
    context.fillText("0 ms", 0, base - 1);
    if (this.period_ms <= 0) return;
    context.strokeStyle = colour.line;
    context.setLineDash([5, 4]);
    context.beginPath();
    context.moveTo(40, y(this.period_ms) + .5);
    context.lineTo(width, y(this.period_ms) + .5);
    context.stroke();
    context.setLineDash([]);
    context.fillStyle = colour.line;
    context.fillText(this.period_ms.toFixed(1), 0, y(this.period_ms) + 4);
  }

  lateOnChart() { return this.frames.filter(f => f[3] & 2).length; }
}

// `counts`: frames whose work was in each sixteenth of the period; the last one has all longer ones.
export function drawHistogram(canvas, counts, height) {
  const {context, width} = prepared(canvas, height);
  const colour = colours(), base = height - 15, most = Math.max(1, ...counts);
  const step = width / counts.length;
  counts.forEach((count, i) => {
    context.fillStyle = i >= 16 ? colour.late : colour.moving;
    // The square root lets a single late frame be seen beside thousands that were in time.
    const high = count > 0 ? Math.max(2, Math.sqrt(count / most) * (base - 2)) : 0;
    context.fillRect(i * step + .5, base - high, step - 1, high);
  });
  context.fillStyle = colour.text;
  for (const mark of [0, 0.5, 1, 1.5]) {
    const text = String(mark);
    context.fillText(text, mark === 0 ? 0 : mark * 16 * step - context.measureText(text).width / 2, height - 2);
  }
  context.fillStyle = colour.line;
  context.fillRect(16 * step - .5, 0, 1, base);
}
