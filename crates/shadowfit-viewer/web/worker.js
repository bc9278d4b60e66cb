// Runs the viewer: loads its module, passes the page's messages to it, and draws frames.

const waiting = [];
let viewer = null;

/// Messages to the page after which the viewer cannot continue.
const ENDINGS = ['panic', 'lost', 'memory', 'failure'];
let isOver = false;

/// Ends the viewer, and tells the page why. No frame follows.
function end(kind, text) {
  if (!isOver) {
    isOver = true;
    postMessage([kind, text]);
  }
}

self.tellPage = (kind, value, name) => {
  if (ENDINGS.includes(kind)) {
    end(kind, value);
    return;
  }
  const transferred = value instanceof Uint8Array ? [value.buffer] : [];
  postMessage([kind, value, name], transferred);
};

/// Returns the pixels of an encoded image: width, height, and four bytes each. A canvas would multiply
/// colours by their opacity, and lose the colours of transparent pixels, so a texture is used.
self.decodeImage = async (bytes) => {
  const options = { premultiplyAlpha: 'none', colorSpaceConversion: 'none' };
  const picture = await createImageBitmap(new Blob([bytes]), options);
  const { width, height } = picture;
  const gl = new OffscreenCanvas(1, 1).getContext('webgl2');
  const rgba = new Uint8Array(width * height * 4);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, picture);
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, gl.getParameter(gl.TEXTURE_BINDING_2D), 0);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
  const error = gl.getError();
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  picture.close();
  if (error !== gl.NO_ERROR) {
    throw new Error(`${width} x ${height} pixels are too many`);
  }
  return [width, height, rgba];
};

/// Returns the module's bytes, to be compiled while they arrive, and reports their progress to the page.
async function fetched(url, bytes) {
  const answer = await fetch(url);
  if (!answer.ok) {
    throw new Error(`${url} cannot be loaded: ${answer.status}`);
  }
  let loaded = 0;
  const counted = new TransformStream({
    transform(part, out) {
      loaded += part.byteLength;
      postMessage(['loaded', Math.min(loaded / bytes, 1)]);
      out.enqueue(part);
    },
  });
  const headers = { 'Content-Type': 'application/wasm' };
  return new Response(answer.body.pipeThrough(counted), { headers });
}

/// Returns the browser's graphics API. `wanted` overrides it, and `none` means a browser without any.
async function api(wanted) {
  if (wanted) {
    return wanted === 'none' ? null : wanted;
  }
  const adapter = await navigator.gpu?.requestAdapter().catch(() => null);
  if (adapter) {
    return 'webgpu';
  }
  return new OffscreenCanvas(1, 1).getContext('webgl2') ? 'webgl2' : null;
}

function call([method, ...values]) {
  try {
    const answer = viewer[method](...values);
    if (method === 'facts') {
      postMessage(['facts', answer]);
    }
  } catch (error) {
    failed(error);
  }
}

/// Texts of errors for lack of memory. A module that stops without a panic, which would have been reported
/// before, has also run out of memory.
const WITHOUT_MEMORY = /malloc|allocation failed|out of memory/i;

function failed(error) {
  const text = `${error.message ?? error}`;
  const isStopped = error instanceof WebAssembly.RuntimeError && /unreachable/.test(text);
  end(isStopped || WITHOUT_MEMORY.test(text) ? 'memory' : 'failure', isStopped ? '' : text);
}

function frame() {
  if (isOver) {
    return;
  }
  try {
    viewer.frame();
  } catch (error) {
    failed(error);
    return;
  }
  requestAnimationFrame(frame);
}

async function start({ canvas, width, height, scale, kept, page, fragment, wanted, sizes }) {
  const found = await api(wanted);
  if (!found) {
    postMessage(['none']);
    return;
  }
  postMessage(['api', found]);
  const module = await import(`./${found}/shadowfit_viewer.js`);
  const url = new URL(`./${found}/shadowfit_viewer_bg.wasm`, import.meta.url);
  await module.default({ module_or_path: await fetched(url, sizes[found]) });
  postMessage(['compiled']);
  canvas.width = width;
  canvas.height = height;
  canvas.addEventListener('webglcontextlost', () => end('lost', ''));
  viewer = await module.Page.open(canvas, scale, kept ?? undefined, page, fragment);
  waiting.splice(0).forEach(call);
  requestAnimationFrame(frame);
}

// Errors between frames.
addEventListener('error', ({ error, message }) => failed(error ?? message));

onmessage = ({ data }) => {
  if (!Array.isArray(data)) {
    start(data).catch(failed);
  } else if (viewer) {
    call(data);
  } else {
    waiting.push(data);
  }
};
