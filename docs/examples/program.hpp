// SPDX-License-Identifier: MIT
#pragma once

// What the example programs share: a stopwatch for named stages, types and policies chosen by their names, and how a command
// line is read and a failure told. None of it is about collisions.

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <concepts>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <unistd.h>

#include <CLI/CLI.hpp>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/execution/policy.hpp>
#include <abut/narrow/time_of_impact.hpp>

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
    /// The sum of the stage's runs, in milliseconds; nothing if it has not run.
    [[nodiscard]] std::optional<double> total(const std::string& stage) const {
        for (const auto& [name, times] : stages_) {
            if (name == stage) return std::accumulate(times.begin(), times.end(), 0.0);
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

// --- Ctrl-C ------------------------------------------------------------------------------------------------------------

/// While it lives, the first Ctrl-C ends a series of runs after the one that is going on, so that what was measured is
/// printed. The second one ends the program.
class interruption {
public:
    explicit interruption(bool is_series) {
        if (!is_series) return;
        struct sigaction action {};
        action.sa_handler = note;
        action.sa_flags = static_cast<int>(SA_RESETHAND);
        sigaction(SIGINT, &action, nullptr);
    }
    interruption(const interruption&) = delete;
    interruption& operator=(const interruption&) = delete;
    ~interruption() { std::signal(SIGINT, SIG_DFL); }
    static bool came() { return came_ != 0; }

private:
    static void note(int) {
        came_ = 1;
        constexpr char text[] = "\nstopping after this run; Ctrl-C again stops at once\n";
        if (write(STDERR_FILENO, text, sizeof text - 1) < 0) return;
    }
    static inline volatile std::sig_atomic_t came_ = 0;
};

/// A series of runs, of which there is at least one: for (series runs(n); runs.more();) { ...; if (runs.is_last()) ... }
class series {
public:
    explicit series(int wanted) : wanted_(wanted) {}
    bool more() { return done_ == 0 || !is_last() ? (++done_, true) : false; }
    /// Once it is the last one it stays so, whatever comes during what is done then.
    bool is_last() { return last_ = last_ || done_ >= wanted_ || interruption::came(); }
    /// Counts from 1.
    [[nodiscard]] int number() const { return done_; }

private:
    int wanted_, done_ = 0;
    bool last_ = false;
};

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
    if constexpr (std::same_as<X, abut::conservative>) return "conservative";
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

/// What a program on the processor is compiled for, and its policies; program_cuda.hpp has the same of one on a GPU. A
/// program adds its name.
struct host_program {
    static constexpr const char* note = "";
    static constexpr bool has_threads = true;
    using scalars = types<float, double>;
    using arithmetics = types<abut::filtered, abut::fast, abut::exact>;

    static std::vector<std::string> policies() { return {"openmp", "serial"}; }
    static void require_device(const std::string&) {}
    /// run(policy) for the policy of that name.
    template <class Run>
    static void with_policy(const std::string& name, int threads, const Run& run) {
        if (name == "serial") return run(abut::serial{});
        run(abut::openmp{.threads = threads});
    }
};

// --- the command line --------------------------------------------------------------------------------------------------

/// Settings that all programs have.
struct common_settings {
    std::vector<std::string> policies;
    std::string arithmetic = "filtered", scalar = "float";
    int threads = 0;
    int repeat = 1;
    bool no_output = false;
    std::string view;        ///< a file to look at; empty: none (view.hpp)
    bool is_series = false;  ///< Ctrl-C ends it between two runs also where nothing is repeated

    /// Where a program takes but one.
    [[nodiscard]] const std::string& policy() const { return policies.front(); }
};

template <class Program>
void add_threads(CLI::App& app, common_settings& s) {
    if (!Program::has_threads) return;
    app.add_option("--threads", s.threads, "Threads of openmp (0: as many as OpenMP gives)")
        ->check(CLI::Range(0, 4096))
        ->capture_default_str();
}

/// One policy, by default the first that the program has, and its threads.
template <class Program>
void add_policy(CLI::App& app, common_settings& s) {
    app.add_option("--policy", s.policies.front(), "What runs it")
        ->check(CLI::IsMember(Program::policies()))
        ->capture_default_str();
    add_threads<Program>(app, s);
}

/// `decided`: what the arithmetic is for.
template <class Program>
void add_types(CLI::App& app, common_settings& s, const std::string& decided) {
    app.add_option("--arithmetic", s.arithmetic, "How " + decided + " are decided; only fast can be wrong")
        ->check(CLI::IsMember(names_of(typename Program::arithmetics{})))
        ->capture_default_str();
    app.add_option("--scalar", s.scalar, "Type of the coordinates")
        ->check(CLI::IsMember(names_of(typename Program::scalars{})))
        ->capture_default_str();
}

/// `repeated`: what is done N times.
inline void add_repeat(CLI::App& app, common_settings& s, const std::string& repeated) {
    app.add_option("--repeat", s.repeat, repeated + " N times, and show the medians")
        ->type_name("N")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
}

/// A complaint about the command line, which is the user's to mend.
struct usage_error : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Refuses a file that cannot be written: before the work, not after minutes of it. One that is there stays as it is.
inline void require_writable(const std::string& file) {
    const std::filesystem::path path(file), folder = path.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder)) throw usage_error(file + ": no such folder");
    const bool is_there = std::filesystem::exists(path);
    if (is_there && std::filesystem::is_directory(path)) throw usage_error(file + ": is a folder");
    if (is_there && !std::filesystem::is_regular_file(path)) return;
    std::FILE* const opened = std::fopen(file.c_str(), "ab");
    if (opened == nullptr) throw usage_error(file + ": cannot be written: " + std::strerror(errno));
    std::fclose(opened);
    if (!is_there) std::filesystem::remove(path);
}

