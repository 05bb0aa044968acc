"use strict";

// Sorts by a column: numbers as numbers, what has no value at the end whichever way round.
function valueOf(row, column) {
  return row.cells[column].dataset.value;
}

function compare(a, b) {
  const numbers = [Number(a), Number(b)];
  return numbers.some(Number.isNaN) ? a.localeCompare(b, undefined, {numeric: true})
                                    : numbers[0] - numbers[1];
}

function sortBy(table, head) {
  const heads = Array.from(table.tHead.rows[0].cells);
  const column = heads.indexOf(head);
  // Figures begin with the largest, names with the first.
  const first = head.classList.contains("number") ? "descending" : "ascending";
  const second = first === "descending" ? "ascending" : "descending";
  const order = head.getAttribute("aria-sort") === first ? second : first;
  heads.forEach((other) => other.setAttribute("aria-sort", other === head ? order : "none"));
  const sign = order === "ascending" ? 1 : -1;
  const rows = Array.from(table.tBodies[0].rows);
  rows.sort((a, b) => {
    const [left, right] = [valueOf(a, column), valueOf(b, column)];
    if (left === "" || right === "") {
      return (left === "") - (right === "");
    }
    return sign * compare(left, right);
  });
  table.tBodies[0].append(...rows);
}

document.querySelectorAll("table.sortable").forEach((table) => {
  table.tHead.querySelectorAll("th").forEach((head) => {
    head.querySelector("button").addEventListener("click", () => sortBy(table, head));
  });
});

const enlarged = document.getElementById("enlarged");
document.querySelectorAll(".enlarge").forEach((button) => {
  button.addEventListener("click", () => {
    const image = button.querySelector("img");
    enlarged.querySelector("img").src = image.src;
    enlarged.querySelector("img").alt = image.alt;
    enlarged.querySelector("p").textContent =
        button.parentElement.querySelector("figcaption").textContent;
    enlarged.showModal();
  });
});
enlarged.querySelector("button").addEventListener("click", () => enlarged.close());
