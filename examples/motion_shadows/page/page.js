// --- plots against samples

const sampleCounts = [...new Set(drawn.map(row => row.samples))].sort((a, b) => a - b);
const methodNames = [...new Set(drawn.map(row => row.method))];
const colourOf = name => `var(--exact-${methodNames.indexOf(name)})`;
const passesOf = row => [
    ["visible samples", (row.passes_ms.project ?? 0) + (row.passes_ms.visible ?? 0)],
    ["shadow map", row.shadow_map_ms],
    ["shadow test", row.passes_ms.test ?? 0],
    ["shading", row.passes_ms.shade ?? 0],
];
const passColours = ["var(--approximate-0)", "var(--exact-0)", "var(--exact-1)", "var(--exact-2)"];

function legend(id, entries) {
    byId(id).replaceChildren();
    for (const [name, colour] of entries) {
        const item = element(byId(id), "li");
        const mark = item.appendChild(byId("times").cloneNode(false));
        for (const attribute of ["id", "role", "aria-label", "height"])
            mark.removeAttribute(attribute);
        mark.setAttribute("viewBox", "0 0 14 14");
        element(mark, "rect", {x: 1, y: 1, width: 12, height: 12, style: `fill: ${colour}`});
        item.append(name);
    }
}

// An empty plot with a scale of values from 0 to `most` on its left side.
function frameOf(id, most, title) {
    const svg = byId(id);
    svg.replaceChildren();
    const width = Math.max(300, svg.clientWidth), height = 300;
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.setAttribute("height", height);
    const left = 60, right = width - 12, top = 26, bottom = height - 52;
    const y = value => bottom - (bottom - top) * value / most;
    const power = 10 ** Math.floor(Math.log10(most / 4));
    const step = power * [1, 2, 5, 10].find(factor => most / (power * factor) <= 6);
    for (let value = 0; value <= most * 1.001; value += step) {
        element(svg, "line", {class: "grid", x1: left, x2: right, y1: y(value), y2: y(value)});
        element(svg, "text", {x: left - 6, y: y(value) + 4, "text-anchor": "end"}, digits(value));
    }
    element(svg, "text", {x: 2, y: 12}, title);
    element(svg, "text", {x: (left + right) / 2, y: height - 4, "text-anchor": "middle"},
            "samples a pixel");
    return {svg, left, right, bottom, y};
}

// A group of bars for each number of samples, a bar for each method.
function drawTimes() {
    const total = row => passesOf(row).reduce((sum, [, ms]) => sum + ms, 0);
    const most = 1.05 * Math.max(...drawn.map(total));
    const {svg, left, right, bottom, y} = frameOf("times", most, "ms a frame");
    const group = (right - left) / sampleCounts.length;
    const bar = Math.min(60, group / (methodNames.length + 0.7));
    sampleCounts.forEach((samples, i) => {
        const middle = left + (i + 0.5) * group;
        methodNames.forEach((method, k) => {
            const row = drawn.find(own => own.samples === samples && own.method === method);
            if (row === undefined) return;
            const x = middle + (k - methodNames.length / 2) * bar;
            let sum = 0;
            passesOf(row).forEach(([name, ms], pass) => {
                const rect = element(svg, "rect", {
                    x: x + 1, width: bar - 2, y: y(sum + ms), height: y(sum) - y(sum + ms),
                    style: `fill: ${passColours[pass]}`,
                });
                element(rect, "title", {}, `${nameOf(row)}, ${name}: ${digits(ms)} ms`);
                sum += ms;
            });
            element(svg, "text", {x: x + bar / 2, y: bottom + 15, "text-anchor": "middle"},
                    method.slice(0, Math.max(1, Math.floor(bar / 7))));
        });
        element(svg, "text", {class: "label", x: middle, y: bottom + 31, "text-anchor": "middle"},
                samples);
    });
    legend("times-legend", passesOf(drawn[0]).map(([name], pass) => [name, passColours[pass]]));
}

