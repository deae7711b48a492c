// The moving shapes of analysis and test. Without it the still picture stays.
(() => {
  const host = document.querySelector('figure.viewer');
  if (!host) return;
  const d = host.dataset;
  const unpack = (text, Kind) => new Kind(Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer);
  const xyz = unpack(d.xyz, Int16Array), shapes = unpack(d.shapes, Int8Array);
  const faces = unpack(d.faces, Uint16Array), lines = unpack(d.lines, Uint16Array);
  const sensors = unpack(d.sensors, Int16Array), axes = unpack(d.axes, Int8Array);
  const places = unpack(d.places, Int16Array), traced = unpack(d.traced, Uint16Array);
  const model = unpack(d.model, Int8Array), test = unpack(d.test, Int8Array);
  const labels = d.labels.split('|'), brief = d.brief.split('|'), sides = d.sides.split(' '), before = d.before.split(' ').map(Number);
  const nodes = xyz.length / 3, probes = sensors.length / 3, spots = places.length / 3, nFaces = faces.length / 4, nLines = lines.length / 2;
  const P = new Float32Array(3 * nodes), Q = new Float32Array(3 * spots), R = new Float32Array(3 * spots), depth = new Float32Array(nFaces + nLines), order = new Uint32Array(nFaces + nLines);
  let reach = 0.05, height = 0.05;             // half extents across and along z, whatever the turn
  for (let i = 0; i < 3 * nodes; i += 3) { reach = Math.max(reach, Math.hypot(xyz[i], xyz[i + 1]) / 32767); height = Math.max(height, Math.abs(xyz[i + 2]) / 32767); }
  let ramp = [], ink = {}, amount = +d.amplitude;
  const colours = () => {
    const style = getComputedStyle(document.documentElement), get = n => style.getPropertyValue(n).trim();
    ramp = Array.from({ length: 20 }, (_, k) => get('--c' + k));
    ink = { mesh: get('--mesh'), line: get('--soft'), model: get('--ink'), test: get('--warm'), page: get('--page') };
  };

  // One view of a frame: `who` moves (both, test, analysis); left, width and height in pixels of the page.
  const view3 = (ctx, frame, s, view, detail, who, left, w, h) => {
    const ca = Math.cos(view.turn), sa = Math.sin(view.turn), ce = Math.cos(view.lift), se = Math.sin(view.lift);
    const scale = 0.46 * view.zoom * Math.min(w / (reach + amount), h / (reach * Math.abs(se) + height * ce + amount));
    const project = (x, y, z, out, i) => {     // right, down, away
      out[i] = left + w / 2 + view.right + scale * (-sa * x + ca * y);
      out[i + 1] = h / 2 + view.down - scale * (-se * (ca * x + sa * y) + ce * z);
      out[i + 2] = -(ce * (ca * x + sa * y) + se * z);
    };
    ctx.save(); ctx.beginPath(); ctx.rect(left, 0, w, h); ctx.clip();
    const at = 3 * nodes * frame, m = who === 'test' ? 0 : s;
    for (let i = 0; i < 3 * nodes; i += 3)
      project(xyz[i] / 32767 + m * shapes[at + i] / 127, xyz[i + 1] / 32767 + m * shapes[at + i + 1] / 127, xyz[i + 2] / 32767 + m * shapes[at + i + 2] / 127, P, i);
    for (let f = 0; f < nFaces; f++) depth[f] = P[3 * faces[4 * f] + 2] + P[3 * faces[4 * f + 1] + 2] + P[3 * faces[4 * f + 2] + 2] + P[3 * faces[4 * f + 3] + 2];
    for (let l = 0; l < nLines; l++) depth[nFaces + l] = 2 * (P[3 * lines[2 * l] + 2] + P[3 * lines[2 * l + 1] + 2]) - 0.02;
    for (let i = 0; i < order.length; i++) order[i] = i;
    order.sort((a, b) => depth[b] - depth[a]);
    const size = n => Math.hypot(shapes[at + 3 * n], shapes[at + 3 * n + 1], shapes[at + 3 * n + 2]) / 127;
    ctx.globalAlpha = who === 'test' ? 0.35 : 1;           // at rest behind the test alone
    for (const e of order) {
      ctx.beginPath();
      if (e < nFaces) {
        let sum = 0;
        for (let c = 0; c < 4; c++) { const n = faces[4 * e + c]; sum += size(n); c ? ctx.lineTo(P[3 * n], P[3 * n + 1]) : ctx.moveTo(P[3 * n], P[3 * n + 1]); }
        ctx.closePath(); ctx.fillStyle = ramp[who === 'test' ? 0 : Math.min(11, Math.floor(3 * sum))]; ctx.fill();
        ctx.strokeStyle = ink.mesh; ctx.lineWidth = detail ? 0.5 : 0.25;
      } else {
        const l = e - nFaces, a = lines[2 * l], b = lines[2 * l + 1];
        ctx.moveTo(P[3 * a], P[3 * a + 1]); ctx.lineTo(P[3 * b], P[3 * b + 1]);
        ctx.strokeStyle = nFaces || who === 'test' ? ink.line : ramp[Math.min(19, 5 + Math.floor(7 * (size(a) + size(b))))]; ctx.lineWidth = detail ? 1.4 : 0.8;
      }
      ctx.stroke();
    }
    ctx.globalAlpha = 1;
    if (detail) ['x', 'y', 'z'].forEach((name, k) => {
      const a = [-sa, ca, 0][k], b = [-se * ca, -se * sa, ce][k], x = left + 34, y = h - 34;
      ctx.beginPath(); ctx.moveTo(x, y); ctx.lineTo(x + 22 * a, y - 22 * b); ctx.strokeStyle = ink.line; ctx.lineWidth = 1.2; ctx.stroke();
      ctx.fillStyle = ink.line; ctx.font = '11px sans-serif'; ctx.fillText(name, x + 28 * a - 3, y - 28 * b + 3);
    });
    if (who === 'analysis' || (!detail && order.length && who !== 'test')) return ctx.restore();
    const q = new Float32Array(6), from = 3 * spots * frame;
    if (detail) for (let i = 0; i < probes; i++) {           // the direction that is measured, through where it rests
      const [x, y, z] = [0, 1, 2].map(k => 2 * sensors[3 * i + k] / 32767), [u, v, t] = [0, 1, 2].map(k => 0.03 * axes[3 * i + k] / 127);
      project(x - u, y - v, z - t, q, 0); project(x + u, y + v, z + t, q, 3);
      ctx.beginPath(); ctx.moveTo(q[0], q[1]); ctx.lineTo(q[3], q[4]); ctx.strokeStyle = ink.line; ctx.lineWidth = 0.7; ctx.stroke();
    }
    const put = (of, out) => { for (let i = 0; i < 3 * spots; i += 3) project(...[0, 1, 2].map(k => 2 * places[i + k] / 32767 + s * 2 * of[from + i + k] / 127), out, i); };
    put(model, Q); put(test, R);
    const mark = w > 400 && h > 300 ? 3 : 1.5;
    ctx.strokeStyle = ink.test; ctx.lineWidth = detail ? 1.6 : 0.9;
    for (let l = 0; l < traced.length; l += 2) { const a = 3 * traced[l], b = 3 * traced[l + 1]; ctx.beginPath(); ctx.moveTo(R[a], R[a + 1]); ctx.lineTo(R[b], R[b + 1]); ctx.stroke(); }
    if (detail) for (let i = 0; i < 3 * spots; i += 3) {
      ctx.globalAlpha = Math.min(1, Math.max(0.25, 0.7 - 1.1 * R[i + 2])); ctx.strokeStyle = ink.page; ctx.lineWidth = 0.8;
      if (who === 'both') {
        ctx.beginPath(); ctx.moveTo(Q[i], Q[i + 1]); ctx.lineTo(R[i], R[i + 1]); ctx.strokeStyle = ink.line; ctx.stroke(); ctx.strokeStyle = ink.page;
        ctx.beginPath(); ctx.arc(Q[i], Q[i + 1], mark, 0, 7); ctx.fillStyle = ink.model; ctx.fill(); ctx.stroke();
      }
      ctx.fillStyle = ink.test; ctx.fillRect(R[i] - mark, R[i + 1] - mark, 2 * mark, 2 * mark); ctx.strokeRect(R[i] - mark, R[i + 1] - mark, 2 * mark, 2 * mark);
    }
    ctx.restore();
  };
  // A frame on a canvas of some size, its sides over each other or apart.
  const draw = (canvas, frame, s, view, detail, side, how, w, h, k) => {
    const ctx = canvas.getContext('2d');
    if (canvas.width !== Math.round(w * k) || canvas.height !== Math.round(h * k)) { canvas.width = Math.round(w * k); canvas.height = Math.round(h * k); }
    ctx.setTransform(k, 0, 0, k, 0, 0); ctx.clearRect(0, 0, w, h); ctx.lineJoin = 'round';
    if (side !== 'both' || how === 'test' || how === 'analysis') return view3(ctx, frame, s, view, detail, side === 'both' ? how : side, 0, w, h);
    if (how === 'both') return view3(ctx, frame, s, view, detail, 'both', 0, w, h);
    ['test', 'analysis'].forEach((who, j) => {
      view3(ctx, frame, s, view, detail, who, j * w / 2, w / 2, h);
      ctx.fillStyle = ink.line; ctx.font = '12px sans-serif'; ctx.fillText(who, j * w / 2 + 6, 14);
    });
  };

  const make = (name, fields = {}, ...children) => { const e = Object.assign(document.createElement(name), fields); e.append(...children); return e; };
  const front = { turn: -0.86, lift: 0.48, zoom: 1, right: 0, down: 0 };
  const view = { ...front }, ratio = () => devicePixelRatio || 1;
  let pair = 0, how = 'both', plain = false, playing = !matchMedia('(prefers-reduced-motion: reduce)').matches, seen = false, start = 0;
  const canvas = make('canvas', { tabIndex: 0 }); canvas.setAttribute('role', 'img');
  const caption = make('figcaption'), strip = make('div', { className: 'strip' });
  const play = make('button', { type: 'button' });
  const frameOf = n => plain && before[n] >= 0 ? before[n] : n;
  const show = s => draw(canvas, frameOf(pair), s, view, true, sides[pair], how, canvas.clientWidth, canvas.clientHeight, ratio());
  const still = () => { if (!playing) show(amount); };
  const press = (text, title, act) => { const b = make('button', { type: 'button', title }, text); b.addEventListener('click', () => { act(); still(); }); return b; };
  const look = (turn, lift) => () => Object.assign(view, { turn, lift, zoom: 1, right: 0, down: 0 });
  const zoom = by => { view.zoom = Math.min(20, Math.max(0.2, view.zoom * by)); };
  const ways = make('select', { title: 'what is shown' }, ...[['both', 'overlaid'], ['apart', 'side by side'], ['analysis', 'analysis'], ['test', 'test']].map(([value, text]) => make('option', { value }, text)));
  ways.addEventListener('change', () => { how = ways.value; still(); });
  const raw = make('input', { type: 'checkbox' }), rawly = make('label', { title: 'close modes as they were computed and measured, not turned onto each other' }, raw, 'before turning');
  raw.addEventListener('change', () => { plain = raw.checked; pick(pair); });
  const save = () => {                       // on the page's colour, as large as it is shown
    const sheet = make('canvas', { width: canvas.width, height: canvas.height }), ctx = sheet.getContext('2d');
    ctx.fillStyle = ink.page; ctx.fillRect(0, 0, sheet.width, sheet.height); ctx.drawImage(canvas, 0, 0);
    make('a', { href: sheet.toDataURL('image/png'), download: labels[pair].replace(/[^\w.]+/g, '_').slice(0, 60) + '.png' }).click();
  };
  const slider = make('input', { type: 'range', min: 0, max: 0.4, step: 0.01, value: amount });
  const stage = host.querySelector('.stage'), told = text => text[0].toUpperCase() + text.slice(1);
  const pick = n => {
    pair = n; raw.disabled = before[n] < 0; ways.disabled = sides[n] !== 'both';
    caption.textContent = told(labels[frameOf(n)]); canvas.setAttribute('aria-label', `Shapes of ${labels[n]}. Arrow keys turn the view.`);
    [...strip.children].forEach((b, k) => b.setAttribute('aria-pressed', k === n)); still();
  };
  const frame = time => {
    if (!playing || !seen) return;
    start = start || time; show(amount * Math.cos((time - start) / 320)); requestAnimationFrame(frame);
  };
  const run = on => { playing = on; play.textContent = on ? 'Pause' : 'Play'; start = 0; on ? requestAnimationFrame(frame) : still(); };
  const stills = make('div', { className: 'stills' }), every = make('details', {}, make('summary', {}, spots ? 'All, test beside analysis' : 'All'), stills);
  stage.replaceChildren(caption, canvas, make('div', { className: 'controls' }, play, make('label', {}, 'amplitude ', slider),
    ...(traced.length ? [ways] : []), ...(before.some(b => b >= 0) ? [rawly] : []),
    make('span', {}, press('iso', 'from the front', look(front.turn, front.lift)), press('x', 'along x', look(0, 0)), press('y', 'along y', look(-Math.PI / 2, 0)), press('z', 'along z', look(-Math.PI / 2, Math.PI / 2)),
      press('+', 'nearer (Ctrl and wheel)', () => zoom(1.25)), press('\u2212', 'farther', () => zoom(0.8))), press('PNG', 'save what is shown', save)), strip, every);
  colours();
  brief.forEach((text, k) => {
    const small = make('canvas'), b = make('button', { type: 'button', title: labels[k] }, small, text);
    b.addEventListener('click', () => pick(k)); strip.append(b);
  });
  const thumbs = () => [...strip.querySelectorAll('canvas')].forEach((c, k) => draw(c, k, +d.amplitude, front, false, sides[k], 'both', 92, 84, ratio()));
  const spread = () => { stills.replaceChildren(...brief.map((_, k) => { const c = make('canvas'); draw(c, frameOf(k), amount, view, true, sides[k], traced.length ? 'apart' : 'both', 520, 210, 2); return make('figure', {}, c, make('figcaption', {}, told(labels[frameOf(k)]))); })); };
  thumbs(); pick(0); run(playing); show(amount);
  every.addEventListener('toggle', () => { if (every.open) spread(); });
  addEventListener('beforeprint', () => { every.open = true; spread(); });
  addEventListener('afterprint', () => { every.open = false; });
  play.addEventListener('click', () => run(!playing));
  slider.addEventListener('input', () => { amount = +slider.value; still(); });
  let held = null;
  canvas.addEventListener('pointerdown', e => { held = [e.clientX, e.clientY]; canvas.setPointerCapture(e.pointerId); });
  canvas.addEventListener('pointerup', () => { held = null; });
  const turn = (x, y) => { view.turn -= x; view.lift = Math.min(1.57, Math.max(-1.57, view.lift + y)); still(); };
  canvas.addEventListener('wheel', e => { if (e.ctrlKey) { e.preventDefault(); zoom(Math.exp(-e.deltaY / 300)); still(); } }, { passive: false });
  canvas.addEventListener('pointermove', e => { if (held && e.shiftKey) { view.right += e.clientX - held[0]; view.down += e.clientY - held[1]; held = [e.clientX, e.clientY]; still(); } else if (held) { turn((e.clientX - held[0]) / 120, (e.clientY - held[1]) / 120); held = [e.clientX, e.clientY]; } });
  canvas.addEventListener('keydown', e => {
    const step = { ArrowLeft: [-0.12, 0], ArrowRight: [0.12, 0], ArrowUp: [0, -0.12], ArrowDown: [0, 0.12] }[e.key];
    if (step) { e.preventDefault(); turn(...step); }
    if (e.key === '+' || e.key === '-') { zoom(e.key === '+' ? 1.25 : 0.8); still(); }
  });
  new IntersectionObserver(all => { seen = all[0].isIntersecting; if (seen && playing) requestAnimationFrame(frame); }).observe(canvas);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { colours(); thumbs(); still(); });
  addEventListener('resize', still);
})();
