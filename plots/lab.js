// lab.js - the timeline of a lesson's run and its what-if sliders, from the data in the page; by mouse, wheel and keyboard.
(function () {
  var data = JSON.parse(document.getElementById('data').textContent), NS = 'http://www.w3.org/2000/svg';
  var svg = document.getElementById('timeline'), said = document.getElementById('said'), choice = document.getElementById('run');
  var left = 70, right = 12, top_ = 26, run, begin, end, row, width, rank = 0, chosen = null, step = -1;
  // what a mark's letter and pattern are; the order is that of the kinds in the data
  var kinds = [{name: 'computing', letter: 'C', fill: '#3a3a3a', dark: true}, {name: 'sending', letter: 'S', fill: 'url(#send)'},
    {name: 'receiving', letter: 'R', fill: 'url(#receive)'}, {name: 'waiting', letter: 'W', fill: 'url(#wait)'},
    {name: 'barrier', letter: 'B', fill: 'url(#barrier)'}];
  var RANK = 0, KIND = 1, FROM = 2, TO = 3, PEER = 4, BYTES = 5, MESSAGE = 6;

  function make(parent, name, attributes, text) {
    var e = document.createElementNS(NS, name);
    for (var key in attributes) e.setAttribute(key, attributes[key]);
    if (text !== undefined) e.textContent = text;
    parent.appendChild(e);
    return e;
  }
  function microseconds(ps) { return (ps / 1e6).toLocaleString('en', {maximumFractionDigits: 6}) + ' µs'; }
  function x(ps) { return left + (ps - begin) / (end - begin) * (width - left - right); }
  function y(r) { return top_ + r * row; }

  // Patterns of black on white: they are told apart in print and by those who see no colours.
  function patterns() {
    var defs = make(svg, 'defs', {});
    function pattern(id, size, draw) {
      var p = make(defs, 'pattern', {id: id, width: size, height: size, patternUnits: 'userSpaceOnUse'});
      make(p, 'rect', {width: size, height: size, fill: '#fff'});
      draw.forEach(function (d) { make(p, 'path', {d: d, stroke: '#222', 'stroke-width': 1.3, fill: 'none'}); });
    }
    pattern('send', 6, ['M0 6 L6 0 M-1 1 L1 -1 M5 7 L7 5']);
    pattern('receive', 6, ['M0 0 L6 6 M-1 5 L1 7 M5 -1 L7 1']);
    pattern('wait', 8, ['M4 3.4 v1.2']);
    pattern('barrier', 6, ['M0 3 h6 M3 0 v6']);
  }

  // Round times on the axis: 1, 2 or 5 times a power of ten, about every 110 pixels.
  function axis() {
    var room = (end - begin) / Math.max(1, (width - left - right) / 110), unit = Math.pow(10, Math.floor(Math.log10(room)));
    var each = [1, 2, 5, 10].map(function (f) { return f * unit; }).filter(function (d) { return d >= room; })[0];
    for (var t = Math.ceil(begin / each) * each; t <= end; t += each) {
      make(svg, 'path', {d: 'M' + x(t) + ' ' + (top_ - 4) + ' V' + y(run.ranks), stroke: '#ddd', fill: 'none'});
      make(svg, 'text', {x: x(t), y: 14, 'text-anchor': 'middle'}, microseconds(t));
    }
  }

  function spans() {
    var gap = row > 17 ? 3 : 1;
    var last = {}; // the pixel and kind that were drawn last in each row: what would lie on them is left out
    run.spans.forEach(function (s, i) {
      if (s[TO] <= begin || s[FROM] >= end) return;
      var from = Math.max(x(s[FROM]), left), to = Math.min(x(s[TO]), width - right), key = Math.floor(to) + ' ' + s[KIND];
      if (to - from < 0.5 && last[s[RANK]] === key && i !== chosen) return;
      last[s[RANK]] = key;
      make(svg, 'rect', {x: from, y: y(s[RANK]) + gap, width: Math.max(to - from, 0.5), height: row - 2 * gap,
        'class': 'span' + (i === chosen ? ' chosen' : ''), fill: kinds[s[KIND]].fill, 'data-span': i});
      if (to - from > 16 && row > 17) {
        if (!kinds[s[KIND]].dark) // a clear ground for the letter
          make(svg, 'rect', {x: (from + to) / 2 - 7, y: y(s[RANK]) + row / 2 - 7, width: 14, height: 14, fill: '#fff', 'data-span': i});
        make(svg, 'text', {x: (from + to) / 2, y: y(s[RANK]) + row / 2 + 4, 'text-anchor': 'middle', 'data-span': i,
          'class': kinds[s[KIND]].dark ? 'on-dark' : ''}, kinds[s[KIND]].letter);
      }
    });
  }

  // A line for each message, from the end of its sending to the begin of its receiving.
  function messages() {
    var sent = {}, lines = [];
    run.spans.forEach(function (s) {
      if (s[MESSAGE] >= 0 && kinds[s[KIND]].letter === 'S') sent[s[MESSAGE]] = s;
    });
    run.spans.forEach(function (s) {
      var from = s[MESSAGE] >= 0 && kinds[s[KIND]].letter === 'R' ? sent[s[MESSAGE]] : undefined;
      if (from && s[FROM] >= begin && from[TO] <= end) lines.push([from, s]);
    });
    if (lines.length > 600) return; // they would be one grey area
    lines.forEach(function (l) {
      make(svg, 'path', {'class': 'message', d: 'M' + x(l[0][TO]) + ' ' + (y(l[0][RANK]) + row / 2) + ' L' + x(l[1][FROM]) + ' ' + (y(l[1][RANK]) + row / 2)});
    });
  }

  // The critical path: solid where its rank is busy, in dashes where a message is on its way.
  function path() {
    var group = make(svg, 'g', {'clip-path': 'url(#window)'}), at = null;
    function line(d, away) {
      make(group, 'path', {d: d, 'class': 'halo'});
      make(group, 'path', {d: d, 'class': 'path' + (away ? ' away' : '')});
    }
    run.path.forEach(function (p, i) {
      if (p[1] >= begin && p[0] <= end) {
        var away = data.busy.indexOf(p[2]) < 0, h = y(p[3]) + row - 5;
        if (at !== null && at !== p[3]) line('M' + x(p[0]) + ' ' + (y(at) + row - 5) + ' V' + h, true);
        line('M' + x(p[0]) + ' ' + h + ' H' + x(p[1]), away);
        if (i === step) make(group, 'circle', {cx: (x(p[0]) + x(p[1])) / 2, cy: h, r: 7, fill: '#fff', stroke: '#000', 'stroke-width': 3});
      }
      at = p[3];
    });
  }

  function draw() {
    width = Math.max(320, svg.clientWidth || 900);
    row = Math.max(5, Math.min(30, Math.floor(640 / run.ranks)));
    svg.textContent = '';
    svg.setAttribute('height', y(run.ranks) + 8);
    svg.setAttribute('viewBox', '0 0 ' + width + ' ' + (y(run.ranks) + 8));
    patterns();
    make(make(svg, 'clipPath', {id: 'window'}), 'rect', {x: left, y: 0, width: width - left - right, height: y(run.ranks) + 8});
    axis();
    for (var r = 0; r < run.ranks; r++) {
      make(svg, 'path', {d: 'M' + left + ' ' + (y(r) + row) + ' H' + (width - right), 'class': 'row'});
      if (row >= 11 || r % Math.ceil(11 / row) === 0)
        make(svg, 'text', {x: left - 8, y: y(r) + row / 2 + 4, 'text-anchor': 'end'}, (r === rank ? '▸ ' : '') + 'rank ' + r);
    }
    spans();
    messages();
    path();
    make(svg, 'rect', {x: left - 2, y: y(rank) + 1, width: width - left - right + 4, height: row - 1, 'class': 'row current'});
  }

  // Texts for people who do not see the picture, too: the live region is read out.
  function tell(text) { said.textContent = text; }
  function tell_span(i) {
    var s = run.spans[i];
    chosen = i;
    rank = s[RANK];
    tell('Rank ' + s[RANK] + ', ' + kinds[s[KIND]].name + ' from ' + microseconds(s[FROM]) + ' to ' + microseconds(s[TO]) + ', for ' +
      microseconds(s[TO] - s[FROM]) + (s[PEER] >= 0 ? '; with rank ' + s[PEER] : '') + (s[BYTES] > 0 ? '; ' + s[BYTES] + ' bytes' : '') + '.');
  }
  function tell_window() { tell('From ' + microseconds(begin) + ' to ' + microseconds(end) + ' of ' + microseconds(run.end) + '.'); }

  function show(from, to) { // the part of the run in the window; never less than 1000 ps, never beyond the run
    var length = Math.min(Math.max(to - from, 1000), Math.max(run.end, 1));
    begin = Math.min(Math.max(0, from), Math.max(run.end, 1) - length);
    end = begin + length;
    draw();
  }
  function zoom(factor, at) { show(at - (at - begin) * factor, at + (end - at) * factor); }
  function pan(part) { var by = (end - begin) * part; show(begin + by, end + by); }
  function into_view(from, to) {
    if (from < begin || to > end) { var length = Math.max(end - begin, (to - from) * 1.2), middle = (from + to) / 2; show(middle - length / 2, middle + length / 2); } else draw();
  }
  // The next or last span of the current rank; the first one of the window, where none was chosen.
  function next_span(direction) {
    var mine = [];
    run.spans.forEach(function (s, i) { if (s[RANK] === rank) mine.push(i); });
    if (!mine.length) return tell('Rank ' + rank + ' has nothing recorded.');
    var now = mine.indexOf(chosen), to;
    if (now < 0) to = direction > 0 ? 0 : mine.length - 1;
    else to = Math.min(Math.max(0, now + direction), mine.length - 1);
    tell_span(mine[to]);
    into_view(run.spans[mine[to]][FROM], run.spans[mine[to]][TO]);
  }
  function next_step(direction) {
    if (!run.path.length) return tell('No critical path is known of this run.');
    step = Math.min(Math.max(0, step + direction), run.path.length - 1);
    var p = run.path[step];
    rank = p[3];
    tell('Critical path, step ' + (step + 1) + ' of ' + run.path.length + ': ' + data.causes[p[2]] + ' of rank ' + p[3] + ', from ' +
      microseconds(p[0]) + ' to ' + microseconds(p[1]) + ', for ' + microseconds(p[1] - p[0]) + '.');
    into_view(p[0], p[1]);
  }

  var middle = function () { return (begin + end) / 2; };
  var actions = {
    'zoom-in': function () { zoom(0.5, middle()); tell_window(); }, 'zoom-out': function () { zoom(2, middle()); tell_window(); },
    'earlier': function () { pan(-0.25); tell_window(); }, 'later': function () { pan(0.25); tell_window(); },
    'whole': function () { show(0, run.end); tell_window(); },
    'up': function () { rank = Math.max(0, rank - 1); chosen = null; draw(); tell('Rank ' + rank + '.'); },
    'down': function () { rank = Math.min(run.ranks - 1, rank + 1); chosen = null; draw(); tell('Rank ' + rank + '.'); },
    'span-next': function () { next_span(1); }, 'span-last': function () { next_span(-1); },
    'step-next': function () { next_step(1); }, 'step-last': function () { next_step(-1); }
  };
  var keys = {'+': 'zoom-in', '=': 'zoom-in', '-': 'zoom-out', ArrowLeft: 'earlier', ArrowRight: 'later', ArrowUp: 'up', ArrowDown: 'down',
    Home: 'whole', n: 'span-next', p: 'span-last', c: 'step-next', C: 'step-last'};
  svg.addEventListener('keydown', function (event) {
    if (!keys[event.key] || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    actions[keys[event.key]]();
  });
  document.querySelectorAll('.controls button').forEach(function (button) {
    button.addEventListener('click', function () { actions[button.getAttribute('data-do')](); });
  });

  // The mouse: the wheel zooms where it points, dragging moves, a click tells of a span.
  function time_at(event) { var box = svg.getBoundingClientRect(); return begin + ((event.clientX - box.left) * width / box.width - left) / (width - left - right) * (end - begin); }
  svg.addEventListener('wheel', function (event) {
    event.preventDefault();
    zoom(event.deltaY < 0 ? 0.8 : 1.25, Math.min(Math.max(begin, time_at(event)), end));
  }, {passive: false});
  var drag = null, moved = false;
  svg.addEventListener('pointerdown', function (event) { drag = time_at(event); moved = false; });
  svg.addEventListener('pointermove', function (event) {
    if (drag === null || !event.buttons) return;
    var by = drag - time_at(event);
    if (Math.abs(by) > (end - begin) / 300) { moved = true; show(begin + by, end + by); }
  });
  window.addEventListener('pointerup', function () { drag = null; });
  svg.addEventListener('click', function (event) {
    var i = event.target.getAttribute('data-span');
    if (!moved && i !== null) { tell_span(+i); draw(); }
  });

  // --- what if: a simulated run for every place of the sliders ---
  var inputs = Array.from(document.querySelectorAll('.slider input'));
  function point(at) { // the number of a grid point: the last slider runs fastest
    var p = 0;
    data.sliders.forEach(function (s, i) { p = p * s.values.length + at[i]; });
    return p;
  }
  function what_if() {
    if (!inputs.length) return;
    var at = inputs.map(function (input) { return +input.value; }), own = data.sliders.map(function (s) { return s.own; });
    inputs.forEach(function (input, i) {
      var s = data.sliders[i], text = s.values[at[i]] + (at[i] === s.own ? ' (yours)' : '');
      document.getElementById('value-' + i).textContent = text;
      input.setAttribute('aria-valuetext', text);
    });
    var found = data.grid[+choice.value][point(at)], mine = data.grid[+choice.value][point(own)];
    var body = document.getElementById('shares'), result = document.getElementById('result');
    body.textContent = '';
    if (!found) { result.textContent = 'This point cannot run.'; return; }
    result.textContent = microseconds(found[0]) + (mine ? ', that is ' + (found[0] / mine[0]).toLocaleString('en', {maximumFractionDigits: 3}) + ' times yours (' + microseconds(mine[0]) + ')' : '');
    data.causes.forEach(function (cause, i) {
      var ps = found[i + 1];
      if (!ps) return;
      var tr = body.insertRow(), bar = document.createElement('span');
      tr.insertCell().textContent = cause;
      tr.insertCell().textContent = microseconds(ps);
      tr.insertCell().textContent = (100 * ps / found[0]).toFixed(1) + ' %';
      bar.style.width = 100 * ps / found[0] + '%';
      tr.insertCell().appendChild(bar);
      tr.cells[1].className = tr.cells[2].className = 'number';
      tr.cells[3].className = 'bar';
    });
  }
  inputs.forEach(function (input) { input.addEventListener('input', what_if); });
  var back = document.getElementById('own');
  if (back) back.addEventListener('click', function () { inputs.forEach(function (input, i) { input.value = data.sliders[i].own; }); what_if(); });

  function take_run() {
    run = data.runs[+choice.value];
    rank = 0;
    chosen = null;
    step = -1;
    show(0, run.end);
    if (run.omitted) tell('The timeline of this run has ' + run.omitted + ' parts, which are too many for a page; the critical path is there.');
    else tell_window();
    what_if();
  }
  choice.addEventListener('change', take_run);
  window.addEventListener('resize', draw);
  take_run();
  document.documentElement.setAttribute('data-ready', 'yes');
})();
