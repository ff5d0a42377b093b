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

fillTable(byId("settings"), drawn, [
    ["setting", showButton],
    ["time, ms", row => column(row.ms), row => row.ms],
    ["±", row => percent(spreadOf(row)), spreadOf],
    ["fastest", row => column(row.fastest_ms), row => row.fastest_ms],
    ["MB", row => column(row.bytes / 1e6), row => row.bytes],
    ["PSNR, dB", row => decibels(row.psnr_db), row => row.psnr_db],
    ["SSIM", row => row.ssim.toFixed(5), row => row.ssim],
    ["largest error, /255", row => column(255 * row.max_abs_error), row => row.max_abs_error],
    ["pixels over 1/255", row => row.pixels_over_1_255.toLocaleString("en"),
     row => row.pixels_over_1_255],
    ["options of cellist-oit", row => code(row.options)],
], row => row.pareto ? "on-front" : "");

const range = (least, most) => `${least.toFixed(2)} to ${most.toFixed(2)}`;
const significance = row => row.distinct ? "" : "not significant";

const layers = metrics.fewer_layers;
byId("layers-part").hidden = layers.length === 0;
byId("layers-note").textContent =
    `The nearest layers in linked lists against all ${metrics.most_layers}.`;
fillTable(byId("layers"), layers, [
    ["layers", row => row.layers, row => row.layers],
    ["time, ms", row => column(row.ms), row => row.ms],
    ["speed-up", row => column(row.speed_up), row => row.speed_up],
    ["by quartiles", row => range(row.speed_up_least, row.speed_up_most)],
    ["", significance],
    ["PSNR, dB", row => decibels(row.psnr_db), row => row.psnr_db],
    ["SSIM", row => row.ssim.toFixed(5), row => row.ssim],
]);

byId("exact-part").hidden = metrics.exact_methods.length < 2;
fillTable(byId("exact"), metrics.exact_methods, [
    ["method", row => row.method],
    ["time, ms", row => column(row.ms), row => row.ms],
    ["times as long as linked", row => row.times_linked.toFixed(2), row => row.times_linked],
    ["by quartiles", row => range(row.times_linked_least, row.times_linked_most)],
    ["", row => row.method === "linked" ? "" : significance(row)],
    ["MB", row => column(row.bytes / 1e6), row => row.bytes],
]);

const leftOut = [
    ...metrics.left_out.map(({method, reason}) => ({what: method, reason})),
    ...metrics.settings.filter(setting => setting.failure !== undefined)
        .map(({options, failure}) => ({what: options, reason: failure})),
];
byId("left-out-part").hidden = leftOut.length === 0;
fillTable(byId("left-out"), leftOut, [["what", row => code(row.what)], ["why", row => row.reason]]);

// --- two pictures

const shown = {a: -1, b: drawn.findIndex(setting => setting.pareto), at: 50, differences: false};
const reference = {picture: 0, difference: undefined};
const settingOf = which => shown[which] < 0 ? reference : drawn[shown[which]];
const titleOf = which => shown[which] < 0 ? "reference" : nameOf(settingOf(which));

for (const which of ["a", "b"]) {
    const select = byId(which);
    element(select, "option", {value: -1}, "reference in double precision");
    drawn.forEach((setting, i) => element(select, "option", {value: i}, nameOf(setting)));
    select.addEventListener("change", () => choose(which, Number(select.value)));
}

function choose(which, index) {
    shown[which] = index;
    show();
}

function show() {
    for (const which of ["a", "b"]) {
        const setting = settingOf(which);
        const picture = byId("picture-" + which);
        byId(which).value = shown[which];
        // The reference differs from itself in nothing: its picture is black.
        picture.src = metrics.pictures[shown.differences && setting.difference !== undefined
            ? setting.difference : setting.picture];
        picture.style.filter = shown.differences && setting.difference === undefined
            ? "brightness(0)" : "";
        picture.alt = (shown.differences ? "difference of " : "") + titleOf(which);
        byId("name-" + which).textContent = `${which.toUpperCase()}: ${titleOf(which)}`;
    }
    byId("picture-a").style.clipPath = `inset(0 ${100 - shown.at}% 0 0)`;
    byId("edge").style.left = shown.at + "%";
    byId("at").value = shown.at;
    byId("differences").checked = shown.differences;
    const [a, b] = [settingOf("a"), settingOf("b")];
    const lines = ["a", "b"].filter(which => shown[which] >= 0)
        .map(which => which.toUpperCase() + " is " + summaryOf(settingOf(which)));
    if (shown.a >= 0 && shown.b >= 0)
        lines.push(`B takes ${digits(b.ms / a.ms)} times as long as A`);
    byId("versus").textContent = lines.length > 0 ? lines.join(". ") + "." : "";
    const hash = new URLSearchParams(
        {a: shown.a, b: shown.b, at: shown.at, differences: Number(shown.differences)});
    try {
        history.replaceState(null, "", "#" + hash);
    } catch { /* a page that may not change its address */ }
}

// The address says what is shown, so that it can be sent to others.
function readAddress() {
    const hash = new URLSearchParams(location.hash.slice(1));
    const number = (name, least, most) => {
        const value = Number(hash.get(name) ?? NaN);
        return value >= least && value <= most ? value : shown[name];
    };
    for (const which of ["a", "b"]) shown[which] = Math.round(number(which, -1, drawn.length - 1));
    shown.at = number("at", 0, 100);
    if (hash.has("differences")) shown.differences = hash.get("differences") === "1";
    show();
}

function slide(event) {
    const box = byId("stage").getBoundingClientRect();
    const part = Math.min(1, Math.max(0, (event.clientX - box.left) / box.width));
    shown.at = Math.round(200 * part) / 2;
    show();
}
byId("stage").addEventListener("pointerdown", event => {
    byId("stage").setPointerCapture(event.pointerId);
    slide(event);
});
byId("stage").addEventListener("pointermove", event => { if (event.buttons === 1) slide(event); });
byId("at").addEventListener("input", () => { shown.at = Number(byId("at").value); show(); });
byId("swap").addEventListener("click", () => { [shown.a, shown.b] = [shown.b, shown.a]; show(); });
byId("differences").addEventListener("change", () => {
    shown.differences = byId("differences").checked;
    show();
});
byId("differences-label").textContent = `differences × ${metrics.difference_factor}`;
window.addEventListener("hashchange", readAddress);
readAddress();

// --- all pictures

byId("pictures-note").textContent =
    `Each setting, and its difference from the reference × ${metrics.difference_factor}, ` +
    "as sRGB values.";
for (const setting of [reference, ...drawn]) {
    const name = setting === reference ? "reference in double precision" : nameOf(setting);
    const figure = element(byId("pictures"), "figure");
    const pair = element(figure, "div", {class: "pair"});
    element(pair, "img", {src: metrics.pictures[setting.picture], alt: name, loading: "lazy"});
    if (setting !== reference)
        element(pair, "img", {
            src: metrics.pictures[setting.difference], alt: "difference of " + name,
            loading: "lazy",
        });
    element(figure, "figcaption", {},
            setting === reference
                ? name : `${name}: ${digits(setting.ms)} ms, ${decibels(setting.psnr_db)} dB`);
}
document.documentElement.dataset.ready = "yes";
