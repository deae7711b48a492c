// Values under the pointer. The page is complete without this script.
(() => {
  const tip = document.getElementById('tip');
  const show = (text, x, y) => {
    tip.textContent = text; tip.hidden = false;
    const w = tip.offsetWidth, h = tip.offsetHeight;
    tip.style.left = Math.max(4, x + 14 + w > innerWidth ? x - w - 12 : x + 14) + 'px';
    tip.style.top = Math.max(4, y + 16 + h > innerHeight ? y - h - 12 : y + 16) + 'px';
  };
  const hide = () => { tip.hidden = true; };
  const inside = (svg, e) => {            // pointer in user units of the drawing
    const b = svg.getBoundingClientRect(), v = svg.viewBox.baseVal;
    return [(e.clientX - b.left) * v.width / b.width, (e.clientY - b.top) * v.height / b.height];
  };
  const outside = (svg, x, y) => {
    const b = svg.getBoundingClientRect(), v = svg.viewBox.baseVal;
    return [b.left + x * b.width / v.width, b.top + y * b.height / v.height];
  };
  const toggle = (node, on) => on ? node.removeAttribute('hidden') : node.setAttribute('hidden', '');

  for (const svg of document.querySelectorAll('svg.heat')) {
    const d = svg.dataset, rows = d.rows.split('|'), cols = d.cols.split('|'), sides = d.sides.split('|'), cell = +d.cell;
    const cursor = svg.querySelector('.cursor'), left = 84, top = 8;
    let at = [0, 0];
    const pick = (r, c) => {
      at = [r, c] = [Math.min(Math.max(r, 0), rows.length - 1), Math.min(Math.max(c, 0), cols.length - 1)];
      const code = d.v.substr(2 * (r * cols.length + c), 2);
      const value = code === '--' ? 'unknown' : (parseInt(code, 36) / 10).toFixed(1) + ' %';
      cursor.setAttribute('x', c * cell); cursor.setAttribute('y', r * cell); toggle(cursor, true);
      return `MAC ${value}\n${sides[0]} ${rows[r]}\n${sides[1]} ${cols[c]}`;
    };
    const leave = () => { hide(); toggle(cursor, false); };
    svg.addEventListener('pointermove', e => {
      const [x, y] = inside(svg, e), r = Math.floor((y - top) / cell), c = Math.floor((x - left) / cell);
      if (r < 0 || c < 0 || r >= rows.length || c >= cols.length) return leave();
      show(pick(r, c), e.clientX, e.clientY);
    });
    svg.addEventListener('keydown', e => {
      const step = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] }[e.key];
      if (!step) return;
      e.preventDefault();
      const text = pick(at[0] + step[0], at[1] + step[1]);
      show(text, ...outside(svg, left + (at[1] + .5) * cell, top + (at[0] + .5) * cell));
    });
    svg.addEventListener('pointerleave', leave); svg.addEventListener('blur', leave);
  }

  for (const svg of document.querySelectorAll('svg.lines')) {
    const d = svg.dataset, x = d.x.split(' '), px = d.px.split(' ').map(Number);
    const names = d.names.split('|'), v = d.v.split('|').map(s => s.split(' '));
    const cursor = svg.querySelector('.cursor'), groups = [...svg.querySelectorAll('.series')];
    let at = px.length - 1;
    const told = (k, near) => {
      at = k = Math.min(Math.max(k, 0), px.length - 1);
      cursor.setAttribute('transform', `translate(${px[k]} 0)`); toggle(cursor, true);
      const rows = names.map((n, j) => [n, v[j][k], j]).filter(r => r[1] !== '' && r[1] !== undefined);
      rows.sort((a, b) => b[1] - a[1]);
      return `iteration ${x[k]}\n` + rows.map(r => `${r[2] === near ? '▸ ' : ''}${r[0]}: ${r[1]}${d.unit ? ' ' + d.unit : ''}`).join('\n');
    };
    const leave = () => { hide(); toggle(cursor, false); svg.classList.remove('picking'); groups.forEach(g => g.classList.remove('on')); };
    svg.addEventListener('pointermove', e => {
      const [ux] = inside(svg, e);
      let k = 0; px.forEach((p, j) => { if (Math.abs(p - ux) < Math.abs(px[k] - ux)) k = j; });
      const hit = document.elementsFromPoint(e.clientX, e.clientY).map(n => n.closest && n.closest('.series')).find(Boolean);
      svg.classList.toggle('picking', !!hit); groups.forEach(g => g.classList.toggle('on', g === hit));
      show(told(k, hit ? +hit.dataset.k : -1), e.clientX, e.clientY);
    });
    svg.addEventListener('keydown', e => {
      const step = { ArrowLeft: -1, ArrowRight: 1 }[e.key];
      if (!step) return;
      e.preventDefault();
      const text = told(at + step, -1), [sx, sy] = outside(svg, px[at], 30);
      show(text, sx, sy);
    });
    svg.addEventListener('pointerleave', leave); svg.addEventListener('blur', leave);
  }

  for (const hot of document.querySelectorAll('.hot')) {   // faster than the browser's own titles
    const title = hot.querySelector('title');
    if (!title) continue;
    const text = title.textContent;
    title.remove(); hot.setAttribute('aria-label', text);
    hot.addEventListener('pointermove', e => show(text, e.clientX, e.clientY));
    hot.addEventListener('pointerleave', hide);
  }
  addEventListener('scroll', hide, { passive: true });

  // Every picture as SVG or PNG, every table as CSV.
  const make = (name, fields, ...children) => { const e = Object.assign(document.createElement(name), fields); e.append(...children); return e; };
  const press = (text, title, act) => { const b = make('button', { type: 'button', title }, text); b.addEventListener('click', act); return b; };
  const keep = (name, blob) => { const href = URL.createObjectURL(blob); make('a', { href, download: name }).click(); setTimeout(() => URL.revokeObjectURL(href), 9e3); };
  const named = node => (node.closest('figure')?.querySelector('figcaption b')?.textContent || node.closest('section')?.querySelector('h2')?.textContent || 'trueup').replace(/[^\w.]+/g, '_');
  const style = document.querySelector('style').textContent.replace(/@media screen and \(prefers-color-scheme:dark\)\{:root\{[^}]*\}\}/g, '');
  const drawn = svg => {                     // in the colours of paper, by itself
    const box = svg.viewBox.baseVal, copy = svg.cloneNode(true), own = document.createElementNS(svg.namespaceURI, 'style'), sheet = document.createElementNS(svg.namespaceURI, 'rect');
    own.textContent = style + 'svg{font-family:Arial,Helvetica,sans-serif;overflow:hidden}';
    for (const [k, v] of [['width', box.width], ['height', box.height], ['fill', '#fff']]) sheet.setAttribute(k, v);
    copy.setAttribute('width', box.width); copy.setAttribute('height', box.height); copy.prepend(own, sheet);
    return new Blob([new XMLSerializer().serializeToString(copy)], { type: 'image/svg+xml' });
  };
  const pixels = (svg, done) => {
    const picture = new Image(), box = svg.viewBox.baseVal, href = URL.createObjectURL(drawn(svg));
    picture.onload = () => { const c = make('canvas', { width: 2 * box.width, height: 2 * box.height }); c.getContext('2d').drawImage(picture, 0, 0, c.width, c.height); URL.revokeObjectURL(href); c.toBlob(done); };
    picture.src = href;
  };
  const lines = table => {
    const [above, heads] = [...table.tHead?.rows || []].length > 1 ? table.tHead.rows : [null, table.tHead?.rows[0]];
    const groups = above ? [...above.cells].flatMap(c => Array(c.colSpan).fill(c.textContent)) : [];
    const cell = (c, k) => '"' + [groups[k], c.textContent].filter(Boolean).join(' ').trim().replace(/"/g, '""') + '"';
    const value = c => { const text = c.textContent.trim().replace(/\u2212/g, '-').replace(/^\u2013$/, ''); return /^[-+]?[\d.]+(e-?\d+)?$/.test(text) || !text ? text : '"' + text.replace(/"/g, '""') + '"'; };
    const rows = heads ? [...table.tBodies[0].rows] : [...table.rows];
    return [...heads ? [[...heads.cells].map(cell)] : [], ...rows.map(r => [...r.cells].map(value))].map(r => r.join(',')).join('\r\n') + '\r\n';
  };
  for (const figure of document.querySelectorAll('figure:not(.viewer)')) {
    const pictures = [...figure.querySelectorAll('svg')], caption = figure.querySelector('figcaption') || figure.appendChild(make('figcaption', {}));
    const each = act => () => pictures.forEach((svg, k) => act(svg, named(svg) + (k ? '_' + (k + 1) : '')));
    if (pictures.length) caption.append(make('span', { className: 'keep' }, press('SVG', 'save as a drawing', each((svg, name) => keep(name + '.svg', drawn(svg)))), press('PNG', 'save as a picture', each((svg, name) => pixels(svg, blob => keep(name + '.png', blob))))));
  }
  for (const table of document.querySelectorAll('table')) {
    const figure = table.closest('figure'), block = table.closest('.wide'), next = block?.nextElementSibling;
    const place = figure ? figure.querySelector('.keep') : next?.matches('p.note') ? next : block?.parentNode.appendChild(make('p', { className: 'note' }));
    const save = press('CSV', 'save the table', () => keep(named(table) + '.csv', new Blob(['\ufeff' + lines(table)], { type: 'text/csv' })));
    place?.append(figure ? save : make('span', { className: 'keep' }, save));
  }
})();
