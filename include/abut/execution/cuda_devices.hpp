// SPDX-License-Identifier: MIT
#pragma once

// The CUDA devices of a host, and copies between them.

#include <cstddef>
#include <memory>
#include <mutex>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <cuda_runtime_api.h>

#include <abut/error.hpp>
#include <abut/execution/cuda.hpp>
#include <abut/execution/team.hpp>

namespace abut {

namespace execution {

/// Copies from one device to another, directly where the devices can, else through host memory. Waits for the copy, and not
/// for what the source's stream is busy with.
template <class T>
void copy_across(const cuda& from, const T* p, std::size_t n, const cuda& to, T* q) {
    if (n == 0) return;
    const detail::current_device scope(to);
    detail::check(cudaMemcpyPeerAsync(q, device_of(to), p, device_of(from), n * sizeof(T), to.stream),
                  "cudaMemcpyPeerAsync");
    detail::check(cudaStreamSynchronize(to.stream), "cudaStreamSynchronize");
}

}  // namespace execution

/// Several CUDA devices of one host, which answer a query together. A small value: copy it, and share it among threads.
/// Each device works in a stream of the caller's, or in its default stream.
/// @ingroup devices
class cuda_devices {
public:
    using local_policy = execution::cuda;  ///< of each device

    /// All devices that there are, in the order of their numbers. Throws cuda_error where there is none.
    cuda_devices() : cuda_devices(all_numbers()) {}
    /// The devices of these numbers, in this order. One may be named several times; it is then asked so many times. Throws
    /// error if there are none, or if a number is no device's.
    explicit cuda_devices(const std::vector<int>& devices) : cuda_devices(in_default_streams(devices), checked{}) {}
    /// The devices of these policies, in their streams, which have to outlive all that is made in them. Throws as above.
    [[nodiscard]] static cuda_devices in_streams(std::vector<execution::cuda> policies) {
        return cuda_devices(std::move(policies), checked{});
    }

    /// Number of devices, 1 or more.
    [[nodiscard]] int size() const { return static_cast<int>(policies_.size()); }
    /// The policy of the k-th device.
    [[nodiscard]] const execution::cuda& operator[](int k) const { return policies_[static_cast<std::size_t>(k)]; }
    /// The threads that drive the devices, shared by copies.
    [[nodiscard]] execution::crew& threads() const { return *threads_; }

private:
    struct checked {};
    cuda_devices(std::vector<execution::cuda> policies, checked) : policies_(std::move(policies)) {
        if (policies_.empty()) throw error("abut::cuda_devices: the list of devices is empty");
        int count = 0;
        execution::detail::check(cudaGetDeviceCount(&count), "cudaGetDeviceCount");
        for (execution::cuda& on : policies_) {
            on.device = device_of(on);
            if (on.device >= count) {
                throw error("abut::cuda_devices: there is no device " + std::to_string(on.device) + ", of " +
                            std::to_string(count));
            }
        }
        for (const execution::cuda& a : policies_) {
            for (const execution::cuda& b : policies_) let_read(a.device, b.device);
        }
        // A thread stays with its device, so that no other device is touched for want of one that is current.
        threads_ = std::make_shared<execution::crew>(size(), [all = policies_](int k) {
            if (cudaSetDevice(all[static_cast<std::size_t>(k)].device) != cudaSuccess) cudaGetLastError();
        });
    }
    static std::vector<int> all_numbers() {
        int count = 0;
        execution::detail::check(cudaGetDeviceCount(&count), "cudaGetDeviceCount");
        std::vector<int> numbers(static_cast<std::size_t>(count));
        std::iota(numbers.begin(), numbers.end(), 0);
        return numbers;
    }
    static std::vector<execution::cuda> in_default_streams(const std::vector<int>& devices) {
        std::vector<execution::cuda> policies;
        for (const int device : devices) {
            if (device < 0) throw error("abut::cuda_devices: there is no device " + std::to_string(device));
            policies.push_back(execution::cuda{nullptr, device});
        }
        return policies;
    }
    /// Memory of the library's pool on a device becomes readable from another one, where the two are peers: once in a
    /// process, and for as long as it runs.
    static void let_read(int owner, int reader) {
        static std::mutex mutex;
        static std::set<std::pair<int, int>> done;
        const std::scoped_lock lock(mutex);
        if (owner == reader || done.contains({owner, reader})) return;
        int can = 0;
        execution::detail::check(cudaDeviceCanAccessPeer(&can, reader, owner), "cudaDeviceCanAccessPeer");
        if (can != 0) {
            cudaMemAccessDesc access{};
            access.location.type = cudaMemLocationTypeDevice;
            access.location.id = reader;
            access.flags = cudaMemAccessFlagsProtReadWrite;
            const auto pool = execution::detail::pool_of(owner).handle();
            execution::detail::check(cudaMemPoolSetAccess(pool, &access, 1), "cudaMemPoolSetAccess");
        }
        done.insert({owner, reader});
    }

    std::vector<execution::cuda> policies_;
    std::shared_ptr<execution::crew> threads_;
};

static_assert(execution::policy_team<cuda_devices>);

}  // namespace abut
