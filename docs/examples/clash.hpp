// SPDX-License-Identifier: MIT
#pragma once

// The whole of the program clash but its policies: a scene of parts; which of them overlap, touch, or are closer than they
// may be. It is written once; clash.cpp and clash.cu say what runs it. The calls that matter are in `solve`.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <numeric>
#include <ostream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <abut/abut.hpp>
#include <abut/io/error.hpp>
#include <abut/io/read_parts.hpp>

#include "program.hpp"
#include "scene.hpp"
#include "view.hpp"

namespace clash {

struct settings : example::common_settings {
    std::vector<std::string> files;
    double within = 0, weld = 0;
    std::uint32_t generate = 0;
    bool touches = true;
    std::string out = "clash";
};

// --- the scene ---------------------------------------------------------------------------------------------------------

template <abut::scalar T>
struct part {
    std::string name;
    std::size_t mesh = 0;
    abut::rigid<T> pose{};
};
template <abut::scalar T>
struct input {
    std::vector<abut::mesh<T>> meshes;
    std::vector<part<T>> parts;
};

template <abut::scalar T>
abut::mesh<T> box(const abut::vec3<T>& l, const abut::vec3<T>& u) {
    return {{{l.x, l.y, l.z}, {u.x, l.y, l.z}, {u.x, u.y, l.z}, {l.x, u.y, l.z},
             {l.x, l.y, u.z}, {u.x, l.y, u.z}, {u.x, u.y, u.z}, {l.x, u.y, u.z}},
            {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
             {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}}};
}

/// A wall of a length of 3 on a slab; three walls that go on from it at 2.95 (a clash), 3 (none) and 3.0625 (a gap); and a
/// pipe within the first one.
template <abut::scalar T>
input<T> walls() {
    input<T> in;
    const auto add = [&](const char* name, const abut::vec3<T>& l, const abut::vec3<T>& u) {
        in.parts.push_back({name, in.meshes.size(), {}});
        in.meshes.push_back(box<T>(l, u));
    };
    add("slab", {-1, -1, -1}, {7, 7, 0});
    for (int k = 0; k < 3; ++k) {
        const T y = static_cast<T>(2 * k), from = std::array<T, 3>{static_cast<T>(2.95), 3, static_cast<T>(3.0625)}[static_cast<std::size_t>(k)];
        add(("wall " + std::to_string(k)).c_str(), {0, y, 0}, {3, y + 1, 3});
        add(("wall " + std::to_string(k) + ", next").c_str(), {from, y, 0}, {5, y + 1, 3});
    }
    add("pipe", {1, T(0.25), 1}, {2, T(0.5), T(1.25)});
    return in;
}

/// So many rings of 1,024 triangles on a lattice on which they just touch, each moved by up to a twentieth of its tube.
template <abut::scalar T>
input<T> rings(std::uint32_t count) {
    input<T> in;
    const auto ring = scene::torus<T>(32, 16);
    in.meshes.push_back({ring.vertices, ring.faces});
    const auto side = static_cast<std::uint32_t>(std::ceil(std::cbrt(static_cast<double>(count))));
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto at = [&](std::uint32_t place, double width, std::uint64_t k) {
            return static_cast<T>(place * width + 4 * scene::uniform(scene::seed, 3 * std::uint64_t{i} + k) - 2);
        };
        abut::rigid<T> pose;
        pose.translation = {at(i % side, 280, 0), at(i / side % side, 280, 1), at(i / side / side, 80, 2)};
        in.parts.push_back({"ring " + std::to_string(i), 0, pose});
    }
    return in;
}

template <abut::scalar T>
input<T> make_input(const settings& s) {
    if (s.files.empty()) return s.generate > 0 ? rings<T>(s.generate) : walls<T>();
    input<T> in;
    for (const std::string& file : s.files) {
        auto read = abut::io::read_parts<T>(file);
        const std::size_t first = in.meshes.size();
        for (const auto& mesh : read.meshes) in.meshes.push_back({mesh.vertices, mesh.faces});
        for (auto& p : read.parts) in.parts.push_back({std::move(p.name), first + p.mesh, p.pose});
    }
    for (std::size_t i = 0; i < in.parts.size(); ++i) {
        if (in.parts[i].name.empty()) in.parts[i].name = "part " + std::to_string(i);
    }
    return in;
}

