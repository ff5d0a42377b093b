// What the settings of a report of cellist-tradeoff are called.
const drawn = metrics.settings.filter(setting => setting.failure === undefined);
const referenceName = metrics.lens !== null
    ? `mean of ${metrics.reference_views.toLocaleString("en")} pictures`
    : metrics.coverage === "samples"
    ? "reference in double precision" : "reference with 4,096 samples";
const firstShown = drawn.findIndex(setting => setting.pareto);

// How far half of the times are from the median, as a part of it.
const spreadOf = setting =>
    (setting.upper_quartile_ms - setting.lower_quartile_ms) / (2 * setting.ms);
const samplesOf = ({coverage, samples}) => coverage === "all"
    ? "1 to 8 samples and exact coverage"
    : coverage === "exact" ? "exact coverage" : samples + (samples > 1 ? " samples" : " sample");
const nameOf = setting => [
    setting.method + (setting.size === null ? "" : ":" + setting.size),
    setting.layers === null ? "" : setting.layers + (setting.layers === 1 ? " layer" : " layers"),
    setting.epsilon === 0 ? "" : "ε " + digits(setting.epsilon),
    setting.lens_rays === metrics.lens_rays ? "" : setting.lens_rays + " rays",
    setting.format === "float" ? "" : setting.format,
    metrics.coverage === "all" ? samplesOf(setting) : "",
].filter(part => part !== "").join(", ");
const summaryOf = setting =>
    `${nameOf(setting)}: ${digits(setting.ms)} ms ± ${percent(spreadOf(setting))}, ` +
    `${decibels(setting.psnr_db)} dB, SSIM ${setting.ssim.toFixed(5)}, ` +
    `error at most ${digits(255 * setting.max_abs_error)}/255, ${digits(setting.bytes / 1e6)} MB`;

byId("scene").textContent = metrics.scene;
byId("about").textContent =
    `${metrics.width}×${metrics.height}${metrics.eyes > 1 ? ", two eyes" : ""}, ` +
    `${samplesOf(metrics)}${metrics.coverage === "samples" ? " a pixel" : ""}, view ` +
    `${metrics.view.map(angle => digits(angle)).join("°, ")}°, opacity ` +
    `${digits(metrics.alpha)}. ${metrics.triangles.toLocaleString("en")} triangles, ` +
    `${metrics.fragments.toLocaleString("en")} fragments, up to ${metrics.most_layers} ` +
    "in a pixel. " +
    `${metrics.device}, driver ${metrics.driver}; times are medians of ` +
    `${metrics.frames} ${metrics.frames === 1 ? "frame" : "frames"}.`;
