// SPDX-License-Identifier: MIT
#pragma once

// How far convex shapes that meet have to go apart, and along which way, by a polytope that grows in their differences as in
// hull_contact.hpp, in doubles whose operations are rounded one by one. It tells what it knows at its end: every ray from the
// origin passes a face of a closed surface, whose corners are differences, and no face is nearer than some length. So no
// move is shorter than that, whatever rounding did on the way. It need not be convex. Not for decisions, and not for shapes that just
// touch: where it knows nothing, others are asked.
//
// The plane of a face with the edges e and f, whose product is n, is known from the corner p to 2^-51 |e| |f| |p| / |n|.

#include <concepts>
#include <cstddef>
#include <cstdint>

#include <abut/arithmetic/error_free.hpp>
#include <abut/arithmetic/limits.hpp>
#include <abut/arithmetic/magnitude.hpp>
#include <abut/narrow/numbers.hpp>
#include <abut/narrow/plain_search.hpp>

namespace abut::detail {

/// Ways no farther than an angle from a unit vector, as its cosine and sine tell; by default none.
struct plain_cap {
    vec3<double> middle{0, 0, 0};
    double cosine = 2, sine = 0;
};

/// A polytope in the differences of a point of b and one of a. It takes some 10 KiB, and no other memory.
template <class A, class B>
class plain_polytope {
public:
    using point = vec3<double>;
    static constexpr int most_corners = 64, most_faces = 2 * most_corners - 4;

