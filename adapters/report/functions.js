// The function that the menu names. Without it the first one stays.
(() => {
  const host = document.querySelector('figure.overlaid');
  if (!host) return;
  const d = host.dataset, unpack = (text, Kind) => new Kind(Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer);
  const size = unpack(d.size, Uint8Array), angle = unpack(d.angle, Int8Array);
  const x = d.x.split(' ').map(Number), f = d.f.split(' '), n = x.length;
  const gaps = new Set(d.gaps ? d.gaps.split(' ').map(Number) : []);
  const [low, high] = d.decades.split(' ').map(Number), [top, tall, below, deep] = d.panels.split(' ').map(Number);
  const svg = host.querySelector('svg'), menu = host.querySelector('select'), cursor = svg.querySelector('.cursor');
  const tip = document.getElementById('tip'), names = d.names.split('|');
  let shown = 0;
  const path = (y, jump) => x.map((a, k) => (k && !gaps.has(k) && Math.abs(y[k] - y[k - 1]) <= jump ? 'L' : 'M') + a + ' ' + y[k].toFixed(1)).join('');
  const part = (all, j) => Array.from(all.subarray(n * (2 * shown + j), n * (2 * shown + j + 1)));
  const draw = () => ['measured', 'made'].forEach((kind, j) => {
    svg.querySelector(`.${kind}.size`).setAttribute('d', path(part(size, j).map(v => top + tall * (1 - v / 255)), Infinity));
    svg.querySelector(`.${kind}.angle`).setAttribute('d', path(part(angle, j).map(v => below + deep * .5 * (1 - v / 127)), deep / 2));
  });
  const pick = k => { shown = k; menu.value = k; draw(); svg.setAttribute('aria-label', `Magnitude and phase of ${menu.options[k].text}.`); };
  menu.addEventListener('change', () => pick(+menu.value));
  for (const row of document.querySelectorAll('button[data-function]')) row.addEventListener('click', () => {
    const k = names.indexOf(row.dataset.function);
    if (k >= 0) { pick(k); host.scrollIntoView({ block: 'nearest' }); }
  });
  svg.addEventListener('pointermove', e => {
    const b = svg.getBoundingClientRect(), u = (e.clientX - b.left) * svg.viewBox.baseVal.width / b.width;
    let k = 0; x.forEach((a, j) => { if (Math.abs(a - u) < Math.abs(x[k] - u)) k = j; });
    const told = j => { const at = n * (2 * shown + j) + k; return (10 ** (low + (high - low) * size[at] / 255)).toPrecision(2) + ', ' + Math.round(180 * angle[at] / 127) + '°'; };
    cursor.setAttribute('transform', `translate(${x[k]} 0)`); cursor.removeAttribute('hidden');
    tip.textContent = `${f[k]} Hz\nmeasured ${told(0)}\n${d.made} ${told(1)}`; tip.hidden = false;
    tip.style.left = Math.min(e.clientX + 14, innerWidth - tip.offsetWidth - 4) + 'px'; tip.style.top = e.clientY + 16 + 'px';
  });
  svg.addEventListener('pointerleave', () => { tip.hidden = true; cursor.setAttribute('hidden', ''); });
  pick(0);
})();
