// SPDX-License-Identifier: MIT
#pragma once

// An MPI that reads and writes memory of devices, made of one that does not: messages in such memory take the way through
// the host here, below MPI's own functions (its profiling interface). So it is tested that the library gives MPI addresses on
// a device where MPI says that it may, and that nothing is lost there. To be included in one source of a program.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <vector>

#include <cuda_runtime_api.h>
#include <mpi.h>

namespace abut::test {

/// What MPI says of itself, and how many messages of a device it has had.
inline bool mpi_is_aware = false;
inline std::uint64_t messages_on_devices = 0;

/// From here on.
inline void make_mpi_aware(bool is) {
    mpi_is_aware = is;
    messages_on_devices = 0;
    setenv("ABUT_MPI_READS_DEVICES", is ? "1" : "0", 1);
}

struct staged_message {
    std::vector<std::byte> here;
    void* there = nullptr;  ///< where it goes, if it comes in
};
inline std::map<MPI_Request, staged_message> staged_messages;

inline bool is_on_device(const void* p) {
    cudaPointerAttributes at{};
    return cudaPointerGetAttributes(&at, p) == cudaSuccess && at.type == cudaMemoryTypeDevice;
}
inline std::size_t bytes_of(int count, MPI_Datatype type) {
    int size = 0;
    PMPI_Type_size(type, &size);
    return static_cast<std::size_t>(count) * static_cast<std::size_t>(size);
}

}  // namespace abut::test

extern "C" int MPIX_Query_cuda_support() { return abut::test::mpi_is_aware ? 1 : 0; }

extern "C" int MPI_Isend(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request* request) {
    using namespace abut::test;
    if (!is_on_device(data)) return PMPI_Isend(data, count, type, to, tag, comm, request);
    if (!mpi_is_aware) return MPI_ERR_BUFFER;
    ++messages_on_devices;
    staged_message staged{std::vector<std::byte>(bytes_of(count, type))};
    if (cudaMemcpy(staged.here.data(), data, staged.here.size(), cudaMemcpyDeviceToHost) != cudaSuccess) return MPI_ERR_BUFFER;
    const int code = PMPI_Isend(staged.here.data(), count, type, to, tag, comm, request);
    staged_messages[*request] = std::move(staged);
    return code;
}

extern "C" int MPI_Irecv(void* data, int count, MPI_Datatype type, int from, int tag, MPI_Comm comm, MPI_Request* request) {
    using namespace abut::test;
    if (!is_on_device(data)) return PMPI_Irecv(data, count, type, from, tag, comm, request);
    if (!mpi_is_aware) return MPI_ERR_BUFFER;
    ++messages_on_devices;
    staged_message staged{std::vector<std::byte>(bytes_of(count, type)), data};
    const int code = PMPI_Irecv(staged.here.data(), count, type, from, tag, comm, request);
    staged_messages[*request] = std::move(staged);
    return code;
}

extern "C" int MPI_Waitall(int count, MPI_Request* requests, MPI_Status* statuses) {
    using namespace abut::test;
    const std::vector<MPI_Request> all(requests, requests + count);
    int code = PMPI_Waitall(count, requests, statuses);
    for (const MPI_Request request : all) {
        const auto at = staged_messages.find(request);
        if (at == staged_messages.end()) continue;
        const staged_message& staged = at->second;
        const bool copied = staged.there == nullptr || cudaMemcpy(staged.there, staged.here.data(), staged.here.size(),
                                                                  cudaMemcpyHostToDevice) == cudaSuccess;
        if (!copied) code = MPI_ERR_BUFFER;
        staged_messages.erase(at);
    }
    return code;
}