// `series` are {name, colour, dashed, value of a number of samples or undefined}.
function drawLines(id, series, title) {
    const points = series.map(({value}) => sampleCounts.map(samples => [samples, value(samples)])
        .filter(([, number]) => number !== undefined));
    const most = 1.05 * Math.max(1e-6, ...points.flat().map(([, number]) => number));
    const {svg, left, right, bottom, y} = frameOf(id, most, title);
    const largest = Math.max(1, ...sampleCounts);
    const x = samples => left + (right - left) * samples / (1.05 * largest);
    let labelled = -Infinity;
    for (const samples of sampleCounts) {
        if (x(samples) - labelled < 22) continue;
        labelled = x(samples);
        element(svg, "text", {class: "label", x: labelled, y: bottom + 17, "text-anchor": "middle"},
                samples);
    }
    // The first lies on top.
    [...series.entries()].reverse().forEach(([i, {name, colour, dashed}]) => {
        element(svg, "path", {
            d: points[i].map(([samples, number], k) =>
                `${k === 0 ? "M" : "L"}${x(samples)} ${y(number)}`).join(""),
            style: `stroke: ${colour}; stroke-width: 2; fill: none` +
                (dashed ? "; stroke-dasharray: 6 4" : ""),
        });
        for (const [samples, number] of points[i]) {
            const mark = element(svg, "circle",
                {cx: x(samples), cy: y(number), r: 4, style: `fill: ${colour}`});
            element(mark, "title", {}, `${name}, ${samples} samples: ${digits(number)}`);
        }
    });
    legend(id + "-legend", series.map(({name, colour}) => [name, colour]));
}

const seriesOf = of => methodNames.map(name => ({
    name, colour: colourOf(name),
    value: samples => {
        const row = drawn.find(own => own.samples === samples && own.method === name);
        return row === undefined ? undefined : of(row);
    },
}));

function drawPlots() {
    drawTimes();
    drawLines("memory", [
        ...seriesOf(row => row.bytes / 1e6),
        {name: "Equation 2", colour: "var(--approximate-1)", dashed: true,
         value: () => metrics.equation_2_bytes / 1e6},
        {name: "tsm (paper)", colour: "var(--approximate-2)", dashed: true,
         value: samples => samples * 4 * metrics.shadow_map ** 2 / 1e6},
    ], "MB");
    drawLines("error", seriesOf(row => row.psnr_db ?? undefined),
              "PSNR against the reference, dB; higher is better");
}
byId("lines").hidden = sampleCounts.length < 2;
window.addEventListener("resize", drawPlots);
drawPlots();

// --- tables

const countOf = number => number > 0 ? number.toLocaleString("en") : "";

fillTable(byId("methods"), drawn, [
    ["method", showButton],
    ["time, ms", row => column(row.ms), row => row.ms],
    ["MB", row => column(row.bytes / 1e6), row => row.bytes],
    ["ranges", row => countOf(row.ranges), row => row.ranges],
    ["after compression", row => countOf(row.pieces), row => row.pieces],
    ["PSNR, dB", row => decibels(row.psnr_db), row => row.psnr_db],
    ["SSIM", row => row.ssim.toFixed(4), row => row.ssim],
    ["largest error, /255", row => column(255 * row.max_abs_error), row => row.max_abs_error],
    ["self-shadowed pixels", row => row.pixels_self_shadowed.toLocaleString("en"),
     row => row.pixels_self_shadowed],
]);
byId("methods-note").textContent =
    `Self-shadowed pixels are improbably dark, of ` +
    `${drawn[0].pixels_lit.toLocaleString("en")} pixels that the reference has lit. Errors are ` +
    `against ${referenceName}, which took ${digits(accumulated.ms / 1000)} s. Equation 2 of the ` +
    `paper is ${digits(metrics.equation_2_bytes / 1e6)} MB.`;
const common = ["project", "visible", "test", "shade"];
const ownPasses = new Set(drawn.flatMap(row => Object.keys(row.passes_ms))
    .filter(name => !common.includes(name)));
const passNames = [...common.slice(0, 2), ...ownPasses, ...common.slice(2)];
fillTable(byId("passes"), drawn, [
    ["ms", showButton],
    ...passNames.map(name => [
        name, row => name in row.passes_ms ? column(row.passes_ms[name]) : "",
        row => row.passes_ms[name],
    ]),
]);
