// The contents of the wall, each with a small picture; a tap shows it.

import {getJson, getThumbnail} from "./api.js";

const kKinds = {model: "Model", picture: "Picture", panorama: "Panorama", slides: "Slides", file: "File"};
const kSigns = {model: "◭", picture: "▣", panorama: "◎", slides: "▤", file: "◰"};
const kMostFiles = 24;

export class Contents {
  // `box`: where they are listed. `show`: shows the content of a name.
  constructor(box, show) {
    this.box = box;
    this.show = show;
    this.tiles = new Map();  // by name
    this.listed = "";        // JSON of the names and kinds that are listed
  }

  // Whether there is anything to choose from.
  get any() { return this.tiles.size > 0; }

  // Reads the list again, and the pictures that are new. `files`: names of the contents that are not in the configuration,
  // and that the wall can show again; the newest first.
  async refresh(open, files) {
    const {contents, shown = []} = await getJson("/api/contents");
    for (const name of files.slice(0, kMostFiles))
      if (!contents.some(c => c.name === name))
        contents.push({kind: "file", ...shown.find(s => s.name === name), name});
    const listed = JSON.stringify(contents.map(c => [c.name, c.kind]));
    if (listed !== this.listed) {
      this.listed = listed;
      this.tiles = new Map(contents.map((c, place) => [c.name, this.makeTile(c, place, open)]));
      this.box.replaceChildren(...[...this.tiles.values()].map(tile => tile.button));
    }
    let fault = null;
    for (const c of contents) {
      const tile = this.tiles.get(c.name);
      tile.note.textContent = c.fault ? "cannot be read" : kKinds[c.kind] || c.kind;
      tile.note.classList.toggle("bad", Boolean(c.fault));
      tile.button.title = c.fault || "";
      if (c.place !== undefined) tile.place = c.place;
      try {
        if (c.thumbnail && c.thumbnail !== tile.number) await this.picture(tile, c.thumbnail);
      } catch (error) {
        fault = error;  // the other pictures are read all the same
      }
    }
    if (fault) throw fault;
  }

  makeTile(content, place, open) {
    const button = document.createElement("button"), frame = document.createElement("span"),
          name = document.createElement("span"), note = document.createElement("small");
    button.type = "button";
    button.className = "content command";
    button.disabled = !open;
    button.setAttribute("aria-pressed", "false");
    button.dataset.name = content.name;
    frame.className = "thumbnail";
    frame.setAttribute("aria-hidden", "true");
    frame.textContent = kSigns[content.kind] || "?";
    name.className = "name";
    name.textContent = content.name;
    button.append(frame, name, note);
    button.onclick = () => this.show(content.name);
    return {button, frame, note, place, number: 0, url: ""};
  }

  // The tile takes the number once it has the picture, so that a picture that failed is tried again.
  async picture(tile, number) {
    const url = URL.createObjectURL(await getThumbnail(tile.place)), image = new Image();
    image.alt = "";
    image.src = url;
    try {
      await image.decode();
    } catch (error) {
      URL.revokeObjectURL(url);
      throw error;
    }
    tile.frame.replaceChildren(image);
    if (tile.url) URL.revokeObjectURL(tile.url);
    tile.url = url;
    tile.number = number;
  }

  // Marks the content that is shown.
  mark(name) {
    for (const [own, tile] of this.tiles)
      tile.button.setAttribute("aria-pressed", String(own === name));
  }
}
