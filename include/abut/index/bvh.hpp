// SPDX-License-Identifier: MIT
#pragma once

// Bounding volume hierarchies: how a tree lies in memory, who owns it, and how it is read. Builders are in files of their
// own (lbvh.hpp, mean_split.hpp, binned_sah.hpp, ploc.hpp), and so are the layouts that a finished tree can be brought to
// (quantised.hpp, wide.hpp, bounded.hpp, experimental/leafless.hpp); traversals are in traverse/ and read nodes through the
// accessor concept below alone, so that another layout needs no second traversal.

#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <type_traits>
#include <utility>

#include <abut/execution/buffer.hpp>
#include <abut/execution/policy.hpp>
#include <abut/shape/bounds.hpp>
#include <abut/shape/view.hpp>

namespace abut {

/// Reference to a child: a leaf with one shape, or an inner node.
struct bvh_child {
    static constexpr std::uint32_t leaf_bit = std::uint32_t{1} << 31;  ///< set in leaves
    std::uint32_t bits;                                                ///< the bit and the number, as they lie in memory

    /// The leaf of a shape, by its id, which is below 2^31.
    ABUT_HD static constexpr bvh_child leaf(std::uint32_t shape) { return {shape | leaf_bit}; }
    /// An inner node, by its number, which is below 2^31.
    ABUT_HD static constexpr bvh_child inner(std::uint32_t node) { return {node}; }
    /// Whether it is a leaf.
    [[nodiscard]] ABUT_HD constexpr bool is_leaf() const { return (bits & leaf_bit) != 0; }
    /// Id of the leaf's shape, or number of the inner node.
    [[nodiscard]] ABUT_HD constexpr std::uint32_t index() const { return bits & ~leaf_bit; }

    friend constexpr bool operator==(bvh_child, bvh_child) = default;
};

/// An inner node: its two children with their boxes, one cache line in single precision. Both boxes come with one fetch.
template <scalar T>
struct alignas(sizeof(T) == 4 ? 64 : 16) bvh_node {
    aabb<T> bounds[2];   ///< boxes around the children
    bvh_child child[2];  ///< the children
    /// So that nodes are written whole: memory has to read what it is to write a part of.
    std::uint32_t unused[sizeof(T) == 4 ? 2 : 1] = {};
};

/// Depth of the deepest leaf that any builder may make, and so the size of a traversal's stack. Linear builders stay below
/// it by construction: 63 bits of Morton code and 31 bits of position. The others halve what would get deeper.
inline constexpr int bvh_max_depth = 96;

/// What a traversal needs of a tree. The accessors may run wherever the layout's memory can be read, take constant time,
/// and may hand out boxes that are larger than they were built, never smaller.
template <class L>
concept bvh_layout = std::is_trivially_copyable_v<L> && memory_space<typename L::memory_space> &&
    requires(const L& tree, int slot) {
    typename L::scalar_type;
    { tree.size() } -> std::convertible_to<std::size_t>;  // number of shapes; the rest is for trees that have some
    { tree.root() } -> std::same_as<bvh_child>;
    { tree.root_bounds() } -> std::convertible_to<aabb<typename L::scalar_type>>;
    { L::width } -> std::convertible_to<int>;    // the most children that a node has
    { L::nested } -> std::convertible_to<bool>;  // whether each box holds its children's, and not their shapes alone
    typename L::node_type;                       // a node; its children are in slots 0, 1, ...
    { tree.fetch(std::uint32_t{}) } -> std::convertible_to<typename L::node_type>;
    { tree.children(tree.fetch(std::uint32_t{})) } -> std::same_as<int>;  // two at least; always two where width is 2
    { tree.bounds(tree.fetch(std::uint32_t{}), slot) } -> std::convertible_to<aabb<typename L::scalar_type>>;
    { tree.child(tree.fetch(std::uint32_t{}), slot) } -> std::same_as<bvh_child>;
    tree.prefetch(bvh_child{});  // a hint that the child may be fetched soon
};

/// Root of a tree; lies with the nodes, where walks read it.
template <scalar T>
struct bvh_root {
    aabb<T> bounds;   ///< around all shapes
    bvh_child child;  ///< the root, or the leaf of a tree of one shape
};

/// What views of all layouts have in common: where the nodes and the root lie, and the number of shapes. `Node` is what lies
/// in memory, `Width` the number of its children; a layout whose nodes may have fewer says so itself.
template <scalar T, memory_space Space, class Node, int Width = 2>
struct bvh_view_base {
    using scalar_type = T;                ///< float or double
    using memory_space = Space;           ///< where the nodes lie
    using stored_node = Node;             ///< a node as it lies there
    static constexpr int width = Width;   ///< the most children that a node has
    static constexpr bool nested = true;  ///< a node's box holds those of its children

