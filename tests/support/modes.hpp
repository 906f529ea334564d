// SPDX-License-Identifier: MIT
#pragma once

// Floating-point modes of a thread: rounding, and on x86 what becomes of denormal results and operands.

#include <cfenv>
#include <cstdint>
#include <functional>
#include <vector>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace abut::test {

struct floating_mode {
    const char* name;
    int rounding;
    unsigned flags = 0;
};

/// Flags of MXCSR.
inline constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;

/// The first is the default.
inline std::vector<floating_mode> floating_modes() {
    std::vector<floating_mode> modes{
        {"default", FE_TONEAREST}, {"upward", FE_UPWARD}, {"downward", FE_DOWNWARD}, {"towards zero", FE_TOWARDZERO}};
#if defined(__SSE2__)
    constexpr unsigned both = flush_to_zero | denormals_are_zero;
    modes.push_back({"flush to zero, denormals are zero", FE_TONEAREST, both});
    modes.push_back({"flush to zero", FE_TONEAREST, flush_to_zero});
    modes.push_back({"denormals are zero", FE_TONEAREST, denormals_are_zero});
    modes.push_back({"flush to zero, denormals are zero, upward", FE_UPWARD, both});
    modes.push_back({"flush to zero, denormals are zero, towards zero", FE_TOWARDZERO, both});
#endif
    return modes;
}

/// Runs `body` in a mode. By a call that compilers cannot look through, so that nothing moves out of the mode or into it.
inline void in_mode(const floating_mode& mode, const std::function<void()>& body) {
    const std::function<void()>* volatile hidden = &body;
    const int rounding = std::fegetround();
    std::fesetround(mode.rounding);
#if defined(__SSE2__)
    const unsigned before = _mm_getcsr();
    _mm_setcsr((before & ~(flush_to_zero | denormals_are_zero)) | mode.flags);
#endif
    (*hidden)();
#if defined(__SSE2__)
    _mm_setcsr(before);
#endif
    std::fesetround(rounding);
}

/// In how many of the modes `holds()` says true.
template <class Question>
std::uint64_t modes_in_which(const Question& holds) {
    static const std::vector<floating_mode> modes = floating_modes();
    std::uint64_t count = 0;
    for (const floating_mode& mode : modes) {
        bool answer = false;
        in_mode(mode, [&] { answer = holds(); });
        count += answer;
    }
    return count;
}

}  // namespace abut::test
