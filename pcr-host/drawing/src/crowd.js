"use strict";
/** The parts of a picture that are taken by discs and texts. A text for which there is no room is left out: on another one neither could be read. */
class Crowd {
  // Areas by the cells that they touch [px].
  cells = new Map();

  * keys([left, top, right, bottom]) {
    const cell = (value) => Math.floor(value / 32);
    for (let x = cell(left); x <= cell(right); x++) for (let y = cell(top); y <= cell(bottom); y++) yield `${x} ${y}`;
  }

  /** Takes an area (left, top, right, bottom): the disc of an owner, or a text if there is none. */
  take(area, owner = null) {
    for (const key of this.keys(area)) {
      const found = this.cells.get(key);
      if (found) found.push([area, owner]); else this.cells.set(key, [[area, owner]]);
    }
  }

  /** Whether an area is free of texts, and of the discs of others unless `over` them. */
  free(area, owner, over = false) {
    const apart = ([left, top, right, bottom]) => right <= area[0] || area[2] <= left || bottom <= area[1] || area[3] <= top;
    for (const key of this.keys(area)) {
      if (!(this.cells.get(key) ?? []).every(([other, whose]) => (whose !== null && (over || whose === owner)) || apart(other))) return false;
    }
    return true;
  }

  /** The middle of a text of this width and height for a disc, which is then taken: within the disc if that is seen around it, else beside it. */
  place([x, y, r], owner, width, height, over = false) {
    const inside = Math.hypot(width, height) / 2 + 2 <= r, [dx, dy] = [0.7 * r + 2 + width / 2, 0.7 * r + height / 2];
    const middles = inside ? [[x, y]] : [[x + dx, y - dy], [x - dx, y - dy], [x + dx, y + dy], [x - dx, y + dy], [x + r + 3 + width / 2, y], [x - r - 3 - width / 2, y]];
    const area = ([x, y]) => [x - width / 2, y - height / 2, x + width / 2, y + height / 2];
    const found = middles.find((middle) => this.free(area(middle), owner, inside || over));
    if (found) this.take(area(found));
    return found;
  }
}
