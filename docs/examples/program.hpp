// SPDX-License-Identifier: MIT
#pragma once

// What the example programs share: a stopwatch for named stages, types chosen by their names, and how a command line is read
// and a failure told. None of it is about collisions.

#include <algorithm>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include <CLI/CLI.hpp>

#include <abut/arithmetic/arithmetic.hpp>

namespace example {

// --- where the time goes -----------------------------------------------------------------------------------------------

/// Times named stages, and on a terminal says which one is running; if it is told to, it says on stderr how long each took.
class stopwatch {
public:
    explicit stopwatch(bool tells = false) : tells_(tells) {}
    /// Runs `work` as a stage and returns what it returns.
    template <class Work>
    decltype(auto) time(const char* stage, const Work& work) {
        const running now(*this, stage);
        return work();
    }
    /// The median of the stage's runs, in milliseconds; nothing if it has not run.
    [[nodiscard]] std::optional<double> median(const std::string& stage) const {
        for (const auto& [name, times] : stages_) {
            if (name != stage) continue;
            std::vector<double> sorted = times;
            std::sort(sorted.begin(), sorted.end());
            return (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]) / 2;
        }
        return std::nullopt;
    }
    void print() const {
        for (const auto& stage : stages_) std::printf("  %-16s %12.3f\n", stage.first.c_str(), *median(stage.first));
    }

private:
    class running {
    public:
        running(stopwatch& watch, const char* stage) : watch_(watch), stage_(stage) {
            if (watch_.terminal_) std::fprintf(stderr, "\r\033[K%s ...", stage);
            start_ = std::chrono::steady_clock::now();
        }
        running(const running&) = delete;
        running& operator=(const running&) = delete;
        ~running() {
            const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start_;
            if (watch_.terminal_) std::fputs("\r\033[K", stderr);
            if (watch_.tells_) std::fprintf(stderr, "%s: %.3f ms\n", stage_, took.count());
            watch_.add(stage_, took.count());
        }

    private:
        stopwatch& watch_;
        const char* stage_;
        std::chrono::steady_clock::time_point start_;
    };

    void add(const std::string& stage, double milliseconds) {
        for (auto& [name, times] : stages_) {
            if (name == stage) return times.push_back(milliseconds);
        }
        stages_.push_back({stage, {milliseconds}});
    }

    std::vector<std::pair<std::string, std::vector<double>>> stages_;
    bool terminal_ = isatty(STDERR_FILENO) != 0, tells_;
};

/// How many of a list of flags are set.
inline std::size_t count_set(const std::vector<std::uint8_t>& flags) {
    return static_cast<std::size_t>(std::count(flags.begin(), flags.end(), std::uint8_t{1}));
}

// --- types by name -----------------------------------------------------------------------------------------------------

/// A list of types.
template <class... X>
struct types {};

template <class X>
std::string name_of() {
    if constexpr (std::same_as<X, float>) return "float";
    if constexpr (std::same_as<X, double>) return "double";
    if constexpr (std::same_as<X, abut::fast>) return "fast";
    if constexpr (std::same_as<X, abut::filtered>) return "filtered";
    if constexpr (std::same_as<X, abut::exact>) return "exact";
}

template <class... X>
std::vector<std::string> names_of(types<X...>) {
    return {name_of<X>()...};
}

/// Calls work.template operator()<X>() for the X of the list that has this name.
template <class... X, class Work>
void choose(types<X...>, const std::string& name, const Work& work) {
    ((name_of<X>() == name ? work.template operator()<X>() : void()), ...);
}

// --- the command line --------------------------------------------------------------------------------------------------

/// A complaint about the command line, which is the user's to mend.
struct usage_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Refuses a file that could not be written: before the work, not after minutes of it.
inline void require_folder(const std::string& file) {
    const auto folder = std::filesystem::path(file).parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder)) throw usage_error(file + ": no such folder");
}

/// Describes the options with `describe(app)`, reads them, and does the work, whose result is the exit status; 1 if it
/// fails, 2 if the command line is wrong. A failure is one line on stderr.
template <class Describe, class Work>
int run(const char* name, int argc, char** argv, const Describe& describe, const Work& work) {
    const auto fail = [name](const std::string& why, int status) {
        std::fprintf(stderr, "%s: %s\n", name, why.c_str());
        return status;
    };
    CLI::App app("", name);
    describe(app);
    try {
        app.parse(argc, argv);
        return work();
    } catch (const CLI::Success& help) {
        return app.exit(help);
    } catch (const CLI::ParseError& e) {
        return fail(e.what() + std::string(" (--help explains)"), 2);
    } catch (const usage_error& e) {
        return fail(e.what() + std::string(" (--help explains)"), 2);
    } catch (const std::bad_alloc&) {
        return fail("out of memory", 1);
    } catch (const std::exception& e) {
        return fail(e.what(), 1);
    }
}

}  // namespace example
