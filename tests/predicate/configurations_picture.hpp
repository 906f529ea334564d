// SPDX-License-Identifier: MIT
#pragma once

// The configurations as a picture (SVG): a panel for each. All geometry is rational, and rounded once to tenths of a pixel,
// so that every compiler makes the same bytes.

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "common_part.hpp"
#include "configurations.hpp"

namespace abut::test {

/// How many corners of a lie above, on and below the plane of b, as "++-": the more frequent side first. Empty if b has
/// none.
inline std::string placement(const integer_triangle& a, const integer_triangle& b) {
    const hull t = hull_of(b);
    if (t.size() < 3) return {};
    std::size_t sides[3] = {};
    for (const vec3<int>& p : {a.a, a.b, a.c}) {
        const rational excess = above(normal_of(t), t[0]).excess({p.x, p.y, p.z});
        ++sides[excess > 0 ? 0 : excess == 0 ? 1 : 2];
    }
    if (sides[0] < sides[2]) std::swap(sides[0], sides[2]);
    return std::string(sides[0], '+') + std::string(sides[1], '0') + std::string(sides[2], '-');
}

namespace picture {

// Pixels
inline constexpr int columns = 8, panel_width = 128, panel_height = 92, caption_height = 34, title_height = 30, margin = 16;
inline constexpr int head_height = 134, width = columns * panel_width + 2 * margin;

struct screen_point {
    rational x, y;
};

/// Seen from the front and a little from above and the right: x to the right, z up, y away from the viewer.
inline screen_point projected(const rational_point& p) {
    const rational unit(63, 10);
    return {unit * (p.x + rational(9, 20) * p.y), -(unit * (p.z + rational(1, 2) * p.y))};
}
/// Away from the viewer: what this moves stays where it is on the screen.
inline const rational_point away{-9, 20, -10};

/// A number of pixels, rounded to tenths
inline std::string text_of(const rational& x) {
    using boost::multiprecision::cpp_int;
    const rational tenths = x * 10 + rational(1, 2);
    const cpp_int n = numerator(tenths), d = denominator(tenths);
    cpp_int rounded = n / d;
    if (rounded * d > n) rounded -= 1;  // division is towards 0
    const bool negative = rounded < 0;
    if (negative) rounded = -rounded;
    const cpp_int whole = rounded / 10, tenth = rounded % 10;
    return (negative ? "-" : "") + whole.str() + (tenth == 0 ? "" : "." + tenth.str());
}

/// Attributes of an element: ` name="value"` each
inline std::string attribute(const char* name, const std::string& value) {
    return std::string(" ") + name + "=\"" + value + "\"";
}
inline std::string attribute(const char* name, const rational& value) { return attribute(name, text_of(value)); }

inline std::string text(const rational& x, const rational& y, const char* kind, const std::string& words) {
    return "<text" + attribute("x", x) + attribute("y", y) + attribute("class", kind) + ">" + words + "</text>\n";
}

/// A panel's inside, with the middle of what is drawn in its middle
class panel {
public:
    panel(const rational& left, const rational& top, const std::vector<hull>& shown) {
        bool first = true;
        for (const hull& h : shown) {
            for (const rational_point& p : h) {
                const screen_point at = projected(p);
                low_ = first ? at : screen_point{std::min(low_.x, at.x), std::min(low_.y, at.y)};
                high_ = first ? at : screen_point{std::max(high_.x, at.x), std::max(high_.y, at.y)};
                first = false;
            }
        }
        if (high_.x - low_.x > panel_width - 8 || high_.y - low_.y > panel_height - 8) {
            throw std::runtime_error("does not fit into its panel");
        }
        move_ = {left + panel_width / 2 - (low_.x + high_.x) / 2, top + panel_height / 2 - (low_.y + high_.y) / 2};
    }

    /// A point, a segment or a polygon
    std::string draw(const hull& h, const std::string& kind) const {
        if (h.empty()) return {};
        if (h.size() == 1) return dot_at(h[0], "4", kind);
        std::string points;
        for (const rational_point& p : h) points += (points.empty() ? "" : " ") + text_of(at(p).x) + "," + text_of(at(p).y);
        return (h.size() == 2 ? "<polyline" : "<polygon") + attribute("points", points) + attribute("class", kind) + "/>\n";
    }

    [[nodiscard]] std::string dot_at(const rational_point& p, const char* radius, const std::string& kind) const {
        return "<circle" + attribute("cx", at(p).x) + attribute("cy", at(p).y) + attribute("r", std::string(radius)) +
               attribute("class", kind) + "/>\n";
    }

private:
    [[nodiscard]] screen_point at(const rational_point& p) const {
        const screen_point s = projected(p);
        return {s.x + move_.x, s.y + move_.y};
    }

