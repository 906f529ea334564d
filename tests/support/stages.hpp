// SPDX-License-Identifier: MIT
#pragma once

// What the stages of a predicate say of the pairs of a family, against the truth; and the table of it, on stdout and as
// Markdown in the folder that ABUT_RESULTS names.

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <stdexcept>
#include <string>

#include <abut/arithmetic/align.hpp>
#include <abut/predicate/intersects.hpp>

#include "catch.hpp"
#include "samples.hpp"

namespace abut::test {

/// What all stages together say: wrong of any but `fast`, unlike of that, and open after the filter.
struct decision_tally {
    std::uint64_t pairs = 0, hits = 0, wrong = 0, unlike = 0, open = 0;

    decision_tally& operator+=(const decision_tally& o) {
        pairs += o.pairs, hits += o.hits, wrong += o.wrong, unlike += o.unlike, open += o.open;
        return *this;
    }
};

struct stage_tally {
    std::uint64_t pairs = 0, hits = 0, missed = 0, phantom = 0;                     // missed and phantom: of `fast`
    std::uint64_t filter = 0, late = 0, one_limb = 0, two_limbs = 0, any_span = 0;  // which stage decided
    std::uint64_t wrong = 0;  // of any stage but `fast`, and of `intersects`

    stage_tally& operator+=(const stage_tally& o) {
        pairs += o.pairs, hits += o.hits, missed += o.missed, phantom += o.phantom;
        filter += o.filter, late += o.late, one_limb += o.one_limb, two_limbs += o.two_limbs, any_span += o.any_span,
            wrong += o.wrong;
        return *this;
    }

    /// One more pair: what `fast` says, and each stage, whose integers take `width` digits. Returns whether a stage but
    /// `fast` is wrong.
    bool count(bool truth, bool quick, verdict by_filter, verdict by_late, verdict by_limbs, int width) {
        ++pairs;
        hits += truth;
        missed += truth && !quick;
        phantom += !truth && quick;
        ++(by_filter != verdict::unknown ? filter
           : by_late != verdict::unknown ? late
           : width <= 59                 ? one_limb
           : width <= 124                ? two_limbs
                                         : any_span);
        const verdict lie = to_verdict(!truth);
        return by_filter == lie || by_late == lie || by_limbs == lie;
    }
};

/// What lies between the filter and the integers: not every pair of shapes has it.
template <class S, class U>
verdict late_verdict(const S& s, const U& t) {
    if constexpr (requires { decide_late<filtered>(s, t); }) {
        return decide_late<filtered>(s, t);
    } else {
        return verdict::unknown;
    }
}

/// Tries every stage on pair number `index`. `Predicate` is the one that the integers evaluate, and `values` its arguments.
template <class Predicate, class S, class U, scalar T, int V>
void examine_stages(const S& s, const U& t, const T (&values)[V], bool truth, std::uint64_t index, stage_tally& sum) {
    const bool quick = intersects<fast>(s, t);
    const verdict by_filter = decide<filtered>(s, t), late = late_verdict(s, t), by_limbs = decide<exact>(s, t);
    const aligned<V> integers(values);
    const int width = integers.width();

    bool wrong = sum.count(truth, quick, by_filter, late, by_limbs, width);
    wrong = wrong || (by_limbs == verdict::unknown) != (width > 124);
    wrong = wrong || decide<fast>(s, t) == to_verdict(!quick);
    wrong = wrong || intersects(s, t) != truth || intersects<exact>(t, s) != truth;
    // The last stage is a hundred times slower than the others: all pairs that need it, and some that do not.
    if (by_limbs == verdict::unknown || index % 16 == 0) wrong = wrong || resolve(s, t) != truth;
    // The narrow integers must agree with the wide ones where both may be used.
    if (width <= 60 && index % 4 == 0) {
        wrong = wrong || holds_in_limbs<Predicate, 1>(integers) != truth || holds_in_limbs<Predicate, 2>(integers) != truth;
    }
    sum.wrong += wrong;
}

inline double percent(std::uint64_t part, std::uint64_t whole) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

/// The page is Markdown, and its last line holds a checksum of all others, FNV-1a of 64 bits: bench/report.py looks whether
/// anybody has changed a digit.
class stage_table {
public:
    /// `file_name` without a folder; `title` says which shapes, and `late` whether they have a stage `decide_late`.
    stage_table(const char* title, const char* file_name, bool late) : late_(late) {
        if (const char* const folder = std::getenv("ABUT_RESULTS"); folder != nullptr && *folder != 0) {
            const std::string path = std::string(folder) + "/" + file_name;
            file_ = std::fopen(path.c_str(), "w");
            if (file_ == nullptr) throw std::runtime_error("ABUT_RESULTS: cannot write " + path);
        }
        const char* const commit = std::getenv("ABUT_COMMIT");
        const std::time_t now = std::time(nullptr);
        char date[16] = "";
        std::strftime(date, sizeof date, "%Y-%m-%d", std::gmtime(&now));
        put("# %s\n\n", title);
        put("Pairs that were built to break the arithmetic, one family for each way, compared with an\n"
            "[oracle](../glossary.md#oracle). Seed %llu, commit %s, %s.\n\n",
            static_cast<unsigned long long>(sample_seed), commit == nullptr ? "unknown" : commit, date);
        put("The column of `fast` has its wrong answers of a million, [missed](../glossary.md#missed) / "
            "[phantom](../glossary.md#phantom). Those after it have the\n"
            "share of pairs in %% that each [stage](../glossary.md#stage) of `filtered` decides: the floating-point "
            "[filter](../glossary.md#filter)%s, integers\n"
            "of 1 and 2 [limbs](../glossary.md#word), and the last stage, for numbers of any [span](../glossary.md#span). "
            "The last column counts the pairs about\n"
            "which one of these, `filtered` or `exact` is wrong.\n\n",
            late_ ? ", the late stage" : "");
        put("| family | scalar | pairs | hits %% | fast | filter |%s 1 limb | 2 limbs | any span | wrong |\n",
            late_ ? " late |" : "");
        put("| --- | --- | --- | --- | --- | --- |%s --- | --- | --- | --- |\n", late_ ? " --- |" : "");
    }
    ~stage_table() {
        if (file_ == nullptr) return;
        std::fprintf(file_, "\n<!-- checksum: %016llx -->\n", static_cast<unsigned long long>(sum_));
        std::fclose(file_);
    }
    stage_table(const stage_table&) = delete;
    stage_table& operator=(const stage_table&) = delete;

