// SPDX-License-Identifier: MIT
#pragma once

// The processes (ranks) that work on one query, and what they say to each other beside shapes: how much each has, and
// whether one of them has failed. MPI stays in distributed/.

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <abut/collide/executor.hpp>
#include <abut/error.hpp>
#include <abut/execution/policy.hpp>

#include <mpi.h>
#if __has_include(<mpi-ext.h>)
#include <mpi-ext.h>
#endif

namespace abut {

/// @addtogroup distributed
///@{

/// Another rank failed, so that no rank has an answer. The rank that failed throws what was thrown there.
class distributed_error : public error {
public:
    /// Of rank `rank`, which said `message`.
    distributed_error(int rank, const std::string& message)
        : error("rank " + std::to_string(rank) + ": " + message), rank_(rank) {}
    /// The rank that failed; of several the least.
    [[nodiscard]] int rank() const noexcept { return rank_; }

private:
    int rank_;
};

///@}

namespace detail {

/// Says in one line that ranks take no bodies; true where there are none.
template <bool AreBodies>
consteval bool refuse_bodies() {
    static_assert(!AreBodies, "abut: bodies lie on one machine: ask those of a rank by its local policy");
    return !AreBodies;
}

/// Throws error if an MPI call failed.
inline void check_mpi(int code, const char* call) {
    if (code == MPI_SUCCESS) return;
    char text[MPI_MAX_ERROR_STRING] = "";
    int length = 0;
    MPI_Error_string(code, text, &length);
    throw error(std::string("abut::distributed: ") + call + ": " + text);
}

/// Whether messages lie in memory of CUDA devices: where MPI says that it reads that (Open MPI, and MPICH from 4.0 on), and
/// the environment says by ABUT_MPI_READS_DEVICES=1 that it does so with memory of a pool, as the library's is: some that
/// read devices do not.
inline bool mpi_reads_devices() {
    const char* const wanted = std::getenv("ABUT_MPI_READS_DEVICES");
    if (wanted == nullptr || std::strcmp(wanted, "1") != 0) return false;
#if defined(OMPI_HAVE_MPI_EXT_CUDA)
    return MPIX_Query_cuda_support() == 1;
#elif defined(MPIX_GPU_SUPPORT_CUDA)
    int is = 0;
    return MPIX_GPU_query_support(MPIX_GPU_SUPPORT_CUDA, &is) == MPI_SUCCESS && is != 0;
#else
    return false;
#endif
}

/// A communicator of the library's own, shared by its copies: messages of the caller's and of the library never meet.
class own_communicator {
public:
    /// A duplicate of the caller's: all its ranks have to call this.
    explicit own_communicator(MPI_Comm callers) {
        int initialized = 0, finalized = 0;
        MPI_Initialized(&initialized);
        MPI_Finalized(&finalized);
        if (initialized == 0 || finalized != 0) throw error("abut::distributed: MPI is not initialised");
        if (callers == MPI_COMM_NULL) throw error("abut::distributed: the communicator is MPI_COMM_NULL");
        int between = 0;
        check_mpi(MPI_Comm_test_inter(callers, &between), "MPI_Comm_test_inter");
        if (between != 0) throw error("abut::distributed: an intercommunicator has two groups of ranks; expected one");
        MPI_Comm own = MPI_COMM_NULL;
        check_mpi(MPI_Comm_dup(callers, &own), "MPI_Comm_dup");
        comm_ = std::shared_ptr<MPI_Comm>(new MPI_Comm(own), [](MPI_Comm* comm) {
            int gone = 0;
            MPI_Finalized(&gone);
            if (gone == 0) MPI_Comm_free(comm);
            delete comm;
        });
        check_mpi(MPI_Comm_set_errhandler(own, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
        check_mpi(MPI_Comm_rank(own, &rank_), "MPI_Comm_rank");
        check_mpi(MPI_Comm_size(own, &size_), "MPI_Comm_size");
    }

    [[nodiscard]] MPI_Comm get() const { return *comm_; }
    [[nodiscard]] int rank() const { return rank_; }
    [[nodiscard]] int size() const { return size_; }

private:
    std::shared_ptr<MPI_Comm> comm_;
    int rank_ = 0, size_ = 1;
};

/// Values of a type as MPI counts them, so that an int counts values and not bytes.
template <class T>
class message_type {
public:
    message_type() {
        check_mpi(MPI_Type_contiguous(int{sizeof(T)}, MPI_BYTE, &type_), "MPI_Type_contiguous");
        check_mpi(MPI_Type_commit(&type_), "MPI_Type_commit");
    }
    message_type(const message_type&) = delete;
    message_type& operator=(const message_type&) = delete;
    ~message_type() { MPI_Type_free(&type_); }
    [[nodiscard]] MPI_Datatype get() const { return type_; }

private:
    MPI_Datatype type_ = MPI_DATATYPE_NULL;
};

/// What each rank has, in the order of the ranks, into room for one of each. All ranks call it.
template <class T>
void gather(const own_communicator& ranks, const T& mine, std::vector<T>& all) {
    const message_type<T> type;
    check_mpi(MPI_Allgather(&mine, 1, type.get(), all.data(), 1, type.get(), ranks.get()), "MPI_Allgather");
}

/// Tells the ranks of each other's failures: all call it, each with what it caught, or null. It returns on all of them, or
/// throws on all of them.
inline void agree(const own_communicator& ranks, const std::exception_ptr& failure) {
    const int mine = failure ? ranks.rank() : ranks.size();
    int first = 0;
    check_mpi(MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, ranks.get()), "MPI_Allreduce");
    if (first == ranks.size()) return;
    char message[512] = "";
    if (first == ranks.rank()) {
        try {
            std::rethrow_exception(failure);
        } catch (const std::exception& e) {
            std::strncpy(message, e.what(), sizeof message - 1);
        } catch (...) {
            std::strncpy(message, "an exception that is no std::exception", sizeof message - 1);
        }
    }
    check_mpi(MPI_Bcast(message, int{sizeof message}, MPI_CHAR, first, ranks.get()), "MPI_Bcast");
    if (failure) std::rethrow_exception(failure);
    throw distributed_error(first, message);
}

/// Work that may fail between messages that all have to send: the first failure is kept, and what comes after it is left
/// out. All memory is asked for in such work, so that none is lacking in between.
class attempts {
public:
    template <class Work>
    void operator()(const Work& work) {
        if (failure_) return;
        try {
            work();
        } catch (...) {
            failure_ = std::current_exception();
        }
    }
    [[nodiscard]] bool failed() const { return failure_ != nullptr; }
    /// As `agree`.
    void settle(const own_communicator& ranks) const { agree(ranks, failure_); }

private:
    std::exception_ptr failure_;
};

/// Throws error on all ranks if they give different numbers for what they have to agree on. All ranks call it.
inline void require_one(const own_communicator& ranks, double mine, const char* function, const char* what) {
    const double ends[2] = {mine, -mine};
    double most[2] = {};
    check_mpi(MPI_Allreduce(ends, most, 2, MPI_DOUBLE, MPI_MAX, ranks.get()), "MPI_Allreduce");
    if (most[0] == -most[1]) return;
    throw error(std::string(function) + ": ranks give " + what + " from " + std::to_string(-most[1]) + " to " +
                std::to_string(most[0]) + "; expected the same on all");
}

}  // namespace detail

/// @defgroup distributed Many processes
///
/// `abut::distributed` runs a query on the ranks of an MPI communicator: on cores and devices of many machines. Each rank
/// has a part of each set, and gives that part as the argument, as a set, a view or an index. The set that is asked about is
/// all parts one after another, in the order of the ranks. So ids are 64 bits wide: those of a rank begin where those of the
/// rank before end. Answers are those of one machine that has the whole sets.
///
/// The queries come with `<abut/mpi.hpp>` and the target `abut::mpi`. docs/distributed.md says how to use them.
///
/// @par Collective
/// All ranks make each call, in the same order, with arguments of the same types and the same options. A part may be empty.
/// Calls through one `distributed` and its copies come from one thread at a time. Where threads of one process use MPI at a
/// time, MPI_THREAD_MULTIPLE is needed, as MPI says.
///
/// @par Memory
/// Parts lie in the memory of the local policy. Besides its own parts a rank holds one message in and one out: shapes of b
/// that one other rank has and that come near its own a-shapes, at most that rank's part, and 4 bytes of id for each; of
/// hulls their points, and 4 bytes more for each. Under `cuda` messages lie on the host as well. Results are as large as
/// those of the same query on one machine, of a rank's own a-shapes.
///
/// @par Errors
/// What one rank throws is thrown there, as by the same query under the local policy; all others throw `distributed_error`.
/// No rank waits for one that failed, and the next call works. An MPI call that fails is an `error`, on the rank that made
/// it; then nothing is known of the others.
///
/// @par Synchronisation
/// Calls return when the rank's answer is complete and all ranks know of each other's failures.
///
/// @par Example
/// @snippet distributed.cpp distributed

/// @ingroup distributed
/// The ranks of a communicator, each of which works by a policy of its own.
template <execution_policy Local = openmp>
class distributed {
public:
    using local_policy = Local;            ///< by which a rank works
    using memory_space = space_of<Local>;  ///< where parts and results lie

    /// Duplicates the communicator, so all its ranks call this, between MPI_Init and MPI_Finalize; copies share the
    /// duplicate, and the last one frees it. Throws error if MPI is not initialised, if the communicator is null or has two
    /// groups, or if MPI fails.
    explicit distributed(MPI_Comm communicator, Local local = {}) : ranks_(communicator), local_(std::move(local)) {}

    /// The number of this rank, from 0.
    [[nodiscard]] int rank() const { return ranks_.rank(); }
    /// Number of ranks, 1 or more.
    [[nodiscard]] int size() const { return ranks_.size(); }
    /// By which this rank works.
    [[nodiscard]] const Local& local() const { return local_; }
    /// The library's duplicate of the communicator.
    [[nodiscard]] const detail::own_communicator& ranks() const { return ranks_; }

private:
    detail::own_communicator ranks_;
    Local local_;
};

namespace detail {

template <class Local>
inline constexpr bool is_ranks<distributed<Local>> = true;

}  // namespace detail

}  // namespace abut
