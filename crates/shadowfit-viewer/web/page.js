// The page around the viewer, which runs in a worker. The page sends it keys, pointers, sizes and files, and
// does everything that only a page can: store, download, copy, open.

import { sizes } from './sizes.js';

const STORED = 'shadowfit viewer';
const element = (id) => document.getElementById(id);
const [canvas, typing, files, cover] = ['canvas', 'typing', 'files', 'cover'].map(element);
const asked = new URLSearchParams(location.search);

/// Advice for each kind of end.
const ADVICE = {
  none:
    'This browser has neither WebGPU nor WebGL2 turned on. A current Chrome, Edge, Firefox or Safari has; if yours is, '
    + 'turn on hardware acceleration in its settings and load the page again.',
  lost: 'The graphics driver was reset, or the browser took its memory back. Your settings are saved: load the page again.',
  memory: 'Close other pages, or choose a smaller scene, and load the page again.',
  panic: 'This is a bug of the viewer. Your settings are saved: load the page again, and please report the text above.',
  failure: 'Load the page again; if that does not help, please report the text above.',
};

/// Ends the page with a message. Later errors of the worker follow from the first one, and are not shown.
function show(state, advice) {
  if (cover.classList.contains('failed')) {
    return;
  }
  cover.classList.remove('gone');
  cover.classList.add('failed');
  element('state').textContent = state;
  element('advice').textContent = advice;
  element('again').hidden = false;
}

element('again').onclick = () => location.reload();

// ---- the worker

const worker = new Worker(new URL('worker.js', import.meta.url), { type: 'module' });
const tell = (...message) => worker.postMessage(message);
const questions = [];
let isTyping = false;
/// Whether a mouse button is pressed.
let isPressed = false;

/// For tests, and for use in the console.
window.viewer = {
  facts: () => new Promise((resolve) => {
    questions.push(resolve);
    tell('facts');
  }),
  tell,
};

/// Reads or writes local storage, which a browser may forbid.
const stored = (key, text) => {
  try {
    return text === undefined ? localStorage.getItem(key) : localStorage.setItem(key, text);
  } catch {
    return null;
  }
};

const told = {
  loaded(share) {
    element('progress').value = share;
  },
  api(name) {
    document.documentElement.dataset.api = name;
    element('progress').value = 0;
  },
  compiled() {
    element('progress').removeAttribute('value');
    element('state').textContent = 'Starting';
  },
  ready(adapter) {
    document.documentElement.dataset.ready = adapter || 'yes';
    cover.classList.add('gone');
    canvas.focus();
  },
  none() {
    show('Nothing to draw with', ADVICE.none);
  },
  failure(text) {
    show(text, ADVICE.failure);
  },
  panic(text) {
    show(text, ADVICE.panic);
  },
  lost(text) {
    show(`The graphics device was lost. ${text}`.trim(), ADVICE.lost);
  },
  memory(text) {
    show(`No memory is left. ${text}`.trim(), ADVICE.memory);
  },
  error(text) {
    console.error(text);
  },
  title(text) {
    document.title = text;
  },
  cursor(name) {
    canvas.style.cursor = name;
  },
  keep(text) {
    stored(STORED, text);
  },
  'keep aside'(text) {
    stored(`${STORED}, damaged`, text);
  },
  copy(text) {
    navigator.clipboard?.writeText(text).catch(() => copyByHand(text));
  },
  open(url) {
    window.open(url, '_blank', 'noopener');
  },
  choose() {
    files.value = '';
    files.click();
  },
  types(whether) {
    isTyping = Boolean(whether);
    (whether ? typing : canvas).focus({ preventScroll: true });
  },
  download(bytes, name) {
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([bytes]));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  },
  looks(whether) {
    if (whether && isPressed) {
      lock();
    }
  },
  busy(text) {
    const bar = element('busy');
    const [from, to, seconds] = text.split(' ').map(Number);
    bar.style.transition = 'none';
    bar.style.transform = `scaleX(${text ? from : 0})`;
    if (text) {
      bar.getBoundingClientRect();
      bar.style.transition = `transform ${seconds}s linear`;
      bar.style.transform = `scaleX(${to})`;
    }
  },
  facts(text) {
    questions.shift()?.(JSON.parse(text));
  },
};

