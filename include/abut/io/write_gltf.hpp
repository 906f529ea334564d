// SPDX-License-Identifier: MIT
#pragma once

// Scenes as binary glTF 2.0: sets, what touches, and motions, for programs that show them. What the format has no words for,
// such as pairs of ids, stands in the file's extras. Layout: docs/reference/formats.md.

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/io/curve_lines.hpp>
#include <abut/io/file.hpp>
#include <abut/io/gltf_canvas.hpp>
#include <abut/io/gltf_drawing.hpp>
#include <abut/io/json_text.hpp>
#include <abut/io/property.hpp>
#include <abut/shape/motion.hpp>
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

/// A hit of a sweep: `abut::sweep_hit`, or any type with its members.
template <class H>
concept sweep_hit_like = requires(const H& h) {
    { h.id } -> std::convertible_to<std::uint32_t>;
    { h.t } -> std::convertible_to<double>;
    { h.point.x } -> std::convertible_to<double>;
    { h.normal.x } -> std::convertible_to<double>;
};

/// A patch: `abut::contact_patch`, or any type with its members.
template <class P>
concept patch_like = requires(const P& p, std::size_t i) {
    requires curve_like<std::remove_cvref_t<decltype(p.curves[i])>>;
    { p.points[i].point.x } -> std::convertible_to<double>;
    { p.center.x } -> std::convertible_to<double>;
    { p.area } -> std::convertible_to<double>;
    { p.depth } -> std::convertible_to<double>;
};

/// An impact: `abut::impact`, or any type with its members.
template <class I>
concept impact_like = requires(const I& i) {
    { i.time } -> std::convertible_to<double>;
    { i.vertices[3] } -> std::convertible_to<std::uint32_t>;
    static_cast<unsigned char>(i.kind);
};

namespace detail {

/// Results that have a place each: ids, points, normals, one number, and a line along the normal.
class gltf_rows {
public:
    explicit gltf_rows(const gltf_canvas& canvas) : canvas_(canvas), length_(canvas.line_length()) {}
    template <class A, class B, class P, class N>
    void add(A a, B b, const vec3<P>& point, const vec3<P>& normal, N number) {
        of_a.push_back(static_cast<std::uint32_t>(a));
        of_b.push_back(static_cast<std::uint32_t>(b));
        const std::array<float, 3> p = canvas_.rounded(in_double(point)),
                                   n = canvas_.in_float(in_double(normal));
        points.insert(points.end(), p.begin(), p.end());
        normals.insert(normals.end(), n.begin(), n.end());
        numbers.push_back(static_cast<float>(number));
        lines.insert(lines.end(), p.begin(), p.end());
        for (std::size_t k = 0; k < 3; ++k) lines.push_back(p[k] + length_ * n[k]);
    }
    std::vector<std::uint32_t> of_a, of_b;
    std::vector<float> points, normals, numbers, lines;

private:
    const gltf_canvas& canvas_;
    float length_;
};

}  // namespace detail

/// A scene that is being put together: sets, and what touches among them. `write_gltf` writes it.
///
/// @par Memory
/// What is added is copied, in the form of the file: 133 bytes a triangle, 36 more for each further frame of a motion, 1.3
/// kB a box, 48 bytes a segment, 24 a point, 37 a sphere (some 200 bytes of text where they are 256 or fewer), 84 a contact, 54
/// kB a shape that sweeps, 2 kB a patch.
/// A file of binary glTF holds 4 GiB.
///
/// @par Errors
/// - `error`: a coordinate is too large for a float, an option has not one value for each shape, frames do not go together,
/// or
///   a set is of another scene.
/// - `invalid_geometry`: a view that is added is no geometry, or a pose is none.
/// - `std::bad_alloc`.
///
/// @par Synchronisation
/// All calls run on the calling thread and return when they are done. One thread at a time may add to a scene; several may
/// write it.
///
/// @par Example
/// @snippet files.cpp scene
class gltf_scene {
public:
    /// Adds a set: triangles (mesh, triangle_soup), spheres, segments (edge_mesh, segments), points or boxes; or a view of
    /// one in host memory; or one that is posed, which is written where `place` puts it, in the world; or a mesh or soup in
    /// motion, whose two frames are written; or a single shape. Coordinates are rounded to float: those of a set of doubles
    /// after the scene's origin is subtracted. Spheres are drawn as polyhedra.
    ///
    /// The origin is that of the world, unless the first set that is not empty is of doubles, and lies so far from there
    /// that float would lose more than a millionth of its extent: then it is the middle of that set's box.
    template <class Object>
    gltf_set add(const std::string& name, const Object& object, const gltf_set_options& options = {}) {
        const auto view = detail::gltf_view(object);
        using shape_type = typename decltype(view)::shape_type;
        const auto corner = [&](std::size_t i, std::size_t k) { return detail::gltf_corner(view, i, k); };
        if constexpr (is_motion<shape_type>) {
            const auto at = [&](std::size_t frame, std::size_t i) { return frame == 0 ? view[i].t0 : view[i].t1; };
            return add_drawn(name, view.size(), 2, at, corner, options);
        } else if constexpr (detail::is_sphere<shape_type>) {
            const std::size_t node = canvas_.add_spheres(name, view, marks_of(view.size(), options));
            const bool are_instances = view.size() > detail::gltf_canvas::most_nodes;
            return add_set(name, "spheres", node, view.size(), options,
                           {member{"moves", "false"}, member{"as", are_instances ? "\"instances\"" : "\"nodes\""}});
        } else {
            const auto at = [&](std::size_t, std::size_t i) { return view[i]; };
            return add_drawn(name, view.size(), 1, at, corner, options);
        }
    }

