// SPDX-License-Identifier: MIT
#pragma once

// Sets of convex hulls, each of its own number of points: all points one after another, and where each hull's begin.

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <ranges>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/error.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/host.hpp>
#include <abut/shape/check.hpp>
#include <abut/shape/hull.hpp>
#include <abut/shape/posed.hpp>
#include <abut/shape/rows.hpp>
#include <abut/shape/set.hpp>
#include <abut/shape/view.hpp>

namespace abut {

/// @addtogroup sets
///@{

/// Convex hulls of points. Hull i has the points from offset i up to offset i + 1, without that one.
template <scalar T, memory_space Space = host_space>
struct hulls_view {
    using scalar_type = T;       ///< float or double
    using shape_type = hull<T>;  ///< what a shape is
    using memory_space = Space;  ///< where the memory lies

    detail::strided<vec3<T>> points;         ///< of all hulls: first one, number and stride
    detail::strided<std::uint32_t> offsets;  ///< one more than there are hulls: from 0 to the number of points
    detail::strided<std::uint32_t> edges;    ///< what `with_edges` made, or none

    /// Of no hull.
    hulls_view() = default;
    /// Over the caller's arrays, which have to outlive every use of the view: there are `hull_count` + 1 offsets. The stride
    /// is in bytes.
    ABUT_HD hulls_view(const vec3<T>* first_point, std::size_t point_count, const std::uint32_t* first_offset,
                       std::size_t hull_count, std::size_t stride = sizeof(vec3<T>))
        : points(first_point, point_count, stride),
          offsets(first_offset, first_offset == nullptr ? 0 : hull_count + 1, sizeof(std::uint32_t)) {}
    /// Over an array of points of another type that holds three T (shape/rows.hpp), or T one by one.
    template <class P>
    ABUT_HD hulls_view(const P* first_point, std::size_t point_count, const std::uint32_t* first_offset,
                       std::size_t hull_count, std::size_t stride = detail::row_stride<vec3<T>, P>)
        : points(first_point, point_count, stride),
          offsets(first_offset, first_offset == nullptr ? 0 : hull_count + 1, sizeof(std::uint32_t)) {
        (void)detail::is_row<vec3<T>, P>();
    }

