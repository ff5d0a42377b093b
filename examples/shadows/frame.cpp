// SPDX-License-Identifier: MIT
#include "frame.hpp"

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

#include <glm/geometric.hpp>

#include "camera.hpp"
#include "input_error.hpp"
#include "shadows_kernels.hpp"

namespace shadows {
namespace {

// Rays of a batch, so that their memory is bounded.
constexpr std::size_t batch_rays = std::size_t{1} << 22;

constexpr cl_ulong no_key = std::numeric_limits<cl_ulong>::max();

// Height of rays above surfaces, in a scene of 3 m.
constexpr cl_float bias = 1e-3F;

cl_float4 float4(const glm::dvec3& v, double w) {
    return {{static_cast<cl_float>(v.x), static_cast<cl_float>(v.y), static_cast<cl_float>(v.z),
             static_cast<cl_float>(w)}};
}
cl_float4 point(const glm::dvec3& p) { return float4(p, 1); }
cl_float4 direction(const glm::dvec3& d) { return float4(d, 0); }

cl_float4 row(const glm::dmat4& matrix, int k) {
    return float4({matrix[0][k], matrix[1][k], matrix[2][k]}, matrix[3][k]);
}

std::vector<PlacedMesh> placed_meshes(const Scene& scene) {
    std::vector<PlacedMesh> placed;
    for (const Instance& instance : scene.instances) {
        const glm::dmat4& m = instance.to_world;
        placed.push_back({row(m, 0), row(m, 1), row(m, 2),
                          float4(glm::dvec3(instance.albedo), instance.blocks ? 1 : 0)});
    }
    return placed;
}

std::vector<raster::Placed> raster_placed(const Scene& scene) {
    std::vector<raster::Placed> placed;
    for (const Instance& instance : scene.instances)
        placed.push_back({instance.mesh, instance.to_world, static_cast<cl_uint>(placed.size())});
    return placed;
}

raster::View eye_view(const Scene& scene, const Gather& gather) {
    return support::look_at(scene.eye, scene.target, scene.field_degrees, gather.width,
                            gather.height);
}

raster::View light_view(const support::Light& light, int side) {
    return light.is_spot
               ? support::look_at(light.position, light.target, light.field_degrees, side, side)
               : support::look_along(light.position, light.target, light.side, side);
}

// A view as the source of light that shines through it.
LightSource source_of(const raster::View& view, const support::Light& light) {
    const auto axis = [](const cl_float(&v)[4]) {
        return glm::normalize(glm::dvec3(v[0], v[1], v[2]));
    };
    LightSource source{};
    source.position = point(light.position);
    source.axis = direction(glm::normalize(light.target - light.position));
    source.right = direction(axis(view.row_x));
    source.down = direction(axis(view.row_y));
    source.intensity = float4(glm::dvec3(light.intensity), 0);
    source.is_spot = light.is_spot ? 1 : 0;
    const double scale = glm::length(glm::dvec3(view.row_x[0], view.row_x[1], view.row_x[2]));
    source.side = static_cast<cl_float>(view.width * RASTER_SUBPIXELS / scale);
    return source;
}

// The eye, for what kernels need of it: where rays come from.
LightSource source_of(const Scene& scene) {
    LightSource source{};
    source.position = point(scene.eye);
    source.axis = direction(glm::normalize(scene.target - scene.eye));
    source.is_spot = 1;
    return source;
}

std::vector<const support::Mesh*> pointers(const std::vector<support::Mesh>& meshes,
                                           const std::vector<support::Mesh>& more) {
    std::vector<const support::Mesh*> result;
    for (const auto* list : {&meshes, &more})
        for (const support::Mesh& mesh : *list) result.push_back(&mesh);
    return result;
}

std::vector<support::Mesh> simplified_meshes(const Scene& scene, int cells) {
    std::vector<support::Mesh> result;
    if (cells > 0)
        for (const support::Mesh& mesh : scene.meshes) result.push_back(simplify(mesh, cells));
    return result;
}

// The triangles of all instances that block light, of simplified meshes where there are any.
std::vector<Blocker> blockers_of(const Scene& scene, const raster::Geometry& geometry,
                                 bool simplified) {
    std::vector<Blocker> blockers;
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        if (!instance.blocks) continue;
        const auto& part =
            geometry.part(instance.mesh + (simplified ? scene.meshes.size() : std::size_t{0}));
        for (cl_uint t = 0; t < part.triangles; ++t)
            blockers.push_back({static_cast<cl_uint>(i), part.first_triangle + t});
    }
    return blockers;
}

// The blockers in the world, for the cells of the grid.
std::vector<grid::GridTriangle> world_triangles(const Scene& scene,
                                                const std::vector<const support::Mesh*>& meshes,
                                                bool simplified) {
    std::vector<grid::GridTriangle> triangles;
    for (const Instance& instance : scene.instances) {
        if (!instance.blocks) continue;
        const support::Mesh& mesh =
            *meshes[instance.mesh + (simplified ? scene.meshes.size() : std::size_t{0})];
        const auto place = [&](std::uint32_t vertex) {
            return glm::vec3(instance.to_world * glm::dvec4(mesh.positions[vertex], 1));
        };
        for (const auto& t : mesh.triangles)
            triangles.push_back({place(t[0]), place(t[1]), place(t[2])});
    }
    return triangles;
}

// In front of the passes of the rasteriser.
std::string pass_source(std::string_view pass) {
    return std::string(kernels::visible_clh) + std::string(pass);
}

std::string kernel_source() {
    return grid::with_queries(std::string(kernels::light_clh) + std::string(kernels::indirect_cl) +
                              std::string(kernels::show_cl));
}

Gather gather_of(const Settings& s) {
    check_settings(s);
    return {.width = s.width,
            .height = s.height,
            .rsm_side = s.rsm,
            .samples = s.samples,
            .reduce = s.reduce,
            .interleave = s.interleave,
            .first_row = 0,
            .rows = 0,
            .bias = bias};
}

std::size_t rays_per_pixel(const Gather& gather) {
    const auto rays = static_cast<std::size_t>(gather.samples / gather.interleave);
    return 2 * rays * rays;
}

// Rows of B in a batch of rays, and as many rays.
int batch_rows(const Gather& gather, int b_width) {
    const std::size_t row_rays = static_cast<std::size_t>(b_width) * rays_per_pixel(gather);
    return static_cast<int>(std::max<std::size_t>(1, batch_rays / row_rays));
}

std::size_t pixels_of(const Gather& gather) {
    return static_cast<std::size_t>(gather.width) * static_cast<std::size_t>(gather.height);
}

std::vector<std::size_t> all_of(std::size_t count) {
    std::vector<std::size_t> all(count);
    for (std::size_t i = 0; i < count; ++i) all[i] = i;
    return all;
}

}  // namespace

