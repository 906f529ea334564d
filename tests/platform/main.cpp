// SPDX-License-Identifier: MIT

// usage: platform TABLE                                 compare with a table; 0 if all is equal
//        platform --print                               write the table
//        platform --part K N TABLE                      compare part K, from 0, of N, for processes beside each other
//        platform --only KIND TABLE                     compare one kind
//        platform --first N KIND SCALAR QUESTION        the first N answers of a row, in bits, for bisection

#include <chrono>
#include <fstream>
#include <map>
#include <sstream>

#include <abut/arithmetic/self_test.hpp>

#include "questions.hpp"

namespace {

/// A part of all kinds: every n-th source from the k-th on.
struct part {
    unsigned long k = 0, n = 1;
};

platform::table answered(const platform::watched& w, const std::string& only, bool is_timed, part p = {}) {
    platform::table t(w, only);
    if (p.k == 0 && t.asks("self_test")) {
        platform::answers a = t.of("self_test", "both", "passed");
        a.next(), a.add(abut::self_test().passed());
    }
    struct named {
        const char* name;
        void (*ask)(platform::table&);
    };
    unsigned long source = 0;
    for (const named& q : {named{"triangles", platform::ask_triangles},
                           {"simple", platform::ask_simple},
                           {"hulls", platform::ask_hulls},
                           {"revolution", platform::ask_revolution},
                           {"revolution_pairs", platform::ask_revolution_pairs},
                           {"motion", platform::ask_motion},
                           {"rays", platform::ask_rays},
                           {"points", platform::ask_points},
                           {"meshes", platform::ask_meshes},
                           {"bodies", platform::ask_bodies}}) {
        if (source++ % p.n != p.k) continue;
        const auto start = std::chrono::steady_clock::now();
        q.ask(t);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        if (is_timed) std::fprintf(stderr, "%s: %.2f s\n", q.name, seconds.count());
    }
    return t;
}

void print(const platform::table& t) {
    std::printf("# kind scalar question asked yes hash; written by --print on x86-64\n");
    for (const platform::row* r : t.rows()) {
        if (r->asked == 0) continue;
        std::printf("%s %" PRIu64 " %" PRIu64 " %016" PRIx64 "\n", r->name().c_str(), r->asked, r->yes, r->hash);
    }
}

int compare(const platform::table& t, const char* file, bool is_whole) {
    std::ifstream in(file);
    if (!in) {
        std::printf("cannot read %s\n", file);
        return 2;
    }
    std::map<std::string, std::string> expected;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string kind, scalar, question, asked, yes, hash;
        if (line.empty() || line[0] == '#' || !(words >> kind >> scalar >> question >> asked >> yes >> hash)) continue;
        expected[kind + " " + scalar + " " + question] = asked + " " + yes + " " + hash;
    }
    unsigned differ = 0, rows = 0;
    for (const platform::row* r : t.rows()) {
        if (r->asked == 0) continue;
        ++rows;
        char here[80];
        std::snprintf(here, sizeof here, "%" PRIu64 " %" PRIu64 " %016" PRIx64, r->asked, r->yes, r->hash);
        const auto found = expected.find(r->name());
        const std::string there = found == expected.end() ? "nothing" : found->second;
        if (there == here) continue;
        ++differ;
        std::printf("differs: %s: %s here, %s in the table\n", r->name().c_str(), here, there.c_str());
    }
    if (is_whole && expected.size() != rows) {
        ++differ;
        std::printf("differs: %u rows here, %u in the table\n", rows, static_cast<unsigned>(expected.size()));
    }
    if (differ == 0) std::printf("equal: %u rows\n", rows);
    return differ == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string first = argc > 1 ? argv[1] : "";
    if (first == "--print" && argc == 2) {
        print(answered({}, "", true));
    } else if (first == "--part" && argc == 5) {
        return compare(answered({}, "", true, {std::stoul(argv[2]), std::stoul(argv[3])}), argv[4], false);
    } else if (first == "--only" && argc == 4) {
        return compare(answered({}, argv[2], false), argv[3], false);
    } else if (first == "--first" && argc == 6) {
        const std::string kind = argv[3];
        (void)answered({kind + " " + argv[4] + " " + argv[5], std::stoull(argv[2])}, kind, false);
        std::printf("\n");
    } else if (argc == 2) {
        return compare(answered({}, "", true), argv[1], true);
    } else {
        std::fprintf(
            stderr,
            "usage: platform TABLE | --part K N TABLE | --print | --only KIND TABLE | --first N KIND SCALAR QUESTION\n");
        return 2;
    }
}
