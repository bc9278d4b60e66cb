// When the casters of a scene changed, and which of them move. Moving casters are drawn over kept maps of the others.

/** Number of scans without a change after which a caster counts as still again: half a second at 60 frames per second. */
const REST = 30;

/** Nodes of a material that may move its shadow from frame to frame. Nobody can tell without evaluating them. */
const SHAPING_NODES = [
  'positionNode', 'castShadowPositionNode', 'vertexNode', 'depthNode', 'maskNode', 'maskShadowNode', 'castShadowNode',
  'alphaTestNode',
];

/** Nodes that do so for materials with an alpha test. */
const ALPHA_NODES = ['colorNode', 'opacityNode'];

/** @type {WeakMap<import('../three/scan.js').SceneScan, Movement>} */
const movements = new WeakMap();

/** The changes of a scene's casters. Its clock counts scans. */
export class Movement {
  /**
   * Returns the movement of a scan.
   * @param {import('../three/scan.js').SceneScan} scan
   */
  static of(scan) {
    let movement = movements.get(scan);
    if (movement === undefined) {
      movement = new Movement(scan);
      movements.set(scan, movement);
    }
    return movement;
  }

  constructor(scan) {
    this.scan = scan;
    /** Number of the latest scan. */
    this.now = 0;
    this.version = 0;
    /** Number of the scan in which each row changed last. */
    this.changedAt = [];
    /** Number of the scan at which each row counts as still again. */
    this.movesUntil = [];
    /** Rows whose materials may change their shape in any frame. @type {number[]} */
    this.volatile = [];
  }

  /** Finds the rows that changed in the latest scan. One change is no movement, but a second one soon after it is. */
  update() {
    const { scan, changedAt, movesUntil, version } = this;
    if (this.now === scan.scans) {
      return;
    }
    this.now = scan.scans;
    if (scan.version !== version) {
      this.version = scan.version;
      this.volatile = [];
      for (let row = 0; row < scan.rows.length; row += 1) {
        if (isVolatile(scan.rows[row])) {
          this.volatile.push(row);
        }
        if (scan.casterChanges[row] > version) {
          const isSecond = this.now - (changedAt[row] ?? -REST) < REST;
          movesUntil[row] = isSecond ? this.now + REST : 0;
          changedAt[row] = this.now;
        }
      }
    }
    for (const row of this.volatile) {
      changedAt[row] = this.now;
      movesUntil[row] = this.now + REST;
    }
  }

  /** Returns whether a row's caster moves. */
  moves(row) {
    return this.movesUntil[row] > this.now;
  }
}

function isVolatile(entry) {
  if (entry === undefined || !entry.casts) {
    return false;
  }
  const { material } = entry.object;
  return Array.isArray(material) ? material.some(hasShapingNode) : hasShapingNode(material);
}

function hasShapingNode(material) {
  const hasNode = (name) => material[name]?.isNode === true;
  return material?.isNodeMaterial === true
    && (SHAPING_NODES.some(hasNode) || ((material.alphaTest > 0 || material.alphaHash) && ALPHA_NODES.some(hasNode)));
}