void check_settings(const Settings& s) {
    const auto must_divide = [](int part, const char* name, int whole, const char* whole_name) {
        if (part < 1 || whole % part != 0)
            throw support::InputError(std::string(name) + " " + std::to_string(part) +
                                      " does not divide " + whole_name + " " +
                                      std::to_string(whole));
    };
    must_divide(s.samples, "--samples", s.rsm, "--rsm");
    must_divide(s.interleave, "--interleave", s.samples, "--samples");
}

SurfaceView::SurfaceView(const cellist::Device& device, raster::SetupKernels& setup,
                         const raster::Geometry& geometry,
                         const std::vector<raster::Placed>& placed, const raster::View& view)
    : projection_(device, setup, geometry, placed, std::span(&view, 1)),
      triangles_(device, projection_, all_of(placed.size())),
      keys_(device, static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height)),
      surfaces_(device, keys_.size()) {}

void SurfaceView::move(const std::vector<raster::Placed>& placed, const raster::View& view) {
    projection_.move(placed, std::span(&view, 1));
}

void SurfaceView::draw(raster::Pass& nearest, raster::Pass& surface, cellist::Kernel& clear,
                       const raster::Geometry& geometry, const cellist::Buffer<PlacedMesh>& placed,
                       const LightSource& from) {
    projection_.transform();
    do {
        triangles_.bin();
        keys_.fill(no_key);
        clear.run(cellist::Range::padded(surfaces_.size()), surfaces_,
                  static_cast<cl_uint>(surfaces_.size()));
        for (raster::Pass* pass : {&nearest, &surface})
            triangles_.draw(*pass, keys_, surfaces_, placed, geometry.positions(),
                            geometry.normals(), from);
    } while (!triangles_.finish_or_grow());
}

