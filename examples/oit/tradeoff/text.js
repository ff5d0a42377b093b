// The script of the report of cellist-tradeoff: text.js, plot.js and page.js are one script, in
// this order. Here: the metrics, and how they read as text.
"use strict";
const byId = id => document.getElementById(id);
const metrics = JSON.parse(byId("metrics").textContent);
const drawn = metrics.settings.filter(setting => setting.failure === undefined);

// --- text

const digits = value => value.toLocaleString("en", {maximumSignificantDigits: 3});
// The same with zeros at the end, for columns.
const column = value =>
    value.toLocaleString("en", {minimumSignificantDigits: 3, maximumSignificantDigits: 3});
const decibels = value => value === null ? "equal" : value.toFixed(1);
const percent = part => (100 * part).toFixed(1) + " %";
// How far half of the times are from the median, as a part of it.
const spreadOf = setting =>
    (setting.upper_quartile_ms - setting.lower_quartile_ms) / (2 * setting.ms);
const nameOf = setting => [
    setting.method + (setting.size === null ? "" : ":" + setting.size),
    setting.layers === null ? "" : setting.layers + (setting.layers === 1 ? " layer" : " layers"),
    setting.epsilon === 0 ? "" : "ε " + digits(setting.epsilon),
    setting.format === "float" ? "" : setting.format,
].filter(part => part !== "").join(", ");
const summaryOf = setting =>
    `${nameOf(setting)}: ${digits(setting.ms)} ms ± ${percent(spreadOf(setting))}, ` +
    `${decibels(setting.psnr_db)} dB, SSIM ${setting.ssim.toFixed(5)}, ` +
    `error at most ${digits(255 * setting.max_abs_error)}/255, ${digits(setting.bytes / 1e6)} MB`;

// A new element; attributes that are functions become listeners.
function element(parent, tag, attributes = {}, text = undefined) {
    const made =
        document.createElementNS((parent.closest("svg") ?? document.body).namespaceURI, tag);
    for (const [name, value] of Object.entries(attributes))
        if (typeof value === "function") made.addEventListener(name, value);
        else made.setAttribute(name, value);
    if (text !== undefined) made.textContent = text;
    return parent.appendChild(made);
}

byId("scene").textContent = metrics.scene;
byId("about").textContent =
    `${metrics.width}×${metrics.height}${metrics.eyes > 1 ? ", two eyes" : ""}, ` +
    `${metrics.samples} ${metrics.samples > 1 ? "samples" : "sample"} a pixel, view ` +
    `${metrics.view.map(angle => digits(angle)).join("°, ")}°, opacity ` +
    `${digits(metrics.alpha)}. ${metrics.triangles.toLocaleString("en")} triangles, ` +
    `${metrics.fragments.toLocaleString("en")} fragments, up to ${metrics.most_layers} ` +
    "in a pixel. " +
    `${metrics.device}, driver ${metrics.driver}; times are medians of ` +
    `${metrics.frames} ${metrics.frames === 1 ? "frame" : "frames"}.`;

// As a shell reads it again.
const shellWord = word =>
    /^[\w@%+=:,./-]+$/.test(word) ? word : "'" + word.replaceAll("'", "'\\''") + "'";
byId("run").append(
    element(byId("run"), "code", {},
        ["cellist-tradeoff", ...(metrics.arguments ?? []).map(shellWord)].join(" ")),
    [metrics.version && ` Version ${metrics.version}`,
     metrics.date && ` ${metrics.date.replace("T", " ").replace("Z", " UTC")}`]
        .filter(part => part).join(","));

