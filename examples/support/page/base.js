// The script of a report: base.js, the program's text.js, table.js, the program's own parts, and
// stage.js are one script, in this order. Here: the metrics, and how they read as text.
"use strict";
const byId = id => document.getElementById(id);
const metrics = JSON.parse(byId("metrics").textContent);

// --- text

const digits = value => value.toLocaleString("en", {maximumSignificantDigits: 3});
// The same with zeros at the end, for columns.
const column = value =>
    value.toLocaleString("en", {minimumSignificantDigits: 3, maximumSignificantDigits: 3});
const decibels = value => value === null ? "equal" : value.toFixed(1);
const percent = part => (100 * part).toFixed(1) + " %";

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

// As a shell reads it again.
const shellWord = word =>
    /^[\w@%+=:,./-]+$/.test(word) ? word : "'" + word.replaceAll("'", "'\\''") + "'";
byId("run").append(
    element(byId("run"), "code", {},
        [metrics.program, ...(metrics.arguments ?? []).map(shellWord)].join(" ")),
    [metrics.version && ` Version ${metrics.version}`,
     metrics.date && ` ${metrics.date.replace("T", " ").replace("Z", " UTC")}`]
        .filter(part => part).join(","));
