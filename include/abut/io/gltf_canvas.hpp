// SPDX-License-Identifier: MIT
#pragma once

// What a scene draws, as nodes of a glTF file: triangles, boxes, segments and points by their corners, spheres by one ball,
// contacts as lines, motions as morph targets. All coordinates pass through here, and are rounded to float.

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/error.hpp>
#include <abut/io/gltf_document.hpp>
#include <abut/io/gltf_drawing.hpp>
#include <abut/io/json_text.hpp>

namespace abut::io::detail {

[[noreturn]] inline void refuse_scene(const std::string& function, const std::string& what) {
    throw error("abut::io::gltf_scene::" + function + ": " + what);
}

/// How shapes are marked and named; empty: not, and 0, 1, 2, ...
struct gltf_marks {
    std::span<const std::uint8_t> hit;
    std::span<const std::uint32_t> ids;

    [[nodiscard]] bool is_hit(std::size_t i) const { return !hit.empty() && hit[i] != 0; }
    [[nodiscard]] std::uint32_t id(std::size_t i) const { return ids.empty() ? static_cast<std::uint32_t>(i) : ids[i]; }
};

class gltf_canvas {
public:
    /// More spheres than this are instances of one ball; of more than that, coarser ones.
    static constexpr std::size_t most_nodes = 256, most_fine_balls = 1000;

    [[nodiscard]] vec3<double> origin() const { return origin_; }
    static std::array<float, 3> in_float(const vec3<double>& p) {
        return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    }
    /// A point as the file has it.
    [[nodiscard]] std::array<float, 3> rounded(const vec3<double>& p) const { return finite(p - origin_, p); }
    template <class V>
    std::string add_values(const std::vector<V>& values, std::size_t components = 1) {
        return json_number(file_.add(values, components));
    }

    /// A set that is drawn by points of its own: at(frame, i) is shape i in a frame, corner(i, k) the vertex at its corner
    /// k. Returns its node.
    template <class At, class Corner>
    std::size_t add_drawn(const std::string& name, std::size_t count, std::size_t frames, const At& at, const Corner& corner,
                          const gltf_marks& marks) {
        using shape_type = std::remove_cvref_t<decltype(at(0, 0))>;
        using kind = gltf_kind<shape_type>;
        constexpr std::size_t corners = std::tuple_size_v<decltype(gltf_points(at(0, 0)))>;
        settle_origin<scalar_type_of<shape_type>>(
            count * corners, [&](std::size_t i) { return in_double(gltf_points(at(0, i / corners))[i % corners]); });
        if (count == 0) return add_root({{"name", json_string(name)}});

        std::vector<float> positions, normals;
        std::vector<std::uint8_t> colours;
        std::vector<float> ids, vertices;
        const colour plain = plain_colour(drawn_++), marked = hit_colour();
        for (std::size_t i = 0; i < count; ++i) {
            const auto points = gltf_points(at(0, i));
            const bool is_hit = marks.is_hit(i);
            std::array<float, 3> normal{};
            for (std::size_t k = 0; k < corners; ++k) {
                const std::array<float, 3> p = rounded(in_double(points[k]));
                grow(p);
                positions.insert(positions.end(), p.begin(), p.end());
                colours.insert(colours.end(), (is_hit ? marked : plain).begin(), (is_hit ? marked : plain).end());
                push_id(ids, marks.id(i));
                if constexpr (kind::mode == 4) {
                    if (k % 3 == 0) {
                        normal = flat_normal(in_double(points[k]), in_double(points[k + 1]), in_double(points[k + 2]));
                    }
                    normals.insert(normals.end(), normal.begin(), normal.end());
                }
                if constexpr (corners == 3) push_id(vertices, corner(i, k));
            }
        }
        std::vector<std::string> targets;
        for (std::size_t frame = 1; frame < frames; ++frame) {
            std::vector<float> moved;
            moved.reserve(positions.size());
            for (std::size_t i = 0; i < count; ++i) {
                const auto from = gltf_points(at(0, i)), to = gltf_points(at(frame, i));
                for (std::size_t k = 0; k < corners; ++k) {
                    grow(rounded(in_double(to[k])));
                    const auto way = finite(in_double(to[k]) - in_double(from[k]), in_double(to[k]));
                    moved.insert(moved.end(), way.begin(), way.end());
                }
            }
            targets.push_back(json_object({{"POSITION", add_positions(moved)}}));
        }
        const std::string attributes = json_object({{"POSITION", add_positions(positions)},
                                                    {"NORMAL", normals.empty() ? "" : add_attribute(normals, 3)},
                                                    {"COLOR_0", add_attribute(colours, 4, true)},
                                                    {"_ID", add_attribute(ids, 2)},
                                                    {"_CORNER", vertices.empty() ? "" : add_attribute(vertices, 2)}});
        const std::size_t node = add_mesh_node(name, kind::mode, attributes, targets);
        if (frames > 1) add_motion(node, frames);
        return node;
    }

