// Sorts tables by clicks on column headers: by the number in a cell's data-key, or by its text if it has none. Empty
// cells are last in both orders.
(() => {
  "use strict";

  /** Returns a number, a text, or null if the cell is empty. */
  function keyOf(row, column) {
    const cell = row.cells[column];
    const key = cell.dataset.key;
    if (key === undefined) return cell.textContent.trim() || null;
    return key === "" ? null : Number(key);
  }

  function compare(a, b, direction) {
    if (a === null || b === null) return (a === null) - (b === null);
    return direction * (typeof a === "string" ? a.localeCompare(b) : a - b);
  }

  function sortBy(table, head) {
    const ascending = head.getAttribute("aria-sort") !== "ascending";
    for (const other of table.tHead.rows[0].cells) other.setAttribute("aria-sort", "none");
    head.setAttribute("aria-sort", ascending ? "ascending" : "descending");
    const rows = Array.from(table.tBodies[0].rows, (row) => ({ row, key: keyOf(row, head.cellIndex) }));
    rows.sort((a, b) => compare(a.key, b.key, ascending ? 1 : -1));
    table.tBodies[0].append(...rows.map((entry) => entry.row));
  }

  for (const table of document.querySelectorAll("table.sortable")) {
    for (const head of table.tHead.rows[0].cells) {
      head.querySelector("button").addEventListener("click", () => sortBy(table, head));
    }
  }
})();