// --- the queries -------------------------------------------------------------------------------------------------------

/// In the order in which they matter.
enum class kind { overlap, surfaces, touch, near };
inline const char* name_of(kind k) {
    constexpr std::array<const char*, 4> names{"overlap", "surfaces", "touch", "near"};
    return names[static_cast<std::size_t>(k)];
}
inline const char* name_of(abut::solid_relation r) {
    using enum abut::solid_relation;
    switch (r) {
        case externally_connected: return "externally connected";
        case partially_overlapping: return "partially overlapping";
        case equal: return "equal";
        case tangential_part: return "tangential part";
        case nontangential_part: return "nontangential part";
        case tangential_part_inverse: return "tangential part, inverse";
        case nontangential_part_inverse: return "nontangential part, inverse";
        default: return "disconnected";
    }
}

/// Two parts, the lower number first.
struct clash {
    std::uint32_t a, b;
    kind what;
    abut::solid_relation relation = abut::solid_relation::disconnected;  // of two solids
    double distance = 0;
    std::uint32_t group = 0;
};
struct outcome {
    std::vector<clash> clashes;          // by kind, then a, then b
    std::vector<std::string> no_solids;  // of each mesh: why it is none; empty if it is one
};

/// Why a mesh does not bound a solid; empty if it does.
template <class Policy, class Tree, class Mesh>
std::string why_no_solid(const Policy& on, const Tree& tree, const Mesh& mesh) {
    const abut::mesh_report r = abut::validate(on, mesh);
    if (!r.boundary_edges.empty()) return std::to_string(r.boundary_edges.size()) + " open edges";
    if (!r.nonmanifold_edges.empty()) return std::to_string(r.nonmanifold_edges.size()) + " edges of more than two faces";
    if (!r.inconsistent_edges.empty()) return std::to_string(r.inconsistent_edges.size()) + " edges with inconsistent sides";
    if (!r.zero_area_faces.empty()) return std::to_string(r.zero_area_faces.size()) + " faces without area";
    if (const auto n = abut::count_self_pairs(on, tree); n > 0) return std::to_string(n) + " pairs of faces that touch without an edge";
    return "";
}

/// The heart of it: a tree for each mesh, the parts as bodies, and one call for each kind of clash. Parts that bound no solid
/// have no interior: all that can be said of them is that surfaces meet.
template <class Policy, abut::scalar T>
outcome solve(const Policy& on, const input<T>& in, const settings& s, example::stopwatch& watch) {
    outcome found;
    using tree = decltype(abut::make_bvh(on, abut::copy_to(on, in.meshes.front())));
    std::vector<tree> trees;
    watch.time("trees", [&] {
        for (const auto& m : in.meshes) {
            const auto mesh = abut::copy_to(on, m);
            const auto joined = s.weld > 0 ? abut::welded(on, mesh, s.weld, {.drop_collapsed = true, .drop_duplicates = true}).mesh
                                           : abut::welded(on, mesh);
            trees.push_back(abut::make_bvh(on, joined));
            found.no_solids.push_back(why_no_solid(on, trees.back(), joined));
        }
    });
    std::vector<abut::posed_object<tree>> solids, surfaces, all;
    std::vector<std::uint32_t> of_solid, of_surface;
    for (std::uint32_t i = 0; i < in.parts.size(); ++i) {
        const part<T>& p = in.parts[i];
        const bool is_solid = found.no_solids[p.mesh].empty();
        all.push_back(abut::posed(trees[p.mesh], p.pose));
        (is_solid ? solids : surfaces).push_back(all.back());
        (is_solid ? of_solid : of_surface).push_back(i);
    }

    const auto add = [&](std::uint32_t a, std::uint32_t b, kind what, abut::solid_relation relation) {
        if (a > b) std::swap(a, b);
        found.clashes.push_back({a, b, what, relation});
    };
    watch.time("relation", [&] {
        const auto bodies = abut::make_bodies(on, solids);
        for (const auto& r : abut::relation(on, bodies, {.known_solid = true})) {
            const bool touch = r.relation == abut::solid_relation::externally_connected;
            add(of_solid[r.body_a], of_solid[r.body_b], touch ? kind::touch : kind::overlap, r.relation);
        }
    });
    if (!surfaces.empty()) {
        watch.time("surfaces", [&] {
            const auto a = abut::make_bodies(on, solids), b = abut::make_bodies(on, surfaces);
            const auto none = abut::solid_relation::disconnected;
            for (const auto& p : abut::to_host(abut::touching_bodies(on, abut::between(a, b)))) {
                add(of_solid[p.a], of_surface[p.b], kind::surfaces, none);
            }
            for (const auto& p : abut::to_host(abut::touching_bodies(on, b))) {
                add(of_surface[p.a], of_surface[p.b], kind::surfaces, none);
            }
        });
    }
    if (s.within > 0) {
        watch.time("within", [&] {
            std::vector<abut::index_pair> known, near;
            for (const clash& c : found.clashes) known.push_back({c.a, c.b});
            std::sort(known.begin(), known.end());
            const auto bodies = abut::make_bodies(on, all);
            for (const auto& p : abut::to_host(abut::bodies_within(on, bodies, s.within))) {
                if (!std::binary_search(known.begin(), known.end(), abut::index_pair{p.a, p.b})) near.push_back({p.a, p.b});
            }
            std::vector<abut::posed_pair<tree>> list;
            for (const auto& p : near) list.push_back({all[p.a], all[p.b]});
            const auto distances = abut::to_host(abut::distance(on, list));
            for (std::size_t i = 0; i < near.size(); ++i) {
                add(near[i].a, near[i].b, kind::near, abut::solid_relation::disconnected);
                found.clashes.back().distance = static_cast<double>(distances[i].distance);
            }
        });
    }
    return found;
}