    /// Number of hulls.
    [[nodiscard]] ABUT_HD std::size_t size() const { return offsets.count == 0 ? 0 : offsets.count - 1; }
    /// Hull i, by value; its points stay where they are.
    [[nodiscard]] ABUT_HD hull<T> operator[](std::size_t i) const {
        const std::uint32_t first = offsets[i];
        const std::uint32_t at = edges.count == 0 ? 0 : edges[i];
        return {&points[first], offsets[i + 1] - first, points.stride, at == 0 ? nullptr : edges.first() + at};
    }
    /// A hint on the host, as of any shape_view.
    ABUT_INLINE void prefetch(std::size_t i, int step) const {
        if (step == 0) return offsets.prefetch(i);
        points.prefetch(offsets[i]);
    }
};

namespace detail {

template <scalar T>
inline constexpr shape_name name_of<hull<T>>{"hull", "abut::hulls"};

/// Index i if offset i is not what it has to be, otherwise the largest index.
struct bad_offset {
    strided<std::uint32_t> offsets;
    std::uint32_t points;
    ABUT_HD std::size_t operator()(std::size_t i) const {
        const bool good = i + 1 == offsets.count ? offsets[i] == points : offsets[i] < offsets[i + 1];
        return good && (i > 0 || offsets[i] == 0) ? none_is_bad : i;
    }
};

[[noreturn]] inline void refuse_offset(const char* function, std::size_t i, std::size_t hulls, std::size_t points,
                                       std::uint32_t offset, std::uint32_t next) {
    if (i == 0 && offset != 0) throw invalid_geometry(function, "offset", i, "the first one has to be 0", offset);
    if (i == hulls) {
        throw invalid_geometry(function, "offset", i,
                               "the last one has to be the number of points, which is " + std::to_string(points), offset);
    }
    throw invalid_geometry(function, "hull", i,
                           next == offset ? "it has no point: the next one begins at the same offset"
                                          : "the next one begins before it does, at " + std::to_string(next),
                           offset);
}

/// Throws for point i, which is p and not finite, of a hull. The message says both numbers.
template <scalar T>
[[noreturn]] void refuse_point(const char* function, const char* element, std::size_t hull, std::size_t i,
                               const vec3<T>& p) {
    const shape_flaw flaw = flaw_of(p);
    throw invalid_geometry(function, element, hull, "point " + std::to_string(i) + ": " + flaw.what, flaw.value);
}

/// The hull that point i of all points belongs to. The offsets are valid.
template <class Policy, scalar T, memory_space Space>
std::size_t hull_of_point(const Policy& on, const hulls_view<T, Space>& view, std::size_t i) {
    std::vector<std::uint32_t> offsets(view.offsets.count);
    download(on, view.offsets.first(), offsets.size(), offsets.data());
    return static_cast<std::size_t>(std::upper_bound(offsets.begin(), offsets.end(), i) - offsets.begin()) - 1;
}

template <class Policy, scalar T, memory_space Space>
void check(const Policy& on, const hulls_view<T, Space>& view, const char* function) {
    check_count(view.size(), function);
    check_count(view.points.count, function);
    require_access(on, view.points.data, function);
    see_writes_to(view.points.data);
    const std::size_t n = view.size();
    if (view.offsets.count == 0 && view.points.count > 0) {
        throw error(std::string(function) + ": " + std::to_string(view.points.count) +
                    " points and no offset; expected one for each hull, and the number of points");
    }
    require_access(on, view.offsets.data, function);
    see_writes_to(view.offsets.data);
    const auto points = static_cast<std::uint32_t>(view.points.count);
    const std::size_t bad = reduce(on, view.offsets.count, none_is_bad, minimum{}, bad_offset{view.offsets, points});
    if (bad != none_is_bad) {
        std::uint32_t offset[2] = {};
        download(on, &view.offsets[bad], bad < n ? 2 : 1, offset);
        refuse_offset(function, bad, n, points, offset[0], offset[1]);
    }
    const shapes_view<vec3<T>, Space> all(view.points.first(), view.points.count, view.points.stride);
    const std::size_t point = first_bad(on, all);
    if (point == none_is_bad) return;
    refuse_point(function, "hull", hull_of_point(on, view, point), point, fetched(on, all, point));
}

/// A hull's points, where they are in the world.
template <scalar T, memory_space Space>
struct points_of_hull {
    using scalar_type = T;
    using shape_type = vec3<T>;
    using memory_space = Space;
    hull<T> of;
    [[nodiscard]] ABUT_HD std::size_t size() const { return of.count; }
    [[nodiscard]] ABUT_HD vec3<T> operator[](std::size_t i) const { return of[i]; }
};

/// One hull: by its points, since those of a device's memory cannot be looked at here.
template <class Policy, scalar T, memory_space Space>
void check(const Policy& on, const single_view<hull<T>, Space>& view, const char* function) {
    const hull<T>& h = view.shape;
    if (h.count == 0) throw invalid_geometry(function, "hull", 0, "it has no point; their number is", 0);
    const points_of_hull<T, Space> points{h};
    const std::size_t point = first_bad(on, points);
    if (point != none_is_bad) refuse_point(function, "hull", 0, point, fetched(on, points, point));
}

/// Whether placed points overflow. Looks at each.
template <class Policy, scalar T, memory_space Space>
void check(const Policy& on, const posed_view<hulls_view<T, Space>>& placed, const char* function) {
    const strided<vec3<T>>& all = placed.shapes.points;
    const shapes_view<vec3<T>, Space> points(all.first(), all.count, all.stride);
    const posed_view<shapes_view<vec3<T>, Space>> there{points, placed.pose};
    const std::size_t point = first_bad(on, there);
    if (point == none_is_bad) return;
    refuse_point(function, "posed hull", hull_of_point(on, placed.shapes, point), point, fetched(on, there, point));
}

/// Says what was expected instead of offsets of type P; false, so that nothing else is said.
template <class P>
consteval bool holds_offsets() {
    static_assert(std::integral<P> && !std::same_as<P, bool>, "abut: expected an array of offsets, which are integers");
    return std::integral<P> && !std::same_as<P, bool>;
}

/// The caller's offsets in host memory, none of which is negative or above the number of points.
template <array_like O>
std::vector<std::uint32_t> offsets_of(const O& offsets, std::size_t points, const char* function) {
    std::vector<std::uint32_t> made;
    made.reserve(std::ranges::size(offsets));
    check_count(points, function);
    for (const auto& offset : offsets) {
        if (std::cmp_less(offset, 0) || std::cmp_greater(offset, points)) {
            throw invalid_geometry(function, "offset", made.size(),
                                   "out of range, there are " + std::to_string(points) + " points",
                                   static_cast<double>(offset));
        }
        made.push_back(static_cast<std::uint32_t>(offset));
    }
    return made;
}

}  // namespace detail

/// Convex hulls, each of its own number of points, of which there is at least one. hulls<float>(points, offsets).
template <scalar T, memory_space Space = host_space>
class hulls {
    static constexpr const char* name = "abut::hulls";

public:
    using scalar_type = T;                   ///< float or double
    using shape_type = hull<T>;              ///< what a shape is
    using memory_space = Space;              ///< where the memory lies
    using view_type = hulls_view<T, Space>;  ///< what algorithms read