    /// Adds a mesh that takes several positions in turn, frame after frame in straight lines; each frame has the same faces.
    template <scalar T>
    gltf_set add_frames(const std::string& name, const std::vector<mesh<T>>& frames, const gltf_set_options& options = {}) {
        if (frames.empty()) detail::refuse_scene("add_frames", "expected at least one frame");
        for (const auto& frame : frames) (void)moving(frames.front(), frame);  // throws where they do not go together
        const auto view = frames.front().view();
        const auto at = [&](std::size_t frame, std::size_t i) { return frames[frame].view()[i]; };
        const auto corner = [&](std::size_t i, std::size_t k) { return detail::gltf_corner(view, i, k); };
        return add_drawn(name, view.size(), frames.size(), at, corner, options);
    }

    /// Adds curves, as `curves` makes them, as a set of segments, all of them `hit`.
    template <std::ranges::input_range Curves>
        requires curve_like<std::ranges::range_value_t<Curves>>
    gltf_set add_curves(const std::string& name, const Curves& curves) {
        const auto lines = detail::lines_of(curves);
        const std::vector<std::uint8_t> all(lines.segments.size(), 1);
        const gltf_set set = add(name, shapes(lines.segments), {.hit = all});
        say_of_last({{"role", "\"curves\""}});
        return set;
    }

    /// Adds patches, as `contact_patches` makes them: for each its corners as a surface in its plane, with its area and depth; and
    /// as a set of segments of its own, `name` with ": borders" behind, the curves of all. Returns the set of surfaces, all `hit`.
    template <std::ranges::input_range Patches>
        requires patch_like<std::ranges::range_value_t<Patches>>
    gltf_set add_patches(const std::string& name, const Patches& patches) {
        std::vector<detail::drawn_surface<42>> surfaces;
        std::vector<float> areas, depths;
        std::vector<std::remove_cvref_t<decltype((*std::ranges::begin(patches)).curves[0])>> borders;
        for (const auto& patch : patches) {
            surfaces.push_back(detail::patch_surface(patch));
            areas.push_back(static_cast<float>(patch.area));
            depths.push_back(static_cast<float>(patch.depth));
            borders.insert(borders.end(), patch.curves.begin(), patch.curves.end());
        }
        const std::vector<std::uint8_t> all(surfaces.size(), 1);
        const gltf_set set = add_surfaces(name, surfaces, surfaces, {.hit = all});
        say_of_last({{"role", "\"patches\""},
                     {"numbers", all.empty() ? ""
                                             : detail::json_object({{"area", add_values(areas)}, {"depth", add_values(depths)}})}});
        add_curves(name + ": borders", borders);
        return set;
    }

