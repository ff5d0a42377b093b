// SPDX-License-Identifier: MIT
#include "budget/survey.hpp"

#include <limits>
#include <sstream>

#include "frame/fragment_source.hpp"
#include "oit_kernels.hpp"

namespace oit {

/// How much depths differ at least if they are resolved: constant + depth * (linear + depth *
/// quadratic), for float, 24 and 16 bits.
struct OitResolution {
    cl_float constant_part[3];
    cl_float linear_part[3];
    cl_float quadratic_part[3];
};
CELLIST_STRUCT(OitResolution, constant_part, linear_part, quadratic_part);

namespace {

constexpr std::size_t packed_formats = node_formats.size() - 1;
constexpr std::size_t bins = 16;
constexpr std::array depths_of_nodes{NodeFormat::float32, NodeFormat::rgba8_d24c8,
                                     NodeFormat::rgb565_d16};
// In the order of survey.cl.
constexpr std::array<NodeFormat, packed_formats> packed{
    NodeFormat::rgba16f, NodeFormat::rgba8, NodeFormat::rgba8_d24c8, NodeFormat::rgb565_d16};

// In float, of the brightest colour, and sRGB encoding in float. 2^-15 are the 512 * 2^-24 of
// shading that docs/numerics.md derives.
constexpr std::string_view errors =
    "#define OIT_SHADING_ERROR 0x1p-15f\n#define OIT_ENCODING_ERROR 0x1p-19f\n";

Frame exact_frame(const Frame& frame) {
    Frame exact = frame;
    exact.quality = {.samples = frame.quality.samples,
                     .depth_range = frame.quality.depth_range,
                     .depth_scale = frame.quality.depth_scale};
    return exact;
}

OitResolution resolution_of(const Frame& frame, const FrameFeatures& features) {
    OitResolution resolution{};
    for (std::size_t i = 0; i < depths_of_nodes.size(); ++i) {
        Quality quality = frame.quality;
        quality.format = depths_of_nodes.at(i);
        const DepthResolution parts = node_layout(quality, features).depth_resolution(features);
        resolution.constant_part[i] = static_cast<cl_float>(parts.constant);
        resolution.linear_part[i] = static_cast<cl_float>(parts.linear);
        resolution.quadratic_part[i] = static_cast<cl_float>(parts.quadratic);
    }
    return resolution;
}

std::string hexadecimal(auto value) {
    std::ostringstream text;
    text << std::hexfloat << value;
    return text.str();
}

std::string list(const auto& values, const auto& write) {
    std::string text;
    for (const auto& value : values) text += (text.empty() ? "" : ", ") + write(value);
    return text;
}

// The maxima and sums of all pixels.
struct Metrics {
    std::vector<double> most;
    std::vector<double> sum;

    Metrics(const std::vector<cl_float>& groups, std::size_t maxima, std::size_t sums)
        : most(maxima, -std::numeric_limits<double>::infinity()), sum(sums, 0.0) {
        const std::size_t width = maxima + sums;
        for (std::size_t at = 0; at < groups.size(); ++at) {
            const auto value = static_cast<double>(groups[at]);
            const std::size_t i = at % width;
            if (i < maxima)
                most[i] = std::max(most[i], value);
            else
                sum[i - maxima] += value;
        }
    }

    // Sums of squares were rounded within their group.
    [[nodiscard]] PictureError bound(std::size_t i, std::uint64_t pixels) const {
        constexpr double rounded = 1 + 1e-5;
        return {most[i], sum[i] * rounded / (3 * static_cast<double>(pixels))};
    }
    [[nodiscard]] std::uint64_t count(std::size_t i) const {
        return static_cast<std::uint64_t>(sum[i]);
    }
};

std::size_t groups_of(const Frame& frame) {
    const auto across = [](int side) { return (static_cast<std::size_t>(side) + 7) / 8; };
    return across(frame.width()) * across(frame.height()) * frame.views.size();
}

}  // namespace

class Survey::Drawing {
public:
    Drawing(const cellist::Device& device, const Frame& frame, std::vector<std::uint32_t> layers,
            std::vector<float> epsilons)
        : frame_(exact_frame(frame)),
          layers_(std::move(layers)),
          epsilons_(std::move(epsilons)),
          source_(device, frame_),
          compare_(source_.screen_kernel(text(kernels::survey_compare_cl, 2, 3),
                                         "survey_compare.cl", "oit_compare")),
          uncertainty_(device, frame_.pixels()),
          metrics_(device, groups_of(frame_) * (maxima() + sums())),
          compared_(device, groups_of(frame_) * 5) {}
    Drawing(const Drawing&) = delete;
    Drawing& operator=(const Drawing&) = delete;
    virtual ~Drawing() = default;

    SurveyResult measure(const Frame& frame) {
        frame_.time = frame.time;
        frame_.views = frame.views;
        source_.follow();
        source_.projection().transform();
        do source_.prepare();
        while (!source_.finish_or_grow());
        run();
        return read(Metrics(metrics_.download(), maxima(), sums()));
    }

    PictureErrors compare(const cellist::Buffer<cl_float4>& picture, double limit) {
        source_.run_on_screen(compare_, picture, uncertainty_, static_cast<cl_float>(limit),
                              compared_);
        const Metrics metrics(compared_.download(), 2, 3);
        return {metrics.bound(0, frame_.pixels()), metrics.bound(1, frame_.pixels()),
                metrics.count(2)};
    }

protected:
    virtual void run() = 0;

