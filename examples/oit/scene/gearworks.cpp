// SPDX-License-Identifier: MIT
// A gearbox: a shaft in the middle whose gears drive those on six shafts around it, with glass
// gears, sleeves, drums and a glass case, and a metal core, bearings and bolts. In the spirit of
// the mecha in Yang et al. 2010, figure 3: 602,000 triangles, 254,000 of them transparent, up to 64
// layers.
#include <algorithm>
#include <array>
#include <cmath>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "scene/scenes.hpp"
#include "scene/shapes.hpp"

namespace oit {
namespace {

constexpr std::uint64_t triangles_in_all = 602'000;
constexpr std::uint64_t triangles_of_glass = 254'000;

constexpr int planets = 6;
constexpr int levels = 10;
constexpr double shaft_distance = 0.51;
constexpr int teeth_of_pair = 72;  ///< of a gear of the middle and one that it drives
constexpr double level_height = 0.075;
constexpr double speed = 0.08;  ///< turns of the middle shaft a second

glm::dmat4 moved(double x, double y, double z) {
    return glm::translate(glm::dmat4(1), glm::dvec3(x, y, z));
}

bool is_near(const glm::dvec2& a, const glm::dvec2& b) { return glm::distance(a, b) < 1e-9; }

double height_of(int level) { return level_height * (level - 0.5 * (levels - 1)); }

Material surface(const std::array<float, 3>& tint, float gloss, float alpha, Blend blend) {
    Material material = glass(alpha);
    for (std::size_t i = 0; i < 3; ++i) {
        material.front_tint[i] = tint[i];
        material.back_tint[i] =
            blend == Blend::opaque ? tint[i] : 0.6F * tint[(i + 1) % 3] + 0.4F * tint[i];
    }
    material.gloss = gloss;
    material.blend = static_cast<cl_uint>(blend);
    return material;
}

// Puts the machine together.
class GearworksBuilder {
public:
    explicit GearworksBuilder(float alpha) {
        const std::array<std::array<float, 3>, 4> tints{{{0.04F, 0.55F, 0.85F},
                                                         {0.90F, 0.10F, 0.32F},
                                                         {0.95F, 0.55F, 0.05F},
                                                         {0.10F, 0.75F, 0.25F}}};
        for (const auto& tint : tints)
            gear_glass_.push_back(add_material(surface(tint, 0.5F, alpha, Blend::over)));
        clear_ = add_material(surface({0.05F, 0.07F, 0.09F}, 0.4F, alpha, Blend::over));
        brass_ = add_material(surface({0.62F, 0.42F, 0.14F}, 0.9F, 1, Blend::opaque));
        steel_ = add_material(surface({0.34F, 0.36F, 0.40F}, 0.8F, 1, Blend::opaque));
    }

    Scene build() {
        add_gears();
        add_shafts();
        add_bearings();
        add_case();
        add_springs();
        scene_.lighting = studio_lighting(-1.0F);
        return std::move(scene_);
    }

private:
    std::size_t add_material(const Material& material) {
        scene_.materials.push_back(material);
        return scene_.materials.size() - 1;
    }
    std::size_t add_model(support::Mesh mesh) {
        scene_.models.push_back({.mesh = std::move(mesh)});
        return scene_.models.size() - 1;
    }
    void add(std::size_t model, std::size_t material, const glm::dmat4& place,
             double turns_per_second = 0) {
        scene_.instances.push_back({.model = model,
                                    .material = material,
                                    .to_world = place,
                                    .turns_per_second = turns_per_second});
    }

    [[nodiscard]] std::size_t tinted(int i) const {
        return gear_glass_[static_cast<std::size_t>(i) % gear_glass_.size()];
    }

    static double planet_angle(int planet) { return full_turn * (planet + 0.5) / planets; }

    glm::dmat4 at_planet(int planet, double z) const {
        const double angle = planet_angle(planet);
        return moved(shaft_distance * std::cos(angle), shaft_distance * std::sin(angle), z);
    }

    // In each level the gear of the middle has another size.
    void add_gears() {
        for (int level = 0; level < levels; ++level) {
            const int teeth = 38 + 2 * (level % 2 == 0 ? level : levels - level);
            const double module = shaft_distance / teeth_of_pair;
            const Gear driving{.teeth = teeth,
                               .pitch_radius = module * teeth,
                               .tooth_height = 4 * module,
                               .rim_radius = module * (teeth - 7),
                               .bore_radius = 0.045,
                               .thickness = 0.045};
            Gear driven = driving;
            driven.teeth = teeth_of_pair - teeth;
            driven.pitch_radius = module * driven.teeth;
            driven.rim_radius = module * (driven.teeth - 7);
            driven.web_segments = 24;
            driven.thickness = 0.05;
            driven.tooth_points = 8;
            const std::size_t driving_model = add_model(gear(driving));
            const std::size_t driven_model = add_model(gear(driven));
            add(driving_model, brass_, moved(0, 0, height_of(level)), speed);
            for (int planet = 0; planet < planets; ++planet) {
                // A tooth of the one meets a gap of the other in the direction between the shafts.
                const double angle = planet_angle(planet);
                const double tooth = angle * teeth / full_turn;
                const double own = angle + full_turn / 2 - (0.5 - tooth) * full_turn / driven.teeth;
                add(driven_model, tinted(planet + level),
                    glm::rotate(at_planet(planet, height_of(level)), own, glm::dvec3(0, 0, 1)),
                    -speed * teeth / driven.teeth);
            }
        }
    }