    /// Adds what `sweep(policy, touched, shapes, ways)` found: the shapes, which go to where they touch something, or to the end
    /// of their ways, and a page plays that; as segments, `name` with ": ways" behind, their ways, those parts `hit` that
    /// they go; and the hits as results between the shapes, by their rows, and `touched`. Shapes are spheres, capsules, triangles, segments,
    /// points, boxes, oriented boxes or hulls, drawn as 320 triangles each. Throws `error` unless shapes, ways and hits are
    /// equally many.
    template <class Object, class Ways, std::ranges::random_access_range Hits>
        requires sweep_hit_like<std::ranges::range_value_t<Hits>>
    gltf_set add_sweep(const std::string& name, const Object& movers, const Ways& ways, const Hits& hits, gltf_set touched) {
        const auto view = detail::gltf_view(movers);
        const auto way_of = detail::gltf_view(ways);
        const std::size_t count = view.size();
        if (way_of.size() != count || std::ranges::size(hits) != count) {
            detail::refuse_scene("add_sweep", "expected as many ways and hits as shapes, " + std::to_string(count) + ", found " +
                                                  std::to_string(way_of.size()) + " and " + std::to_string(std::ranges::size(hits)));
        }
        const detail::ball_mesh ball(2);
        std::vector<detail::drawn_surface<960>> start, stop;
        std::vector<segment<double>> parts;
        std::vector<std::uint8_t> touches(count), gone;
        for (std::size_t i = 0; i < count; ++i) {
            const auto& hit = hits[i];
            touches[i] = hit.t <= 1 ? 1 : 0;
            const double t = touches[i] != 0 ? static_cast<double>(hit.t) : 1;
            const vec3<double> way = detail::in_double(way_of[i]);
            start.push_back(detail::convex_surface(view[i], ball));
            stop.push_back(start.back());
            for (auto& p : stop.back().points) p = p + t * way;
            const auto box = bounds(view[i]);
            const vec3<double> middle = 0.5 * (detail::in_double(box.lower) + detail::in_double(box.upper));
            parts.push_back({middle, middle + t * way});
            parts.push_back({middle + t * way, middle + way});
            gone.insert(gone.end(), {1, 0});
        }
        const gltf_set set = add_surfaces(name, start, stop, {.hit = touches});
        add(name + ": ways", shapes(parts), {.hit = gone});
        say_of_last({{"role", "\"ways\""}});
        detail::gltf_rows rows(canvas_);
        for (std::size_t i = 0; i < count; ++i) {
            if (touches[i] != 0) rows.add(i, hits[i].id, hits[i].point, hits[i].normal, hits[i].t);
        }
        add_rows("sweeps", "times", set, touched, rows, {});
        return set;
    }

    /// Adds an arrow from a point, as long as a move: the one that `penetration` found, say. It is a set of 24 triangles,
    /// all of them `hit`. The body that moves is added by `moving(body, moved)`, and a page plays its way. Throws `error` where the move is 0 or not finite.
    gltf_set add_move(const std::string& name, const vec3<double>& from, const vec3<double>& by) {
        const double square = dot(by, by);
        if (!(square > 0) || !std::isfinite(square)) {
            detail::refuse_scene("add_move", "expected a move of a length above 0 whose square is finite");
        }
        const auto faces = detail::arrow_faces(from, by);
        const std::vector<std::uint8_t> all(faces.size(), 1);
        const gltf_set set = add(name, shapes(faces), {.hit = all});
        say_of_last({{"role", "\"move\""},
                     {"move", detail::json_list(detail::json_number(by.x), detail::json_number(by.y), detail::json_number(by.z))}});
        return set;
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
        detail::gltf_rows rows(canvas_);
        for (const auto& c : contacts) rows.add(c.a, c.b, c.point, c.normal, c.depth);
        add_rows("contacts", "depths", a, b, rows, options);
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
                   detail::json_object(
                       {{"kinds", add_values(kinds)}, {"vertices", add_values(vertices)}, {"times", add_values(times)}}),
                   {member{"times_exact", exact.size() <= most_exact_times ? detail::json_array(exact) : ""}}, options);
    }

    /// Adds the part of a step that `safe_step` says is free, of two meshes in motion or of one: a page marks it on its clock.
    /// Throws `error` unless it is from 0 to 1.
    void add_safe_step(gltf_set a, gltf_set b, double part, const gltf_result_options& options = {}) {
        if (!(part >= 0) || part > 1) {
            detail::refuse_scene("add_safe_step", "expected a part from 0 to 1, found " + abut::detail::shortest(part));
        }
        add_result("safe_step", a, b, 0, {}, {member{"part", detail::json_number(part)}}, options);
    }

    /// Adds a sentence for the reader of the file, such as what was left out of it.
    void add_note(const std::string& text) { notes_.push_back(detail::json_string(text)); }

    /// What is subtracted from all coordinates before they are rounded to float; the file puts it back by a node.
    [[nodiscard]] vec3<double> origin() const { return canvas_.origin(); }

    /// Hands the bytes of the file to `to.write(pointer, size)`; throws io_error of `file` where the format cannot hold
    /// them.
    template <class Output>
    void write(Output& to, const std::string& file) const {
        canvas_.write(to, file,
                      detail::json_object({{"version", "1"},
                                           {"origin", canvas_.json_origin()},
                                           {"sets", detail::json_array(sets_)},
                                           {"results", detail::json_array(results_)},
                                           {"notes", notes_.empty() ? "" : detail::json_array(notes_)}}));
    }