    const Node* nodes = nullptr;       ///< in the tree's memory
    const bvh_root<T>* top = nullptr;  ///< likewise
    std::size_t count = 0;             ///< number of shapes

    /// Number of shapes.
    [[nodiscard]] ABUT_HD std::size_t size() const { return count; }
    /// The root of a tree that has shapes.
    [[nodiscard]] ABUT_HD bvh_child root() const { return top->child; }
    /// The box around all shapes of a tree that has some.
    [[nodiscard]] ABUT_HD aabb<T> root_bounds() const { return top->bounds; }
    /// How many children a node has.
    [[nodiscard]] ABUT_HD static int children(const auto&) { return Width; }
    /// A hint on the host that a child will be fetched soon; nothing on a device.
    ABUT_INLINE ABUT_HD void prefetch([[maybe_unused]] bvh_child c) const {
#if !ABUT_DEVICE_CODE
        if (c.is_leaf()) return;
        const auto* const line = reinterpret_cast<const char*>(nodes + c.index());
        ABUT_PREFETCH(line);
        if constexpr (sizeof(Node) > 64) ABUT_PREFETCH(line + 64);
        if constexpr (sizeof(Node) > 128) ABUT_PREFETCH(line + 128);
        if constexpr (sizeof(Node) > 192) ABUT_PREFETCH(line + 192);
#endif
    }
};

/// The least ids below a tree's nodes, by nodes (bvh_options::least_ids, index/least_ids.hpp); null where nobody asked for
/// them. All trees of one topology share them.
template <memory_space Space>
using shared_least_ids = std::shared_ptr<const execution::buffer<std::uint32_t, Space>>;

/// What owns a tree of a layout that has nodes and a root and nothing else.
template <class Layout, scalar T, memory_space Space>
struct bvh_storage {
    /// What a kernel sees.
    using view = typename Layout::template view<T, Space>;
    execution::buffer<typename view::stored_node, Space> nodes;  ///< one fewer than shapes where nodes have two children
    execution::buffer<bvh_root<T>, Space> root;                  ///< one; none where there are no shapes
    shared_least_ids<Space> least_ids = {};                      ///< those of the tree that it was made of

    /// The view of a tree of so many shapes.
    [[nodiscard]] view view_of(std::size_t shapes) const { return {{nodes.data(), root.data(), shapes}}; }
    /// Its memory.
    [[nodiscard]] std::size_t bytes() const { return nodes.capacity_bytes() + root.capacity_bytes(); }
    /// A copy in host memory. Waits for it.
    [[nodiscard]] bvh_storage<Layout, T, host_space> to_host() const { return {nodes.to_host(), root.to_host()}; }
};

/// The standard layout: full precision, both children's boxes in their parent.
template <scalar T, memory_space Space>
struct bvh_view : bvh_view_base<T, Space, bvh_node<T>> {
    /// A node as walks read it.
    using node_type = bvh_node<T>;

    /// Node, box and child by number, as bvh_layout says. On hosts and devices.
    ///@{
    [[nodiscard]] ABUT_HD const node_type& fetch(std::uint32_t node) const { return this->nodes[node]; }
    [[nodiscard]] ABUT_HD static const aabb<T>& bounds(const node_type& n, int slot) { return n.bounds[slot]; }
    [[nodiscard]] ABUT_HD static bvh_child child(const node_type& n, int slot) { return n.child[slot]; }
    ///@}
};

/// What refit derives of a topology (index/refit_plan.hpp).
template <memory_space Space>
struct refit_plan;

/// Where the first refit of a tree leaves its plan, for all trees of that topology.
template <memory_space Space>
struct shared_refit_plan {
    std::mutex making;                              ///< held by who looks or makes
    std::shared_ptr<const refit_plan<Space>> made;  ///< null before the first refit
};

namespace detail {
class ties_of_tree;
}
/// Where the first query that meets many equal values leaves what it finds of a tree's copies, for those that follow
/// (index/ties.hpp).
struct kept_ties {
    std::mutex making;                                 ///< held by who makes it
    std::atomic<bool> is_known{false};                 ///< from when on `made` may be read
    std::shared_ptr<const detail::ties_of_tree> made;  ///< null before
};

/// The layout that trees are built in.
struct standard_layout {
    /// What kernels see.
    template <scalar T, memory_space Space>
    using view = bvh_view<T, Space>;

