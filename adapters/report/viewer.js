// The moving overlay of analysis and test. Without it the still picture stays.
(() => {
  const host = document.querySelector('figure.viewer');
  if (!host) return;
  const d = host.dataset;
  const unpack = (text, Kind) => new Kind(Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer);
  const xyz = unpack(d.xyz, Int16Array), shapes = unpack(d.shapes, Int8Array);
  const faces = unpack(d.faces, Uint16Array), lines = unpack(d.lines, Uint16Array);
  const sensors = unpack(d.sensors, Int16Array), axes = unpack(d.axes, Int8Array);
  const model = unpack(d.model, Int8Array), test = unpack(d.test, Int8Array);
  const labels = d.labels.split('|'), brief = d.brief.split('|');
  const nodes = xyz.length / 3, probes = sensors.length / 3, nFaces = faces.length / 4, nLines = lines.length / 2;
  const P = new Float32Array(3 * nodes), depth = new Float32Array(nFaces + nLines), order = new Uint32Array(nFaces + nLines);
  let reach = 0.05, height = 0.05;             // half extents across and along z, whatever the turn
  for (let i = 0; i < 3 * nodes; i += 3) { reach = Math.max(reach, Math.hypot(xyz[i], xyz[i + 1]) / 32767); height = Math.max(height, Math.abs(xyz[i + 2]) / 32767); }
  let ramp = [], ink = {}, amount = +d.amplitude;
  const colours = () => {
    const style = getComputedStyle(document.documentElement), get = n => style.getPropertyValue(n).trim();
    ramp = Array.from({ length: 20 }, (_, k) => get('--c' + k));
    ink = { mesh: get('--mesh'), line: get('--soft'), model: get('--ink'), test: get('--warm'), page: get('--page') };
  };

  const draw = (canvas, pair, s, view, detail) => {
    const k = devicePixelRatio || 1, w = canvas.clientWidth, h = canvas.clientHeight, ctx = canvas.getContext('2d');
    if (canvas.width !== Math.round(w * k) || canvas.height !== Math.round(h * k)) { canvas.width = Math.round(w * k); canvas.height = Math.round(h * k); }
    ctx.setTransform(k, 0, 0, k, 0, 0); ctx.clearRect(0, 0, w, h); ctx.lineJoin = 'round';
    const ca = Math.cos(view.turn), sa = Math.sin(view.turn), ce = Math.cos(view.lift), se = Math.sin(view.lift);
    const scale = 0.46 * view.zoom * Math.min(w / (reach + amount), h / (reach * Math.abs(se) + height * ce + amount));
    const project = (x, y, z, out, i) => {     // right, down, away
      out[i] = w / 2 + view.right + scale * (-sa * x + ca * y);
      out[i + 1] = h / 2 + view.down - scale * (-se * (ca * x + sa * y) + ce * z);
      out[i + 2] = -(ce * (ca * x + sa * y) + se * z);
    };
    const at = 3 * nodes * pair;
    for (let i = 0; i < 3 * nodes; i += 3)
      project(xyz[i] / 32767 + s * shapes[at + i] / 127, xyz[i + 1] / 32767 + s * shapes[at + i + 1] / 127, xyz[i + 2] / 32767 + s * shapes[at + i + 2] / 127, P, i);
    for (let f = 0; f < nFaces; f++) depth[f] = P[3 * faces[4 * f] + 2] + P[3 * faces[4 * f + 1] + 2] + P[3 * faces[4 * f + 2] + 2] + P[3 * faces[4 * f + 3] + 2];
    for (let l = 0; l < nLines; l++) depth[nFaces + l] = 2 * (P[3 * lines[2 * l] + 2] + P[3 * lines[2 * l + 1] + 2]) - 0.02;
    for (let i = 0; i < order.length; i++) order[i] = i;
    order.sort((a, b) => depth[b] - depth[a]);
    const size = n => Math.hypot(shapes[at + 3 * n], shapes[at + 3 * n + 1], shapes[at + 3 * n + 2]) / 127;
    for (const e of view.model ? order : []) {
      ctx.beginPath();
      if (e < nFaces) {
        let sum = 0;
        for (let c = 0; c < 4; c++) { const n = faces[4 * e + c]; sum += size(n); c ? ctx.lineTo(P[3 * n], P[3 * n + 1]) : ctx.moveTo(P[3 * n], P[3 * n + 1]); }
        ctx.closePath(); ctx.fillStyle = ramp[Math.min(11, Math.floor(3 * sum))]; ctx.fill();
        ctx.strokeStyle = ink.mesh; ctx.lineWidth = detail ? 0.5 : 0.25;
      } else {
        const l = e - nFaces, m = lines[2 * l], n = lines[2 * l + 1];
        ctx.moveTo(P[3 * m], P[3 * m + 1]); ctx.lineTo(P[3 * n], P[3 * n + 1]);
        ctx.strokeStyle = nFaces ? ink.line : ramp[Math.min(19, 5 + Math.floor(7 * (size(m) + size(n))))]; ctx.lineWidth = detail ? 1.4 : 0.8;
      }
      ctx.stroke();
    }
    if (detail) ['x', 'y', 'z'].forEach((name, k) => {
      const a = [-sa, ca, 0][k], b = [-se * ca, -se * sa, ce][k], x = 34, y = h - 34;
      ctx.beginPath(); ctx.moveTo(x, y); ctx.lineTo(x + 22 * a, y - 22 * b); ctx.strokeStyle = ink.line; ctx.lineWidth = 1.2; ctx.stroke();
      ctx.fillStyle = ink.line; ctx.font = '11px sans-serif'; ctx.fillText(name, x + 28 * a - 3, y - 28 * b + 3);
    });
    if (!view.test || (!detail && order.length)) return;     // sensors alone where there are no lines
    const q = new Float32Array(12), from = probes * pair;
    for (let i = 0; i < probes; i++) {
      const x = 2 * sensors[3 * i] / 32767, y = 2 * sensors[3 * i + 1] / 32767, z = 2 * sensors[3 * i + 2] / 32767;
      [model[from + i], test[from + i]].forEach((value, j) => {
        const r = s * 2 * value / 127;
        project(x + r * axes[3 * i] / 127, y + r * axes[3 * i + 1] / 127, z + r * axes[3 * i + 2] / 127, q, 3 * j);
      });
      project(x, y, z, q, 6);                // the direction that is measured, through where it rests
      const tick = k => 0.03 * axes[3 * i + k] / 127;
      project(x + tick(0), y + tick(1), z + tick(2), q, 9); q[9] -= q[6]; q[10] -= q[7];
      ctx.globalAlpha = Math.min(1, Math.max(0.18, 0.62 - 1.1 * q[2]));
      ctx.beginPath(); ctx.moveTo(q[6] - q[9], q[7] - q[10]); ctx.lineTo(q[6] + q[9], q[7] + q[10]); ctx.strokeStyle = ink.line; ctx.lineWidth = 0.7; ctx.stroke();
      ctx.beginPath(); ctx.moveTo(q[0], q[1]); ctx.lineTo(q[3], q[4]); ctx.strokeStyle = ink.test; ctx.lineWidth = 2; ctx.stroke();
      for (const [j, colour] of [[0, ink.model], [3, ink.test]]) { ctx.beginPath(); ctx.arc(q[j], q[j + 1], 3, 0, 7); ctx.fillStyle = colour; ctx.fill(); ctx.strokeStyle = ink.page; ctx.lineWidth = 0.8; ctx.stroke(); }
    }
    ctx.globalAlpha = 1;
  };

  const make = (name, fields = {}, ...children) => { const e = Object.assign(document.createElement(name), fields); e.append(...children); return e; };
  const front = { turn: -0.86, lift: 0.48, zoom: 1, right: 0, down: 0, model: true, test: true };
  const view = { ...front };
  let pair = 0, playing = !matchMedia('(prefers-reduced-motion: reduce)').matches, seen = false, start = 0;
  const canvas = make('canvas', { tabIndex: 0 }); canvas.setAttribute('role', 'img');
  const caption = make('figcaption'), strip = make('div', { className: 'strip' });
  const play = make('button', { type: 'button' });
  const press = (text, title, act) => { const b = make('button', { type: 'button', title }, text); b.addEventListener('click', () => { act(); if (!playing) still(); }); return b; };
  const look = (turn, lift) => () => Object.assign(view, { turn, lift, zoom: 1, right: 0, down: 0 });
  const zoom = by => { view.zoom = Math.min(20, Math.max(0.2, view.zoom * by)); };
  const shown = (what, name) => { const box = make('input', { type: 'checkbox', checked: true }); box.addEventListener('change', () => { view[what] = box.checked; if (!playing) still(); }); return make('label', {}, box, name); };
  const save = () => {                       // on the page's colour, as large as it is shown
    const sheet = make('canvas', { width: canvas.width, height: canvas.height }), ctx = sheet.getContext('2d');
    ctx.fillStyle = ink.page; ctx.fillRect(0, 0, sheet.width, sheet.height); ctx.drawImage(canvas, 0, 0);
    make('a', { href: sheet.toDataURL('image/png'), download: labels[pair].replace(/[^\w.]+/g, '_').slice(0, 60) + '.png' }).click();
  };
  const slider = make('input', { type: 'range', min: 0, max: 0.4, step: 0.01, value: amount });
  const stage = host.querySelector('.stage');
  const still = () => { draw(canvas, pair, amount, view, true); };
  const pick = n => {
    pair = n; caption.textContent = labels[n][0].toUpperCase() + labels[n].slice(1); canvas.setAttribute('aria-label', `Shapes of ${labels[n]}. Arrow keys turn the view.`);
    [...strip.children].forEach((b, k) => b.setAttribute('aria-pressed', k === n)); if (!playing) still();
  };
  const frame = time => {
    if (!playing || !seen) return;
    start = start || time; draw(canvas, pair, amount * Math.cos((time - start) / 320), view, true); requestAnimationFrame(frame);
  };
  const run = on => { playing = on; play.textContent = on ? 'Pause' : 'Play'; start = 0; on ? requestAnimationFrame(frame) : still(); };
  stage.replaceChildren(caption, canvas, make('div', { className: 'controls' }, play, make('label', {}, 'amplitude ', slider),
    press('iso', 'from the front', look(front.turn, front.lift)), press('x', 'along x', look(0, 0)), press('y', 'along y', look(-Math.PI / 2, 0)), press('z', 'along z', look(-Math.PI / 2, Math.PI / 2)),
    press('+', 'nearer (Ctrl and wheel)', () => zoom(1.25)), press('\u2212', 'farther', () => zoom(0.8)), ...(probes ? [shown('model', 'structure'), shown('test', 'sensors')] : []), press('PNG', 'save what is shown', save)), strip);
  colours();
  labels.forEach((label, k) => {
    const small = make('canvas'), b = make('button', { type: 'button', title: label }, small, brief[k]);
    b.addEventListener('click', () => pick(k)); strip.append(b);
  });
  const thumbs = () => [...strip.querySelectorAll('canvas')].forEach((c, k) => draw(c, k, +d.amplitude, front, false));
  thumbs(); pick(0); run(playing); still();
  play.addEventListener('click', () => run(!playing));
  slider.addEventListener('input', () => { amount = +slider.value; if (!playing) still(); });
  let held = null;
  canvas.addEventListener('pointerdown', e => { held = [e.clientX, e.clientY]; canvas.setPointerCapture(e.pointerId); });
  canvas.addEventListener('pointerup', () => { held = null; });
  const turn = (x, y) => { view.turn -= x; view.lift = Math.min(1.57, Math.max(-1.57, view.lift + y)); if (!playing) still(); };
  canvas.addEventListener('wheel', e => { if (e.ctrlKey) { e.preventDefault(); zoom(Math.exp(-e.deltaY / 300)); if (!playing) still(); } }, { passive: false });
  canvas.addEventListener('pointermove', e => { if (held && e.shiftKey) { view.right += e.clientX - held[0]; view.down += e.clientY - held[1]; held = [e.clientX, e.clientY]; if (!playing) still(); } else if (held) { turn((e.clientX - held[0]) / 120, (e.clientY - held[1]) / 120); held = [e.clientX, e.clientY]; } });
  canvas.addEventListener('keydown', e => {
    const step = { ArrowLeft: [-0.12, 0], ArrowRight: [0.12, 0], ArrowUp: [0, -0.12], ArrowDown: [0, 0.12] }[e.key];
    if (step) { e.preventDefault(); turn(...step); }
    if (e.key === '+' || e.key === '-') { zoom(e.key === '+' ? 1.25 : 0.8); if (!playing) still(); }
  });
  new IntersectionObserver(all => { seen = all[0].isIntersecting; if (seen && playing) requestAnimationFrame(frame); }).observe(canvas);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { colours(); thumbs(); still(); });
  addEventListener('resize', () => { if (!playing) still(); });
})();
