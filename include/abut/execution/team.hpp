// SPDX-License-Identifier: MIT
#pragma once

// Several policies of one kind that work together, each in memory of its own, each driven by a thread of the host.

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <abut/execution/policy.hpp>
#include <abut/execution/policy_team.hpp>

namespace abut::execution {

/// Threads that wait for work: one for each policy of a team but the first, which the caller's thread drives. They are kept,
/// since what a thread of the host holds for a device, as page-locked memory, takes long to make.
class crew {
public:
    /// For a team of `size` policies. Each thread but the caller's begins with begin(k). Throws std::system_error if a
    /// thread cannot be started.
    explicit crew(
        int size, const std::function<void(int)>& begin = [](int) {}) {
        for (int k = 1; k < size; ++k) {
            workers_.push_back(std::make_unique<worker>());
            workers_.back()->give([begin, k] { begin(k); });
        }
    }

    /// Runs f(k) for each policy, the first on the caller's thread. Returns when all have ended. If some throw, what the
    /// first of them threw is thrown on. May be called from several threads at a time: each of the crew's threads does their
    /// work in turn. Not to be called from within f.
    template <class F>
    void run(const F& f) {
        std::vector<std::exception_ptr> failed(workers_.size() + 1);
        const auto attempt = [&](std::size_t k) {
            try {
                f(static_cast<int>(k));
            } catch (...) {
                failed[k] = std::current_exception();
            }
        };
        countdown left(workers_.size());
        std::size_t given = 0;
        try {
            for (; given < workers_.size(); ++given) {
                workers_[given]->give([&attempt, &left, k = given + 1] {
                    attempt(k);
                    left.count();
                });
            }
        } catch (...) {  // no memory for a job: it is done here
        }
        attempt(0);
        for (std::size_t k = given; k < workers_.size(); ++k) {
            attempt(k + 1);
            left.count();
        }
        left.wait();
        for (const std::exception_ptr& e : failed) {
            if (e) std::rethrow_exception(e);
        }
    }

private:
    class countdown {
    public:
        explicit countdown(std::size_t n) : left_(n) {}
        void count() {
            const std::scoped_lock lock(mutex_);
            if (--left_ == 0) none_.notify_all();  // under the lock: whoever waits may go away with this
        }
        void wait() {
            std::unique_lock lock(mutex_);
            none_.wait(lock, [this] { return left_ == 0; });
        }

    private:
        std::mutex mutex_;
        std::condition_variable none_;
        std::size_t left_;
    };

    class worker {
    public:
        worker() : thread_([this] { work(); }) {}
        worker(const worker&) = delete;
        worker& operator=(const worker&) = delete;
        ~worker() {
            {
                const std::scoped_lock lock(mutex_);
                ends_ = true;
            }
            some_.notify_one();
            thread_.join();
        }
        void give(std::function<void()> job) {
            {
                const std::scoped_lock lock(mutex_);
                jobs_.push_back(std::move(job));
            }
            some_.notify_one();
        }

    private:
        void work() {
            for (;;) {
                std::unique_lock lock(mutex_);
                some_.wait(lock, [this] { return ends_ || !jobs_.empty(); });
                if (jobs_.empty()) return;
                const auto job = std::move(jobs_.front());
                jobs_.pop_front();
                lock.unlock();
                job();
            }
        }

        std::mutex mutex_;
        std::condition_variable some_;
        std::deque<std::function<void()>> jobs_;
        bool ends_ = false;
        std::thread thread_;  // last: it reads the others
    };

    std::vector<std::unique_ptr<worker>> workers_;
};

/// Runs f(k) for every policy of a team, as crew::run says.
template <policy_team Team, class F>
void on_each(const Team& team, const F& f) {
    team.threads().run(f);
}

}  // namespace abut::execution
