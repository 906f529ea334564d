// SPDX-License-Identifier: MIT
#pragma once

// Scenes as binary glTF 2.0: sets, what touches, and motions, for programs that show them. What the format has no words for,
// such as pairs of ids, stands in the file's extras. Layout: docs/files.md.

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <ranges>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/error.hpp>
#include <abut/io/file.hpp>
#include <abut/io/gltf_document.hpp>
#include <abut/io/gltf_drawing.hpp>
#include <abut/io/property.hpp>
#include <abut/shape/motion.hpp>
#include <abut/shape/posed.hpp>
#include <abut/shape/set.hpp>

namespace abut::io {

/// @addtogroup files
///@{

/// A set of a scene, as `gltf_scene::add` returns it.
struct gltf_set {
    std::size_t number;  ///< from 0, in the order in which sets were added
};

/// What goes into a scene with a set; by default the set is whole, and all of it has one colour.
struct gltf_set_options {
    /// For each shape 0 or not: those that are not 0 are orange. Empty: none is.
    std::span<const std::uint8_t> hit{};
    /// Where only some shapes of a set are added: their ids in the whole set. Empty: 0, 1, 2, ...
    std::span<const std::uint32_t> ids{};
    /// Where only some shapes are added: how many the whole set has. 0: these are all.
    std::size_t of = 0;
};

/// What goes into a scene with a list of results.
struct gltf_result_options {
    /// Where only some results are added: how many there are in all. 0: these are all.
    std::size_t of = 0;
    /// Of impacts of a set of several frames: the frame in which their step begins.
    std::size_t step = 0;
};

/// A contact: `abut::contact`, or any type with its members.
template <class C>
concept contact_like = id_pair<C> && requires(const C& c) {
    { c.depth } -> std::convertible_to<double>;
    { c.point.x } -> std::convertible_to<double>;
    { c.normal.x } -> std::convertible_to<double>;
};

/// An impact: `abut::impact`, or any type with its members.
template <class I>
concept impact_like = requires(const I& i) {
    { i.time } -> std::convertible_to<double>;
    { i.vertices[3] } -> std::convertible_to<std::uint32_t>;
    static_cast<unsigned char>(i.kind);
};

///@}

/// A scene that is being put together: sets, and what touches among them. `write_gltf` writes it.
///
/// @par Memory
/// What is added is copied, in the form of the file: 108 bytes a triangle, 72 more for each further frame of a motion, 1.3 kB
/// a box, 32 bytes a sphere. A file of binary glTF holds 4 GiB.
///
/// @par Errors
/// `error`: a coordinate is too large for a float, an option has not one value for each shape, frames do not go together, or a
/// set is of another scene. `invalid_geometry`: a view that is added is no geometry. `std::bad_alloc`.
class gltf_scene {
public:
    /// Adds a set: triangles (mesh, triangle_soup), spheres, segments (edge_mesh, segments), points or boxes; or a view of
    /// one in host memory; or one that is posed, which is written where `place` puts it, in the world; or a mesh or soup in
    /// motion, whose two frames are written; or a single shape. Coordinates are rounded to float: those of a set of doubles
    /// after the scene's origin is subtracted. Spheres are drawn as polyhedra.
    ///
    /// The origin is that of the world, unless the first set that is not empty is of doubles, and lies so far from there that
    /// float would lose more than a millionth of its extent: then it is the middle of that set's box.
    template <class Object>
    gltf_set add(const std::string& name, const Object& object, const gltf_set_options& options = {}) {
        const auto view = detail::gltf_view(object);
        using shape_type = typename decltype(view)::shape_type;
        const auto corner = [&](std::size_t i, std::size_t k) { return detail::gltf_corner(view, i, k); };
        if constexpr (is_motion<shape_type>) {
            const auto at = [&](std::size_t frame, std::size_t i) { return frame == 0 ? view[i].t0 : view[i].t1; };
            return add_drawn(name, view.size(), 2, at, corner, options);
        } else if constexpr (detail::is_sphere<shape_type>) {
            return add_spheres(name, view, options);
        } else {
            const auto at = [&](std::size_t, std::size_t i) { return view[i]; };
            return add_drawn(name, view.size(), 1, at, corner, options);
        }
    }

