"use strict";
// Every [data-grid]: menus filter its rows, headings sort them; a long table shows its first rows until asked for all.
const FIRST_ROWS = 100;

// A cell begins with its value; badges follow it.
const textOf = (row, place) => {
  const cell = row.cells[place];
  return (cell.firstElementChild?.matches("span") ? cell.firstElementChild.textContent : cell.firstChild?.nodeValue ?? "").trim();
};
// "91.4 %", "0.00475", "<0.000000001", "infinite"; NaN for a dash, which goes last either way.
const valueOf = (text) => (text === "infinite" ? Infinity : parseFloat(text.replace(/^[<>]/, "")));

function compare(first, second, isNumber, direction) {
  if (!isNumber) return direction * first.localeCompare(second, "en", { numeric: true });
  const a = valueOf(first), b = valueOf(second);
  if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b);
  return a === b ? 0 : direction * (a < b ? -1 : 1);
}

function enliven(grid) {
  const body = grid.querySelector("tbody"), rows = Array.from(body.rows);
  const headings = Array.from(grid.querySelectorAll("th")), menus = Array.from(grid.querySelectorAll("select"));
  const count = grid.querySelector("output"), more = grid.querySelector(".more");
  let order = rows, isWhole = false;

  function show() {
    const kept = order.filter((row) => menus.every((menu) => !menu.value || textOf(row, menu.dataset.place) === menu.value));
    const shown = new Set(isWhole ? kept : kept.slice(0, FIRST_ROWS));
    for (const row of order) row.hidden = !shown.has(row);
    const all = kept.length === rows.length ? "" : `, of ${rows.length} in all`;
    const some = shown.size === kept.length ? "" : `${shown.size} shown of `;
    count.textContent = kept.length ? `${some}${kept.length} row${kept.length === 1 ? "" : "s"}${all}` : "No row matches.";
    more.hidden = shown.size === kept.length;
  }

  headings.forEach((heading, place) => {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = heading.textContent;
    heading.replaceChildren(button);
    button.addEventListener("click", () => {
      const direction = heading.getAttribute("aria-sort") === "ascending" ? -1 : 1;
      for (const other of headings) other.removeAttribute("aria-sort");
      heading.setAttribute("aria-sort", direction === 1 ? "ascending" : "descending");
      const isNumber = heading.classList.contains("number");
      order = [...rows].sort((a, b) => compare(textOf(a, place), textOf(b, place), isNumber, direction));
      body.append(...order);
      show();
    });
  });
  for (const menu of menus) menu.addEventListener("change", show);
  more.addEventListener("click", () => { isWhole = true; show(); });
  show();
}

// A box that is narrower than what it holds says that it scrolls.
function hint(box) {
  const line = document.createElement("p");
  line.className = "hint";
  line.textContent = "Scroll sideways to see all of it →";
  line.hidden = true;
  box.after(line);
  const watcher = new ResizeObserver(() => { line.hidden = box.scrollWidth <= box.clientWidth + 1; });
  for (const part of [box, ...box.children]) watcher.observe(part);
}

document.querySelectorAll("[data-grid]").forEach(enliven);
document.querySelectorAll(".scroll").forEach(hint);
// Paper has no folds.
addEventListener("beforeprint", () => document.querySelectorAll("details").forEach((part) => { part.open = true; }));