    void add_shafts() {
        const double end = 0.47;
        const auto stepped = [&](double radius) {
            const glm::dvec2 profile[] = {{0, -end},
                                          {0.7 * radius, -end},
                                          {0.7 * radius, -end + 0.04},
                                          {radius, -end + 0.04},
                                          {radius, end - 0.04},
                                          {0.7 * radius, end - 0.04},
                                          {0.7 * radius, end},
                                          {0, end}};
            return lathe(divided(profile, 0.1), 40, Corners::sharp);
        };
        add(add_model(stepped(0.042)), steel_, moved(0, 0, 0), speed);
        const std::size_t thin = add_model(stepped(0.03));
        const std::size_t inner = add_model(sleeve(0.036, 0.043, -0.44, 0.44, 40, 0.11));
        const std::size_t drum = add_model(sleeve(0.115, 0.123, -0.39, 0.39, 72, 0.13));
        const std::size_t outer_drum = add_model(sleeve(0.132, 0.140, -0.39, 0.39, 72, 0.13));
        for (int planet = 0; planet < planets; ++planet) {
            add(thin, steel_, at_planet(planet, 0));
            add(inner, clear_, at_planet(planet, 0));
            add(drum, tinted(planet), at_planet(planet, 0));
            add(outer_drum, clear_, at_planet(planet, 0));
        }
    }

    void add_bearings() {
        constexpr int balls = 12;
        const std::size_t ball_model = add_model(ball(0.012, 28));
        const std::size_t inner_race = add_model(ring(0.052, 0.008, 96, 20));
        const std::size_t outer_race = add_model(ring(0.088, 0.008, 120, 20));
        const auto add_bearing = [&](const glm::dmat4& place) {
            add(inner_race, steel_, place);
            add(outer_race, brass_, place);
            for (int i = 0; i < balls; ++i) {
                const double angle = full_turn * i / balls;
                add(ball_model, steel_,
                    glm::translate(place,
                                   glm::dvec3(0.07 * std::cos(angle), 0.07 * std::sin(angle), 0)));
            }
        };
        for (const double z : {-0.42, 0.42}) {
            add_bearing(moved(0, 0, z));
            for (int planet = 0; planet < planets; ++planet) add_bearing(at_planet(planet, z));
        }
    }

    // A drum of glass with rounded rims around all, glass plates and bolts.
    void add_case() {
        std::vector<glm::dvec2> profile;
        const auto quarters = [&](double z, double radius, int begin, int end) {
            const auto points =
                arc({0.78, z}, radius, full_turn / 4 * begin, full_turn / 4 * end, 15);
            profile.insert(profile.end(), points.begin(), points.end());
        };
        quarters(-0.41, 0.08, -1, 0);  // outside
        quarters(0.41, 0.08, 0, 1);
        quarters(0.48, 0.01, 1, 3);  // rim
        quarters(0.41, 0.06, 1, 0);  // inside
        quarters(-0.41, 0.06, 0, -1);
        quarters(-0.48, 0.01, 1, 3);
        profile.erase(std::unique(profile.begin(), profile.end(), is_near), profile.end());
        profile.back() = profile.front();
        add(add_model(lathe(divided(profile, 0.06), 240, Corners::round)), clear_, moved(0, 0, 0));

        for (const double radius : {0.78, 0.80, 0.82})
            add(add_model(sleeve(radius, radius + 0.004, -0.38, 0.38, 120, 0.095)), clear_,
                moved(0, 0, 0));

        const std::size_t plate = add_model(sleeve(0.10, 0.76, -0.006, 0.006, 144, 0.095));
        for (const double z : {-0.40, 0.40}) add(plate, clear_, moved(0, 0, z));

        constexpr int bolts = 24;
        const glm::dvec2 bolt_profile[] = {{0, -0.03},    {0.012, -0.03}, {0.012, 0.01},
                                           {0.022, 0.01}, {0.022, 0.022}, {0.016, 0.03},
                                           {0, 0.03}};
        const std::size_t bolt = add_model(lathe(bolt_profile, 36, Corners::sharp));
        for (const double z : {-0.42, 0.42})
            for (int i = 0; i < bolts; ++i) {
                const double angle = full_turn * (i + 0.5) / bolts;
                add(bolt, steel_, moved(0.74 * std::cos(angle), 0.74 * std::sin(angle), z));
            }
    }

    // What is left of the triangles. The rest of the machine must leave some.
    void add_springs() {
        std::uint64_t glass_triangles = 0;
        for (const Instance& instance : scene_.instances)
            if (!scene_.is_opaque(instance))
                glass_triangles += scene_.models[instance.model].mesh.triangles.size();
        const Spring around_case{
            .radius = 0.762, .wire_radius = 0.010, .low = -0.36, .high = 0.36, .turns = 9};
        const Spring around_shaft{
            .radius = 0.10, .wire_radius = 0.010, .low = -0.40, .high = 0.40, .turns = 14};
        const std::uint64_t opaque_triangles = scene_.triangles() - glass_triangles;
        add(add_model(spring(around_case, triangles_of_glass - glass_triangles)), clear_,
            moved(0, 0, 0));
        add(add_model(
                spring(around_shaft, triangles_in_all - triangles_of_glass - opaque_triangles)),
            steel_, moved(0, 0, 0), speed);
    }

    Scene scene_;
    std::vector<std::size_t> gear_glass_;
    std::size_t clear_ = 0, brass_ = 0, steel_ = 0;
};

// With so many layers, the glass of each is thin.
Scene make_gearworks(float alpha) { return GearworksBuilder(0.4F * alpha).build(); }

const SceneRegistration gearworks_scene(
    {.name = "gearworks",
     .summary = "a gearbox of glass and metal: 602,000 triangles, animated",
     .make = make_gearworks});

}  // namespace
}  // namespace oit
