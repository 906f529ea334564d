// SPDX-License-Identifier: MIT
#pragma once

// The file in which a benchmark leaves what it measured, from which bench/report.py makes tables and plots:
//
//   {"context": {"program": "...", "machine": "...", "cores": "...", "compiler": "...", "flags": "...", "commit": "...",
//                "date": "YYYY-MM-DD", ...},
//    "rows": {"NAME": {"ms": 1.25, "COUNTER": 39708, ...}, ...}}
//
// A row is a median; `ms` is left out where nothing was timed. Names have parts with slashes between them. Programs on
// Google Benchmark give the same context (bench/google.hpp), and bench/report.py reads medians and counters out of their
// files.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <time.h>

namespace bench {

using counters = std::vector<std::pair<std::string, double>>;
using description = std::vector<std::pair<std::string, std::string>>;

/// A version as CUDA numbers it, 13000, as people write it: 13.0.
inline std::string cuda_version(int number) {
    return std::to_string(number / 1000) + "." + std::to_string(number % 1000 / 10);
}

/// Parts of a row's name with slashes between them.
inline std::string joined(std::initializer_list<std::string> parts) {
    std::string name;
    for (const auto& part : parts) {
        if (!name.empty()) name += '/';
        name += part;
    }
    return name;
}

/// What the results of a program need to be read years later. The environment says what a program cannot know of itself:
/// ABUT_COMMIT and ABUT_FLAGS (of the compiler).
inline description context(const std::string& program) {
    const auto from_environment = [](const char* name, std::string otherwise = "unknown") {
        const char* const value = std::getenv(name);
        return value == nullptr ? otherwise : std::string(value);
    };
    const std::string cores = std::to_string(std::thread::hardware_concurrency());
    std::string machine = "unknown", line;
    for (std::ifstream cpu("/proc/cpuinfo"); std::getline(cpu, line);) {
        if (line.rfind("model name", 0) != 0) continue;
        machine = line.substr(line.find(':') + 2);
        break;
    }
#ifdef __clang__
    const std::string compiler = __VERSION__;
#else
    const std::string compiler = std::string("g++ ") + __VERSION__;
#endif
    const std::time_t now = std::time(nullptr);
    char date[16];
    std::strftime(date, sizeof(date), "%Y-%m-%d", std::gmtime(&now));
    return {{"program", program},
            {"machine", machine},
            {"cores", cores},
            {"threads", from_environment("OMP_NUM_THREADS", cores)},
            {"compiler", compiler},
            {"flags", from_environment("ABUT_FLAGS")},
            {"commit", from_environment("ABUT_COMMIT")},
            {"date", date}};
}

class results {
public:
    explicit results(const std::string& program) : context_(context(program)) {}

    void describe(const std::string& key, const std::string& value) { context_.emplace_back(key, value); }

    /// A row is printed as it comes.
    void add(const std::string& name, const counters& values) {
        rows_.emplace_back(name, values);
        std::printf("%-44s", name.c_str());
        for (const auto& [key, value] : values) std::printf("  %s %.6g", key.c_str(), value);
        std::printf("\n");
        std::fflush(stdout);
    }

    void write(const std::string& path) const {
        std::ofstream out(path);
        out.precision(9);
        out << "{\"context\": {";
        const char* between = "";
        for (const auto& [key, value] : context_) {
            out << between << quoted(key) << ": " << quoted(value);
            between = ", ";
        }
        out << "},\n \"rows\": {";
        between = "\n";
        for (const auto& [name, values] : rows_) {
            out << between << "  " << quoted(name) << ": {";
            between = "";
            for (const auto& [key, value] : values) {
                if (!std::isfinite(value)) continue;  // JSON has no such numbers
                out << between << quoted(key) << ": " << value;
                between = ", ";
            }
            out << "}";
            between = ",\n";
        }
        out << "\n}}\n";
        if (!out.flush()) throw std::runtime_error(path + ": cannot be written");
    }

private:
    static std::string quoted(const std::string& text) {
        std::string all = "\"";
        for (const char c : text) {
            if (c == '"' || c == '\\') all += '\\';
            all += c;
        }
        return all + '"';
    }

    description context_;
    std::vector<std::pair<std::string, counters>> rows_;
};

/// Of this thread, in ns.
inline double processor_time() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

/// Takes NAME=VALUE out of the arguments, where NAME is such as "--json"; `otherwise` if it is not there.
inline std::string take_argument(int& argc, char** argv, const std::string& name, std::string otherwise = "") {
    int kept = 1;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        if (argument.rfind(name + "=", 0) == 0) {
            otherwise = argument.substr(name.size() + 1);
        } else {
            argv[kept++] = argv[i];
        }
    }
    argc = kept;
    return otherwise;
}

}  // namespace bench
