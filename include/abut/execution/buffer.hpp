// SPDX-License-Identifier: MIT
#pragma once

// Uninitialised arrays in a policy's memory. Filling scratch with zeros can cost more than the work on it, so nothing is
// written on allocation; `fill` does it where it is wanted.

#include <cstddef>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

#include <abut/execution/policy.hpp>

namespace abut::execution {

/// Allocation in a memory space, specialised for device_space in execution/cuda.hpp.
template <memory_space Space>
struct allocator;

template <>
struct allocator<host_space> {
    template <class Policy>
    explicit allocator(const Policy&) {}
    allocator() = default;

    /// Throws std::bad_alloc. Rows of 64 bytes never share a cache line with foreign data.
    [[nodiscard]] void* allocate(std::size_t bytes) const { return ::operator new (bytes, std::align_val_t{64}); }
    void deallocate(void* p) const noexcept { ::operator delete (p, std::align_val_t{64}); }
    /// Copies bytes of this memory to host memory and waits for them.
    void read(const void* from, std::size_t bytes, void* to) const { std::memcpy(to, from, bytes); }
    /// Host memory is one place.
    [[nodiscard]] int device() const { return -1; }
};

/// An owning array of trivially copyable elements; movable, not copyable. Memory of a device is given back in the order of
/// the policy's stream, so the stream has to outlive the buffer.
template <class T, memory_space Space>
class buffer {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

public:
    using value_type = T;
    using memory_space = Space;

    buffer() = default;
    /// `n` elements of unspecified value. Throws std::bad_alloc.
    template <works_in<Space> Policy>
    buffer(const Policy& policy, std::size_t n) : memory_(policy), size_(n) {
        if (n > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_alloc();
        if (n > 0) data_ = static_cast<T*>(memory_.allocate(n * sizeof(T)));
    }
    buffer(buffer&& other) noexcept { swap(other); }
    buffer& operator=(buffer&& other) noexcept {
        buffer(std::move(other)).swap(*this);
        return *this;
    }
    ~buffer() {
        if (data_) memory_.deallocate(data_);
    }

    [[nodiscard]] T* data() noexcept { return data_; }
    [[nodiscard]] const T* data() const noexcept { return data_; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] std::size_t capacity_bytes() const noexcept { return size_ * sizeof(T); }

    /// Copies all elements to `to` in host memory and waits for them.
    void read(T* to) const {
        if (size_ > 0) memory_.read(data_, size_ * sizeof(T), to);
    }
    /// A copy of all elements in host memory. Waits for it. Throws std::bad_alloc.
    [[nodiscard]] buffer<T, host_space> to_host() const;
    /// The CUDA device that holds the elements; -1 for host memory.
    [[nodiscard]] int device() const { return memory_.device(); }

    /// Lets go of elements past `n`; memory stays as it is.
    void shrink(std::size_t n) noexcept { size_ = n < size_ ? n : size_; }

    void swap(buffer& other) noexcept {
        std::swap(memory_, other.memory_);
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
    }

private:
    allocator<Space> memory_;
    T* data_ = nullptr;
    std::size_t size_ = 0;
};

template <class T, memory_space Space>
buffer<T, host_space> buffer<T, Space>::to_host() const {
    buffer<T, host_space> copy(serial{}, size_);
    read(copy.data());
    return copy;
}

template <class Policy, class T>
using buffer_of = buffer<T, space_of<Policy>>;

}  // namespace abut::execution
