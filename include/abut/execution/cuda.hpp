// SPDX-License-Identifier: MIT
#pragma once

// The CUDA policy: a stream on a device, its errors, and its memory. The verbs are in execution/cuda_verbs.hpp.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <mutex>
#include <new>
#include <string>
#include <type_traits>

#include <cuda_runtime_api.h>

#include <abut/error.hpp>
#include <abut/execution/buffer.hpp>
#include <abut/execution/policy.hpp>

namespace abut {

/// A CUDA call that failed. The message names the call and carries CUDA's own text.
/// @ingroup errors
class cuda_error : public error {
public:
    /// Of a call, by its name, and what it returned.
    cuda_error(const char* call, cudaError_t code)
        : error(std::string(call) + ": " + cudaGetErrorString(code) + " (" + cudaGetErrorName(code) + ")"), code_(code) {}
    /// What the call returned.
    [[nodiscard]] cudaError_t code() const noexcept { return code_; }

private:
    cudaError_t code_;
};

namespace execution {

/// Runs on one CUDA device, in the order of one stream. The stream belongs to the caller and has to outlive the sets,
/// indices and results made on it. `cuda{}` is the default stream of the current device. Its name for programs is
/// `abut::cuda`.
/// @ingroup policies
struct cuda {
    using memory_space = device_space;  ///< memory of the device
    cudaStream_t stream = nullptr;  ///< a stream of `device`
    int device = -1;                ///< -1: the device that is current when a call is made
};

/// Where limit_memory sets no limit.
/// @ingroup policies
inline constexpr std::uint64_t no_memory_limit = ~std::uint64_t{0};

/// Memory of the library's pool on one device, in bytes.
/// @ingroup policies
struct memory_use {
    std::uint64_t reserved;                 ///< taken from the system
    std::uint64_t used;                     ///< of these, in use
    std::uint64_t used_peak;                ///< the most that has been in use
    std::uint64_t limit = no_memory_limit;  ///< the most that may be in use (limit_memory)
};

namespace detail {

inline void check(cudaError_t code, const char* call) {
    if (code == cudaSuccess) return;
    cudaGetLastError();  // a failure that has been reported is not reported again by the next call
    if (code == cudaErrorMemoryAllocation) throw std::bad_alloc();
    throw cuda_error(call, code);
}

}  // namespace detail

/// The device that the policy works on. Throws cuda_error where there is none.
inline int device_of(const cuda& on) {
    int device = on.device;
    if (device < 0) detail::check(cudaGetDevice(&device), "cudaGetDevice");
    return device;
}

namespace detail {

#if ABUT_ALLOW_UNTESTED_NVCC
/// In collide/device_self_test.hpp, which abut/cuda.hpp includes.
template <class Policy>
void require_right_decisions_once(const Policy& on, int device);
#endif

/// Makes a device current and the one before it current again at the end of the scope.
class current_device {
public:
    explicit current_device(int device) {
        check(cudaGetDevice(&before_), "cudaGetDevice");
        if (before_ == device) return;
        const cudaError_t code = cudaSetDevice(device);
        if (code != cudaSuccess) check(code, ("cudaSetDevice(" + std::to_string(device) + ")").c_str());
        changed_ = true;
    }
    explicit current_device(const cuda& on) : current_device(device_of(on)) {
#if ABUT_ALLOW_UNTESTED_NVCC
        require_right_decisions_once(on, device_of(on));
#endif
    }
    current_device(const current_device&) = delete;
    current_device& operator=(const current_device&) = delete;
    ~current_device() {
        if (changed_ && cudaSetDevice(before_) != cudaSuccess) cudaGetLastError();  // not for the next call to report
    }

private:
    int before_ = 0;
    bool changed_ = false;
};

/// The library's own pool on a device, made at first use and kept: it holds on to freed memory, so that a repeated query
/// allocates nothing from the system. The device's default pool is left alone.
class memory_pool {
public:
    explicit memory_pool(int device) : device_(device) {
        cudaMemPoolProps properties{};
        properties.allocType = cudaMemAllocationTypePinned;
        properties.location.type = cudaMemLocationTypeDevice;
        properties.location.id = device;
        check(cudaMemPoolCreate(&handle_, &properties), "cudaMemPoolCreate");
        keep(no_memory_limit);
    }
    memory_pool(const memory_pool&) = delete;
    memory_pool& operator=(const memory_pool&) = delete;

