// SPDX-License-Identifier: MIT
#pragma once

// What walks for the least value know of equal ones, on a host. The least id wins among ties, so that where nothing is known
// every tie has to be visited: that makes n copies of a shape cost n visits each time. A walk therefore counts the ties that
// it meets. Once they have cost about as much, it is found out which nodes hold copies of one shape alone, and the least id
// below each node (least_ids.hpp). Copies are as near and are met as soon as each other, whatever is measured, so that one
// visit is enough for all of them. Trees keep what was found, but for chains of copies, which are for the rest of a call.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <abut/index/bvh.hpp>
#include <abut/index/least_ids.hpp>
#include <abut/shape/view.hpp>

namespace abut::detail {

/// What lies below the nodes of a tree, as walks read it. Null where it is not known; so it is on a device.
struct known_below {
    static constexpr std::uint32_t none = static_cast<std::uint32_t>(-1);
    const std::uint32_t* of_nodes = nullptr;  ///< a leaf of the least id, if all are copies of its shape, or else that id
    const std::uint32_t* links = nullptr;     ///< the links to the leaves of the least ids (traverse/pair_walk.hpp)
    const std::uint32_t* copies = nullptr;    ///< by shapes: the next copy by ids, of those below one node, or none

    /// A child, or if copies of one shape are all that is below it, the leaf of the least of these.
    [[nodiscard]] ABUT_INLINE ABUT_HD bvh_child fold([[maybe_unused]] bvh_child child) const {
#if !ABUT_DEVICE_CODE
        if (of_nodes != nullptr && !child.is_leaf() && bvh_child{of_nodes[child.index()]}.is_leaf()) {
            return {of_nodes[child.index()]};
        }
#endif
        return child;
    }
    [[nodiscard]] std::uint32_t least_id(std::uint32_t node) const { return bvh_child{of_nodes[node]}.index(); }
};

/// What belongs to it.
class ties_of_tree {
public:
    /// Of a tree with shapes that lie in host memory. In time proportional to their number (with `chains` of copies, as for
    /// a sort); 8 bytes a shape, with chains 12, and 4 more while it works. Throws std::bad_alloc.
    template <bvh_layout Tree, shape_view Shapes>
    void find(const Tree& tree, const Shapes& shapes, bool chains) {
        constexpr std::uint32_t width = Tree::width;
        of_nodes_.reserve(tree.size());
        links_.reserve(tree.size());
        if (chains) copies_.assign(tree.size(), none);
        for_each_node_up(tree, [&](std::uint32_t at) {
            const auto& node = tree.fetch(at);
            std::uint32_t least = none, link = 0, first = none;
            bool copies = true;
            for (int slot = 0; slot < tree.children(node); ++slot) {
                const bvh_child child = tree.child(node, slot);
                const bvh_child below{child.is_leaf() ? child.bits : of_nodes_[child.index()]};
                copies = copies && below.is_leaf() && (slot == 0 || are_copies(shapes, first, below.index()));
                first = slot == 0 ? below.index() : first;
                if (below.index() >= least && slot > 0) continue;
                least = below.index();
                link = child.is_leaf() ? width * at + static_cast<std::uint32_t>(slot) : links_[child.index()];
            }
            if (copies && chains) join(tree, node);
            place_of(of_nodes_, at) = copies ? bvh_child::leaf(least).bits : least;
            place_of(links_, at) = link;
        });
    }
    [[nodiscard]] known_below known() const {
        return {of_nodes_.data(), links_.data(), copies_.empty() ? nullptr : copies_.data()};
    }

private:
    static constexpr std::uint32_t none = known_below::none;
    /// By their bits: then what is computed of them is the same. What is told apart here though it is equal is visited.
    template <shape_view Shapes>
    static bool are_copies(const Shapes& shapes, std::uint32_t i, std::uint32_t j) {
        const typename Shapes::shape_type s = shapes[i], t = shapes[j];
        return std::memcmp(&s, &t, sizeof(s)) == 0;
    }
    /// The copies below the children of a node are those below the node, ascending.
    template <bvh_layout Tree>
    void join(const Tree& tree, const typename Tree::node_type& node) {
        std::uint32_t all = none;
        for (int slot = 0; slot < tree.children(node); ++slot) {
            const bvh_child child = tree.child(node, slot);
            std::uint32_t other = child.is_leaf() ? child.index() : bvh_child{of_nodes_[child.index()]}.index();
            std::uint32_t* end = &all;
            while (*end != none && other != none) {
                if (other < *end) std::swap(other, *end);
                end = &copies_[*end];
            }
            if (other != none) *end = other;
        }
    }

    std::vector<std::uint32_t> of_nodes_, links_, copies_;
};

/// What a tree keeps of it: nothing before somebody asks.
inline known_below known_of(const kept_ties& kept) {
    return kept.is_known.load(std::memory_order_acquire) ? kept.made->known() : known_below{};
}
/// The same, found out by who asks first, from any thread, as `ties_of_tree` says.
template <bvh_layout Tree, shape_view Shapes>
known_below find_ties(kept_ties& kept, const Tree& tree, const Shapes& shapes, bool chains) {
    const std::scoped_lock lock(kept.making);
    if (kept.made == nullptr) {
        const auto made = std::make_shared<ties_of_tree>();
        made->find(tree, shapes, chains);
        kept.made = made;
        kept.is_known.store(true, std::memory_order_release);
    }
    return kept.made->known();
}

/// Counts the ties that walks of one call meet, from any threads.
class tie_watch {
public:
    static constexpr std::uint32_t of_neighbours = 16;  ///< who share a corner
    std::uint32_t few = of_neighbours;  ///< ties of one walk that are none to care about; walks that share a sink count all
    using both_known = std::array<known_below, 2>;

