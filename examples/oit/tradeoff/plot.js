// --- the plot: time or memory, and root mean square error, both logarithmic. Settings without a
// visible error have a strip of their own, with a row for each method.

// Methods by kind, each with a colour of its own; approximations also have another mark.
const methodsOf = exact => {
    const ofKind = drawn.filter(setting => setting.exact === exact);
    return [...new Set(ofKind.map(setting => setting.method))].sort();
};
const kinds = [["exact", methodsOf(true), 6], ["approximate", methodsOf(false), 5]];
const methods = kinds.flatMap(([, names]) => names);
const colourOf = method => {
    const [kind, names, colours] = kinds.find(([, names]) => names.includes(method));
    return `var(--${kind}-${names.indexOf(method) % colours})`;
};
const cappedPsnr = setting => Math.min(setting.psnr_db ?? Infinity, metrics.psnr_enough);

// A disc for exact methods, a triangle where layers are left out, a diamond for approximations.
function shapeOf(setting, x, y, r) {
    if (!setting.exact) return `M${x - r} ${y}L${x} ${y - r}L${x + r} ${y}L${x} ${y + r}Z`;
    if (setting.layers !== null || setting.epsilon !== 0)
        return `M${x - r} ${y + 0.8 * r}L${x} ${y - r}L${x + r} ${y + 0.8 * r}Z`;
    return `M${x - r} ${y}A${r} ${r} 0 1 1 ${x + r} ${y}A${r} ${r} 0 1 1 ${x - r} ${y}Z`;
}

// What the plot shows.
const plotted = {axis: "ms", hidden: new Set()};
const axes = {
    ms: {title: "time of a frame, ms", of: setting => setting.ms,
         least: setting => setting.lower_quartile_ms,
         most: setting => setting.upper_quartile_ms},
    bytes: {title: "memory of the method, MB", of: setting => setting.bytes / 1e6},
};
const isEnough = setting => cappedPsnr(setting) >= metrics.psnr_enough;

// Which settings nothing else beats, in what the axis shows.
function frontOf(settings) {
    if (plotted.axis === "ms") return settings.filter(setting => setting.pareto);
    return settings.filter(own => !settings.some(other =>
        other.bytes <= own.bytes && cappedPsnr(other) >= cappedPsnr(own) &&
        (other.bytes < own.bytes || cappedPsnr(other) > cappedPsnr(own))));
}