    /// Memory in the order of a stream of the device, which is current. Under a limit threads ask one after another, so that
    /// two of them do not take the same room.
    [[nodiscard]] void* allocate(std::size_t bytes, cudaStream_t stream) {
        std::unique_lock<std::mutex> one_at_a_time;
        if (limit_.load(std::memory_order_relaxed) != no_memory_limit) {
            one_at_a_time = std::unique_lock(mutex_);
            require_room(bytes, stream);
        }
        void* p = nullptr;
        check(cudaMallocFromPoolAsync(&p, bytes, handle_, stream), "cudaMallocFromPoolAsync");
        return p;
    }
    /// Of what is in use. What is kept besides goes back to the system when a stream is waited for, if it is more in all.
    void limit(std::uint64_t bytes) {
        const std::scoped_lock lock(mutex_);
        keep(bytes);
        limit_ = bytes;
    }
    [[nodiscard]] std::uint64_t limit() const { return limit_; }
    [[nodiscard]] std::uint64_t get(cudaMemPoolAttr attribute) const {
        std::uint64_t value = 0;
        check(cudaMemPoolGetAttribute(handle_, attribute, &value), "cudaMemPoolGetAttribute");
        return value;
    }
    [[nodiscard]] cudaMemPool_t handle() const { return handle_; }

private:
    void keep(std::uint64_t bytes) {
        check(cudaMemPoolSetAttribute(handle_, cudaMemPoolAttrReleaseThreshold, &bytes), "cudaMemPoolSetAttribute");
    }
    void require_room(std::size_t bytes, cudaStream_t stream) {
        const std::uint64_t most = limit_;
        const auto fits = [&] {
            const std::uint64_t used = get(cudaMemPoolAttrUsedMemCurrent);
            return used <= most && bytes <= most - used;
        };
        if (fits()) return;
        check(cudaStreamSynchronize(stream), "cudaStreamSynchronize");  // memory on its way back is counted until then
        if (fits()) return;
        throw capacity_error("abut::limit_memory: device " + std::to_string(device_) + " may have " + std::to_string(most) +
                             " bytes in use; " + std::to_string(get(cudaMemPoolAttrUsedMemCurrent)) + " are, and " +
                             std::to_string(bytes) + " more are needed");
    }

    int device_;
    cudaMemPool_t handle_ = nullptr;
    std::mutex mutex_;
    std::atomic<std::uint64_t> limit_{no_memory_limit};
};

inline memory_pool& pool_of(int device) {
    static std::mutex mutex;
    static std::map<int, memory_pool> pools;
    const std::scoped_lock lock(mutex);
    return pools.try_emplace(device, device).first->second;
}

/// A little page-locked memory for each host thread, through which sizes and sums come back without a slow copy.
class pinned_scratch {
public:
    static constexpr std::size_t bytes = 256;
    pinned_scratch() { check(cudaHostAlloc(&data_, bytes, cudaHostAllocPortable), "cudaHostAlloc"); }
    pinned_scratch(const pinned_scratch&) = delete;
    pinned_scratch& operator=(const pinned_scratch&) = delete;
    ~pinned_scratch() { cudaFreeHost(data_); }

    [[nodiscard]] static void* of_this_thread() {
        thread_local pinned_scratch scratch;
        return scratch.data_;
    }

private:
    void* data_ = nullptr;
};

}  // namespace detail

/// Memory of a device, from the library's pool and in the order of a policy's stream.
template <>
struct allocator<device_space> {
    /// Of the default stream.
    allocator() = default;
    /// Of the policy's stream and device.
    explicit allocator(const cuda& on) : on_{on.stream, device_of(on)} {}

    /// Throws std::bad_alloc when the device has not enough memory, and capacity_error when limit_memory allows no more.
    /// Rows are aligned to 256 bytes.
    [[nodiscard]] void* allocate(std::size_t bytes) const {
        const detail::current_device scope(on_);
        return detail::pool_of(on_.device).allocate(bytes, on_.stream);
    }
    /// Gives memory back when the stream gets there. Does not wait.
    void deallocate(void* p) const noexcept {
        // The default stream is the current device's: the memory goes back in the order of the stream that it came from.
        int before = on_.device;
        cudaGetDevice(&before);
        if (before != on_.device) cudaSetDevice(on_.device);
        cudaFreeAsync(p, on_.stream);
        if (before != on_.device) cudaSetDevice(before);
    }
    /// Copies to the host and waits for the stream. Throws cuda_error.
    void read(const void* from, std::size_t bytes, void* to) const {
        const detail::current_device scope(on_);
        detail::check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToHost, on_.stream), "cudaMemcpyAsync");
        detail::check(cudaStreamSynchronize(on_.stream), "cudaStreamSynchronize");
    }
    /// The device.
    [[nodiscard]] int device() const { return on_.device; }

private:
    cuda on_;
};

