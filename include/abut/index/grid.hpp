// SPDX-License-Identifier: MIT
#pragma once

// make_grid: uniform buckets in a hash table, so that empty space costs nothing, and coarser buckets for larger shapes, so
// that a shape that spans many cells is stored once all the same.
//
// Space is cut into at most 2^19 base cells an axis; level l joins 2^l of them. A shape whose box spans at most 2^l + 1 base
// cells in each axis goes to the finest such level, to the cell of its lower corner, and nowhere else: so a pair meets in
// one cell. A query looks, on each level in use, at the cells under its own box and one more on the lower side. After the
// base cell is found (which is monotone in the coordinate) all of this is in integers: nothing is lost to rounding.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include <abut/arithmetic/limits.hpp>
#include <abut/execution/atomic.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/index/operand.hpp>
#include <abut/index/point_cells.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/box_measure.hpp>

namespace abut {

/// Options of make_grid.
/// @ingroup indices
struct grid_options {
    /// Width of the base cells. 0 chooses twice the mean of the shapes' longest box sides: four radii for equal spheres; for
    /// points, which have none, as many cells as points in the box around them. A width under 2^-19 of the scene's extent is
    /// raised to that.
    double cell_width = 0;
    /// Whether a grid of points keeps distances to the nearest point as well, for `any_each` and `any_within_each` of spheres,
    /// which take a tenth to a half of the time then: 25 bytes a point more, and up to 0.7 us a point while it is built. Of
    /// serial and openmp; a device has no use for them and keeps none.
    bool clearances = false;
};

/// How space is cut. Lies with the cells: a build does not wait for it, and walks read it where they run.
template <scalar T>
struct grid_frame {
    static constexpr int axis_bits = 19;          ///< of the number of a base cell along an axis
    static constexpr int levels = axis_bits + 1;  ///< sizes of cells that there may be

    aabb<T> bounds;               ///< around all shapes
    double cells_per_unit;        ///< base cells in a unit of length
    std::uint32_t levels_in_use;  ///< bit l is set where level l has shapes

    /// Base cell of a coordinate. Monotone, and 0 at the scene's lower end. There is no product to be contracted into a sum,
    /// so it is the same function wherever it is compiled; but not in another rounding mode, or with other denormals. A
    /// difference that overflows is infinite, and in the last cell.
    [[nodiscard]] ABUT_HD std::int32_t cell(T x, T lower) const {
        const double at = (static_cast<double>(x) - static_cast<double>(lower)) * cells_per_unit;
        constexpr double last = (1 << axis_bits) - 1;
        return at > 0 ? (at < last ? static_cast<std::int32_t>(at) : (1 << axis_bits) - 1) : 0;
    }
    /// Base cell of a point, by its three coordinates.
    [[nodiscard]] ABUT_HD vec3<std::int32_t> cell(const vec3<T>& p) const {
        return {cell(p.x, bounds.lower.x), cell(p.y, bounds.lower.y), cell(p.z, bounds.lower.z)};
    }
    /// Level at which a box that spans these base cells is stored.
    [[nodiscard]] ABUT_HD static int level(const vec3<std::int32_t>& first, const vec3<std::int32_t>& last) {
        const std::int32_t span = detail::greatest(last.x - first.x, last.y - first.y, last.z - first.z);
        int level = 0;
        while ((1 << level) < span) ++level;
        return level;
    }
    /// The key of a cell of a level, which is at `at` among the cells of that level.
    [[nodiscard]] ABUT_HD static std::uint64_t key(int level, const vec3<std::int32_t>& at) {
        return ((static_cast<std::uint64_t>(level) << axis_bits | static_cast<std::uint64_t>(at.x)) << axis_bits |
                static_cast<std::uint64_t>(at.y))
                   << axis_bits |
               static_cast<std::uint64_t>(at.z);
    }
};

/// A shape in its cell.
template <scalar T>
struct grid_item {
    aabb<T> box;       ///< around it
    std::uint32_t id;  ///< its place in the set
};

/// A trivially copyable view of a grid.
template <scalar T, memory_space Space>
struct grid_view {
    using scalar_type = T;                                                   ///< float or double
    using memory_space = Space;                                              ///< where the memory lies
    static constexpr std::uint64_t no_key = static_cast<std::uint64_t>(-1);  ///< the key of a free slot

    const grid_frame<T>* frame = nullptr;   ///< one
    const std::uint64_t* keys = nullptr;    ///< of each slot, by open addressing
    const std::uint32_t* starts = nullptr;  ///< slots + 1: items of slot s are [starts[s], starts[s + 1])
    const grid_item<T>* items = nullptr;    ///< as many as shapes, by slots
    std::uint64_t slots = 0;                ///< a power of two
    std::size_t count = 0;                  ///< number of shapes