    /// Adds a mesh that takes several positions in turn, frame after frame in straight lines; each frame has the same faces.
    template <scalar T>
    gltf_set add_frames(const std::string& name, const std::vector<mesh<T>>& frames, const gltf_set_options& options = {}) {
        if (frames.empty()) refuse("add_frames", "expected at least one frame");
        for (const auto& frame : frames) (void)moving(frames.front(), frame);  // throws where they do not go together
        const auto view = frames.front().view();
        const auto at = [&](std::size_t frame, std::size_t i) { return frames[frame].view()[i]; };
        const auto corner = [&](std::size_t i, std::size_t k) { return detail::gltf_corner(view, i, k); };
        return add_drawn(name, view.size(), frames.size(), at, corner, options);
    }

    /// Adds pairs of ids of shapes of two sets, or of one (`b` the same as `a`).
    template <std::ranges::input_range Pairs>
        requires id_pair<std::ranges::range_value_t<Pairs>>
    void add_pairs(gltf_set a, gltf_set b, const Pairs& pairs, const gltf_result_options& options = {}) {
        std::vector<std::uint32_t> of_a, of_b;
        for (const auto& pair : pairs) {
            of_a.push_back(static_cast<std::uint32_t>(pair.a));
            of_b.push_back(static_cast<std::uint32_t>(pair.b));
        }
        if (of_a.empty()) return add_result("pairs", a, b, 0, {}, {}, options);
        add_result("pairs", a, b, of_a.size(),
                   detail::json_object({{"a_ids", add_values(of_a)}, {"b_ids", add_values(of_b)}}), {}, options);
    }

    /// Adds contacts of two sets, or of one: ids, points, normals and depths, and a line for each, from its point along its
    /// normal, a fiftieth of the scene's diagonal long. All are rounded to float, points after the origin is subtracted.
    template <std::ranges::input_range Contacts>
        requires contact_like<std::ranges::range_value_t<Contacts>>
    void add_contacts(gltf_set a, gltf_set b, const Contacts& contacts, const gltf_result_options& options = {}) {
        std::vector<std::uint32_t> of_a, of_b;
        std::vector<float> points, normals, depths, lines;
        const float length = line_length();
        for (const auto& c : contacts) {
            of_a.push_back(static_cast<std::uint32_t>(c.a));
            of_b.push_back(static_cast<std::uint32_t>(c.b));
            const std::array<float, 3> p = rounded(detail::in_double(c.point)), n = in_float(detail::in_double(c.normal));
            points.insert(points.end(), p.begin(), p.end());
            normals.insert(normals.end(), n.begin(), n.end());
            depths.push_back(static_cast<float>(c.depth));
            lines.insert(lines.end(), p.begin(), p.end());
            for (std::size_t k = 0; k < 3; ++k) lines.push_back(p[k] + length * n[k]);
        }
        if (of_a.empty()) return add_result("contacts", a, b, 0, {}, {}, options);
        const std::string node = add_lines(lines);
        add_result("contacts", a, b, of_a.size(),
                   detail::json_object({{"a_ids", add_values(of_a)},
                                        {"b_ids", add_values(of_b)},
                                        {"points", add_values(points, 3)},
                                        {"normals", add_values(normals, 3)},
                                        {"depths", add_values(depths)}}),
                   {member{"node", node}}, options);
    }

    /// Adds impacts of two meshes in motion, or of one. Times are rounded down to float, so that none is later than it was;
    /// of up to 1,000 impacts they are written as they are too, as decimals.
    template <std::ranges::input_range Impacts>
        requires impact_like<std::ranges::range_value_t<Impacts>>
    void add_impacts(gltf_set a, gltf_set b, const Impacts& impacts, const gltf_result_options& options = {}) {
        std::vector<std::uint8_t> kinds;
        std::vector<std::uint32_t> vertices;
        std::vector<float> times;
        std::vector<std::string> exact;
        for (const auto& i : impacts) {
            kinds.push_back(static_cast<std::uint8_t>(i.kind));
            for (std::size_t k = 0; k < 4; ++k) vertices.push_back(static_cast<std::uint32_t>(i.vertices[k]));
            const auto time = static_cast<double>(i.time);
            const auto nearest = static_cast<float>(time);
            times.push_back(static_cast<double>(nearest) <= time ? nearest : std::nextafter(nearest, -1.0f));
            if (exact.size() <= most_exact_times) exact.push_back(detail::json_string(detail::json_number(time)));
        }
        if (kinds.empty()) return add_result("impacts", a, b, 0, {}, {}, options);
        add_result("impacts", a, b, kinds.size(),
                   detail::json_object({{"kinds", add_values(kinds)},
                                        {"vertices", add_values(vertices)},
                                        {"times", add_values(times)}}),
                   {member{"times_exact", exact.size() <= most_exact_times ? detail::json_array(exact) : ""}}, options);
    }