    /// A finished tree: one node fewer than it has shapes (none for none), and one root.
    template <scalar T, memory_space Space>
    struct storage {
        execution::buffer<bvh_node<T>, Space> nodes;  ///< one fewer than shapes
        execution::buffer<bvh_root<T>, Space> root;   ///< one; none where there are no shapes
        /// Shared by all trees that refit makes of one.
        std::shared_ptr<shared_refit_plan<Space>> plan = std::make_shared<shared_refit_plan<Space>>();
        /// Whether node k lies between leaves k and k + 1 of an order, as the linear builder makes them.
        bool along_curve = false;
        shared_least_ids<Space> least_ids = {};  ///< shared alike
        bool is_refitted_in_place = false;       ///< its boxes change (collide/async_index.hpp)

        /// The view of a tree of so many shapes.
        [[nodiscard]] view<T, Space> view_of(std::size_t shapes) const { return {{nodes.data(), root.data(), shapes}}; }
        /// Its memory, without the plan.
        [[nodiscard]] std::size_t bytes() const { return nodes.capacity_bytes() + root.capacity_bytes(); }
        /// A copy in host memory, without the plan. Waits for it.
        [[nodiscard]] storage<T, host_space> to_host() const { return {nodes.to_host(), root.to_host()}; }
    };
};

/// How a tree lies in memory: standard_layout, quantised_layout, wide_layout, bounded_layout<V> (in headers of these
/// names), leafless_layout (in experimental/). A layout names the view that traversals read and the storage that owns it,
/// which has `view_of(shapes)`, `bytes()`, `to_host()` and the buffer `root` of one bvh_root, whose box holds every box
/// that the view hands out.
template <class L>
concept bvh_layout_kind = requires(const typename L::template storage<float, host_space>& tree) {
    requires bvh_layout<typename L::template view<float, host_space>>;
    { tree.view_of(std::size_t{}) } -> std::same_as<typename L::template view<float, host_space>>;
    { tree.bytes() } -> std::same_as<std::size_t>;
    { tree.to_host() } -> std::same_as<typename L::template storage<float, host_space>>;
    { tree.root.data() } -> std::same_as<const bvh_root<float>*>;
};

/// @defgroup indices Trees and grids
///
/// What queries look in. `make_bvh` builds a tree and `make_grid` a grid over the shapes of a set, a view or one shape.
/// `refit` brings a tree to shapes that have moved. `quantised`, `wide` and `bounded_by` convert a tree to another
/// layout, and `quality` measures one. docs/hierarchies.md says which to take.
///
/// @par Memory
/// An index lies in the memory of the policy that made it, and keeps its set there: a set in the policy's memory is shared,
/// a set in host memory is copied to the device under `cuda`. Of a view it keeps the view alone, whose arrays have to
/// outlive it. Indices are immutable, and copies share their storage. Under `cuda` the policy's stream has to outlive them.
///
/// @par Errors
/// - `invalid_geometry`: a view or a single shape holds no geometry. Sets were checked when they were made.
/// - `error`: an option is none; a set, a view or an index lies on another device; and as each function says.
/// - `capacity_error`: a view has 2^31 elements or more.
/// - `std::bad_alloc`, `cuda_error`.
///
/// @par Synchronisation
/// Each call returns when its index is complete; under `cuda` it waits for the policy's stream. Then any stream of that
/// device may read it.
///
/// @par Example
/// @snippet trees.cpp indices
///@{

/// How make_bvh builds. The choice moves speed, never results.
enum class bvh_builder : unsigned char {
    linear,      ///< sorted along a Morton curve (lbvh.hpp): fast to build, on every policy
    mean_split,  ///< top-down, at the mean of the axis of largest variance (mean_split.hpp): serial and openmp
    sah,         ///< top-down, by the surface area heuristic over bins (binned_sah.hpp): serial and openmp
    ploc         ///< bottom-up, what costs least surface to join (ploc.hpp): better to query, on every policy
};

/// Options of make_bvh.
struct bvh_options {
    /// Bits of the Morton codes that order the leaves: 30, 63, or 0 to choose from the scene: as few as tell that many
    /// shapes apart, at most 30, and 63 where these turn out to leave an eighth of the shapes in crowds of one code, as in
    /// small clusters far apart. The choice moves speed, never results. Of linear and ploc.
    int morton_bits = 0;
    /// By which rule shapes are joined or divided.
    bvh_builder builder = bvh_builder::linear;
    /// Whether to keep the least id of the shapes below each node, 4 bytes a shape: for trees that are asked for `distance`
    /// again and again where something touches, or much is equally far. Trees that are refitted or converted share them. Of
    /// serial and openmp; a device has no use for them and keeps none.
    bool least_ids = false;
};

/// A tree over the shapes of a set, which it keeps alive. Immutable; any number of threads may query it. `Set` is an owner
/// (mesh, spheres, ...) or a view over the caller's arrays, in the same memory as the tree.
template <class Set, memory_space Space, bvh_layout_kind Layout = standard_layout>
class bvh {
public:
    using set_type = Set;                                                   ///< the set
    using scalar_type = typename Set::scalar_type;                          ///< float or double
    using shape_type = typename Set::shape_type;                            ///< what a shape is
    using memory_space = Space;                                             ///< where the memory lies
    using layout_type = Layout;                                             ///< how the tree lies in memory
    using view_type = typename Layout::template view<scalar_type, Space>;   ///< what algorithms read
    using storage = typename Layout::template storage<scalar_type, Space>;  ///< what owns the nodes

