// A click on a heading sorts by its column, another one the other way round. What has no value stays last.
(() => {
  const value = (row, column) => {
    const text = row.cells[column].dataset.value;
    const number = Number(text);
    return text === undefined ? undefined : Number.isNaN(number) ? text : number;
  };

  const compare = (a, b, sign) => {
    if (a === undefined || b === undefined) return (a === undefined) - (b === undefined);
    return sign * (typeof a === "number" ? a - b : a.localeCompare(b));
  };

  const sort = (heading) => {
    const table = heading.closest("table");
    const sign = heading.ariaSort === "ascending" ? -1 : 1;
    for (const other of table.querySelectorAll("[aria-sort]")) other.ariaSort = "none";
    heading.ariaSort = sign > 0 ? "ascending" : "descending";
    const body = table.tBodies[0];
    const column = heading.cellIndex;
    const rows = [...body.rows].sort((a, b) => compare(value(a, column), value(b, column), sign));
    body.append(...rows);
  };

  for (const button of document.querySelectorAll("table.sortable thead button")) {
    button.addEventListener("click", () => sort(button.closest("th")));
  }
})();