    /// Spheres are nodes of their own, or instances of one ball where they are many. Returns the node of all.
    template <class V>
    std::size_t add_spheres(const std::string& name, const V& view, const gltf_marks& marks) {
        const std::size_t count = view.size();
        settle_origin<typename V::scalar_type>(2 * count, [&](std::size_t i) {
            const auto box = bounds(view[i / 2]);
            return in_double(i % 2 == 0 ? box.lower : box.upper);
        });
        std::vector<float> centers, scales;
        std::vector<std::uint8_t> colours;
        std::vector<float> ids;
        const colour plain = plain_colour(drawn_++), marked = hit_colour();
        std::vector<std::string> children;
        for (std::size_t i = 0; i < count; ++i) {
            const auto sphere = view[i];
            const auto radius = static_cast<double>(sphere.radius);
            const auto center = rounded(in_double(sphere.center));
            for (const double k : {-radius, radius}) grow(rounded(in_double(sphere.center) + vec3<double>{k, k, k}));
            const colour& c = marks.is_hit(i) ? marked : plain;
            if (count <= most_nodes) {
                const auto r = static_cast<float>(radius);
                children.push_back(
                    json_number(file_.add_node(json_object({{"name", json_string(name + ' ' + std::to_string(marks.id(i)))},
                                                            {"mesh", json_number(ball_of(c, 2))},
                                                            {"translation", json_point(center)},
                                                            {"scale", json_point({r, r, r})},
                                                            {"extras", json_object({{"id", json_number(marks.id(i))}})}}))));
                continue;
            }
            centers.insert(centers.end(), center.begin(), center.end());
            scales.insert(scales.end(), 3, static_cast<float>(radius));
            colours.insert(colours.end(), c.begin(), c.end());
            push_id(ids, marks.id(i));
        }
        std::string mesh, extensions;
        if (count > most_nodes) {
            extensions_ = {"\"EXT_mesh_gpu_instancing\""};
            mesh = json_number(ball_of(marks.hit.empty() ? plain : white, count <= most_fine_balls ? 2 : 1));
            const std::string attributes = json_object({{"TRANSLATION", add_values(centers, 3)},
                                                        {"SCALE", add_values(scales, 3)},
                                                        {"_ID", add_values(ids, 2)},
                                                        {"_COLOR_0", marks.hit.empty() ? "" : add_colours(colours)}});
            extensions = json_object({{"EXT_mesh_gpu_instancing", json_object({{"attributes", attributes}})}});
        }
        return add_root({{"name", json_string(name)},
                         {"mesh", mesh},
                         {"children", children.empty() ? "" : json_array(children)},
                         {"extensions", extensions}});
    }

    /// Of contacts, a fiftieth of the diagonal of all that has been added.
    [[nodiscard]] float line_length() const {
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double side = static_cast<double>(upper_[k]) - static_cast<double>(lower_[k]);
            sum += side > 0 ? side * side : 0;
        }
        return sum > 0 ? static_cast<float>(0.02 * std::sqrt(sum)) : 1;
    }
    /// Lines of two positions each, one after another; returns their node.
    std::size_t add_lines(const std::vector<float>& positions) {
        std::vector<std::uint8_t> colours;
        std::vector<float> ids;
        const colour c = linear_colour(200, 30, 60);
        for (std::size_t i = 0; i < positions.size() / 3; ++i) {
            push_id(ids, static_cast<std::uint32_t>(i / 2));
            colours.insert(colours.end(), c.begin(), c.end());
        }
        const std::string attributes = json_object({{"POSITION", add_positions(positions)},
                                                    {"COLOR_0", add_attribute(colours, 4, true)},
                                                    {"_ID", add_attribute(ids, 2)}});
        return add_mesh_node("contacts", 1, attributes, {});
    }