/// What touches may be left out; the rest is sorted, and clashes of one kind that share a part are a group.
inline void put_in_order(outcome& found, const settings& s, std::size_t parts) {
    auto& all = found.clashes;
    if (!s.touches) std::erase_if(all, [](const clash& c) { return c.what == kind::touch; });
    std::sort(all.begin(), all.end(), [](const clash& x, const clash& y) {
        return std::tie(x.what, x.a, x.b) < std::tie(y.what, y.a, y.b);
    });
    std::vector<std::uint32_t> above(parts);
    const auto top = [&](std::uint32_t i) {
        while (above[i] != i) i = above[i] = above[above[i]];
        return i;
    };
    std::uint32_t groups = 0;
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
        std::iota(above.begin(), above.end(), 0u);
        for (end = begin; end < all.size() && all[end].what == all[begin].what; ++end) {
            const std::uint32_t a = top(all[end].a), b = top(all[end].b);
            above[std::max(a, b)] = std::min(a, b);
        }
        std::map<std::uint32_t, std::uint32_t> numbers;  // in the order in which groups come first
        for (std::size_t i = begin; i < end; ++i) {
            const auto [place, is_new] = numbers.try_emplace(top(all[i].a), groups);
            groups += is_new ? 1 : 0;
            all[i].group = place->second;
        }
    }
}

// --- what comes out ----------------------------------------------------------------------------------------------------

/// The box of a part where it is.
template <abut::scalar T>
abut::aabb<double> box_of(const input<T>& in, std::uint32_t i) {
    const part<T>& p = in.parts[i];
    const auto view = in.meshes[p.mesh].view();
    abut::aabb<double> b{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
    for (std::size_t v = 0; v < view.vertices.count; ++v) {
        const abut::vec3<T> at = place(p.pose, view.vertices[v]);
        const abut::vec3<double> q{static_cast<double>(at.x), static_cast<double>(at.y), static_cast<double>(at.z)};
        b = abut::merge(b, abut::aabb<double>{q, q});
    }
    return b;
}

/// Where to look for a clash: the middle of what both boxes have in common, or of what is between them; and how large it is.
struct viewpoint {
    abut::vec3<double> at;
    double size;
};
inline viewpoint between(const abut::aabb<double>& a, const abut::aabb<double>& b) {
    const auto middle = [](double la, double ua, double lb, double ub) { return 0.5 * (std::max(la, lb) + std::min(ua, ub)); };
    const auto wide = [](double la, double ua, double lb, double ub) { return std::fabs(std::max(la, lb) - std::min(ua, ub)); };
    return {{middle(a.lower.x, a.upper.x, b.lower.x, b.upper.x), middle(a.lower.y, a.upper.y, b.lower.y, b.upper.y),
             middle(a.lower.z, a.upper.z, b.lower.z, b.upper.z)},
            std::hypot(wide(a.lower.x, a.upper.x, b.lower.x, b.upper.x), wide(a.lower.y, a.upper.y, b.lower.y, b.upper.y),
                       wide(a.lower.z, a.upper.z, b.lower.z, b.upper.z))};
}

inline std::string quoted(const std::string& text, bool is_json) {
    std::string r = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (is_json && byte < 0x20) {
            std::array<char, 8> code;
            std::snprintf(code.data(), code.size(), "\\u%04x", byte);
            r += code.data();
            continue;
        }
        if (c == '"' || (is_json && c == '\\')) r += is_json ? '\\' : '"';
        r += c;
    }
    return r + '"';
}

