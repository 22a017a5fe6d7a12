// report.js - tables of a report sort by a column when its head is clicked: up, down, as it was. Without scripts they stay.
document.querySelectorAll('table').forEach(function (table) {
  if (!table.tHead || table.tBodies[0].rows.length < 2) return;
  var body = table.tBodies[0], rows = Array.from(body.rows), number = /^[-+]?[0-9][0-9,]*(\.[0-9]+)?(e[-+]?[0-9]+)?/i;
  function sort(head, column) {
    var was = head.getAttribute('aria-sort'), order = was === 'ascending' ? -1 : was === 'descending' ? 0 : 1;
    table.tHead.querySelectorAll('th').forEach(function (other) { other.removeAttribute('aria-sort'); });
    if (order) head.setAttribute('aria-sort', order > 0 ? 'ascending' : 'descending');
    function text(row) { var cell = row.cells[column]; return cell ? cell.textContent.trim() : ''; }
    // A column of numbers is one in which each cell begins with one, or is empty.
    var numbers = rows.every(function (row) { return text(row) === '' || number.test(text(row)); });
    function value(row) { var found = text(row).match(number); return found ? parseFloat(found[0].replace(/,/g, '')) : NaN; }
    var sorted = rows.slice();
    if (order) sorted.sort(function (a, b) {
      if (text(a) === '' || text(b) === '') return (text(a) === '') - (text(b) === '');
      return order * (numbers ? value(a) - value(b) : text(a).localeCompare(text(b), 'en', {numeric: true}));
    });
    sorted.forEach(function (row) { body.appendChild(row); });
  }
  table.tHead.querySelectorAll('th').forEach(function (head, column) {
    head.classList.add('sorts');
    head.tabIndex = 0;
    head.addEventListener('click', function () { sort(head, column); });
    head.addEventListener('keydown', function (event) { if (event.key === 'Enter') sort(head, column); });
  });
});