    /// Adds a sentence for the reader of the file, such as what was left out of it.
    void add_note(const std::string& text) { notes_.push_back(detail::json_string(text)); }

    /// What is subtracted from all coordinates before they are rounded to float; the file puts it back by a node.
    [[nodiscard]] vec3<double> origin() const { return origin_; }

    /// Hands the bytes of the file to `to.write(pointer, size)`; throws io_error of `file` where the format cannot hold them.
    template <class Output>
    void write(Output& to, const std::string& file) const {
        const bool is_shifted = origin_.x != 0 || origin_.y != 0 || origin_.z != 0;
        const std::string origin = is_shifted ? json_point(in_float(origin_)) : "";
        const std::string ours = detail::json_object({{"version", "1"},
                                                      {"origin", origin},
                                                      {"sets", detail::json_array(sets_)},
                                                      {"results", detail::json_array(results_)},
                                                      {"notes", notes_.empty() ? "" : detail::json_array(notes_)}});
        const std::string animation =
            channels_.empty() ? "" : detail::json_object({{"name", "\"step\""},
                                                          {"samplers", detail::json_array(samplers_)},
                                                          {"channels", detail::json_array(channels_)}});
        document_.write(to, file, {.roots = roots_,
                                   .translation = origin,
                                   .animation = animation,
                                   .extras = detail::json_object({{"abut", ours}}),
                                   .extensions = extensions_});
    }

private:
    using member = std::pair<std::string_view, std::string>;
    static constexpr float infinity = std::numeric_limits<float>::infinity();
    static constexpr std::size_t most_exact_times = 1000, most_nodes = 256, most_fine_balls = 1000;