private:
    using member = std::pair<std::string_view, std::string>;
    static constexpr std::size_t most_exact_times = 1000;

    /// Whether each option has one value for each shape, if any.
    static detail::gltf_marks marks_of(std::size_t shapes, const gltf_set_options& options) {
        const auto check = [&](const char* what, std::size_t found) {
            if (found == 0 || found == shapes) return;
            detail::refuse_scene("add", "expected " + std::to_string(shapes) + " values of '" + what +
                                            "', one for each shape, found " + std::to_string(found));
        };
        check("hit", options.hit.size());
        check("ids", options.ids.size());
        return {options.hit, options.ids};
    }
    template <class At, class Corner>
    gltf_set add_drawn(const std::string& name, std::size_t count, std::size_t frames, const At& at, const Corner& corner,
                       const gltf_set_options& options) {
        using kind = detail::gltf_kind<std::remove_cvref_t<decltype(at(0, 0))>>;
        const std::size_t node = canvas_.add_drawn(name, count, frames, at, corner, marks_of(count, options));
        return add_set(name, kind::name, node, count, options,
                       {member{"moves", frames > 1 ? "true" : "false"},
                        member{"frames", frames > 2 ? detail::json_number(frames) : ""}});
    }
    /// Surfaces, and where they are at the end, if that is elsewhere.
    template <std::size_t N>
    gltf_set add_surfaces(const std::string& name, const std::vector<detail::drawn_surface<N>>& start,
                          const std::vector<detail::drawn_surface<N>>& stop, const gltf_set_options& options) {
        const auto at = [&](std::size_t frame, std::size_t i) { return frame == 0 ? start[i] : stop[i]; };
        const auto no_corner = [](std::size_t, std::size_t) { return 0u; };
        return add_drawn(name, start.size(), &start == &stop ? 1 : 2, at, no_corner, options);
    }
    /// More members of the set that was added last.
    void say_of_last(std::initializer_list<member> members) {
        const std::string more = detail::json_object(members);
        if (more.size() == 2) return;
        sets_.back().back() = ',';
        sets_.back() += more.substr(1);
    }

    void add_rows(const char* kind, const char* number, gltf_set a, gltf_set b, const detail::gltf_rows& rows,
                  const gltf_result_options& options) {
        if (rows.of_a.empty()) return add_result(kind, a, b, 0, {}, {}, options);
        const std::string node = detail::json_number(canvas_.add_lines(rows.lines));
        add_result(kind, a, b, rows.of_a.size(),
                   detail::json_object({{"a_ids", add_values(rows.of_a)},
                                        {"b_ids", add_values(rows.of_b)},
                                        {"points", add_values(rows.points, 3)},
                                        {"normals", add_values(rows.normals, 3)},
                                        {number, add_values(rows.numbers)}}),
                   {member{"node", node}}, options);
    }
    template <class V>
    std::string add_values(const std::vector<V>& values, std::size_t components = 1) {
        return canvas_.add_values(values, components);
    }
    gltf_set add_set(const std::string& name, const char* kind, std::size_t node, std::size_t count,
                     const gltf_set_options& options, const std::array<member, 2>& more) {
        const bool is_part = !options.ids.empty() && count > 0;
        std::vector<std::uint8_t> hit(options.hit.begin(), options.hit.end());
        for (std::uint8_t& h : hit) h = h != 0 ? 1 : 0;
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
            detail::refuse_scene(std::string("add_") + kind, "expected a set of this scene, which has " +
                                                                 std::to_string(sets_.size()) + ", found number " +
                                                                 std::to_string(set.number));
        }
        results_.push_back(detail::json_object({{"kind", detail::json_string(kind)},
                                                {"a", detail::json_number(a.number)},
                                                {"b", detail::json_number(b.number)},
                                                {"count", detail::json_number(count)},
                                                {"of", options.of > 0 ? detail::json_number(options.of) : ""},
                                                {"step", options.step > 0 ? detail::json_number(options.step) : ""},
                                                {"accessors", accessors.empty() ? "{}" : accessors},
                                                more[0],
                                                more[1]}));
    }

    detail::gltf_canvas canvas_;
    std::vector<std::string> sets_, results_, notes_;
};

/// Writes a scene as binary glTF 2.0. An existing file is replaced. Throws io_error if the file cannot be written in full
/// (what is there of it then is not removed), or would be larger than 4 GiB.
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