/// Refuses a mesh's file of a format that is not written, by its extension, as abut::io::write_mesh does.
inline void require_mesh_format(const std::string& option, const std::string& file) {
    std::string extension = std::filesystem::path(file).extension().string();
    for (char& c : extension) c = 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (extension != ".ply" && extension != ".vtp") {
        throw usage_error(option + ": " + file + ": expected a name that ends with .ply or .vtp");
    }
}

/// Writes files with `write`, if anything is to be written, then calls print(written), and only then says what could not be
/// written: results are shown all the same.
template <class Write, class Print>
void write_and_print(bool writes, const Write& write, const Print& print) {
    std::exception_ptr failure;
    try {
        if (writes) write();
    } catch (...) {
        failure = std::current_exception();
    }
    print(writes && !failure);
    std::fflush(stdout);
    if (failure) std::rethrow_exception(failure);
}

inline void check_threads(const common_settings& s) {
    if (s.threads > 0 && std::count(s.policies.begin(), s.policies.end(), "openmp") == 0) {
        throw usage_error("--threads goes with --policy openmp");
    }
}

/// The main of a program: describes the options with `describe(app)`, reads them into `s`, looks for what CLI11 does not
/// with `check()`, and does work.template operator()<T>() for the scalar T, whose result is the exit status; 1 if it fails,
/// 2 if the command line is wrong. A failure is one line on stderr.
template <class Program, class Describe, class Check, class Work>
int run(int argc, char** argv, const common_settings& s, const Describe& describe, const Check& check, const Work& work) {
    const auto fail = [](const std::string& why, int status) {
        std::fprintf(stderr, "%s: %s\n", Program::name, why.c_str());
        return status;
    };
    CLI::App app("", Program::name);
    describe(app);
    try {
        app.parse(argc, argv);
        check();
        for (const auto& policy : s.policies) Program::require_device(policy);
        const interruption in_runs(s.repeat > 1 || s.is_series);
        int status = 0;
        choose(typename Program::scalars{}, s.scalar, [&]<class T>() { status = work.template operator()<T>(); });
        if (!interruption::came()) return status;
        std::fflush(stdout);
        return fail("stopped by Ctrl-C: the figures are those of the runs until then", 130);
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