    /// Without hulls.
    hulls() = default;
    /// Of all points, hull by hull, and offsets, in host memory: hull i has the points from offset i up to offset i + 1. So
    /// there is one offset more than there are hulls, and the last one is the number of points.
    hulls(const std::vector<vec3<T>>& points, const std::vector<std::uint32_t>& offsets)
        requires std::same_as<Space, host_space>
        : hulls(serial{}, points, offsets) {}
    /// Of points and offsets, which lie in host memory, in the policy's.
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, Space>
    hulls(const Policy& policy, std::span<const vec3<T>> points, std::span<const std::uint32_t> offsets)
        : points_(policy, points), offsets_(policy, offsets) {
        detail::check(policy, view(), name);
    }
    /// The same of both in braces.
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, Space>
    hulls(const Policy& policy, std::initializer_list<vec3<T>> points, std::initializer_list<std::uint32_t> offsets)
        : hulls(policy, detail::span_of(points), detail::span_of(offsets)) {}
    /// Of a list of points for each hull, in host memory.
    explicit hulls(const std::vector<std::vector<vec3<T>>>& lists)
        requires std::same_as<Space, host_space>
        : hulls(serial{}, lists) {}
    /// The same in the policy's memory. The lists lie in host memory.
    template <execution_policy Policy>
        requires std::same_as<space_of<Policy>, Space>
    hulls(const Policy& policy, const std::vector<std::vector<vec3<T>>>& lists) {
        std::vector<vec3<T>> points;
        std::vector<std::uint32_t> offsets(1, 0);
        for (const std::vector<vec3<T>>& list : lists) {
            points.insert(points.end(), list.begin(), list.end());
            detail::check_count(points.size(), name);
            offsets.push_back(static_cast<std::uint32_t>(points.size()));
        }
        *this = hulls(policy, std::span<const vec3<T>>(points), std::span<const std::uint32_t>(offsets));
    }
    /// Of other libraries' arrays, containers or spans: of points that hold three T, or of T itself; of integers of any
    /// type. Negative offsets are refused like those that are too large.
    template <detail::array_like P, detail::array_like O>
        requires std::same_as<Space, host_space>
    hulls(const P& points, const O& offsets) : hulls(serial{}, points, offsets) {}
    /// The same in the policy's memory. The arrays lie in host memory.
    template <execution_policy Policy, detail::array_like P, detail::array_like O>
        requires(std::same_as<space_of<Policy>, Space> && !(std::convertible_to<const P&, std::span<const vec3<T>>> &&
                                                            std::convertible_to<const O&, std::span<const std::uint32_t>>))
    hulls(const Policy& policy, const P& points, const O& offsets) {
        if constexpr (detail::is_row<vec3<T>, detail::element_of<P>>() &&
                      detail::holds_offsets<detail::element_of<O>>()) {
            const std::span<const vec3<T>> all = detail::rows_as<vec3<T>>(points, name);
            const std::vector<std::uint32_t> from = detail::offsets_of(offsets, all.size(), name);
            *this = hulls(policy, all, std::span<const std::uint32_t>(from));
        }
    }

    /// Number of hulls.
    [[nodiscard]] std::size_t size() const { return view().size(); }
    /// What algorithms read; for as long as the set or a copy of it lives.
    [[nodiscard]] view_type view() const {
        const std::size_t n = offsets_.size();
        view_type all(points_.data(), points_.size(), offsets_.data(), n == 0 ? 0 : n - 1);
        all.edges = {edges_.data(), edges_.size(), sizeof(std::uint32_t)};
        return all;
    }
    /// The CUDA device that the memory lies on; -1 for the host, and of a default set.
    [[nodiscard]] int device() const { return points_.device(); }

    /// See `copy_to`.
    template <execution_policy Policy>
    [[nodiscard]] auto copied_to(const Policy& to) const {
        hulls<T, space_of<Policy>> copy;
        copy.points_ = points_.copied_to(to);
        copy.offsets_ = offsets_.copied_to(to);
        copy.edges_ = edges_.copied_to(to);
        return copy;
    }

private:
    template <scalar, abut::memory_space>
    friend class hulls;
    friend detail::set_parts;

    detail::shared_array<vec3<T>, Space> points_;
    detail::shared_array<std::uint32_t, Space> offsets_, edges_;
};

///@}

}  // namespace abut