/// Throws abut::error if `p` is memory of another device than the policy's.
inline void require_access(const cuda& on, const void* p, const char* function) {
    if (p == nullptr) return;
    cudaPointerAttributes attributes{};
    detail::check(cudaPointerGetAttributes(&attributes, p), "cudaPointerGetAttributes");
    if (attributes.type == cudaMemoryTypeDevice && attributes.device != device_of(on)) {
        throw error(std::string(function) + ": the view is over memory of device " + std::to_string(attributes.device) +
                    ", the policy works on device " + std::to_string(device_of(on)));
    }
}

/// Its name is what nvcc says of a functor that it refuses. (The body is not there where nvcc compiles for the host.)
template <class F, class... Args>
__device__ void functors_for_the_policy_cuda_have_to_be_marked_ABUT_HD([[maybe_unused]] const F& f,
                                                                       [[maybe_unused]] const Args&... args) {
    (void)f(args...);
}

/// Does not compile where a device cannot call f(args...). Templates for hosts and devices call what they are given unasked
/// (ABUT_CALLS_ANY), and of a host's function nothing would be left there: a filter would let every pair pass. Of a
/// `__device__` function nvcc refuses it. Taking the address is enough, so no code is made and nothing runs. What a marked
/// functor calls in turn is its own matter: nvcc warns there.
template <class F, class... Args>
void require_callable(const cuda&, const F&, const Args&...) {
    static_assert(!std::is_pointer_v<std::decay_t<F>>,
                  "abut: a pointer to a function of the host cannot be called on a device: pass a functor marked ABUT_HD");
    static_assert(!std::is_polymorphic_v<F>,
                  "abut: virtual functions of an object that was made on the host cannot be called on a device");
    (void)&functors_for_the_policy_cuda_have_to_be_marked_ABUT_HD<F, Args...>;
}

/// Waits until everything put into the policy's stream is done. Throws cuda_error, also for what went wrong in the stream
/// before.
/// @ingroup policies
inline void synchronize(const cuda& on) {
    const detail::current_device scope(on);
    detail::check(cudaStreamSynchronize(on.stream), "cudaStreamSynchronize");
}

template <class T>
void upload(const cuda& on, const T* from, std::size_t n, T* to) {
    if (n == 0) return;
    const detail::current_device scope(on);
    detail::check(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyHostToDevice, on.stream), "cudaMemcpyAsync");
}

template <class T>
void copy(const cuda& on, const T* from, std::size_t n, T* to) {
    if (n == 0) return;
    const detail::current_device scope(on);
    detail::check(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyDeviceToDevice, on.stream), "cudaMemcpyAsync");
}

template <class T>
void download(const cuda& on, const T* from, std::size_t n, T* to) {
    const detail::current_device scope(on);
    if (n > 0) {
        const std::size_t bytes = n * sizeof(T);
        void* const through = bytes <= detail::pinned_scratch::bytes ? detail::pinned_scratch::of_this_thread() : to;
        detail::check(cudaMemcpyAsync(through, from, bytes, cudaMemcpyDeviceToHost, on.stream), "cudaMemcpyAsync");
        detail::check(cudaStreamSynchronize(on.stream), "cudaStreamSynchronize");
        if (through != to) std::memcpy(static_cast<void*>(to), through, bytes);
    }
}

/// Waits for the stream and gives the memory that the library's pool keeps for this device, and does not use, back to the
/// system. Throws cuda_error.
/// @ingroup policies
inline void release_memory(const cuda& on) {
    synchronize(on);
    detail::check(cudaMemPoolTrimTo(detail::pool_of(device_of(on)).handle(), 0), "cudaMemPoolTrimTo");
}

/// The most memory of the policy's device that the library's pool may have in use from now on, for all streams and threads
/// of the process; `no_memory_limit` ends it. A call that needs more throws capacity_error and leaves nothing behind, as for
/// want of memory. What is in use already stays. Unused memory is kept up to this size and no further. Does not synchronise.
/// Throws cuda_error.
/// @ingroup policies
inline void limit_memory(const cuda& on, std::uint64_t bytes) { detail::pool_of(device_of(on)).limit(bytes); }

/// What the library's pool holds on the policy's device. Does not synchronise. Beside the pool each host thread that
/// runs queries keeps up to 32 MiB for what they leave open. Throws cuda_error.
/// @ingroup policies
inline memory_use memory_in_use(const cuda& on) {
    const detail::memory_pool& pool = detail::pool_of(device_of(on));
    return {pool.get(cudaMemPoolAttrReservedMemCurrent), pool.get(cudaMemPoolAttrUsedMemCurrent),
            pool.get(cudaMemPoolAttrUsedMemHigh), pool.limit()};
}

}  // namespace execution

using execution::cuda;
using execution::limit_memory;
using execution::memory_in_use;
using execution::memory_use;
using execution::no_memory_limit;
using execution::release_memory;
using execution::synchronize;

}  // namespace abut
