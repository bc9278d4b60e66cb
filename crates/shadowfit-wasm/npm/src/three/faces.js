// The faces that are drawn into the maps: all of them, unless a material chooses with its `shadowSide`.
//
// three.js draws the back faces of one-sided materials, to hide that surfaces shadow themselves. It loses the shadows of
// open meshes, and light leaks in where a caster touches its receiver. Our biases need no such help.

import { DoubleSide } from 'three';

/** Materials whose faces are all drawn in the present pass. */
export class AllFaces {
  /** @type {import('three').Material[]} */
  #materials = [];

  /** Begins a pass that draws the objects of a scan. */
  begin(scan) {
    this.end();
    for (const entry of scan.entries.values()) {
      if (entry.casts) {
        this.#draw(entry.object.material);
      }
    }
  }

  /** Gives the materials back as they were. */
  end() {
    for (const material of this.#materials) {
      material.shadowSide = null;
    }
    this.#materials.length = 0;
  }

  #draw(material) {
    if (Array.isArray(material)) {
      material.forEach((part) => this.#draw(part));
    } else if (material?.shadowSide === null) {
      material.shadowSide = DoubleSide;
      this.#materials.push(material);
    }
  }
}
