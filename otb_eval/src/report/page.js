'use strict';
(() => {
  const SVG = 'http://www.w3.org/2000/svg';
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];
  const make = (name, properties) => Object.assign(document.createElement(name), properties);
  const numbers = JSON.parse(document.getElementById('numbers').textContent);
  const tip = document.getElementById('tip');
  const off = new Set();

  window.addEventListener('error', (event) => { document.body.dataset.error = event.message; });

  // Trackers on and off, by one rule each.
  const rules = document.head.appendChild(document.createElement('style'));
  function toggle(tracker, on) {
    if (on) off.delete(tracker); else off.add(tracker);
    rules.textContent = [...off].map((t) =>
      `main .s${t},#tip .box.s${t}{display:none}main .row.s${t}{display:revert;opacity:.3}main summary .s${t}{display:revert}`).join('');
    for (const box of all('#trackers input')) box.checked = !off.has(+box.value);
  }
  function setUpTrackers() {
    for (const box of all('#trackers input')) {
      box.checked = true;
      box.addEventListener('change', () => toggle(+box.value, box.checked));
    }
    for (const button of all('#trackers button')) {
      button.addEventListener('click', () =>
        numbers.trackers.forEach((_, tracker) => toggle(tracker, button.dataset.all !== '')));
    }
  }

  // One of several panels, chosen by buttons, or from a list where there may be many.
  function setUpTabs(tabs) {
    const panels = [...tabs.children];
    const titles = panels.map((panel) => panel.querySelector('h3').textContent);
    let mark = () => {};
    function show(chosen) {
      panels.forEach((panel, i) => panel.classList.toggle('on', i === chosen));
      mark(chosen);
      for (const timeline of all('.timeline', panels[chosen])) setUpTimeline(timeline);
    }
    if (panels.length > 1) {
      const label = tabs.dataset.select;
      tabs.prepend(label ? list(label) : buttons());
      tabs.classList.add('tabbed');
    }
    function buttons() {
      const row = make('div', { className: 'tablist' });
      row.setAttribute('role', 'tablist');
      const made = titles.map((textContent, i) => {
        const button = make('button', { type: 'button', textContent });
        button.setAttribute('role', 'tab');
        button.addEventListener('click', () => show(i));
        row.append(button);
        return button;
      });
      panels.forEach((panel) => panel.setAttribute('role', 'tabpanel'));
      mark = (chosen) => made.forEach((button, i) => button.setAttribute('aria-selected', i === chosen));
      return row;
    }
    function list(label) {
      const select = make('select', {});
      select.append(...titles.map((textContent, value) => make('option', { textContent, value })));
      select.addEventListener('change', () => show(+select.value));
      mark = (chosen) => { select.value = chosen; };
      const row = make('label', { className: 'tablist' });
      row.append(label, select);
      return row;
    }
    tabs.show = show;
    show(0);
  }

  function download(name, type, text) {
    const url = URL.createObjectURL(new Blob([text], { type }));
    make('a', { href: url, download: name.replace(/[^\w.-]+/g, '_') }).click();
    setTimeout(() => URL.revokeObjectURL(url), 1000);
  }
  function offer(place, textContent, action) {
    const button = make('button', { type: 'button', className: 'download', textContent });
    button.addEventListener('click', action);
    place.append(button);
  }

  // What a table shows, filtered rows left out, as comma-separated values.
  function csv(table) {
    const field = (cell) => {
      const text = cell.textContent.replace(/\s+/g, ' ').trim();
      return /[",]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
    };
    const rows = [...table.tHead.rows, ...table.tBodies[0].rows].filter((row) => !row.hidden);
    return rows.map((row) => [...row.cells].map(field).join(',')).join('\n') + '\n';
  }

  function setUpFilter() {
    const input = document.getElementById('filter');
    if (!input) return;
    const told = document.getElementById('filtered');
    input.addEventListener('input', () => {
      const wanted = input.value.trim().toLowerCase();
      for (const table of all('#sequences table')) {
        const rows = [...table.tBodies[0].rows];
        for (const row of rows) row.hidden = !row.cells[0].textContent.toLowerCase().includes(wanted);
        told.textContent = wanted ? `${rows.filter((row) => !row.hidden).length} of ${rows.length}` : '';
      }
    });
  }

  // From a row to its sequence over time.
  function setUpLinks() {
    for (const link of all('a[href^="#sequence-"]')) {
      link.addEventListener('click', (event) => {
        const target = document.getElementById(link.hash.slice(1));
        if (!target) return;
        event.preventDefault();
        const panel = target.closest('.panel');
        const tabs = panel.parentElement;
        tabs.show([...tabs.querySelectorAll(':scope > .panel')].indexOf(panel));
        document.getElementById('time').scrollIntoView();
      });
    }
  }

  function drawn(parent, name, attributes) {
    const element = document.createElementNS(SVG, name);
    for (const key in attributes) element.setAttribute(key, attributes[key]);
    parent.append(element);
    return element;
  }
  const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

  // Overlap and centre error over time, drawn when the sequence is looked at.
  function setUpTimeline(place) {
    if (place.firstChild) return;
    const data = numbers.timelines[+place.dataset.timeline];
    const figures = all('figure', place.parentElement);
    const kinds = [
      { label: 'Overlap', largest: 1, digits: 2, values: data.overlaps.map(bytes) },
      { label: 'Centre error (pixels)', largest: data.largest, digits: 1, values: data.errors.map(bytes) },
    ];
    // As wide as the page, so that letters keep their size on a phone, and in print where the place was hidden.
    const narrow = innerWidth < 700;
    const width = narrow ? 400 : 900, height = 190, left = 46, right = width - 10, top = 22, bottom = 164;
    const last = Math.max(1, data.frames - 1);
    const across = (i) => left + i * data.every / last * (right - left);
    const svgs = kinds.map((kind) => {
      const svg = drawn(place, 'svg', { viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': `${kind.label} of ${data.name} over time` });
      drawn(svg, 'text', { x: left, y: 14, class: 'head' }).textContent = kind.label;
      for (let part = 0; part <= 4; part++) {
        const y = bottom - part / 4 * (bottom - top);
        drawn(svg, 'line', { x1: left, x2: right, y1: y, y2: y, class: 'rule' });
        drawn(svg, 'text', { x: left - 6, y: y + 4, 'text-anchor': 'end' }).textContent = +(part / 4 * kind.largest).toPrecision(3);
      }
      for (let part = 0; part <= 5; part++) {
        const frame = Math.round(part / 5 * last) + 1;
        drawn(svg, 'text', { x: left + (frame - 1) / last * (right - left), y: bottom + 17, 'text-anchor': part === 5 ? 'end' : 'middle' }).textContent = frame;
      }
      for (const figure of figures) {
        const x = left + (figure.dataset.frame - 1) / last * (right - left);
        drawn(svg, 'path', { d: `M${x - 4} ${top - 7}h8l-4 6z`, class: 'shown' });
      }
      kind.values.forEach((values, tracker) => {
        let d = '', pen = false;
        values.forEach((value, i) => {
          if (value === 255) { pen = false; return; }
          d += `${pen ? 'L' : 'M'}${across(i).toFixed(1)} ${(bottom - value / 250 * (bottom - top)).toFixed(1)}`;
          pen = true;
        });
        if (d) drawn(svg, 'path', { d, class: `over s${tracker}` });
      });
      return svg;
    });
    const crosses = svgs.map((svg) => drawn(svg, 'line', { y1: top, y2: bottom, class: 'cross', visibility: 'hidden' }));
    function nearestFigure(frame) {
      return figures.reduce((best, figure) =>
        (!best || Math.abs(figure.dataset.frame - frame) < Math.abs(best.dataset.frame - frame) ? figure : best), null);
    }
    function leave() {
      tip.hidden = true;
      crosses.forEach((cross) => cross.setAttribute('visibility', 'hidden'));
      figures.forEach((figure) => figure.classList.remove('near'));
    }
    function move(event, kind) {
      const matrix = svgs[kind].getScreenCTM();
      if (!matrix) return leave();
      const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
      if (at.x < left - 4 || at.x > right + 4) return leave();
      const count = kinds[kind].values[0]?.length ?? 0;
      const i = Math.max(0, Math.min(count - 1, Math.round((at.x - left) / (right - left) * last / data.every)));
      const frame = i * data.every + 1;
      crosses.forEach((cross) => {
        cross.setAttribute('visibility', 'visible');
        cross.setAttribute('x1', across(i));
        cross.setAttribute('x2', across(i));
      });
      const { label, largest, digits, values } = kinds[kind];
      const rows = values.map((all, tracker) => ({ tracker, value: all[i] })).filter((row) => !off.has(row.tracker));
      rows.sort((a, b) => (a.value === 255) - (b.value === 255) || (kind ? a.value - b.value : b.value - a.value));
      tip.replaceChildren(make('p', { textContent: `#${frame} ${label.toLowerCase()}` }), ...rows.map((row) => line(row.tracker,
        row.value === 255 || row.value === undefined ? '–' : (row.value / 250 * largest).toFixed(digits))));
      const near = nearestFigure(frame);
      figures.forEach((figure) => figure.classList.toggle('near', figure === near));
      if (near) {
        const picture = near.querySelector('svg').cloneNode(true);
        picture.removeAttribute('aria-label');
        const box = make('div', { className: 'preview strip' });
        box.append(picture);
        tip.prepend(box, make('p', { textContent: `frame ${near.dataset.frame}${+near.dataset.frame === frame ? '' : ', the nearest shown'}` }));
      }
      placeTip(event);
    }
    svgs.forEach((svg, kind) => {
      svg.addEventListener('pointermove', (event) => move(event, kind));
      svg.addEventListener('pointerdown', (event) => move(event, kind));
      svg.addEventListener('pointerleave', leave);
    });
    offer(place, 'CSV', () => {
      const head = ['frame', ...kinds.flatMap((kind) => numbers.trackers.map((name) => `${name} ${kind.label.split(' ')[0].toLowerCase()}`))];
      const quote = (text) => (/[",]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text);
      const count = kinds[0].values[0]?.length ?? 0;
      const rows = Array.from({ length: count }, (_, i) => [i * data.every + 1, ...kinds.flatMap((kind) =>
        kind.values.map((values) => (values[i] === 255 || values[i] === undefined ? '' : +(values[i] / 250 * kind.largest).toFixed(3))))]);
      download(`${data.name}.csv`, 'text/csv', [head.map(quote), ...rows].map((row) => row.join(',')).join('\n') + '\n');
    });
  }

  // A tracker's line in the tip.
  function line(tracker, value, className = '') {
    const row = make('div', { className });
    const key = document.querySelectorAll('#trackers .key')[tracker].cloneNode(true);
    row.append(key, numbers.trackers[tracker], make('b', { textContent: value }));
    return row;
  }
  function placeTip(event) {
    tip.hidden = false;
    const { offsetWidth: width, offsetHeight: height } = tip;
    const beside = event.clientX + 18 + width < innerWidth ? event.clientX + 18 : event.clientX - 18 - width;
    tip.style.left = `${Math.max(4, beside)}px`;
    tip.style.top = `${Math.max(4, Math.min(event.clientY - height / 2, innerHeight - height - 4))}px`;
  }

  // A click sorts by a column, the next one the other way round. What has no score stays last.
  function setUpTable(table) {
    const heads = all('thead th', table);
    const body = table.tBodies[0];
    const tools = make('p', { className: 'tools' });
    offer(tools, 'CSV', () => download(`${table.dataset.name || 'table'}.csv`, 'text/csv', csv(table)));
    (table.closest('.scroll') || table).after(tools);
    heads.forEach((head, column) => {
      const button = make('button', { type: 'button', textContent: head.textContent });
      head.replaceChildren(button);
      const isText = head.hasAttribute('data-text');
      button.addEventListener('click', () => {
        const was = head.getAttribute('aria-sort');
        const descending = was ? was === 'ascending' : !isText;
        for (const other of heads) other.removeAttribute('aria-sort');
        head.setAttribute('aria-sort', descending ? 'descending' : 'ascending');
        const value = (row) => {
          const text = row.cells[column].textContent.trim();
          return isText ? text : parseFloat(text);
        };
        const sign = descending ? -1 : 1;
        const rows = [...body.rows].map((row) => ({ row, value: value(row) }));
        rows.sort((a, b) => {
          if (isText) return sign * a.value.localeCompare(b.value, 'en', { numeric: true });
          if (Number.isNaN(a.value) || Number.isNaN(b.value)) return Number.isNaN(a.value) - Number.isNaN(b.value);
          return sign * (a.value - b.value);
        });
        body.append(...rows.map((entry) => entry.row));
      });
    });
  }

  const nearest = (values, at) =>
    values.reduce((best, value, i) => (Math.abs(value - at) < Math.abs(values[best] - at) ? i : best), 0);

  function setUpPlot(plot, data) {
    const svg = plot.querySelector('svg');
    const layers = svg.querySelector('g');
    const original = svg.outerHTML;
    const tools = make('p', { className: 'tools' });
    const name = svg.getAttribute('aria-label') || 'plot';
    offer(tools, 'SVG', () => download(`${name}.svg`, 'image/svg+xml', original));
    plot.append(tools);
    const marks = svg.appendChild(document.createElementNS(SVG, 'g'));
    const [left, top, right, bottom] = data.area;
    let hot = null;

    function leave() {
      marks.replaceChildren();
      tip.hidden = true;
    }
    function mark(name, attributes) {
      const element = document.createElementNS(SVG, name);
      for (const key in attributes) element.setAttribute(key, attributes[key]);
      marks.append(element);
    }
    function move(event) {
      const matrix = svg.getScreenCTM();
      if (!matrix || !data.curves.length) return leave();
      const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
      if (at.x < left || at.x > right || at.y < top || at.y > bottom) return leave();
      const wanted = (at.x - left) / (right - left) * data.max;
      const first = data.curves[0].x;
      const threshold = first[nearest(first, wanted)];
      const place = (x) => left + x / data.max * (right - left);
      marks.replaceChildren();
      mark('line', { class: 'cross', x1: place(threshold), x2: place(threshold), y1: top, y2: bottom });
      const rows = data.curves.filter((curve) => !off.has(curve.t)).map((curve) => {
        const x = curve.x || first;
        const i = nearest(x, threshold);
        return { tracker: curve.t, x: x[i], y: curve.y[i] };
      });
      for (const row of rows) {
        mark('circle', { class: `dot s${row.tracker}`, cx: place(row.x), cy: bottom - row.y * (bottom - top), r: 3.5 });
      }
      rows.sort((a, b) => b.y - a.y);
      tip.replaceChildren(make('p', { textContent: `${data.label}: ${threshold}` }),
        ...rows.map((row) => line(row.tracker, row.y.toFixed(3), row.tracker === hot ? 'on' : '')));
      placeTip(event);
    }
    function highlight(tracker) {
      hot = tracker;
      layers.classList.toggle('hot', tracker !== null && !off.has(tracker));
      for (const curve of all('.curve', layers)) curve.classList.toggle('on', curve.classList.contains(`s${tracker}`));
    }

    plot.addEventListener('mousemove', move);
    plot.addEventListener('mouseleave', leave);
    for (const row of all('.row', layers)) {
      const tracker = +[...row.classList].find((name) => /^s\d+$/.test(name)).slice(1);
      row.addEventListener('mouseenter', () => highlight(tracker));
      row.addEventListener('mouseleave', () => highlight(null));
      row.addEventListener('click', () => { toggle(tracker, off.has(tracker)); highlight(null); });
    }
  }

  document.documentElement.classList.add('js');
  setUpTrackers();
  all('.tabs').forEach(setUpTabs);
  setUpFilter();
  setUpLinks();
  addEventListener('beforeprint', () => all('.timeline').forEach(setUpTimeline));
  all('table').forEach(setUpTable);
  all('.plot').forEach((plot, i) => setUpPlot(plot, numbers.plots[i]));
  document.body.dataset.ready = 'yes';
})();
