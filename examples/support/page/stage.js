// --- two pictures

const shown = {a: -1, b: firstShown, at: 50, differences: false};
const reference = {picture: 0, difference: undefined};
const settingOf = which => shown[which] < 0 ? reference : drawn[shown[which]];
const titleOf = which => shown[which] < 0 ? "reference" : nameOf(settingOf(which));

for (const which of ["a", "b"]) {
    const select = byId(which);
    element(select, "option", {value: -1}, referenceName);
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
    const name = setting === reference ? referenceName : nameOf(setting);
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