    /// From four differences that hold the origin.
    ABUT_HD constexpr plain_polytope(const A& a, const B& b, const plain_simplex& at) : a_(a), b_(b) {
        if (at.count != 4) return;
        for (int k = 0; k < 4; ++k) put_corner(at.w[k], at.on_b[k]);
        const point e = contact_math::plain_difference(w_[1], w_[0]), f = contact_math::plain_difference(w_[2], w_[0]),
                    g = contact_math::plain_difference(w_[3], w_[0]);
        if (contact_math::plain_dot(plain_cross(e, f), g) > 0) {  // the fourth is behind the first face
            put_corner(w_[1], on_b_[1]);
            w_[1] = w_[2], on_b_[1] = on_b_[2];
            w_[2] = w_[4], on_b_[2] = on_b_[4];
            corners_ = 4;
        }
        constexpr std::uint8_t corner[4][3] = {{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}};
        constexpr std::uint8_t across[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
        is_closed_ = true;
        for (int i = 0; i < 4; ++i) {
            put(i, corner[i][0], corner[i][1], corner[i][2]);
            for (int k = 0; k < 3; ++k) face_[i].across[k] = across[i][k];
        }
        faces_ = 4;
    }
    /// Whether it is closed still, and holds the origin.
    [[nodiscard]] ABUT_HD constexpr bool is_closed() const { return is_closed_; }
    /// The nearest face, and how far its plane is.
    [[nodiscard]] ABUT_HD constexpr int nearest() const {
        int best = 0;
        for (int f = 1; f < faces_; ++f) {
            if (distance_[f] < distance_[best]) best = f;
        }
        return best;
    }
    [[nodiscard]] ABUT_HD constexpr double distance_of(int f) const { return distance_[f]; }
    [[nodiscard]] ABUT_HD constexpr const point& normal_of(int f) const { return face_[f].normal; }
    [[nodiscard]] ABUT_HD constexpr int faces() const { return faces_; }
    /// Corner k of a face, as a point of b.
    [[nodiscard]] ABUT_HD constexpr const point& on_b(int f, int k) const { return on_b_[face_[f].corner[k]]; }
    /// Whether no move is shorter than a length, rounding included.
    [[nodiscard]] ABUT_HD constexpr bool are_all_beyond(double length) const { return is_closed_ && open_face(length, {}) < 0; }
    /// The nearest of the faces that do not tell that no move is shorter than a length, but for ways in a cap; or -1. Along a
    /// way at an angle to a face's normal, whose plane is so far away, K reaches to that distance over the angle's cosine.
    [[nodiscard]] ABUT_HD constexpr int open_face(double length, const plain_cap& cap) const {
        using namespace contact_math;
        int best = -1;
        for (int f = 0; f < faces_; ++f) {
            const double loose = plain_product(0x1p-51, loose_[f]), low = plain_sum(distance_[f], -plain_product(loose, far_));
            if (low >= length || (best >= 0 && !(distance_[f] < distance_[best]))) continue;
            if (distance_[f] >= length && (distance_from(f, 0) >= length || distance_from(f, 1) >= length || distance_from(f, 2) >= length))
                continue;
            const point& n = face_[f].normal;
            const double cosine = plain_dot(n, cap.middle);
            if (cosine >= cap.cosine) {
                const point turned = plain_cross(n, cap.middle);
                const double sine = root(one_double{plain_dot(turned, turned)}).high,
                             at_border = plain_sum(plain_product(cap.cosine, cosine), plain_product(cap.sine, sine));
                if (plain_product(plain_sum(at_border, plain_sum(8 * loose, 0x1p-48)), length) <= low) continue;
            }
            best = f;
        }
        return best;
    }
    /// The farthest difference along a way, and its product with that.
    ABUT_HD constexpr double look(const point& n) {
        const point p = a_.farthest(contact_math::negated(n));
        seen_b_ = b_.farthest(n);
        seen_ = contact_math::plain_difference(seen_b_, p);
        return contact_math::plain_dot(n, seen_);
    }
    /// Takes in what was seen last, beyond a face. False where that leads to nothing.
    ABUT_HD constexpr bool grow(int f) {
        if (corners_ == most_corners || !is_closed_) return false;
        for (int k = 0; k < corners_; ++k) {
            if (w_[k] == seen_) return false;
        }
        put_corner(seen_, seen_b_);
        wrap(f);
        return is_closed_;
    }

private:
    struct face {
        point normal;  ///< a unit vector, outwards
        std::uint8_t corner[3];  ///< counterclockwise, as seen from outside
        std::uint8_t across[3];  ///< the face beyond the edge from this corner to the next
        std::uint8_t is_seen;    ///< 1 if from the new corner, 2 if not, 0 where that was not asked
    };

    ABUT_HD constexpr void put_corner(const point& w, const point& on_b) {
        w_[corners_] = w;
        far_ = greatest(far_, plain_product(0x1.cp0, contact_math::largest_of(w)));
        on_b_[corners_++] = on_b;
    }
    /// A plane as known from one of its corners.
    struct plane_at {
        point normal;
        double square, edges, distance;  ///< of the normal; product of the edges' squares; of the plane, times the normal
    };
    ABUT_HD constexpr plane_at plane_from(const point& p, const point& q, const point& r) const {
        using namespace contact_math;
        const point e = plain_difference(q, p), g = plain_difference(r, p), n = plain_cross(e, g);
        return {n, plain_dot(n, n), plain_product(plain_dot(e, e), plain_dot(g, g)), plain_dot(n, p)};
    }
    /// The plane is that from the corner with the largest sine, which is opposite to the longest edge.
    ABUT_HD constexpr void put(int f, std::uint8_t i, std::uint8_t j, std::uint8_t k) {
        using namespace contact_math;
        const point &p = w_[i], &q = w_[j], &r = w_[k];
        const auto square = [](const point& v) { return plain_dot(v, v); };
        const double pq = square(plain_difference(q, p)), qr = square(plain_difference(r, q)),
                     rp = square(plain_difference(p, r));
        const plane_at of = qr >= pq && qr >= rp ? plane_from(p, q, r)
                            : rp >= pq           ? plane_from(q, r, p)
                                                 : plane_from(r, p, q);
        face& made = face_[f];
        made.corner[0] = i, made.corner[1] = j, made.corner[2] = k;
        made.is_seen = 0;
        if (!(of.square > plain_product(0x1p-90, of.edges) && of.square > 0x1p-900)) {
            is_closed_ = false;
            return;
        }
        const double length = root(one_double{of.square}).high;
        made.normal = {of.normal.x / length, of.normal.y / length, of.normal.z / length};
        distance_[f] = of.distance / length;
        loose_[f] = of.edges / of.square;
        if (!(distance_[f] > 0)) is_closed_ = false;
    }
    /// How far the plane of a face is at least, as known from its corner k.
    [[nodiscard]] ABUT_HD constexpr double distance_from(int f, int k) const {
        using namespace contact_math;
        const std::uint8_t(&at)[3] = face_[f].corner;
        const point& p = w_[at[k]];
        const plane_at of = plane_from(p, w_[at[k == 2 ? 0 : k + 1]], w_[at[k == 0 ? 2 : k - 1]]);
        if (!(of.square > 0)) return 0;
        const double off = root(one_double{plain_product(of.edges / of.square, plain_dot(p, p))}).high;
        return plain_sum(of.distance / root(one_double{of.square}).high, -plain_product(0x1p-51, off));
    }
    ABUT_NOINLINE ABUT_HD constexpr void wrap(int first) {
        std::uint8_t seen[most_faces], from[most_faces], to[most_faces], outside[most_faces], place_from[most_corners];
        for (int k = 0; k < corners_; ++k) place_from[k] = 255;
        int seen_count = 0, border = 0;
        face_[first].is_seen = 1;
        seen[seen_count++] = static_cast<std::uint8_t>(first);
        for (int k = 0; k < seen_count; ++k) {
            const face& f = face_[seen[k]];
            for (int e = 0; e < 3; ++e) {
                face& next = face_[f.across[e]];
                if (next.is_seen == 0) {
                    const double side = plain_sum(contact_math::plain_dot(next.normal, seen_), -distance_[f.across[e]]);
                    next.is_seen = side > 0 ? 1 : 2;
                    if (next.is_seen == 1) seen[seen_count++] = f.across[e];
                }
                if (next.is_seen != 2) continue;
                from[border] = f.corner[e];
                to[border] = f.corner[e == 2 ? 0 : e + 1];
                outside[border++] = f.across[e];
            }
        }
        // The border is one cycle, or rounding has led astray.
        if (border < 3 || faces_ - seen_count + border > most_faces) is_closed_ = false;
        for (int k = 0; k < border && is_closed_; ++k) {
            if (place_from[from[k]] != 255) is_closed_ = false;
            place_from[from[k]] = static_cast<std::uint8_t>(k);
        }
        for (int k = 0, at = 0; k < border && is_closed_; ++k) {
            at = place_from[to[at]];
            if (at == 255 || (at == 0) != (k == border - 1)) is_closed_ = false;
        }
        if (!is_closed_) return;
        std::uint8_t places[most_faces];  // of those that make way, and behind all
        for (int k = 0; k < border; ++k) places[k] = k < seen_count ? seen[k] : static_cast<std::uint8_t>(faces_++);
        const auto last = static_cast<std::uint8_t>(corners_ - 1);
        for (int k = 0; k < border; ++k) {
            face& beyond = face_[outside[k]];
            for (int e = 0; e < 3; ++e) {
                if (beyond.corner[e] == to[k] && beyond.corner[e == 2 ? 0 : e + 1] == from[k]) {
                    beyond.across[e] = places[k];
                }
            }
            beyond.is_seen = 0;
            put(places[k], from[k], to[k], last);
            face& made = face_[places[k]];
            made.across[0] = outside[k];
            made.across[1] = places[place_from[to[k]]];
            face_[places[place_from[to[k]]]].across[2] = places[k];
        }
        // Corners inside of the border are gone, and leave places, the last of which goes first.
        for (int free = seen_count; free > border; --free) {
            int last_of = border;
            for (int k = border + 1; k < free; ++k) {
                if (seen[k] > seen[last_of]) last_of = k;
            }
            move(--faces_, seen[last_of]);
            seen[last_of] = seen[free - 1];
        }
    }

    ABUT_HD constexpr void move(int from, int to) {
        if (from == to) return;
        face_[to] = face_[from];
        distance_[to] = distance_[from];
        loose_[to] = loose_[from];
        for (int e = 0; e < 3; ++e) {
            face& beyond = face_[face_[to].across[e]];
            for (int k = 0; k < 3; ++k) {
                if (beyond.across[k] == from) beyond.across[k] = static_cast<std::uint8_t>(to);
            }
        }
    }

    const A& a_;
    const B& b_;
    point w_[most_corners + 1], on_b_[most_corners + 1], seen_{}, seen_b_{};
    face face_[most_faces];
    double distance_[most_faces], loose_[most_faces];  ///< of planes; and how much of what is rounded stays
    double far_ = 0;  ///< no corner is farther away
    int corners_ = 0, faces_ = 0;
    bool is_closed_ = false;
};

/// The way on which a goes apart from b soonest, a unit vector, and how far, but for the radii around both; of shapes that the
/// search found to meet, or that are apart where the radii are more than that.
struct plain_way_out {
    vec3<double> normal{0, 0, 1};
    double depth = infinity<double>;
    bool is_sure = false;  ///< no move is shorter by more than 2^-50 of the shapes' size
};

/// Of polytopes.
template <scalar T, class A, class B>
ABUT_NOINLINE ABUT_HD constexpr plain_way_out way_out_in_doubles(const A& a, const B& b, const plain_simplex& at, double size) {
    plain_way_out found;
    plain_polytope<A, B> polytope(a, b, at);
    const double enough = plain_product(std::same_as<T, float> ? 0x1p-30 : 0x1p-50, size);
    while (polytope.is_closed()) {
        const int f = polytope.nearest();
        const vec3<double> n = polytope.normal_of(f);
        const double depth = polytope.look(n);
        if (depth < found.depth) found.depth = depth, found.normal = n;
        if (plain_sum(found.depth, -polytope.distance_of(f)) <= enough) {
            found.is_sure = polytope.are_all_beyond(plain_sum(found.depth, -2 * enough));
            break;
        }
        if (!polytope.grow(f)) break;
    }
    return found;
}

}  // namespace abut::detail