    /// Number of shapes.
    [[nodiscard]] ABUT_HD std::size_t size() const { return count; }
    /// The slot at which the search for a key begins.
    [[nodiscard]] ABUT_HD static std::uint64_t first_slot(std::uint64_t key, std::uint64_t slots) {
        key = (key ^ (key >> 31)) * 0x9e3779b97f4a7c15u;  // Fibonacci hashing
        return (key >> 20) & (slots - 1);
    }
    /// The slot of a cell, or `slots` if the cell is empty.
    [[nodiscard]] ABUT_HD std::uint64_t find(std::uint64_t key) const {
        for (std::uint64_t slot = first_slot(key, slots);; slot = (slot + 1) & (slots - 1)) {
            if (keys[slot] == key) return slot;
            if (keys[slot] == no_key) return slots;
        }
    }
};

/// A grid over the shapes of a set, which it keeps alive. Immutable; any number of threads may query it.
/// @ingroup indices
template <class Set, memory_space Space>
class grid {
public:
    using set_type = Set;                             ///< the set
    using scalar_type = typename Set::scalar_type;    ///< float or double
    using shape_type = typename Set::shape_type;      ///< what a shape is
    using memory_space = Space;                       ///< where the memory lies
    using view_type = grid_view<scalar_type, Space>;  ///< what algorithms read

    /// What owns the cells, as grid_view reads them; all empty where there are no shapes.
    struct storage {
        execution::buffer<grid_frame<scalar_type>, Space> frame;  ///< one
        execution::buffer<std::uint64_t, Space> keys;             ///< of each slot
        execution::buffer<std::uint32_t, Space> starts;           ///< of each slot, and the end
        execution::buffer<grid_item<scalar_type>, Space> items;   ///< as many as shapes
        std::shared_ptr<const detail::point_cells<scalar_type>> clearances = {};  ///< of points, where asked for
    };

    /// For make_grid: of a set and the cells over it, which are not checked.
    grid(Set set, std::shared_ptr<const storage> cells) : set_(std::move(set)), cells_(std::move(cells)) {}

    /// The set, in the memory of the grid.
    [[nodiscard]] const Set& set() const { return set_; }
    /// Number of shapes.
    [[nodiscard]] std::size_t size() const { return set_.size(); }
    /// What kernels and walks read; for as long as the grid lives.
    [[nodiscard]] view_type view() const {
        return {cells_->frame.data(), cells_->keys.data(), cells_->starts.data(),
                cells_->items.data(), cells_->keys.size(), set_.size()};
    }
    /// The CUDA device that the grid lies on; -1 for the host.
    [[nodiscard]] int device() const { return cells_->frame.device(); }
    /// Memory of the grid itself, in bytes.
    [[nodiscard]] std::size_t bytes() const {
        return cells_->frame.capacity_bytes() + cells_->keys.capacity_bytes() + cells_->starts.capacity_bytes() +
               cells_->items.capacity_bytes() + (clearances() != nullptr ? clearances()->bytes() : 0);
    }
    /// What grid_options::clearances asks for; null where nobody did. For the library's own use.
    [[nodiscard]] const detail::point_cells<scalar_type>* clearances() const { return cells_->clearances.get(); }

private:
    Set set_;
    std::shared_ptr<const storage> cells_;
};

namespace detail {

/// Box of all shapes and sum of half their longest sides.
template <class T>
struct extent_sum {
    aabb<T> box;
    double half_sides;
};

template <shape_view Shapes>
struct measure_shape {
    Shapes shapes;
    ABUT_HD auto operator()(std::size_t i) const {
        const auto box = bounds(shapes[i]);
        return extent_sum<typename Shapes::scalar_type>{box, longest(half_sides<double>(box))};
    }
};

struct add_extents {
    template <class T>
    ABUT_HD extent_sum<T> operator()(const extent_sum<T>& a, const extent_sum<T>& b) const {
        return {merge(a.box, b.box), a.half_sides + b.half_sides};
    }
};

/// Half the width of `count` cubes that fill a box of these half sides, side by side along the axes along which it is wider.
ABUT_HD inline double half_spacing(const vec3<double>& half, double count) {
    const double a = longest(half), c = least(half.x, half.y, half.z),
                 b = greatest(least(half.x, half.y), least(greatest(half.x, half.y), half.z));
    if (!(a > 0)) return 0;
    const double in_space = a * std::cbrt(b / a * (c / a) / count), in_plane = a * std::sqrt(b / a / count);
    return in_space < c ? in_space : in_plane < b ? in_plane : a / count;
}

template <class T>
struct set_frame {
    const extent_sum<T>* sum;
    grid_frame<T>* frame;
    double count, cell_width;

    ABUT_HD void operator()(std::size_t) const {
        constexpr double cells = 1 << grid_frame<T>::axis_bits;
        constexpr double tiny = 4 * smallest_normal<double>;
        const vec3<double> half = half_sides<double>(sum->box);
        const double half_extent = longest(half);
        double half_width = cell_width > 0 ? cell_width / 2 : 2 * (sum->half_sides / count);
        if (half_width == 0) half_width = half_spacing(half, count);
        if (!(half_width <= half_extent)) half_width = half_extent;  // also where the sum has overflowed
        half_width = greatest(half_width, half_extent / cells, tiny);
        *frame = {sum->box, 0.5 / half_width, 0};
    }
};

/// Finds or claims the slot of each shape's cell and counts the shapes in it.
template <shape_view Shapes>
struct count_in_cells {
    using T = typename Shapes::scalar_type;
    using view = grid_view<T, host_space>;
    Shapes shapes;
    grid_frame<T>* frame;
    std::uint64_t* keys;
    std::uint64_t slots;
    std::uint32_t* counts;
    std::uint64_t* position;  // slot and rank within it, for each shape

