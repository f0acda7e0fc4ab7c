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
      `main .s${t}{display:none}main .row.s${t}{display:revert;opacity:.3}main summary .s${t}{display:revert}`).join('');
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

  function setUpTabs(tabs) {
    const panels = [...tabs.children];
    if (panels.length < 2) return;
    const list = make('div', { className: 'tablist' });
    list.setAttribute('role', 'tablist');
    const buttons = panels.map((panel, i) => {
      const button = make('button', { type: 'button', textContent: panel.querySelector('h3').textContent });
      button.setAttribute('role', 'tab');
      button.addEventListener('click', () => show(i));
      list.append(button);
      panel.setAttribute('role', 'tabpanel');
      return button;
    });
    function show(chosen) {
      panels.forEach((panel, i) => panel.classList.toggle('on', i === chosen));
      buttons.forEach((button, i) => button.setAttribute('aria-selected', i === chosen));
    }
    tabs.classList.add('tabbed');
    tabs.prepend(list);
    show(0);
  }

  // A click sorts by a column, the next one the other way round. What has no score stays last.
  function setUpTable(table) {
    const heads = all('thead th', table);
    const body = table.tBodies[0];
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
      tip.replaceChildren(make('p', { textContent: `${data.label}: ${threshold}` }), ...rows.map((row) => {
        const line = make('div', { className: row.tracker === hot ? 'on' : '' });
        const key = document.querySelectorAll('#trackers .key')[row.tracker].cloneNode(true);
        line.append(key, numbers.trackers[row.tracker], make('b', { textContent: row.y.toFixed(3) }));
        return line;
      }));
      tip.hidden = false;
      const { offsetWidth: width, offsetHeight: height } = tip;
      const beside = event.clientX + 18 + width < innerWidth ? event.clientX + 18 : event.clientX - 18 - width;
      tip.style.left = `${Math.max(4, beside)}px`;
      tip.style.top = `${Math.max(4, Math.min(event.clientY - height / 2, innerHeight - height - 4))}px`;
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
  all('table').forEach(setUpTable);
  all('.plot').forEach((plot, i) => setUpPlot(plot, numbers.plots[i]));
  document.body.dataset.ready = 'yes';
})();