worker.onmessage = ({ data: [kind, value, name] }) => told[kind](value, name);
worker.onerror = (event) => show(event.message ?? 'The viewer cannot be loaded.', ADVICE.failure);

/// Copies a text by selecting it, for pages without access to the clipboard.
function copyByHand(text) {
  typing.value = text;
  typing.select();
  document.execCommand('copy');
  typing.value = '';
  canvas.focus();
}

// ---- size and looks

const pixels = () => [innerWidth, innerHeight].map((side) => Math.max(1, Math.round(side * devicePixelRatio)));

new ResizeObserver(([{ devicePixelContentBoxSize: box }]) => {
  const rounded = pixels();
  const exact = box ? [box[0].inlineSize, box[0].blockSize] : rounded;
  // Browsers that emulate another screen report a wrong exact size.
  const isPlausible = exact.every((side, axis) => Math.abs(side - rounded[axis]) <= 2);
  tell('resize', ...(isPlausible ? exact : rounded), devicePixelRatio);
}).observe(canvas);

const dark = matchMedia('(prefers-color-scheme: dark)');
dark.addEventListener('change', () => tell('dark', dark.matches));

// ---- keys

const SHIFT = 1;
const CTRL = 2;
const ALT = 4;
const META = 8;
let bits = 0;

function held(event) {
  const now = (event.shiftKey ? SHIFT : 0) | (event.ctrlKey ? CTRL : 0) | (event.altKey ? ALT : 0) | (event.metaKey ? META : 0);
  if (now !== bits) {
    bits = now;
    tell('held', bits);
  }
}

/// Returns whether a key is left to the browser: its function keys, and keys with Control or Command, except
/// for the letters of undo and redo.
function isOfBrowser({ key, ctrlKey, metaKey, altKey }) {
  if (/^F(5|6|7|11|12)$/.test(key)) {
    return true;
  }
  return (ctrlKey || metaKey) && !altKey && !/^[zy]$/i.test(key);
}

addEventListener('keydown', (event) => {
  held(event);
  if (event.isComposing || event.key === 'Unidentified' || event.key === 'Process') {
    return;
  }
  if (isOfBrowser(event)) {
    return;
  }
  event.preventDefault();
  if (event.code === 'KeyV' && bits === 0 && !isTyping) {
    lock();
    return;
  }
  tell('key', event.code, event.key, true, event.repeat);
});

addEventListener('keyup', (event) => {
  held(event);
  tell('key', event.code, event.key, false, false);
});

typing.addEventListener('input', () => {
  [...typing.value].forEach((letter) => tell('key', '', letter, true, false));
  typing.value = '';
});

addEventListener('focus', () => tell('focus', true));
addEventListener('blur', () => tell('focus', false));
addEventListener('copy', (event) => {
  event.preventDefault();
  tell('copy');
});
addEventListener('cut', (event) => {
  event.preventDefault();
  tell('cut');
});
addEventListener('paste', (event) => {
  event.preventDefault();
  tell('paste', event.clipboardData?.getData('text') ?? '');
});

// ---- pointers

/// Position of the mouse, in points. It may leave the page while the mouse is locked.
let place = [0, 0];
const at = ({ clientX, clientY }) => [clientX, clientY];
const isLocked = () => document.pointerLockElement === canvas;

/// Locks and hides the mouse, so that it can turn the camera without limit; Esc unlocks it. Browsers may
/// refuse.
function lock() {
  Promise.resolve(canvas.requestPointerLock?.()).catch(() => {});
}

function finger(event) {
  event.preventDefault();
  tell('touch', event.pointerId, event.type, ...at(event));
}