    tie_watch(const tie_watch&) = delete;
    tie_watch& operator=(const tie_watch&) = delete;

    /// Whether it is known by now what lies below the nodes; and what it is, of tree k.
    [[nodiscard]] bool is_known() const { return is_known_.load(std::memory_order_acquire); }
    [[nodiscard]] known_below known(std::size_t k) const { return is_known() ? known_[k] : known_below{least_ids_[k]}; }
    /// What a sink knows a shape by.
    [[nodiscard]] static std::uint64_t key_of(std::uint32_t id) { return id; }
    /// Of trees that keep their least ids.
    void begin_with(const std::uint32_t* of_a, const std::uint32_t* of_b) { least_ids_ = {of_a, of_b}; }
    /// A walk has met one more, beyond a few. Whether it is known by now: another walk may have met enough.
    bool met() {
        if (is_known()) return true;
        if (met_.fetch_add(1, std::memory_order_relaxed) + 1 < enough_) return false;
        const std::scoped_lock lock(making_);
        if (!is_known()) know(find());
        return true;
    }

protected:
    /// What is to be known costs some 10 ns a shape; a tie costs as much or more where a point looks, and 400 ns of two shapes
    /// or of a line.
    explicit tie_watch(std::size_t enough) : enough_(enough + 64) {}
    ~tie_watch() = default;
    virtual both_known find() = 0;
    void know(const both_known& found) {
        known_ = found;
        is_known_.store(true, std::memory_order_release);
    }

private:
    std::size_t enough_;
    std::atomic<std::size_t> met_{0};
    std::atomic<bool> is_known_{false};
    std::mutex making_;
    both_known known_;
    std::array<const std::uint32_t*, 2> least_ids_{};
};

/// The same of one tree.
template <class Tree, class Shapes>
class ties_of_one : public tie_watch {
public:
    /// It is found out after a tie for each so many shapes. With chains of copies, where walks look for several shapes.
    ties_of_one(std::size_t shapes_a_tie, bool chains, kept_ties& kept, const Tree& tree, const Shapes& shapes)
        : tie_watch(tree.size() / shapes_a_tie), tree_(tree), shapes_(shapes), chains_(chains), kept_(chains ? of_call_ : kept) {
        if (kept_.is_known) know({known_of(kept_)});
    }

private:
    both_known find() final { return {find_ties(kept_, tree_, shapes_, chains_)}; }

    Tree tree_;
    Shapes shapes_;
    bool chains_;
    kept_ties of_call_, &kept_;
};
/// Of two objects with `tree` and `shapes`, where these keep it.
template <class A, class B>
class ties_of_two : public tie_watch {
public:
    ties_of_two(kept_ties& of_a, const A& a, kept_ties& of_b, const B& b)
        : tie_watch((a.tree.size() + b.tree.size()) / 128), of_a_(of_a), of_b_(of_b), a_(a), b_(b) {
        if (of_a.is_known && of_b.is_known) know({known_of(of_a), known_of(of_b)});
    }

private:
    both_known find() final {
        return {find_ties(of_a_, a_.tree, a_.shapes, false), find_ties(of_b_, b_.tree, b_.shapes, false)};
    }

    kept_ties &of_a_, &of_b_;
    const A& a_;
    const B& b_;
};

/// What belongs to many trees, by the numbers of objects: anything with `tree` and `shapes`. Of each it is found out when
/// somebody asks first, from any thread.
class ties_of_objects {
public:
    /// Of the trees of all objects, which keep it, but with chains.
    template <class Index>
    explicit ties_of_objects(const std::vector<Index>& trees, bool chains = false) : all_(trees.size()), chains_(chains) {
        for (std::size_t k = 0; k < trees.size(); ++k) all_[k].kept = chains ? &all_[k].of_call : &trees[k].ties();
    }

    [[nodiscard]] kept_ties& of(std::size_t k) { return *all_[k].kept; }
    [[nodiscard]] known_below known(std::size_t k) const { return known_of(*all_[k].kept); }
    [[nodiscard]] bool is_known(std::size_t k) const { return all_[k].kept->is_known.load(std::memory_order_acquire); }
    template <class Object>
    void find(std::size_t k, const Object& object) { find_ties(of(k), object.tree, object.shapes, chains_); }
    /// One more tie beyond a few of a walk, in object k.
    std::size_t count(std::size_t k) { return all_[k].met.fetch_add(1, std::memory_order_relaxed) + 1; }

private:
    struct one {
        std::atomic<std::size_t> met{0};
        kept_ties of_call;
        kept_ties* kept = nullptr;
    };
    std::vector<one> all_;
    bool chains_;
};
/// Watches walks of one of them, the shapes of which go by keys from `first_key` on.
template <class Object>
struct ties_of_body {
    static constexpr std::uint32_t few = tie_watch::of_neighbours;
    ties_of_objects& all;
    std::size_t k;
    const Object& object;
    std::uint64_t first_key;

    [[nodiscard]] known_below known(std::size_t) const { return all.known(k); }
    [[nodiscard]] bool met() const {
        if (!all.is_known(k)) {
            if (all.count(k) < object.tree.size() / 16 + 64) return false;
            all.find(k, object);
        }
        return true;
    }
    [[nodiscard]] std::uint64_t key_of(std::uint32_t id) const { return first_key + id; }
};

}  // namespace abut::detail
