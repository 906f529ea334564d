// SPDX-License-Identifier: MIT
#pragma once

// Policies of the host that work together as devices do, each with memory of its own: so that what does not need a device
// is tested without one.

#include <cstddef>
#include <cstring>
#include <memory>
#include <vector>

#include <abut/abut.hpp>
#include <abut/execution/team.hpp>

namespace abut::execution {

template <class T>
void copy_across(const serial&, const T* p, std::size_t n, const serial&, T* q) {
    if (n > 0) std::memcpy(static_cast<void*>(q), p, n * sizeof(T));
}
template <class T>
void copy_across(const openmp&, const T* p, std::size_t n, const openmp&, T* q) {
    if (n > 0) std::memcpy(static_cast<void*>(q), p, n * sizeof(T));
}

}  // namespace abut::execution

namespace abut::test {

template <class Local>
class host_team {
public:
    using local_policy = Local;
    explicit host_team(int size, const Local& on = {})
        : policies_(static_cast<std::size_t>(size), on), threads_(std::make_shared<execution::crew>(size)) {}
    [[nodiscard]] int size() const { return static_cast<int>(policies_.size()); }
    [[nodiscard]] const Local& operator[](int k) const { return policies_[static_cast<std::size_t>(k)]; }

    [[nodiscard]] execution::crew& threads() const { return *threads_; }

private:
    std::vector<Local> policies_;
    std::shared_ptr<execution::crew> threads_;
};

static_assert(execution::policy_team<host_team<serial>>);

}  // namespace abut::test