function drawPlot() {
    const svg = byId("plot");
    svg.replaceChildren();
    const visible = drawn.filter(setting => !plotted.hidden.has(setting.method));
    if (visible.length === 0) return;
    const axis = axes[plotted.axis];
    const rows = methods.filter(method =>
        visible.some(setting => setting.method === method && isEnough(setting)));
    const rowHeight = 17, strip = rows.length * rowHeight;
    const width = Math.max(300, svg.clientWidth);
    const height = Math.max(320, Math.min(520, 0.55 * width)) + strip;
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.setAttribute("height", height);
    const left = 104, right = width - 56, top = 26, bottom = height - 42;
    const plotTop = top + strip + 10;
    const ends = visible.flatMap(setting =>
        [(axis.least ?? axis.of)(setting), (axis.most ?? axis.of)(setting)]);
    const least = Math.min(...ends) / 1.25, most = Math.max(...ends) * 1.25;
    const floor =
        Math.floor((Math.min(metrics.psnr_enough - 20, ...visible.map(cappedPsnr)) - 3) / 10) * 10;
    const x = value => left + (right - left) * Math.log(value / least) / Math.log(most / least);
    const y = psnr => bottom - (bottom - plotTop) * (psnr - floor) / (metrics.psnr_enough - floor);
    // Neighbours of a row are a little above and below its middle, so that they can be told apart.
    const inRow = new Map();
    for (const method of rows)
        visible.filter(setting => setting.method === method && isEnough(setting))
            .sort((a, b) => axis.of(a) - axis.of(b))
            .forEach((setting, i, all) =>
                inRow.set(setting, all.length > 1 ? (i % 2 ? 3 : -3) : 0));
    const xOf = setting => x(axis.of(setting));
    const yOf = setting => isEnough(setting)
        ? top + (rows.indexOf(setting.method) + 0.5) * rowHeight + inRow.get(setting)
        : y(setting.psnr_db);
    if (strip > 0)
        element(svg, "rect", {class: "band", x: left, y: top, width: right - left, height: strip});
    rows.forEach((method, i) =>
        element(svg, "text", {x: left - 6, y: top + i * rowHeight + 13, "text-anchor": "end"},
            method));

    for (let power = Math.floor(Math.log10(least)); power <= Math.log10(most); ++power)
        for (const step of most / least > 300 ? [1] : [1, 2, 5]) {
            const ms = step * 10 ** power;
            if (ms < least || ms > most) continue;
            element(svg, "line",
                {class: "grid", x1: x(ms), x2: x(ms), y1: strip > 0 ? top : plotTop, y2: bottom});
            element(svg, "text", {x: x(ms), y: bottom + 16, "text-anchor": "middle"}, digits(ms));
        }
    for (let psnr = floor; psnr < metrics.psnr_enough; psnr += 10) {
        element(svg, "line", {class: "grid", x1: left, x2: right, y1: y(psnr), y2: y(psnr)});
        element(svg, "text", {x: left - 6, y: y(psnr) + 4, "text-anchor": "end"}, psnr);
    }
    for (let power = 2; power >= -3; --power) {
        const psnr = 20 * Math.log10(255) - 20 * power;
        if (psnr > floor && psnr < metrics.psnr_enough)
            element(svg, "text", {x: right + 6, y: y(psnr) + 4}, digits(10 ** power));
    }
    element(svg, "text", {x: 2, y: 12},
            strip > 0 ? `strip: ${metrics.psnr_enough} dB and more; below: PSNR, dB` : "PSNR, dB");
    element(svg, "text", {x: width - 2, y: plotTop - 2, "text-anchor": "end"}, "RMS error, /255");
    element(svg, "text", {x: (left + right) / 2, y: height - 6, "text-anchor": "middle"},
        axis.title);

    const front = frontOf(visible).sort((a, b) => axis.of(a) - axis.of(b));
    const onFront = setting => front.includes(setting);
    let path = "";
    front.forEach((setting, i) => {
        const at = isEnough(setting) ? top + strip : yOf(setting);
        path += i === 0 ? `M${xOf(setting)} ${at}` : `H${xOf(setting)}V${at}`;
    });
    if (front.length > 0) element(svg, "path", {class: "front", d: `${path}H${right}`});

    // Those of the front lie on top.
    for (const setting of [...visible].sort((a, b) => onFront(a) - onFront(b))) {
        const show = () => choose("b", drawn.indexOf(setting));
        const point = element(svg, "g", {
            class: onFront(setting) ? "point on-front" : "point", tabindex: 0, role: "button",
            "aria-label": summaryOf(setting), click: show,
            keydown: event => {
                if (event.key !== "Enter" && event.key !== " ") return;
                event.preventDefault();
                show();
            },
        });
        element(point, "title", {}, summaryOf(setting));
        const at = yOf(setting);
        if (axis.least !== undefined)
            element(point, "line", {
                class: "spread", y1: at, y2: at,
                x1: x(axis.least(setting)), x2: x(axis.most(setting)),
                style: `stroke: ${colourOf(setting.method)}`,
            });
        element(point, "path", {
            d: shapeOf(setting, xOf(setting), at, isEnough(setting) ? 4.5 : 5.5),
            style: `fill: ${colourOf(setting.method)}`,
        });
    }

    // Names of the front, where there is room beside their marks.
    const taken = visible.map(setting => {
        // So that no name is nearer to the mark of another one.
        const reach = onFront(setting) ? 20 : 6;
        return {
            setting, x: xOf(setting) - 6, y: yOf(setting) - reach, width: 12, height: 2 * reach,
        };
    });
    const meets = (a, b) => a.x < b.x + b.width && b.x < a.x + a.width &&
        a.y < b.y + b.height && b.y < a.y + a.height;
    for (const setting of front) {
        if (isEnough(setting)) continue;  // its row has a name
        const label = element(svg, "text", {class: "label"}, nameOf(setting));
        const length = label.getComputedTextLength();
        const px = xOf(setting), py = yOf(setting);
        const places = [[px + 9, py + 15], [px + 9, py - 8], [px + 9, py + 4],
                        [px - 9 - length, py - 8], [px - 9 - length, py + 4],
                        [px - 9 - length, py + 15],
                        [px - length / 2, py - 12], [px - length / 2, py + 22],
                        [px + 14, py + 28], [px - 14 - length, py - 22]];
        const place = places.find(([at, base]) => {
            const box = {x: at - 1, y: base - 11, width: length + 2, height: 14};
            const inside = box.x > left && box.x + box.width < right &&
                box.y > plotTop && base < bottom;
            return inside && !taken.some(other => other.setting !== setting && meets(box, other));
        });
        if (place === undefined) { label.remove(); continue; }
        label.setAttribute("x", place[0]);
        label.setAttribute("y", place[1]);
        taken.push({x: place[0] - 1, y: place[1] - 11, width: length + 2, height: 14});
    }
}

