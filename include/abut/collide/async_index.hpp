// SPDX-License-Identifier: MIT
#pragma once

// Indices that a stream brings to where shapes have moved: refit in place, without a wait. What an index shares with others
// never changes; so an async_index has boxes of its own, and of an impact_index vertices of its own too.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include <abut/collide/async.hpp>
#include <abut/collide/impact_index.hpp>
#include <abut/error.hpp>
#include <abut/index/bvh.hpp>
#include <abut/index/operand.hpp>
#include <abut/index/refit.hpp>
#include <abut/shape/copy_view.hpp>
#include <abut/shape/features.hpp>
#include <abut/shape/motion.hpp>
#include <abut/shape/view.hpp>

namespace abut {

/// An index whose boxes a stream makes anew: of a bvh in the standard layout over a view of the caller's device memory, or of
/// an impact_index. Movable, not copyable.
/// @ingroup async
template <class Index>
class async_index {
    static_assert(sizeof(Index) == 0,
                  "abut: an async_index is of a bvh over a view of device memory, in the standard layout, or of an impact_index");
};

namespace detail {

struct async_refit;

/// A tree with nodes of its own, which may change.
template <class Tree>
class tree_in_stream {
    using storage = typename Tree::storage;

public:
    /// Of the topology of `like`, over a set of as many shapes. Waits.
    template <class Policy, class Set, class OldTree>
    static tree_in_stream over(const Policy& on, Set set, const OldTree& like) {
        std::shared_ptr<storage> own = refit_storage(on, like.stored(), view_of(set));
        own->is_refitted_in_place = true;
        if (set.size() > 1) (void)plan_of(on, *own);
        return {own, Tree(std::move(set), own)};
    }
    [[nodiscard]] const Tree& tree() const { return tree_; }
    /// Around where its shapes are now. Does not wait.
    template <class Policy>
    void refit(const Policy& on) {
        refit_boxes(on, *own_, view_of(tree_.set()), *own_);
    }

private:
    tree_in_stream(std::shared_ptr<storage> own, Tree tree) : own_(std::move(own)), tree_(std::move(tree)) {}

    std::shared_ptr<storage> own_;
    Tree tree_;
};

template <class Policy, class Index>
const Index& index_for_stream(const Policy& on, const Index& index) {
    static_assert(!host_policy<Policy>,
                  "abut: an async_index is for cuda; a host's policy has nothing to wait for, and refits by abut::refit");
    require_same_device(on, index, "abut::async_index");
    return index;
}

template <scalar T, memory_space Space>
struct copy_step {
    moving_view<points_view<T, Space>> step;
    vec3<T> *t0, *t1;
    ABUT_HD void operator()(std::size_t i) const {
        t0[i] = step.t0[i];
        t1[i] = step.t1[i];
    }
};
/// Vertices of a mesh at two times, which may change.
template <scalar T, memory_space Space>
struct vertices_in_stream {
    execution::buffer<vec3<T>, Space> t0, t1;

    template <class Policy>
    vertices_in_stream(const Policy& policy, const moving_view<mesh_view<T, Space>>& like)
        : t0(policy, like.t0.vertices.count), t1(policy, like.t1.vertices.count) {
        for_each_index(policy, t0.size(), copy_step<T, Space>{{vertices(like.t0), vertices(like.t1)}, t0.data(), t1.data()});
    }
};

}  // namespace detail

/// A tree over a view of device memory, brought to what that holds.
/// @ingroup async
template <shape_view View, memory_space Space>
class async_index<bvh<View, Space>> {
public:
    using index_type = bvh<View, Space>;  ///< what queries are asked with
    using memory_space = Space;           ///< where the memory lies

    /// With the topology of `index`, which stays as it is, over the same view. Takes nodes of its own, and what the first refit
    /// takes. Waits. Throws error for an index of another device; std::bad_alloc, cuda_error.
    template <works_in<Space> Policy>
    async_index(const Policy& on, const index_type& index)
        : tree_(detail::tree_in_stream<index_type>::over(on, detail::index_for_stream(on, index).set(), index)) {}
    /// The index, for queries of this stream: they see it as it is when the stream gets there.
    [[nodiscard]] const index_type& index() const { return tree_.tree(); }
    /// The CUDA device.
    [[nodiscard]] int device() const { return index().device(); }

private:
    friend detail::async_refit;

    template <class Policy>
    void refit(const Policy& on) {
        tree_.refit(on);
    }

    detail::tree_in_stream<index_type> tree_;
};

/// An index of impacts with a mesh of its own, brought to other steps of that.
/// @ingroup async
template <scalar T, memory_space Space>
class async_index<impact_index<T, Space>> {
public:
    using index_type = impact_index<T, Space>;  ///< what queries are asked with
    using memory_space = Space;                 ///< where the memory lies

