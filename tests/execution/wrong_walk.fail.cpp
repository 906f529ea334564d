// SPDX-License-Identifier: MIT
// expect: abut: for_each_candidate: the walk is no candidate_walk
#include <abut/execution/host.hpp>

// It has no may_find.
struct walk {
    using candidate = unsigned;
    struct cursor {};
    bool operator()(std::size_t, cursor&, const auto& emitter, auto&...) const {
        emitter.push(0u);
        return false;
    }
};
struct judge {
    bool operator()(unsigned, auto&...) const { return true; }
    void finish(unsigned, auto&...) const {}
};

void find() { for_each_candidate(abut::serial{}, 10, walk{}, judge{}); }