    [[noreturn]] static void refuse(const std::string& function, const std::string& what) {
        throw error("abut::io::gltf_scene::" + function + ": " + what);
    }
    static std::array<float, 3> in_float(const vec3<double>& p) {
        return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    }
    /// A point as the file has it.
    [[nodiscard]] std::array<float, 3> rounded(const vec3<double>& p) const {
        const std::array<float, 3> q = in_float(p - origin_);
        if (!std::isfinite(q[0]) || !std::isfinite(q[1]) || !std::isfinite(q[2])) {
            refuse("add", "expected coordinates that float can hold, found " + abut::detail::shortest(p.x) + ", " +
                              abut::detail::shortest(p.y) + ", " + abut::detail::shortest(p.z));
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

    static void check_options(std::size_t shapes, const gltf_set_options& options) {
        const auto check = [&](const char* what, std::size_t found) {
            if (found == 0 || found == shapes) return;
            refuse("add", "expected " + std::to_string(shapes) + " values of '" + what + "', one for each shape, found " +
                              std::to_string(found));
        };
        check("hit", options.hit.size());
        check("ids", options.ids.size());
    }
    static std::uint32_t id_of(const gltf_set_options& options, std::size_t i) {
        return options.ids.empty() ? static_cast<std::uint32_t>(i) : options.ids[i];
    }
    static void push_id(std::vector<std::uint16_t>& to, std::uint32_t id) {
        to.insert(to.end(), {static_cast<std::uint16_t>(id & 0xffff), static_cast<std::uint16_t>(id >> 16)});
    }

    template <class V>
    std::string add_values(const std::vector<V>& values, std::size_t components = 1) {
        return detail::json_number(document_.add(values, components));
    }
    template <class V>
    std::string add_attribute(const std::vector<V>& values, std::size_t components, bool is_normalised = false) {
        return detail::json_number(document_.add(values, components, {.is_attribute = true, .is_normalised = is_normalised}));
    }
    std::string add_positions(const std::vector<float>& values) {
        return detail::json_number(document_.add(values, 3, {.is_attribute = true, .has_bounds = true}));
    }

    /// A material that takes its colour from the vertices, or has this one.
    std::size_t material_of(const detail::colour& c) {
        const auto [place, is_new] = materials_.try_emplace(c);
        if (is_new) {
            std::vector<std::string> factors;
            for (const int part : c) factors.push_back(detail::json_number(part / 255.0));
            place->second = document_.add_material(detail::json_object(
                {{"doubleSided", "true"},
                 {"pbrMetallicRoughness", detail::json_object({{"baseColorFactor", detail::json_array(factors)},
                                                               {"metallicFactor", "0"},
                                                               {"roughnessFactor", "0.8"}})}}));
        }
        return place->second;
    }
    static constexpr detail::colour white{255, 255, 255, 255};

    /// A set that is drawn by points of its own: at(frame, i) is shape i in a frame, corner(i, k) the vertex at its corner k.
    template <class At, class Corner>
    gltf_set add_drawn(const std::string& name, std::size_t count, std::size_t frames, const At& at, const Corner& corner,
                       const gltf_set_options& options) {
        using shape_type = std::remove_cvref_t<decltype(at(0, 0))>;
        using kind = detail::gltf_kind<shape_type>;
        constexpr std::size_t corners = std::tuple_size_v<decltype(detail::gltf_points(at(0, 0)))>;
        check_options(count, options);
        settle_origin<scalar_type_of<shape_type>>(count * corners, [&](std::size_t i) {
            return detail::in_double(detail::gltf_points(at(0, i / corners))[i % corners]);
        });
        if (count == 0) return add_set(name, kind::name, document_.add_node(detail::json_object({{"name", detail::json_string(name)}})), 0, options, {});

        std::vector<float> positions, normals;
        std::vector<std::uint8_t> colours;
        std::vector<std::uint16_t> ids, vertices;
        const detail::colour plain = detail::plain_colour(sets_.size()), marked = detail::hit_colour();
        for (std::size_t i = 0; i < count; ++i) {
            const auto points = detail::gltf_points(at(0, i));
            const bool is_hit = !options.hit.empty() && options.hit[i] != 0;
            std::array<float, 3> normal{};
            for (std::size_t k = 0; k < corners; ++k) {
                const std::array<float, 3> p = rounded(detail::in_double(points[k]));
                grow(p);
                positions.insert(positions.end(), p.begin(), p.end());
                colours.insert(colours.end(), (is_hit ? marked : plain).begin(), (is_hit ? marked : plain).end());
                push_id(ids, id_of(options, i));
                if constexpr (kind::mode == 4) {
                    if (k % 3 == 0) {
                        normal = detail::flat_normal(detail::in_double(points[k]), detail::in_double(points[k + 1]),
                                                     detail::in_double(points[k + 2]));
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
                const auto from = detail::gltf_points(at(0, i)), to = detail::gltf_points(at(frame, i));
                for (std::size_t k = 0; k < corners; ++k) {
                    grow(rounded(detail::in_double(to[k])));
                    const auto way = in_float(detail::in_double(to[k]) - detail::in_double(from[k]));
                    moved.insert(moved.end(), way.begin(), way.end());
                }
            }
            targets.push_back(detail::json_object({{"POSITION", add_positions(moved)}}));
        }
        const std::string attributes = detail::json_object(
            {{"POSITION", add_positions(positions)},
             {"NORMAL", normals.empty() ? "" : add_attribute(normals, 3)},
             {"COLOR_0", add_attribute(colours, 4, true)},
             {"_ID", add_attribute(ids, 2)},
             {"_CORNER", vertices.empty() ? "" : add_attribute(vertices, 2)}});
        const std::size_t node = add_mesh_node(name, kind::mode, attributes, targets);
        if (frames > 1) add_motion(node, frames);
        return add_set(name, kind::name, node, count, options, {member{"moves", frames > 1 ? "true" : "false"},
                                                                member{"frames", frames > 1 ? detail::json_number(frames) : ""}});
    }

    std::size_t add_mesh_node(const std::string& name, int mode, const std::string& attributes,
                              const std::vector<std::string>& targets) {
        const std::vector<std::string> weights(targets.size(), "0");
        const std::string primitive = detail::json_object({{"attributes", attributes},
                                                           {"mode", detail::json_number(mode)},
                                                           {"material", detail::json_number(material_of(white))},
                                                           {"targets", targets.empty() ? "" : detail::json_array(targets)}});
        const std::size_t mesh = document_.add_mesh(
            detail::json_object({{"name", detail::json_string(name)},
                                 {"primitives", detail::json_list(primitive)},
                                 {"weights", targets.empty() ? "" : detail::json_array(weights)}}));
        return document_.add_node(
            detail::json_object({{"name", detail::json_string(name)}, {"mesh", detail::json_number(mesh)}}));
    }

    /// Frame k is at k seconds, where target k - 1 has the weight 1 and the others 0.
    void add_motion(std::size_t node, std::size_t frames) {
        std::vector<float> times, weights;
        for (std::size_t k = 0; k < frames; ++k) {
            times.push_back(static_cast<float>(k));
            for (std::size_t target = 1; target < frames; ++target) weights.push_back(target == k ? 1.0f : 0.0f);
        }
        const std::string input = detail::json_number(document_.add(times, 1, {.has_bounds = true}));
        samplers_.push_back(detail::json_object(
            {{"input", input}, {"output", add_values(weights)}, {"interpolation", "\"LINEAR\""}}));
        channels_.push_back(detail::json_object(
            {{"sampler", detail::json_number(samplers_.size() - 1)},
             {"target", detail::json_object({{"node", detail::json_number(node)}, {"path", "\"weights\""}})}}));
    }

    /// Spheres are nodes of their own, or instances of one ball where they are many.
    template <class V>
    gltf_set add_spheres(const std::string& name, const V& view, const gltf_set_options& options) {
        const std::size_t count = view.size();
        check_options(count, options);
        settle_origin<typename V::scalar_type>(2 * count, [&](std::size_t i) {
            const auto box = bounds(view[i / 2]);
            return detail::in_double(i % 2 == 0 ? box.lower : box.upper);
        });
        std::vector<float> centers, scales;
        std::vector<std::uint8_t> colours;
        std::vector<std::uint16_t> ids;
        const detail::colour plain = detail::plain_colour(sets_.size()), marked = detail::hit_colour();
        std::vector<std::string> children;
        for (std::size_t i = 0; i < count; ++i) {
            const auto sphere = view[i];
            const auto radius = static_cast<double>(sphere.radius);
            const auto center = rounded(detail::in_double(sphere.center));
            for (const double r : {-radius, radius}) grow(rounded(detail::in_double(sphere.center) + vec3<double>{r, r, r}));
            const detail::colour& c = !options.hit.empty() && options.hit[i] != 0 ? marked : plain;
            if (count <= most_nodes) {
                const std::string scale = detail::json_number(static_cast<float>(radius));
                children.push_back(detail::json_number(document_.add_node(detail::json_object(
                    {{"name", detail::json_string(name + ' ' + std::to_string(id_of(options, i)))},
                     {"mesh", detail::json_number(ball_of(c, 2))},
                     {"translation", json_point(center)},
                     {"scale", detail::json_list(scale, scale, scale)}}))));
                continue;
            }
            centers.insert(centers.end(), center.begin(), center.end());
            scales.insert(scales.end(), 3, static_cast<float>(radius));
            colours.insert(colours.end(), c.begin(), c.end());
            push_id(ids, id_of(options, i));
        }
        std::string mesh, extensions;
        if (count > most_nodes) {
            extensions_ = {"\"EXT_mesh_gpu_instancing\""};
            mesh = detail::json_number(ball_of(options.hit.empty() ? plain : white, count <= most_fine_balls ? 2 : 1));
            const std::string attributes = detail::json_object({{"TRANSLATION", add_values(centers, 3)},
                                                                {"SCALE", add_values(scales, 3)},
                                                                {"_ID", add_values(ids, 2)},
                                                                {"_COLOR_0", options.hit.empty() ? "" : add_colours(colours)}});
            extensions = detail::json_object(
                {{"EXT_mesh_gpu_instancing", detail::json_object({{"attributes", attributes}})}});
        }
        const std::size_t node = document_.add_node(
            detail::json_object({{"name", detail::json_string(name)},
                                 {"mesh", mesh},
                                 {"children", children.empty() ? "" : detail::json_array(children)},
                                 {"extensions", extensions}}));
        return add_set(name, "spheres", node, count, options,
                       {member{"moves", "false"}, member{"as", count > most_nodes ? "\"instances\"" : "\"nodes\""}});
    }
    std::string add_colours(const std::vector<std::uint8_t>& colours) {
        return detail::json_number(document_.add(colours, 4, {.is_normalised = true}));
    }

    /// A mesh of one ball in this colour.
    std::size_t ball_of(const detail::colour& c, int divisions) {
        const auto [place, is_new] = balls_.try_emplace({c, divisions});
        if (!is_new) return place->second;
        const auto [arrays, are_new] = ball_arrays_.try_emplace(divisions);
        if (are_new) {
            const detail::ball_mesh ball(divisions);
            arrays->second = {add_positions(ball.positions), add_attribute(ball.positions, 3),
                              detail::json_number(document_.add(ball.corners, 1, {.is_indices = true}))};
        }
        const auto& [positions, normals, corners] = arrays->second;
        const std::string primitive = detail::json_object(
            {{"attributes", detail::json_object({{"POSITION", positions}, {"NORMAL", normals}})},
             {"indices", corners},
             {"mode", "4"},
             {"material", detail::json_number(material_of(c))}});
        return place->second = document_.add_mesh(
                   detail::json_object({{"name", "\"ball\""}, {"primitives", detail::json_list(primitive)}}));
    }

    static std::string json_point(const std::array<float, 3>& p) {
        return detail::json_list(detail::json_number(p[0]), detail::json_number(p[1]), detail::json_number(p[2]));
    }

    gltf_set add_set(const std::string& name, const char* kind, std::size_t node, std::size_t count,
                     const gltf_set_options& options, const std::array<member, 2>& more) {
        const bool is_part = !options.ids.empty() && count > 0;
        std::vector<std::uint8_t> hit(options.hit.begin(), options.hit.end());
        for (std::uint8_t& h : hit) h = h != 0 ? 1 : 0;
        roots_.push_back(detail::json_number(node));
        sets_.push_back(detail::json_object(
            {{"name", detail::json_string(name)},
             {"kind", detail::json_string(kind)},
             {"node", detail::json_number(node)},
             {"count", detail::json_number(count)},
             {"hit", hit.empty() ? "" : add_values(hit)},
             {"ids", is_part ? add_values(std::vector<std::uint32_t>(options.ids.begin(), options.ids.end())) : ""},
             {"of", options.of > 0 ? detail::json_number(options.of) : ""},
             more[0],
             more[1]}));
        return {sets_.size() - 1};
    }

    void add_result(const char* kind, gltf_set a, gltf_set b, std::size_t count, const std::string& accessors,
                    const std::array<member, 2>& more, const gltf_result_options& options) {
        for (const gltf_set set : {a, b}) {
            if (set.number < sets_.size()) continue;
            refuse(std::string("add_") + kind, "expected a set of this scene, which has " + std::to_string(sets_.size()) +
                                                   ", found number " + std::to_string(set.number));
        }
        results_.push_back(
            detail::json_object({{"kind", detail::json_string(kind)},
                                 {"a", detail::json_number(a.number)},
                                 {"b", detail::json_number(b.number)},
                                 {"count", detail::json_number(count)},
                                 {"of", options.of > 0 ? detail::json_number(options.of) : ""},
                                 {"step", options.step > 0 ? detail::json_number(options.step) : ""},
                                 {"accessors", accessors.empty() ? "{}" : accessors},
                                 more[0],
                                 more[1]}));
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
    std::string add_lines(const std::vector<float>& positions) {
        std::vector<std::uint8_t> colours;
        std::vector<std::uint16_t> ids;
        const detail::colour c = detail::linear_colour(200, 30, 60);
        for (std::size_t i = 0; i < positions.size() / 3; ++i) {
            push_id(ids, static_cast<std::uint32_t>(i / 2));
            colours.insert(colours.end(), c.begin(), c.end());
        }
        const std::string attributes = detail::json_object({{"POSITION", add_positions(positions)},
                                                            {"COLOR_0", add_attribute(colours, 4, true)},
                                                            {"_ID", add_attribute(ids, 2)}});
        roots_.push_back(detail::json_number(add_mesh_node("contacts", 1, attributes, {})));
        return roots_.back();
    }

    detail::gltf_document document_;
    std::vector<std::string> sets_, results_, notes_, roots_, samplers_, channels_, extensions_;
    std::map<detail::colour, std::size_t> materials_;
    std::map<std::pair<detail::colour, int>, std::size_t> balls_;
    std::map<int, std::array<std::string, 3>> ball_arrays_;  // positions, normals and corners, by their divisions
    vec3<double> origin_{0, 0, 0};
    bool has_origin_ = false;
    std::array<float, 3> lower_{infinity, infinity, infinity}, upper_{-infinity, -infinity, -infinity};
};

/// Writes a scene as binary glTF 2.0. An existing file is replaced. Throws io_error if the file cannot be written in full (what
/// is there of it then is not removed), or would be larger than 4 GiB.
///
///     abut::io::gltf_scene scene;
///     const auto a = scene.add("part", mesh, {.hit = hit}), b = scene.add("grains", spheres);
///     scene.add_contacts(a, b, contacts);
///     abut::io::write_gltf("scene.glb", scene);
inline void write_gltf(const std::filesystem::path& path, const gltf_scene& scene) {
    detail::output_file file(path);
    scene.write(file, path.string());
    file.close();
}

///@}

}  // namespace abut::io