std::uint64_t SurfaceView::device_bytes() const {
    return projection_.device_bytes() + triangles_.device_bytes() +
           raster::bytes_of(keys_, surfaces_);
}

template <class... Uses>
cellist::Kernel Renderer::kernel(const char* name, const Uses&... uses) const {
    return {device_,
            cellist::Source{.text = kernel_source(), .file_name = "shadows.cl"},
            name,
            grid_->entries(),
            cellist::type<grid::GridCells>,
            cellist::type<grid::GridTriangle>,
            cellist::type<grid::GridSegment>,
            cellist::type<Surface>,
            cellist::type<Emitter>,
            cellist::type<PlacedMesh>,
            cellist::type<Blocker>,
            cellist::type<LightSource>,
            cellist::type<Gather>,
            uses...};
}

Renderer::Renderer(const cellist::Device& device, const Scene& scene, const Settings& settings)
    : device_(device),
      gather_(gather_of(settings)),
      simplified_(simplified_meshes(scene, settings.simplify)),
      geometry_(device, pointers(scene.meshes, simplified_)),
      setup_(device),
      nearest_(device, {}, pass_source(kernels::nearest_cl), "nearest.cl", cellist::type<Surface>,
               cellist::type<PlacedMesh>, cellist::type<LightSource>),
      surface_(device, {}, pass_source(kernels::surface_cl), "surface.cl", cellist::type<Surface>,
               cellist::type<PlacedMesh>, cellist::type<LightSource>),
      placed_meshes_(device, placed_meshes(scene)),
      eye_(device, setup_, geometry_, raster_placed(scene), eye_view(scene, gather_)),
      light_(device, setup_, geometry_, raster_placed(scene),
             light_view(scene.light, gather_.rsm_side)),
      blockers_(device, blockers_of(scene, geometry_, !simplified_.empty())),
      grid_([&] {
          const auto triangles =
              world_triangles(scene, pointers(scene.meshes, simplified_), !simplified_.empty());
          const grid::GridCells cells =
              scene.move
                  ? grid::cells_in_box(scene.low, scene.high, settings.grid, triangles.size())
                  : grid::cells_around(triangles, settings.grid);
          return std::make_unique<grid::TriangleGrid>(device, triangles, cells, settings.storage);
      }()),
      rays_(std::make_unique<grid::Rays>(device, *grid_)),
      emitters_(device, static_cast<std::size_t>(2 * settings.samples * settings.samples)),
      a_(device, pixels_of(gather_)),
      b_(device, static_cast<std::size_t>(b_width()) * static_cast<std::size_t>(b_height())),
      b_all_(device, b_.size()),
      segments_(device,
                std::min(b_.size(), static_cast<std::size_t>(b_width()) *
                                        static_cast<std::size_t>(batch_rows(gather_, b_width()))) *
                    rays_per_pixel(gather_)),
      blocked_(device, segments_.size()),
      ray_counts_(device, 2),
      picture_(device, a_.size()),
      unblocked_(device, a_.size()),
      blurred_(device, a_.size()),
      clear_(kernel("clear_surfaces")),
      place_blockers_(kernel("place_blockers")),
      make_emitters_(kernel("make_emitters")),
      gather_unblocked_(kernel("gather_unblocked")),
      make_rays_(kernel("make_rays")),
      gather_blocked_(kernel("gather_blocked")),
      compose_(kernel("compose")) {}

