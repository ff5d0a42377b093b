// --- tables

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
