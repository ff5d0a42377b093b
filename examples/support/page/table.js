// --- tables

// `columns` are [heading, text of a row, number to sort by or undefined for text that is not
// sorted].
function fillTable(table, rows, columns, classOf = () => "") {
    const head = element(element(table, "thead"), "tr");
    const body = element(table, "tbody");
    let sorted = {column: -1, ascending: true};
    const fill = () => {
        body.replaceChildren();
        const order = [...rows];
        const key = sorted.column < 0 ? undefined : columns[sorted.column][2];
        if (key) order.sort((a, b) =>
            (sorted.ascending ? 1 : -1) * ((key(a) ?? Infinity) - (key(b) ?? Infinity)));
        for (const row of order) {
            const line = element(body, "tr", {class: classOf(row)});
            for (const [, text, number] of columns) {
                const cell = element(line, "td", number ? {} : {class: "text"});
                const content = text(row);
                if (content instanceof Node) cell.append(content); else cell.textContent = content;
            }
        }
    };
    columns.forEach(([heading, , number], column) => {
        const cell = element(head, "th", {scope: "col", class: number ? "" : "text"});
        if (!number) { cell.textContent = heading; return; }
        element(cell, "button", {type: "button", click: () => {
            sorted = {column, ascending: sorted.column !== column || !sorted.ascending};
            for (const other of head.children) other.removeAttribute("aria-sort");
            cell.setAttribute("aria-sort", sorted.ascending ? "ascending" : "descending");
            fill();
        }}, heading);
    });
    fill();
}

const code = text => {
    const made = document.createElement("code");
    made.textContent = text;
    return made;
};

const showButton = row => {
    const made = document.createElement("button");
    made.textContent = nameOf(row);
    made.title = "show the picture as B";
    made.addEventListener("click", () => {
        choose("b", drawn.indexOf(row));
        byId("stage").scrollIntoView({block: "nearest"});
    });
    return made;
};
