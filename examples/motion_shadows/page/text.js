// What the methods of a report of cellist-motion-shadows are called.
const accumulated = metrics.methods.find(row => row.method === "accumulate");
const drawn = metrics.methods.filter(row => row !== accumulated);
const referenceName = `accumulate, ${accumulated.samples.toLocaleString("en")} moments`;
const firstShown = 0;

const nameOf = row => `${row.method}, ${row.samples.toLocaleString("en")} samples`;
const summaryOf = row =>
    `${nameOf(row)}: ${digits(row.ms)} ms, ${decibels(row.psnr_db)} dB, ` +
    `SSIM ${row.ssim.toFixed(4)}, ${digits(row.bytes / 1e6)} MB`;

byId("scene").textContent = metrics.scene;
byId("about").textContent =
    `${metrics.triangles.toLocaleString("en")} triangles, ${metrics.width}×${metrics.height}, ` +
    `shadow map of ${metrics.shadow_map}×${metrics.shadow_map}, ${metrics.light} light, exposure ` +
    `${digits(metrics.exposure)}. ${metrics.device}, driver ${metrics.driver}; times are medians.`;