/// Calls write(stream) for a file, and looks whether all of it was written.
template <class Write>
void write_text(const std::string& path, const Write& write) {
    std::ofstream file(path, std::ios::binary);
    file.precision(9);
    write(file);
    file.close();
    if (!file) throw abut::io_error(path, "cannot be written in full");
}

/// PREFIX.csv: a row a clash.
template <class Boxes, abut::scalar T>
void write_table(const std::string& path, const input<T>& in, const outcome& found, const Boxes& boxes) {
    write_text(path, [&](std::ostream& out) {
        out << "kind,relation,a,b,name_a,name_b,group,distance,x,y,z\n";
        for (const clash& c : found.clashes) {
            const viewpoint v = between(boxes(c.a), boxes(c.b));
            out << name_of(c.what) << ',' << quoted(c.relation == abut::solid_relation::disconnected ? "" : name_of(c.relation), false)
                << ',' << c.a << ',' << c.b << ',' << quoted(in.parts[c.a].name, false) << ',' << quoted(in.parts[c.b].name, false)
                << ',' << c.group << ',' << c.distance << ',' << v.at.x << ',' << v.at.y << ',' << v.at.z << '\n';
        }
    });
}

/// The same for the same names and numbers of two parts, in the next run too.
inline std::string guid_of(const std::string& text) {
    std::array<std::uint64_t, 2> hash{0xcbf29ce484222325u, 0x84222325cbf29ce4u};
    for (const char c : text) {
        for (auto& h : hash) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    }
    std::array<char, 40> guid;
    std::snprintf(guid.data(), guid.size(), "%08x-%04x-4%03x-8%03x-%012llx", static_cast<unsigned>(hash[0] >> 32),
                  static_cast<unsigned>(hash[0] >> 16 & 0xffff), static_cast<unsigned>(hash[0] & 0xfff),
                  static_cast<unsigned>(hash[1] >> 52), static_cast<unsigned long long>(hash[1] & 0xffffffffffffu));
    return guid.data();
}

/// PREFIX.json: a topic a clash, with the members' names of BCF's JSON.
template <class Boxes, abut::scalar T>
void write_topics(const std::string& path, const input<T>& in, const outcome& found, const Boxes& boxes) {
    const auto member = [](const char* name, const std::string& value) { return quoted(name, true) + ':' + quoted(value, true); };
    write_text(path, [&](std::ostream& out) {
        const auto vector = [&](const char* name, double x, double y, double z) {
            out << quoted(name, true) << ":{\"x\":" << x << ",\"y\":" << y << ",\"z\":" << z << "},";
        };
        out << "{\"topics\":[";
        for (std::size_t i = 0; i < found.clashes.size(); ++i) {
            const clash& c = found.clashes[i];
            const std::string names = in.parts[c.a].name + " and " + in.parts[c.b].name;
            const std::string ids = std::to_string(c.a) + ' ' + std::to_string(c.b);
            const bool is_known = c.relation != abut::solid_relation::disconnected;
            out << (i > 0 ? ",\n{" : "\n{") << member("guid", guid_of(names + '\n' + ids)) << ',' << member("topic_type", "Clash") << ','
                << member("topic_status", "Open") << ',' << member("title", names) << ",\"labels\":[" << quoted(name_of(c.what), true)
                << ',' << quoted("group " + std::to_string(c.group), true) << "]," << (is_known ? member("description", name_of(c.relation)) + ',' : "");
            if (c.what == kind::near) out << "\"distance\":" << c.distance << ',';
            const viewpoint v = between(boxes(c.a), boxes(c.b));
            const double off = 2 * std::max(v.size, 1e-6);
            out << "\"viewpoint\":{\"perspective_camera\":{";
            vector("camera_view_point", v.at.x + off, v.at.y - off, v.at.z + off);
            vector("camera_direction", -0.577350269, 0.577350269, -0.577350269);
            vector("camera_up_vector", -0.408248290, 0.408248290, 0.816496581);
            out << "\"field_of_view\":60},\"components\":{\"selection\":[{" << member("authoring_tool_id", std::to_string(c.a)) << "},{"
                << member("authoring_tool_id", std::to_string(c.b)) << "}]}}}";
        }
        out << "\n]}\n";
    });
}

