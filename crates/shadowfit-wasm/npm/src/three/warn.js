// Console messages: each one once, with the name of the object that it is about.

const said = new Set();

/**
 * Returns an object's name for a message.
 * @param {import('three').Object3D | undefined} object
 */
export function nameOf(object) {
  if (!object) {
    return 'a light';
  }
  return object.name ? `${object.type} "${object.name}" (id ${object.id})` : `${object.type} with id ${object.id}`;
}

/**
 * Writes a warning to the console, unless it was written before.
 * @param {string} key Identity of the warning. Texts with changing numbers share one key.
 * @param {string} text
 */
export function warnOnce(key, text) {
  if (!said.has(key)) {
    said.add(key);
    console.warn(`shadowfit: ${text}`);
  }
}