    screen_point low_, high_, move_;
};

/// The line in which two planes meet, as far as the triangles reach along it and a little further; empty if they do not
/// cross.
inline hull shared_line(const hull& s, const hull& t) {
    const rational_point n = normal_of(s), m = normal_of(t), along = cross(n, m);
    if (is_zero(along)) return {};
    const rational n_offset = dot(n, s[0]), m_offset = dot(m, t[0]), square = dot(along, along);
    const rational_point on = rational(1 / square) * cross(n_offset * m - m_offset * n, along);
    rational low, high;
    bool first = true;
    for (const hull* h : {&s, &t}) {
        for (const rational_point& p : *h) {
            const rational at = dot(along, p - on) / square;
            low = first ? at : std::min(low, at);
            high = first ? at : std::max(high, at);
            first = false;
        }
    }
    // The ends are a tenth further apart, on the screen at least 8 pixels.
    const rational further = (high - low) / 20;
    return {on + rational(low - further) * along, on + rational(high + further) * along};
}

/// The reference, or the part of it on one side of the other: outlined, and faintly filled
inline std::string outline(const panel& in, const hull& reference, const half_space* side) {
    if (reference.size() == 1) return in.draw(reference, "edge");
    std::string out;
    if (reference.size() == 3) out += in.draw(side != nullptr ? clipped(reference, *side) : reference, "face");
    const std::size_t edges = reference.size() == 3 ? 3 : 1;
    for (std::size_t i = 0; i < edges; ++i) {
        const hull whole{reference[i], reference[(i + 1) % reference.size()]};
        const hull edge = side != nullptr ? clipped(whole, *side) : whole;
        if (edge.size() == 2) out += in.draw(edge, "edge");
    }
    return out;
}

/// Marks the corners of a hull that are on the plane of a triangle.
inline std::string corners_on_plane(const panel& in, const hull& corners, const hull& t, const char* kind) {
    std::string out;
    for (const rational_point& p : corners) {
        if (above(normal_of(t), t[0]).excess(p) == 0) out += in.dot_at(p, "3.3", kind);
    }
    return out;
}

/// What stands upright on the plane z = 0 under a segment or a point: without it nobody could tell where that is.
inline hull shadow(const hull& h) {
    hull down = h;
    for (std::size_t i = h.size(); i-- > 0;) down.push_back({h[i].x, h[i].y, 0});
    return down;
}

inline std::string drawn(const configuration& c, int left, int top) {
    const hull s = hull_of(c.reference), t = hull_of(c.other), part = common_part(s, t), line = shared_line(s, t);
    const bool floats = t.size() < 3 && !same(shadow(t).back(), t[0]);
    const panel in(left, top, {s, t, line, floats ? shadow(t) : hull{}});
    const std::string other = in.draw(t, c.part == common::nothing ? "miss" : "hit");
    std::string out = floats ? in.draw(shadow(t), "shadow") : "";
    const rational_point n = normal_of(t);
    const rational facing = dot(n, away);
    if (line.empty() || facing == 0) {
        out += other + outline(in, s, nullptr);
    } else {
        const half_space up = above(n, t[0]), down = below(n, t[0]);
        out += outline(in, s, facing > 0 ? &up : &down) + other + outline(in, s, facing > 0 ? &down : &up);
        out += in.draw(line, "line") + corners_on_plane(in, s, t, "corner") + corners_on_plane(in, t, s, "corner other");
    }
    if (s.size() == 3 && t.size() == 2 && part.empty()) {
        const hull crossing = clipped_to_plane(t, s);
        if (crossing.size() == 1) out += in.dot_at(crossing[0], "3.3", "corner other");
    }
    out += part.size() == 1 ? in.dot_at(part[0], "2.2", "part") : in.draw(part, part.size() > 2 ? "part area" : "part");

    const rational middle = left + rational(panel_width, 2);
    const std::size_t comma = c.name.find(", ");
    const std::string first = c.name.substr(0, comma), second = comma == std::string::npos ? "" : c.name.substr(comma + 2);
    out += text(middle, top + panel_height + 11, "name", first + (second.empty() ? "" : ","));
    if (!second.empty()) out += text(middle, top + panel_height + 23, "name", second);
    return out;
}

inline constexpr const char* head = R"(<style>
text { font-family: Helvetica, Arial, 'DejaVu Sans', sans-serif; fill: #222 }
.head { font-size: 18px; font-weight: bold }
.title { font-size: 13px; font-weight: bold }
.name { font-size: 11px; text-anchor: middle }
.note { font-size: 12px }
.line { fill: none; stroke: #555; stroke-width: 1; stroke-dasharray: 4 3 }
.face { fill: #2b6cb0; fill-opacity: 0.13 }
.edge { fill: #2b6cb0; fill-opacity: 0.13; stroke: #1f5fae; stroke-width: 1.7; stroke-linecap: round }
.hit { fill: #f5a04a; fill-opacity: 0.78; stroke: #b35c00; stroke-width: 1.4; stroke-linejoin: round; stroke-linecap: round }
.miss { fill: #c8c8c8; fill-opacity: 0.78; stroke: #6f6f6f; stroke-width: 1.4; stroke-linejoin: round; stroke-linecap: round }
polyline.hit { fill: none; stroke: #ea8a2a; stroke-width: 2.6 }
polyline.miss { fill: none; stroke: #8c8c8c; stroke-width: 2.6 }
.part { fill: #c00020; stroke: #c00020; stroke-width: 3; stroke-linecap: round; stroke-linejoin: round }
circle.part { stroke: none }
.corner { fill: #fff; stroke: #1f5fae; stroke-width: 1.3 }
.corner.other { stroke: #5b3000 }
.shadow { fill: #000; fill-opacity: 0.05; stroke: #999; stroke-width: 0.8; stroke-dasharray: 1.5 2 }
.area { fill-opacity: 0.45; stroke-width: 1.4 }
.frame { fill: none; stroke: #e2e2e2 }
</style>
)";

/// What the colours and lines mean, in two rows from `top`
inline std::string legend(int top) {
    struct sample {
        int left, row;
        const char *drawing, *words;
    };
    // Each is drawn in a box of 26 x 16 pixels.
    const sample samples[] = {
        {0, 0, R"(<polygon points="1,15 25,15 9,1" class="face"/><polygon points="1,15 25,15 9,1" class="edge"/>)",
         "reference"},
        {150, 0, R"(<polygon points="1,15 25,15 9,1" class="hit"/>)", "other, a hit"},
        {320, 0, R"(<polygon points="1,15 25,15 9,1" class="miss"/>)", "other, a miss"},
        {490, 0, R"(<circle cx="6" cy="8" r="3.3" class="corner"/><circle cx="18" cy="8" r="3.3" class="corner other"/>)",
         "corner on the other's plane"},
        {740, 0, R"(<polygon points="3,3 23,1 23,14 3,14" class="shadow"/>)", "height above the plane"},
        {0, 1, R"(<polyline points="0,8 26,8" class="line"/>)", "line in which their planes meet"},
        {320, 1, R"(<circle cx="4" cy="8" r="2.2" class="part"/><polyline points="12,8 24,8" class="part"/>)",
         "point, segment"},
        {490, 1, R"(<polygon points="1,15 25,15 9,1" class="part area"/>)", "or area in common"},
    };
    std::string out;
    for (const sample& s : samples) {
        const std::string to = std::to_string(margin + s.left) + " " + std::to_string(top + 22 * s.row);
        out += "<g" + attribute("transform", "translate(" + to + ")") + ">" + s.drawing +
               "<text x=\"32\" y=\"12\" class=\"note\">" + s.words + "</text></g>\n";
    }
    return out;
}

/// The whole picture
inline std::string render(const std::vector<configuration_group>& groups) {
    std::string body;
    int top = head_height;
    for (const configuration_group& group : groups) {
        body += text(margin, top + 18, "title", group.title);
        top += title_height;
        for (std::size_t i = 0; i < group.members.size(); ++i) {
            if (i > 0 && i % columns == 0) top += panel_height + caption_height;
            const int left = margin + static_cast<int>(i % columns) * panel_width;
            body += "<rect" + attribute("x", left + 2) + attribute("y", top) + attribute("width", panel_width - 4) +
                    attribute("height", panel_height) + attribute("class", "frame") + "/>\n";
            body += drawn(group.members[i], left, top);
        }
        top += panel_height + caption_height;
    }
    const std::string size = std::to_string(width) + " " + std::to_string(top);
    std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\"" + attribute("width", width) + attribute("height", top) +
                      attribute("viewBox", "0 0 " + size) + ">\n";
    out += head;
    out += "<rect" + attribute("width", width) + attribute("height", top) + attribute("fill", "#fff") + "/>\n";
    out += text(margin, 30, "head", "Two triangles: every placement, and what they have in common");
    out += text(margin, 52, "note",
                "+, 0, -: corners of one above, on and below the other's plane; which side is above does not matter. "
                "Names say how the reference's part of the dashed line");
    out +=
        text(margin, 68, "note",
             "lies to the other's: \"contains\" means that the reference's part contains the other's. Seen from the front, "
             "a little from above: the reference lies flat, the other stands.");
    out += legend(84);
    return out + body + "</svg>\n";
}

}  // namespace picture

}  // namespace abut::test