/// Parts that clash, the worst first; of those that overlap, the faces that meet, and where they cross.
template <abut::scalar T>
void write_view(const settings& s, const input<T>& in, const outcome& found) {
    constexpr std::size_t most_parts = 256;
    abut::io::gltf_scene scene;
    std::map<std::uint32_t, abut::io::gltf_set> shown;
    std::size_t faces = 0, left_out = 0;
    const auto show = [&](std::uint32_t i) {
        if (shown.contains(i)) return true;
        const part<T>& p = in.parts[i];
        const std::size_t more = in.meshes[p.mesh].size();
        if (shown.size() == most_parts || faces + more > example::most_faces_shown) return false;
        faces += more;
        shown.emplace(i, scene.add(p.name, abut::posed(in.meshes[p.mesh], p.pose)));
        return true;
    };
    std::vector<abut::curve<T>> cuts;
    const abut::serial on;
    for (const clash& c : found.clashes) {
        if (!show(c.a) || !show(c.b)) {
            ++left_out;
            continue;
        }
        const auto at = [&](std::uint32_t i) { return abut::posed(in.meshes[in.parts[i].mesh], in.parts[i].pose); };
        if (c.what == kind::near || c.what == kind::touch) continue;
        const auto a = at(c.a);
        const auto tree = abut::posed(abut::make_bvh(on, a.object), a.pose);
        const auto crossings = abut::crossings(on, tree, at(c.b));
        std::vector<abut::index_pair> pairs;
        for (const auto& x : crossings) pairs.push_back({x.a, x.b});
        scene.add_pairs(shown.at(c.a), shown.at(c.b), pairs);
        for (auto& line : abut::curves(on, crossings)) cuts.push_back(std::move(line));
    }
    if (!cuts.empty()) scene.add_curves("where surfaces cross", cuts);
    if (left_out > 0) {
        const std::string text = std::to_string(left_out) + " of " + std::to_string(found.clashes.size()) + " clashes are not shown";
        std::printf("view: %s\n", text.c_str());
        scene.add_note(text);
    }
    example::write_view(s.view, scene);
}

template <class Program, abut::scalar T>
void run_as(const settings& s) {
    example::stopwatch watch;
    const auto in = watch.time("read", [&] { return make_input<T>(s); });
    if (in.parts.empty()) throw example::usage_error("expected a scene with parts, found none");
    outcome found;
    Program::with_policy(s.policy(), s.threads, [&](const auto& on) { found = solve(on, in, s, watch); });
    put_in_order(found, s, in.parts.size());

    std::map<std::uint32_t, abut::aabb<double>> known;
    const auto boxes = [&](std::uint32_t i) {
        const auto [place, is_new] = known.try_emplace(i);
        if (is_new) place->second = box_of(in, i);
        return place->second;
    };
    const auto write = [&] {
        watch.time("write", [&] {
            write_table(s.out + ".csv", in, found, boxes);
            write_topics(s.out + ".json", in, found, boxes);
        });
    };
    example::write_and_print(!s.no_output, write, [&](bool all_written) {
        std::printf("%s on %s: %zu parts of %zu meshes\n", s.policy().c_str(), s.scalar.c_str(), in.parts.size(), in.meshes.size());
        std::map<std::size_t, const std::string*> name_of_mesh;
        for (const auto& p : in.parts) name_of_mesh.try_emplace(p.mesh, &p.name);
        std::size_t open = 0;
        for (std::size_t m = 0; m < in.meshes.size(); ++m) {
            if (found.no_solids[m].empty() || !name_of_mesh.contains(m) || ++open > 10) continue;
            std::printf("no solid: the mesh of '%s' has %s\n", name_of_mesh[m]->c_str(), found.no_solids[m].c_str());
        }
        if (open > 10) std::printf("no solid: %zu more meshes\n", open - 10);
        for (const kind what : {kind::overlap, kind::surfaces, kind::touch, kind::near}) {
            std::size_t n = 0;
            std::uint32_t first = ~0u, last = 0;
            for (const clash& c : found.clashes) {
                if (c.what != what) continue;
                ++n;
                first = std::min(first, c.group);
                last = std::max(last, c.group);
            }
            std::printf("%-10s %8zu clashes in %u groups\n", name_of(what), n, n == 0 ? 0 : last - first + 1);
        }
        for (std::size_t i = 0; i < std::min<std::size_t>(found.clashes.size(), 10); ++i) {
            const clash& c = found.clashes[i];
            std::printf("  %s: '%s' and '%s'", name_of(c.what), in.parts[c.a].name.c_str(), in.parts[c.b].name.c_str());
            if (c.what == kind::near) std::printf(", %g apart", c.distance);
            if (c.what == kind::overlap) std::printf(", %s", name_of(c.relation));
            std::printf("\n");
        }
        if (found.clashes.size() > 10) std::printf("  ...\n");
        std::printf("time in ms\n");
        watch.print();
        if (!s.view.empty()) write_view(s, in, found);
        if (all_written) std::printf("written: %s.csv, %s.json\n", s.out.c_str(), s.out.c_str());
    });
}