void Renderer::draw(const Scene& scene, support::PassTimes* times, const TakeRays& take_rays) {
    const auto end = [&](const char* pass) {
        if (times) times->end(pass);
    };
    const raster::View lit = light_view(scene.light, gather_.rsm_side);
    const LightSource light = source_of(lit, scene.light);
    if (scene.move) {
        const std::vector<raster::Placed> instances = raster_placed(scene);
        const std::vector<PlacedMesh> meshes = placed_meshes(scene);
        placed_meshes_.upload_async(meshes).wait();
        eye_.move(instances, eye_view(scene, gather_));
        light_.move(instances, lit);
    }
    end("move");

    const auto blockers = static_cast<cl_uint>(blockers_.size());
    place_blockers_.run(cellist::Range::padded(blockers, 64), blockers_, blockers, placed_meshes_,
                        geometry_.positions(), geometry_.indices(), grid_->triangles());
    build_ = grid_->build();
    end("grid");
    eye_.draw(nearest_, surface_, clear_, geometry_, placed_meshes_, source_of(scene));
    end("g_buffer");
    light_.draw(nearest_, surface_, clear_, geometry_, placed_meshes_, light);
    make_emitters_.run(cellist::Range::padded(64 * emitters_.size(), 64), light_.surfaces(), light,
                       gather_, emitters_);
    end("shadow_map");

    const cellist::Range pixels((gather_.width + 15) / 16 * 16, (gather_.height + 3) / 4 * 4);
    gather_unblocked_.run(pixels, eye_.surfaces(), emitters_, gather_, a_);
    end("buffer_a");
    gather_blocked(times, take_rays);
    compose_.run(pixels, eye_.surfaces(), a_, b_, b_all_, light_.keys(), gather_.rsm_side, light,
                 gather_, picture_, unblocked_, blurred_);
    end("compose");
}

// Traces the rays of B in batches of rows.
void Renderer::gather_blocked(support::PassTimes* times, const TakeRays& take_rays) {
    ray_counts_.fill(0);
    Gather batch = gather_;
    for (int row = 0; row < b_height(); row += batch.rows) {
        batch.first_row = row;
        batch.rows = std::min(batch_rows(gather_, b_width()), b_height() - row);
        const auto places =
            static_cast<std::size_t>(b_width()) * static_cast<std::size_t>(batch.rows);
        make_rays_.run(cellist::Range::padded(places * rays_per_pixel(gather_), 64),
                       eye_.surfaces(), emitters_, batch, segments_);
        if (times) times->end("make_rays");
        rays_->any_hits(segments_, places * rays_per_pixel(gather_), blocked_);
        if (times) times->end("trace");
        if (take_rays) take_rays(segments_, places * rays_per_pixel(gather_), blocked_);
        gather_blocked_.run(cellist::Range::padded(places, 64), eye_.surfaces(), emitters_, batch,
                            blocked_, b_, b_all_, ray_counts_);
        if (times) times->end("buffer_b");
    }
}

void Renderer::follow_camera(const Scene& scene) {
    eye_.move(raster_placed(scene), eye_view(scene, gather_));
}

FrameCounts Renderer::counts() const {
    const std::vector<cl_uint> counts = ray_counts_.download();
    return {counts[0], counts[1], build_};
}

std::size_t Renderer::rays_in_frame() const { return b_.size() * rays_per_pixel(gather_); }

std::vector<cl_uint> Renderer::passed_entries(const Scene& scene) {
    cellist::Buffer<cl_uint> passed(device_, a_.size());
    cellist::Kernel count = kernel("count_passed_entries");
    grid_->run(count, cellist::Range::padded(passed.size(), 64), eye_.surfaces(), source_of(scene),
               gather_, passed);
    return passed.download();
}

std::uint64_t Renderer::device_bytes() const {
    return geometry_.device_bytes() + eye_.device_bytes() + light_.device_bytes() +
           grid_->device_bytes() + rays_->device_bytes() +
           raster::bytes_of(placed_meshes_, blockers_, emitters_, a_, b_, b_all_, segments_,
                            blocked_, picture_, unblocked_, blurred_);
}

}  // namespace shadows