    ABUT_HD void operator()(std::size_t i) const {
        const aabb<T> box = bounds(shapes[i]);
        const vec3<std::int32_t> first = frame->cell(box.lower), last = frame->cell(box.upper);
        const int level = grid_frame<T>::level(first, last);
        const std::uint64_t key = grid_frame<T>::key(level, {first.x >> level, first.y >> level, first.z >> level});
        std::uint64_t slot = view::first_slot(key, slots);
        for (;; slot = (slot + 1) & (slots - 1)) {
            const std::uint64_t found = execution::atomic_compare_exchange(&keys[slot], view::no_key, key);
            if (found == view::no_key || found == key) break;
        }
        if (const std::uint32_t bit = 1u << level; (execution::atomic_load(&frame->levels_in_use) & bit) == 0) {
            execution::atomic_or(&frame->levels_in_use, bit);
        }
        position[i] = slot << 32 | execution::atomic_add(&counts[slot], 1u);
    }
};

template <shape_view Shapes>
struct put_in_cells {
    using T = typename Shapes::scalar_type;
    Shapes shapes;
    const std::uint32_t* starts;
    const std::uint64_t* position;
    grid_item<T>* items;

    ABUT_HD void operator()(std::size_t i) const {
        const auto rank = static_cast<std::uint32_t>(position[i]);
        items[starts[position[i] >> 32] + rank] = {bounds(shapes[i]), static_cast<std::uint32_t>(i)};
    }
};

}  // namespace detail

/// @addtogroup indices
///@{

/// Builds a grid over the shapes of `set` in the policy's memory. A grid takes 24 to 48 bytes a shape for the table, and a
/// box and an id a shape. Throws error where the cell width is negative or not a number, and else as the group says.
template <execution_policy Policy, class Set>
[[nodiscard]] auto make_grid(const Policy& on, const Set& set, const grid_options& options = {}) {
    if (!(options.cell_width >= 0)) {
        throw error("abut::make_grid: cell_width is " + detail::shortest(options.cell_width) + "; expected 0 or more");
    }
    if constexpr (detail::can_reside<Policy, Set>()) {
        auto resident = detail::make_resident(on, set, "abut::make_grid");
        using grid_type = grid<decltype(resident), space_of<Policy>>;
        using T = typename grid_type::scalar_type;
        const auto shapes = detail::view_of(resident);
        using shapes_type = std::remove_const_t<decltype(shapes)>;
        const std::size_t n = shapes.size();
        auto cells = std::make_shared<typename grid_type::storage>();
        if (n > 0) {
            std::size_t slots = 2;
            while (slots < 2 * n) slots *= 2;
            cells->frame = execution::buffer_of<Policy, grid_frame<T>>(on, 1);
            cells->keys = execution::buffer_of<Policy, std::uint64_t>(on, slots);
            cells->starts = execution::buffer_of<Policy, std::uint32_t>(on, slots + 1);
            cells->items = execution::buffer_of<Policy, grid_item<T>>(on, n);
            execution::buffer_of<Policy, detail::extent_sum<T>> sum(on, 1);
            execution::buffer_of<Policy, std::uint64_t> position(on, n);
            reduce_into(on, n, sum.data(), detail::extent_sum<T>{empty_box<T>(), 0.0}, detail::add_extents{},
                        detail::measure_shape<shapes_type>{shapes});
            for_each_index(
                on, 1, detail::set_frame<T>{sum.data(), cells->frame.data(), static_cast<double>(n), options.cell_width});
            fill(on, cells->keys.data(), slots, grid_type::view_type::no_key);
            fill(on, cells->starts.data(), slots, std::uint32_t{0});
            for_each_index(on, n,
                           detail::count_in_cells<shapes_type>{shapes, cells->frame.data(), cells->keys.data(), slots,
                                                               cells->starts.data(), position.data()});
            exclusive_scan(on, cells->starts.data(), slots);
            for_each_index(
                on, n,
                detail::put_in_cells<shapes_type>{shapes, cells->starts.data(), position.data(), cells->items.data()});
            synchronize(on);
            if constexpr (host_policy<Policy> && std::same_as<typename grid_type::shape_type, vec3<T>>) {
                if (options.clearances) {
                    cells->clearances = std::make_shared<const detail::point_cells<T>>(shapes, static_cast<std::size_t>(-1));
                }
            }
        }
        return grid_type(std::move(resident), std::move(cells));
    } else {
        return detail::refused();
    }
}

/// The same with a cell width alone.
template <execution_policy Policy, class Set>
[[nodiscard]] auto make_grid(const Policy& on, const Set& set, double cell_width) {
    return make_grid(on, set, grid_options{.cell_width = cell_width});
}

///@}

}  // namespace abut