    /// The file; see gltf_document::write. `ours` is what its extras have of this library.
    template <class Output>
    void write(Output& to, const std::string& name, const std::string& ours) const {
        const std::string animation =
            channels_.empty()
                ? ""
                : json_object(
                      {{"name", "\"step\""}, {"samplers", json_array(samplers_)}, {"channels", json_array(channels_)}});
        file_.write(to, name,
                    {.roots = roots_,
                     .translation = json_origin(),
                     .animation = animation,
                     .extras = json_object({{"abut", ours}}),
                     .extensions = extensions_});
    }
    /// Empty where it is that of the world.
    [[nodiscard]] std::string json_origin() const {
        const bool is_shifted = origin_.x != 0 || origin_.y != 0 || origin_.z != 0;
        return is_shifted ? json_point(in_float(origin_)) : "";
    }

private:
    static constexpr float infinity = std::numeric_limits<float>::infinity();

    /// `p` in float; `of` is the point that a complaint names.
    static std::array<float, 3> finite(const vec3<double>& p, const vec3<double>& of) {
        const std::array<float, 3> q = in_float(p);
        if (!std::isfinite(q[0]) || !std::isfinite(q[1]) || !std::isfinite(q[2])) {
            refuse_scene("add", "expected coordinates that float can hold, found " + abut::detail::shortest(of.x) + ", " +
                                    abut::detail::shortest(of.y) + ", " + abut::detail::shortest(of.z));
        }
        return q;
    }
    void grow(const std::array<float, 3>& p) {
        for (std::size_t k = 0; k < 3; ++k) {
            lower_[k] = std::fmin(lower_[k], p[k]);
            upper_[k] = std::fmax(upper_[k], p[k]);
        }
    }

    /// The first set that is not empty decides: point(i) of `count` points of type vec3<T>.
    template <class T, class Point>
    void settle_origin(std::size_t count, const Point& point) {
        if (has_origin_ || count == 0) return;
        has_origin_ = true;
        if constexpr (std::same_as<T, double>) {
            aabb<double> box{point(0), point(0)};
            for (std::size_t i = 1; i < count; ++i) box = merge(box, aabb<double>{point(i), point(i)});
            const auto far_off = [](double lower, double upper, double extent) {
                return std::fmax(std::fabs(lower), std::fabs(upper)) > 16 * extent;
            };
            const vec3<double> size = box.upper - box.lower;
            const double extent = std::fmax(size.x, std::fmax(size.y, size.z));
            if (!(extent > 0) || !std::isfinite(extent)) return;
            if (!far_off(box.lower.x, box.upper.x, extent) && !far_off(box.lower.y, box.upper.y, extent) &&
                !far_off(box.lower.z, box.upper.z, extent)) {
                return;
            }
            // As floats, so that programs that keep positions of nodes as such have it right too.
            const auto middle = in_float(box.lower + 0.5 * size);
            if (!std::isfinite(middle[0]) || !std::isfinite(middle[1]) || !std::isfinite(middle[2])) return;
            origin_ = {middle[0], middle[1], middle[2]};
        }
    }

    /// As two floats, which hold 16 bits each exactly: readers take attributes of their own for floats (VTK's leaves out
    /// integers, and then its mesh is not sound).
    static void push_id(std::vector<float>& to, std::uint32_t id) {
        to.insert(to.end(), {static_cast<float>(id & 0xffff), static_cast<float>(id >> 16)});
    }
    template <class V>
    std::string add_attribute(const std::vector<V>& values, std::size_t components, bool is_normalised = false) {
        return json_number(file_.add(values, components, {.is_attribute = true, .is_normalised = is_normalised}));
    }
    std::string add_positions(const std::vector<float>& values) {
        return json_number(file_.add(values, 3, {.is_attribute = true, .has_bounds = true}));
    }
    std::string add_colours(const std::vector<std::uint8_t>& colours) {
        return json_number(file_.add(colours, 4, {.is_normalised = true}));
    }