    void add(const char* family, const char* type, const stage_tally& t) {
        put("| %s | %s | %llu | %.1f | %.0f / %.0f | %.3f |", family, type, static_cast<unsigned long long>(t.pairs),
            percent(t.hits, t.pairs), 1e4 * percent(t.missed, t.pairs), 1e4 * percent(t.phantom, t.pairs),
            percent(t.filter, t.pairs));
        if (late_) put(" %.3f |", percent(t.late, t.pairs));
        put(" %.3f | %.3f | %.3f | %llu |\n", percent(t.one_limb, t.pairs), percent(t.two_limbs, t.pairs),
            percent(t.any_span, t.pairs), static_cast<unsigned long long>(t.wrong));
    }

private:
    /// To stdout, and to the page.
    [[gnu::format(printf, 2, 3)]] void put(const char* format, ...) {
        char text[2048];
        std::va_list values;
        va_start(values, format);
        std::vsnprintf(text, sizeof text, format, values);
        va_end(values);
        std::fputs(text, stdout);
        std::fflush(stdout);
        if (file_ == nullptr) return;
        for (const char* c = text; *c != 0; ++c) sum_ = (sum_ ^ static_cast<unsigned char>(*c)) * 0x100000001b3u;
        std::fputs(text, file_);
        std::fflush(file_);
    }

    bool late_;
    std::FILE* file_ = nullptr;
    std::uint64_t sum_ = 0xcbf29ce484222325u;
};

/// Every stage against the oracle in each of `count` families, float and double. `name(f)` is a family's name, and
/// `examine(T{}, f, index, tally)` tries every stage on one pair of it. Where the oracle takes long, one in `sparsely` of
/// the samples will do.
template <class Family, class Name, class Examine>
void check_every_family(const char* title, const char* file_name, bool late, int count, const Name& name,
                        const Examine& examine, std::uint64_t sparsely = 1) {
    stage_table table(title, file_name, late);
    const std::uint64_t samples = (sample_count() + sparsely - 1) / sparsely;
    const auto all_pairs = [&]<class T>(T, Family f) {
        return in_threads<stage_tally>(samples, [&](std::uint64_t first, std::uint64_t last, stage_tally& sum) {
            for (std::uint64_t k = first; k < last; ++k) examine(T{}, f, k, sum);
        });
    };
    for (int i = 0; i < count; ++i) {
        const auto f = static_cast<Family>(i);
        for (const bool single : {true, false}) {
            const stage_tally t = single ? all_pairs(float{}, f) : all_pairs(double{}, f);
            const char* const type = single ? "float" : "double";
            table.add(name(f), type, t);
            INFO(name(f) << ", " << type);
            CHECK(t.pairs >= samples);
            CHECK(t.wrong == 0);
            // A family in which everything touches, or nothing, tests nothing.
            CHECK(percent(t.hits, t.pairs) > 5);
            CHECK(percent(t.hits, t.pairs) < 95);
        }
    }
}

}  // namespace abut::test
