// SPDX-License-Identifier: MIT
#include <abut/predicate/sphere_triangle.hpp>

#include <cstdio>
#include <cstdlib>
#include <string>

#include <abut/predicate/intersects.hpp>

#include "support/catch.hpp"
#include "support/families.hpp"
#include "support/rational.hpp"
#include "support/samples.hpp"

// Every stage against the oracle, family by family. The table goes to stdout, and as Markdown to the file that ABUT_RESULTS
// names.

namespace {

using namespace abut;
using test::family;

struct tally {
    std::uint64_t pairs = 0, hits = 0, missed = 0, phantom = 0;           // missed and phantom: of `fast`
    std::uint64_t filter = 0, one_limb = 0, two_limbs = 0, any_span = 0;  // which stage decided
    std::uint64_t wrong = 0;                                              // of any stage but `fast`, and of `intersects`

    tally& operator+=(const tally& o) {
        pairs += o.pairs, hits += o.hits, missed += o.missed, phantom += o.phantom;
        filter += o.filter, one_limb += o.one_limb, two_limbs += o.two_limbs, any_span += o.any_span, wrong += o.wrong;
        return *this;
    }
};

template <scalar T>
void examine(const test::sphere_triangle_pair<T>& p, std::uint64_t index, tally& sum) {
    const auto& [s, t] = p;
    const bool truth = test::oracle::intersects(s, t);
    const bool quick = intersects<fast>(s, t);
    const verdict by_filter = decide<filtered>(s, t), by_limbs = decide<exact>(s, t);
    const T values[] = {s.center.x, s.center.y, s.center.z, t.a.x, t.a.y, t.a.z,   t.b.x,
                        t.b.y,      t.b.z,      t.c.x,      t.c.y, t.c.z, s.radius};
    const int width = aligned<13>(values).width();

    ++sum.pairs;
    sum.hits += truth;
    sum.missed += truth && !quick;
    sum.phantom += !truth && quick;
    if (by_filter != verdict::unknown) {
        ++sum.filter;
    } else if (width <= 60) {
        ++sum.one_limb;
    } else if (width <= 124) {
        ++sum.two_limbs;
    } else {
        ++sum.any_span;
    }
    const auto contradicts = [truth](verdict v) { return v == to_verdict(!truth); };
    bool wrong = contradicts(by_filter) || contradicts(by_limbs) || (by_limbs == verdict::unknown) != (width > 124);
    wrong = wrong || intersects(s, t) != truth || intersects<exact>(t, s) != truth;
    // The last stage is a hundred times slower than the others: all pairs that need it, and some that do not.
    if (by_limbs == verdict::unknown || index % 16 == 0) wrong = wrong || resolve(s, t) != truth;
    // The narrow stage must agree with the wide one where both may run.
    if (width <= 60 && index % 4 == 0)
        wrong = wrong || holds_in_limbs<detail::ball_meets_triangle, 2>(aligned<13>(values)) != truth;
    sum.wrong += wrong;
}

template <scalar T>
tally examine_family(family f) {
    return test::in_threads<tally>(test::sample_count(), [f](std::uint64_t first, std::uint64_t last, tally& sum) {
        for (std::uint64_t i = first; i < last; ++i) examine(test::make_pair<T>(test::seed, f, i), i, sum);
    });
}

double percent(std::uint64_t part, std::uint64_t whole) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}
double per_million(std::uint64_t part, std::uint64_t whole) { return 1e4 * percent(part, whole); }

void print_row(std::FILE* out, const char* name, const char* type, const tally& t) {
    std::fprintf(out, "| %s | %s | %llu | %.1f | %.0f / %.0f | %.3f | %.3f | %.3f | %.3f | %llu |\n", name, type,
                 static_cast<unsigned long long>(t.pairs), percent(t.hits, t.pairs), per_million(t.missed, t.pairs),
                 per_million(t.phantom, t.pairs), percent(t.filter, t.pairs), percent(t.one_limb, t.pairs),
                 percent(t.two_limbs, t.pairs), percent(t.any_span, t.pairs), static_cast<unsigned long long>(t.wrong));
    std::fflush(out);
}

void print_head(std::FILE* out) {
    std::fprintf(out,
                 "Sphere against triangle, seed %llu; fast: missed / phantom per million; then the share of pairs that each "
                 "stage decides (%%)\n\n",
                 static_cast<unsigned long long>(test::seed));
    std::fprintf(out, "| family | scalar | pairs | hits %% | fast | filter | 1 limb | 2 limbs | any span | wrong |\n");
    std::fprintf(out, "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
}

}  // namespace

TEST_CASE("sphere and triangle: every stage is right in every family") {
    const char* const path = std::getenv("ABUT_RESULTS");
    std::FILE* const file = path != nullptr ? std::fopen(path, "w") : nullptr;
    print_head(stdout);
    if (file != nullptr) print_head(file);
    for (int i = 0; i < test::family_count; ++i) {
        const auto f = static_cast<family>(i);
        for (const bool single : {true, false}) {
            const tally t = single ? examine_family<float>(f) : examine_family<double>(f);
            print_row(stdout, test::name_of(f), single ? "float" : "double", t);
            if (file != nullptr) print_row(file, test::name_of(f), single ? "float" : "double", t);
            INFO(test::name_of(f) << (single ? ", float" : ", double"));
            CHECK(t.pairs >= test::sample_count());
            CHECK(t.wrong == 0);
            // A family in which everything touches, or nothing, tests nothing.
            CHECK(percent(t.hits, t.pairs) > 5);
            CHECK(percent(t.hits, t.pairs) < 95);
        }
    }
    if (file != nullptr) std::fclose(file);
}