    std::size_t add_root(std::initializer_list<std::pair<std::string_view, std::string>> members) {
        const std::size_t node = file_.add_node(json_object(members));
        roots_.push_back(json_number(node));
        return node;
    }
    std::size_t add_mesh_node(const std::string& name, int mode, const std::string& attributes,
                              const std::vector<std::string>& targets) {
        const std::vector<std::string> weights(targets.size(), "0");
        const std::string primitive = json_object({{"attributes", attributes},
                                                   {"mode", json_number(mode)},
                                                   {"material", json_number(material_of(white))},
                                                   {"targets", targets.empty() ? "" : json_array(targets)}});
        const std::size_t mesh = file_.add_mesh(json_object({{"name", json_string(name)},
                                                             {"primitives", json_list(primitive)},
                                                             {"weights", targets.empty() ? "" : json_array(weights)}}));
        return add_root({{"name", json_string(name)}, {"mesh", json_number(mesh)}});
    }

    /// Frame k is at k seconds, where target k - 1 has the weight 1 and the others 0.
    void add_motion(std::size_t node, std::size_t frames) {
        std::vector<float> times, weights;
        for (std::size_t k = 0; k < frames; ++k) {
            times.push_back(static_cast<float>(k));
            for (std::size_t target = 1; target < frames; ++target) weights.push_back(target == k ? 1.0f : 0.0f);
        }
        const std::string input = json_number(file_.add(times, 1, {.has_bounds = true}));
        samplers_.push_back(
            json_object({{"input", input}, {"output", add_values(weights)}, {"interpolation", "\"LINEAR\""}}));
        channels_.push_back(json_object({{"sampler", json_number(samplers_.size() - 1)},
                                         {"target", json_object({{"node", json_number(node)}, {"path", "\"weights\""}})}}));
    }

    /// A material that takes its colour from the vertices, or has this one.
    std::size_t material_of(const colour& c) {
        const auto [place, is_new] = materials_.try_emplace(c);
        if (is_new) {
            std::vector<std::string> factors;
            for (const int part : c) factors.push_back(json_number(part / 255.0));
            place->second = file_.add_material(json_object(
                {{"doubleSided", "true"},
                 {"pbrMetallicRoughness",
                  json_object(
                      {{"baseColorFactor", json_array(factors)}, {"metallicFactor", "0"}, {"roughnessFactor", "0.8"}})}}));
        }
        return place->second;
    }
    static constexpr colour white{255, 255, 255, 255};

    /// A mesh of one ball in this colour.
    std::size_t ball_of(const colour& c, int divisions) {
        const auto [place, is_new] = balls_.try_emplace({c, divisions});
        if (!is_new) return place->second;
        const auto [arrays, are_new] = ball_arrays_.try_emplace(divisions);
        if (are_new) {
            const ball_mesh ball(divisions);
            arrays->second = {add_positions(ball.positions), add_attribute(ball.positions, 3),
                              json_number(file_.add(ball.corners, 1, {.is_indices = true}))};
        }
        const auto& [positions, normals, corners] = arrays->second;
        const std::string primitive =
            json_object({{"attributes", json_object({{"POSITION", positions}, {"NORMAL", normals}})},
                         {"indices", corners},
                         {"mode", "4"},
                         {"material", json_number(material_of(c))}});
        return place->second = file_.add_mesh(json_object({{"name", "\"ball\""}, {"primitives", json_list(primitive)}}));
    }
    /// Each float as the double that it is: readers take numbers for doubles.
    static std::string json_point(const std::array<float, 3>& p) {
        const auto number = [](float x) { return json_number(static_cast<double>(x)); };
        return json_list(number(p[0]), number(p[1]), number(p[2]));
    }

    gltf_document file_;
    std::vector<std::string> roots_, samplers_, channels_, extensions_;
    std::map<colour, std::size_t> materials_;
    std::map<std::pair<colour, int>, std::size_t> balls_;
    std::map<int, std::array<std::string, 3>> ball_arrays_;  // positions, normals and corners, by their divisions
    std::size_t drawn_ = 0;
    vec3<double> origin_{0, 0, 0};
    bool has_origin_ = false;
    std::array<float, 3> lower_{infinity, infinity, infinity}, upper_{-infinity, -infinity, -infinity};
};

}  // namespace abut::io::detail