    /// With the topology, the faces and the step of `index`, which stays as it is. Takes vertices and nodes of its own, and what
    /// the first refit takes. Waits. Throws error for an index of another device; std::bad_alloc, cuda_error.
    template <works_in<Space> Policy>
    async_index(const Policy& on, const index_type& index)
        : async_index(on, index, detail::vertices_in_stream<T, Space>(on, detail::index_for_stream(on, index).mesh().view())) {}
    /// The index, for queries of this stream: they see it as it is when the stream gets there.
    [[nodiscard]] const index_type& index() const { return index_; }
    /// The CUDA device.
    [[nodiscard]] int device() const { return index_.device(); }

private:
    friend detail::async_refit;
    using mesh_type = typename index_type::mesh_type;
    template <class Set>
    using tree = detail::tree_in_stream<bvh<Set, Space>>;

    template <class Policy>
    async_index(const Policy& on, const index_type& index, detail::vertices_in_stream<T, Space> own)
        : at_t0_(own.t0.data()), at_t1_(own.t1.data()), step_(step_over(index, std::move(own))),
          faces_(tree<mesh_type>::over(on, step_, index.faces())),
          edges_(tree<typename index_type::edges_type>::over(on, detail::edges_over(index.edges().set(), step_),
                                                             index.edges())),
          vertices_(tree<typename index_type::vertices_type>::over(on, vertices(step_), index.vertices())),
          index_(faces_.tree(), edges_.tree(), vertices_.tree()) {}

    static mesh_type step_over(const index_type& index, detail::vertices_in_stream<T, Space> own) {
        using parts = detail::set_parts;
        return {parts::with_points(index.mesh().t0(), parts::template shapes_of<vec3<T>, Space>(std::move(own.t0))),
                parts::with_points(index.mesh().t1(), parts::template shapes_of<vec3<T>, Space>(std::move(own.t1)))};
    }
    template <class Policy>
    void refit(const Policy& on, const moving_view<points_view<T, Space>>& step) {
        const std::size_t n = step_.t0().view().vertices.count;
        const auto require_as_many = [&](std::size_t given, const char* when) {
            if (given == n) return;
            throw error("abut::refit_async: the index has " + std::to_string(n) + " vertices, the view at " + when + " " +
                        std::to_string(given));
        };
        require_as_many(step.t0.size(), "t = 0");
        require_as_many(step.t1.size(), "t = 1");
        for_each_index(on, n, detail::copy_step<T, Space>{step, at_t0_, at_t1_});
        faces_.refit(on);
        edges_.refit(on);
        vertices_.refit(on);
    }

    vec3<T> *at_t0_, *at_t1_;
    mesh_type step_;
    tree<mesh_type> faces_;
    tree<typename index_type::edges_type> edges_;
    tree<typename index_type::vertices_type> vertices_;
    index_type index_;
};

/// Of an index that it is made of.
/// @ingroup async
template <class Policy, class Index>
async_index(const Policy&, const Index&) -> async_index<Index>;

namespace detail {

/// Reaches what an index keeps to itself.
struct async_refit {
    template <class Policy, class Index, class... Step>
    static void of(const async<Policy, async_index<Index>>& stream, const Step&... step) {
        const Policy& on = stream.policy();
        async_index<Index>& into = stream.into();
        if (into.index().size() > 0 && into.device() != device_of(on)) {
            throw error("abut::refit_async: the index lies on device " + std::to_string(into.device()) +
                        ", the policy works on device " + std::to_string(device_of(on)));
        }
        into.refit(on, step...);
    }
};

}  // namespace detail

/// @addtogroup async
///@{

/// `refit` in the stream: the tree is brought to what its view holds when the stream gets there. Results of queries that come
/// later are right however far shapes have moved. A graph may capture it. Numbers in the view have to be finite. Throws error
/// for an index of another device; std::bad_alloc, cuda_error. Does not wait. `refit(async(on, tree))`, where `tree` is
/// `async_index tree(on, make_bvh(on, view))`; docs/guide/streams.md has a program.
template <execution_policy Policy, class View, memory_space Space>
void refit(const async<Policy, async_index<bvh<View, Space>>>& stream) {
    detail::async_refit::of(stream);
}

/// `refit` in the stream: the index is brought to the step that two views of as many points tell, the vertices where the step
/// begins and where it ends, and keeps a copy of both. They lie in the policy's memory and have to be finite. Throws error for
/// another number of vertices, and as above. Does not wait. `refit(async(on, cloth), moving(from, to))` of two views, where
/// `cloth` is `async_index cloth(on, make_impact_index(on, step))`.
template <execution_policy Policy, scalar T, memory_space Space>
void refit(const async<Policy, async_index<impact_index<T, Space>>>& stream,
           const std::type_identity_t<moving_view<points_view<T, Space>>>& step) {
    detail::async_refit::of(stream, step);
}

///@}

}  // namespace abut