// --- the command line --------------------------------------------------------------------------------------------------

template <class Program>
void describe(CLI::App& app, settings& s) {
    app.description(
        "Which parts of a scene overlap, touch, or are closer than they may be? All of it is decided exactly.\n\n"
        "Parts that are closed meshes are solids: they overlap if their interiors meet. Of other parts it is told where\n"
        "surfaces meet. Without files: walls on a slab, and a pipe.\n" +
        std::string(Program::note));
    app.add_option("files", s.files,
                   "Scenes: .glb or .gltf, whose nodes are the parts; .csv, rows file,name,x,y,z[,qw,qx,qy,qz]; or one part\n"
                   "each, .obj, .ply, .stl, .off")
        ->type_name("FILE...");
    app.add_option("--within", s.within, "Report parts that are no farther apart than D, too (0: do not)")
        ->type_name("D")
        ->capture_default_str();
    app.add_option("--weld", s.weld,
                   "Make vertices of a mesh one that are no farther apart than D, where seams are off by rounding")
        ->type_name("D")
        ->capture_default_str();
    app.add_flag("--no-touches{false}", s.touches, "Do not report parts that only touch");
    app.add_option("--generate", s.generate, "Without files: N rings of 1,024 triangles")->type_name("N")->check(CLI::Range(1, 10'000'000));
    example::add_policy<Program>(app, s);
    app.add_option("--scalar", s.scalar, "Type of the coordinates")
        ->check(CLI::IsMember(example::names_of(typename Program::scalars{})))
        ->capture_default_str();
    app.add_option("--out", s.out, "Write PREFIX.csv, a row a clash, and PREFIX.json, a topic a clash as BCF has them")
        ->type_name("PREFIX")
        ->capture_default_str();
    app.add_flag("--no-output", s.no_output, "Write no files");
    example::add_view(app, s);
}

/// What CLI11 does not check.
inline void check(const settings& s) {
    if (!std::isfinite(s.within) || s.within < 0) throw example::usage_error("--within: expected a finite distance, 0 or more");
    if (!std::isfinite(s.weld) || s.weld < 0) throw example::usage_error("--weld: expected a finite distance, 0 or more");
    if (s.generate > 0 && !s.files.empty()) throw example::usage_error("--generate goes without files");
    example::check_threads(s);
    example::check_view(s);
    if (s.no_output) return;
    for (const char* extension : {".csv", ".json"}) example::require_writable(s.out + extension);
}

/// `Program` names itself, its policies, and the types that it is compiled for. Returns the exit status.
template <class Program>
int main(int argc, char** argv) {
    settings s;
    s.policies = {Program::policies().front()};
    const auto work = [&]<class T>() {
        run_as<Program, T>(s);
        return 0;
    };
    return example::run<Program>(
        argc, argv, s, [&](CLI::App& app) { describe<Program>(app, s); }, [&] { check(s); }, work);
}

}  // namespace clash