canvas.addEventListener('pointerdown', (event) => {
  held(event);
  canvas.setPointerCapture(event.pointerId);
  if (event.pointerType === 'touch') {
    finger(event);
    return;
  }
  canvas.focus();
  event.preventDefault();
  if (isLocked()) {
    return;
  }
  isPressed = true;
  place = at(event);
  tell('button', ...place, event.button, true);
});

canvas.addEventListener('pointermove', (event) => {
  if (event.pointerType === 'touch') {
    finger(event);
    return;
  }
  held(event);
  const moved = [event.movementX, event.movementY];
  if (isLocked() && !isPressed) {
    tell('look', ...moved);
    return;
  }
  place = isLocked() ? place.map((side, axis) => side + moved[axis]) : at(event);
  tell('moved', ...place, ...moved);
});

for (const kind of ['pointerup', 'pointercancel']) {
  canvas.addEventListener(kind, (event) => {
    if (event.pointerType === 'touch') {
      finger(event);
    } else {
      if (isPressed) {
        isPressed = false;
        tell('button', ...place, Math.max(event.button, 0), false);
        document.exitPointerLock?.();
      }
    }
  });
}

canvas.addEventListener('pointerleave', (event) => {
  if (event.pointerType !== 'touch') {
    tell('gone');
  }
});
canvas.addEventListener('wheel', (event) => {
  event.preventDefault();
  held(event);
  tell('wheel', event.deltaX, event.deltaY, event.deltaMode);
}, { passive: false });
canvas.addEventListener('contextmenu', (event) => event.preventDefault());

// ---- gamepads: the left stick moves, the right one turns, triggers go down and up

const DEAD = 0.15;
let wasPressed = false;
let isWatching = false;

function pads() {
  const pad = navigator.getGamepads().find((found) => found?.mapping === 'standard');
  isWatching = Boolean(pad);
  if (!pad) {
    tell('sticks', 0, 0, 0, 0, 0);
    return;
  }
  const [right, back, turn, down] = pad.axes.map((axis) => (Math.abs(axis) < DEAD ? 0 : axis));
  tell('sticks', right, pad.buttons[7].value - pad.buttons[6].value, -back, turn, -down);
  const { pressed } = pad.buttons[11];
  if (pressed && !wasPressed) {
    tell('reset_camera');
  }
  wasPressed = pressed;
  requestAnimationFrame(pads);
}

addEventListener('gamepadconnected', () => {
  if (!isWatching) {
    pads();
  }
});

// ---- files

/// Sends files that were chosen together to the viewer, and opens the main one.
async function open(list) {
  const chosen = [...list];
  const main = chosen.find(({ name }) => /\.(glb|gltf)$/i.test(name)) ?? chosen[0];
  if (!main) {
    return;
  }
  tell('files');
  for (const file of chosen) {
    const bytes = new Uint8Array(await file.arrayBuffer());
    worker.postMessage(['file', file.name, bytes], [bytes.buffer]);
  }
  tell('open_file', main.name);
}

files.onchange = () => open(files.files);
addEventListener('dragover', (event) => event.preventDefault());
addEventListener('drop', (event) => {
  event.preventDefault();
  open(event.dataTransfer.files);
});

// ---- the start

addEventListener('hashchange', () => tell('follow', location.hash));
document.addEventListener('visibilitychange', () => {
  if (document.hidden) {
    tell('save');
  }
});

if (!canvas.transferControlToOffscreen) {
  told.none();
} else {
  const [width, height] = pixels();
  const drawn = canvas.transferControlToOffscreen();
  const kept = asked.has('afresh') ? null : stored(STORED);
  worker.postMessage(
    {
      canvas: drawn,
      width,
      height,
      scale: devicePixelRatio,
      kept,
      page: location.href.split('#')[0],
      fragment: location.hash,
      wanted: asked.get('api'),
      sizes,
    },
    [drawn],
  );
  tell('dark', dark.matches);
}