    [[nodiscard]] FragmentSource& source() { return source_; }
    [[nodiscard]] const cellist::Buffer<cl_float4>& uncertainty() const { return uncertainty_; }
    [[nodiscard]] const cellist::Buffer<cl_float>& metrics() const { return metrics_; }
    [[nodiscard]] OitResolution resolution() const {
        return resolution_of(frame_, source_.features());
    }
    [[nodiscard]] std::string survey_text() const {
        return define("OIT_BINS", bins) + define("OIT_FORMATS", packed_formats) +
               define("OIT_LAYER_COUNT", layers_.size()) +
               define("OIT_LAYER_COUNTS",
                      list(layers_, [](std::uint32_t k) { return std::to_string(k) + "u"; })) +
               define("OIT_EPSILON_COUNT", epsilons_.size()) +
               define("OIT_EPSILONS",
                      list(epsilons_, [](float e) { return hexadecimal(e) + "f"; })) +
               text(kernels::survey_cl, maxima(), sums());
    }

private:
    [[nodiscard]] static std::string text(std::string_view source, std::size_t maxima,
                                          std::size_t sums) {
        return define("OIT_MAXIMA", maxima) + define("OIT_SUMS", sums) + std::string(errors) +
               std::string(kernels::metrics_clh) + std::string(source);
    }
    [[nodiscard]] std::size_t bounds() const {
        return 2 + packed_formats + layers_.size() + epsilons_.size();
    }
    [[nodiscard]] std::size_t maxima() const { return bounds() + layers_.size() + 3; }
    [[nodiscard]] std::size_t sums() const { return bounds() + depths_of_nodes.size() + 1 + bins; }

    [[nodiscard]] SurveyResult read(const Metrics& metrics) const {
        SurveyResult measure;
        measure.pixels = frame_.pixels();
        const auto bound = [&](std::size_t i) { return metrics.bound(i, frame_.pixels()); };
        std::size_t at = 0;
        measure.exact = bound(at++);
        measure.exact_with_order = bound(at++);
        measure.formats.fill(measure.exact);
        for (const NodeFormat format : packed)
            measure.formats.at(static_cast<std::size_t>(format)) = bound(at++);
        for (const std::uint32_t layers : layers_)
            measure.cuts.push_back({.layers = layers, .error = bound(at++)});
        for (const float epsilon : epsilons_)
            measure.cuts.push_back({.epsilon = epsilon, .error = bound(at++)});

        std::size_t maximum = at, sum = at;
        for (std::size_t i = 0; i < layers_.size(); ++i)
            measure.cuts[i].light_behind = std::max(0.0, metrics.most[maximum++]);
        measure.greatest_alpha = static_cast<float>(std::max(0.0, metrics.most[maximum++]));
        measure.least_alpha = static_cast<float>(std::min(1.0, -metrics.most[maximum++]));
        measure.longest = static_cast<std::uint64_t>(std::max(0.0, metrics.most[maximum]));
        for (std::uint64_t& unresolved : measure.pixels_unresolved)
            unresolved = metrics.count(sum++);
        measure.fragments = metrics.count(sum++);
        for (std::size_t bin = 0; bin < bins; ++bin)
            measure.pixels_by_layers.push_back(metrics.count(sum++));
        measure.nonempty_pixels = measure.pixels - measure.pixels_by_layers.front();
        return measure;
    }

    Frame frame_;
    std::vector<std::uint32_t> layers_;
    std::vector<float> epsilons_;
    FragmentSource source_;
    cellist::Kernel compare_;
    cellist::Buffer<cl_float4> uncertainty_;
    cellist::Buffer<cl_float> metrics_;
    cellist::Buffer<cl_float> compared_;
};

namespace {

// Fragments so little behind an opaque surface that float does not resolve are kept, too.
const std::string& list_pass_text() {
    static const std::string text =
        "#define OIT_DEPTH_MARGIN (1.0f + 0x1p-20f)\n" + std::string(kernels::lists_cl);
    return text;
}

}  // namespace

// The drawing with lists of one node type.
template <class Node>
class Survey::ListDrawing : public Survey::Drawing {
public:
    ListDrawing(const cellist::Device& device, const Frame& frame,
                std::vector<std::uint32_t> layers, std::vector<float> epsilons)
        : Drawing(device, frame, std::move(layers), std::move(epsilons)),
          fragments_(device, source().shape()),
          pass_(source().pass(list_pass_text(), "lists.cl", fragments_)),
          survey_(source().screen_kernel(survey_text(), "survey.cl", "oit_survey", fragments_,
                                         cellist::type<OitResolution>)) {}

protected:
    void run() override {
        fragments_.build([&] { source().draw(pass_, fragments_); });
        fragments_.sort(&Node::key);
        source().run_on_screen(survey_, fragments_, resolution(), uncertainty(), metrics());
    }

private:
    cellist::Lists<Node> fragments_;
    raster::Pass pass_;
    cellist::Kernel survey_;
};

Survey::Survey(const cellist::Device& device, const Frame& frame, std::vector<std::uint32_t> layers,
               std::vector<float> epsilons) {
    const auto make = [&]<class Node>(const Node*) -> std::unique_ptr<Drawing> {
        return std::make_unique<ListDrawing<Node>>(device, frame, std::move(layers),
                                                   std::move(epsilons));
    };
    const Frame exact = exact_frame(frame);
    drawing_ = with_node_type(node_layout(exact.quality, features_of(exact)).words, make);
}

Survey::~Survey() = default;

SurveyResult Survey::measure(const Frame& frame) { return drawing_->measure(frame); }

PictureErrors Survey::compare(const cellist::Buffer<cl_float4>& picture, double limit) {
    return drawing_->compare(picture, limit);
}

}  // namespace oit