    /// For builders: of a set and the nodes over it, which are not checked.
    bvh(Set set, std::shared_ptr<const storage> tree)
        : parts_(std::make_shared<parts>(std::move(set), std::move(tree))) {}

    /// The set, in the memory of the tree.
    [[nodiscard]] const Set& set() const { return parts_->set; }
    /// Number of shapes.
    [[nodiscard]] std::size_t size() const { return set().size(); }
    /// What kernels and walks read; for as long as the tree lives.
    [[nodiscard]] view_type view() const { return stored().view_of(size()); }
    /// The CUDA device that the tree lies on; -1 for the host.
    [[nodiscard]] int device() const { return stored().root.device(); }
    /// Memory of the tree itself, in bytes, without least ids, what refit keeps, and what queries find of copies.
    [[nodiscard]] std::size_t bytes() const { return stored().bytes(); }
    /// What owns the nodes.
    [[nodiscard]] const storage& stored() const { return *parts_->tree; }
    /// For queries: what they find of copies.
    [[nodiscard]] kept_ties& ties() const { return parts_->ties; }
    /// The box around all shapes; empty where there are none. The first call on a tree in device memory copies it to the
    /// host and waits for that; on a tree of an async_index each call does.
    [[nodiscard]] aabb<scalar_type> bounds() const {
        if constexpr (requires { stored().is_refitted_in_place; }) {
            if (stored().is_refitted_in_place) return read_bounds();
        }
        std::call_once(parts_->once, [this] { parts_->bounds = read_bounds(); });
        return parts_->bounds;
    }

private:
    [[nodiscard]] aabb<scalar_type> read_bounds() const {
        bvh_root<scalar_type> root{empty_box<scalar_type>(), {}};
        stored().root.read(&root);
        return root.bounds;
    }
    /// All of a tree: so a copy counts one owner, and not one for each part. Queries copy trees.
    struct parts {
        Set set;
        std::shared_ptr<const storage> tree;
        std::once_flag once{};
        aabb<scalar_type> bounds{};  ///< copied to the host
        kept_ties ties{};

        parts(Set s, std::shared_ptr<const storage> t) : set(std::move(s)), tree(std::move(t)) {}
    };
    std::shared_ptr<parts> parts_;
};

/// In the place of <abut/experimental/leafless.hpp>, which has it of trees in the standard layout: does not compile.
template <class Policy, class Tree>
const Tree& leafless(const Policy&, const Tree& tree) {
    static_assert(sizeof(Tree) == 0, "abut: leafless is in another header: include <abut/experimental/leafless.hpp>");
    return tree;
}

///@}

}  // namespace abut