for (const method of methods) {
    const item = element(element(byId("legend"), "li"), "button", {
        type: "button", "aria-pressed": "true", title: "show or hide this method",
        click: event => {
            const shows = plotted.hidden.delete(method);
            if (!shows) plotted.hidden.add(method);
            event.currentTarget.setAttribute("aria-pressed", shows);
            drawPlot();
        },
    });
    const mark = item.appendChild(byId("plot").cloneNode(false));
    for (const name of ["id", "role", "aria-label"]) mark.removeAttribute(name);
    mark.setAttribute("viewBox", "0 0 14 14");
    mark.setAttribute("aria-hidden", "true");
    const exact = drawn.find(setting => setting.method === method).exact;
    element(mark, "path", {
        d: shapeOf({exact, layers: null, epsilon: 0}, 7, 7, 5.5),
        style: `fill: ${colourOf(method)}`,
    });
    item.append(method);
}
byId("plot-note").textContent =
    "Better is up and to the left. A disc is an exact method, a triangle its nearest layers or " +
    "an early end, and a diamond an approximation. A bar has half of a setting's frames. " +
    "Settings with overlapping bars are equally fast. The line and the outlined marks are the " +
    "Pareto front. Point at a mark for its metrics. Select it to see its picture as B. Select a " +
    "method's name to hide it.";
for (const choice of document.getElementsByName("axis"))
    choice.addEventListener("change", () => {
        plotted.axis = choice.value;
        byId("plot-title").textContent =
            choice.value === "ms" ? "Time and error" : "Memory and error";
        drawPlot();
    });
byId("front-note").textContent =
    `Marked settings: no other setting is both as fast and as accurate. Times count as equal ` +
    `within ${percent(metrics.equally_fast - 1)}, or if the spreads overlap. Errors count as ` +
    `equal above ${metrics.psnr_enough} dB, which is less than a step of 16 bits. ` +
    "±: half of the frames differ from the median by no more.";
byId("uncertain").hidden = metrics.typical_spread <= metrics.equally_fast - 1;
byId("uncertain").textContent =
    `The times are uncertain: half of the settings have a spread of ` +
    `${percent(metrics.typical_spread)} or more. Ignore smaller ` +
    "differences. Measure again when the machine is idle, or with more --frames.";
window.addEventListener("resize", drawPlot);
drawPlot();

// --- layers

const bins = metrics.pixels_by_layers ?? [];
byId("histogram-part").hidden = bins.length === 0;

// Pixels without layers are said and not drawn: they would dwarf all others.
function drawHistogram() {
    const svg = byId("histogram");
    svg.replaceChildren();
    const width = Math.max(300, svg.clientWidth), height = 170, bottom = height - 24, top = 20;
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.setAttribute("height", height);
    const shown = bins.slice(1), most = Math.max(1, ...shown);
    const step = Math.min(90, width / Math.max(1, shown.length));
    shown.forEach((pixels, i) => {
        const least = 2 ** i, end = Math.min(2 ** (i + 1) - 1, metrics.most_layers);
        const tall = (bottom - top) * pixels / most;
        element(svg, "rect",
            {class: "bar", x: i * step + 2, width: step - 4, y: bottom - tall, height: tall});
        element(svg, "text", {x: (i + 0.5) * step, y: bottom - tall - 5, "text-anchor": "middle"},
            compact(pixels));
        element(svg, "text", {x: (i + 0.5) * step, y: bottom + 16, "text-anchor": "middle"},
                end > least ? `${least}–${end}` : least);
    });
}
const compact = value =>
    value.toLocaleString("en", {notation: "compact", maximumSignificantDigits: 3});
const pixelCount = bins.reduce((sum, pixels) => sum + pixels, 0);
byId("histogram-note").textContent = bins.length === 0 ? "" :
    `Pixels by the number of their layers; ${percent(bins[0] / Math.max(1, pixelCount))} of ` +
    `${compact(pixelCount)} pixels have none.`;
window.addEventListener("resize", drawHistogram);
drawHistogram();
