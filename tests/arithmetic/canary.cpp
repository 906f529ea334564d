// SPDX-License-Identifier: MIT

// Do error-free transforms and decisions survive this compiler with these flags? No test framework: canary.sh compiles this
// file in many ways, also as CUDA, where the checks run in a kernel if there is a device. It prints what failed and returns
// how many; every input is a product or a sum that the compiler would like to contract with what the library does to it.

#include <cmath>
#include <cstdint>
#include <cstdio>

#include <abut/arithmetic/self_test.hpp>
#include <abut/predicate/intersects.hpp>

namespace {

struct failures {
    int two_sum = 0, two_prod = 0, directed = 0, decisions = 0, self_test = 0;
};

ABUT_HD std::uint64_t next(std::uint64_t& state) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return state >> 11;
}

template <abut::scalar T>
ABUT_HD T draw(std::uint64_t& state) {
    return static_cast<T>(static_cast<double>(next(state)) * 0x1p-52 - 1);
}

template <abut::scalar T>
ABUT_HD abut::vec3<T> vec(T x, T y, T z) {
    return {x, y, z};
}

/// The integers decide whether what the floating point said holds: a + b = value + error and so on, all of one unit.
template <abut::scalar T>
ABUT_HD bool sum_is_exact(T a, T b, T value, T error) {
    const T x[] = {a, b, value, error};
    const abut::aligned<4> z(x);
    if (z.width() > 250) return false;
    const abut::wide_int<4> left = z.template integer<4>(0) + z.template integer<4>(1);
    return left == z.template integer<4>(2) + z.template integer<4>(3);
}

template <abut::scalar T>
ABUT_HD bool product_is_exact(T a, T b, T value, T error) {
    const abut::binary_parts x = abut::take_apart(a), y = abut::take_apart(b);
    const T parts[] = {value, error};
    const abut::aligned<2> z(parts);
    const auto p = abut::wide_int<1>::shifted(x.mantissa, 0) * abut::wide_int<1>::shifted(y.mantissa, 0);
    const auto sum = z.template integer<4>(0) + z.template integer<4>(1);
    const int shift = x.exponent + y.exponent - z.low;
    if (p == abut::wide_int<2>{} || shift < 0 || shift > 60) return p == abut::wide_int<2>{};
    return sum == p * abut::wide_int<2>::shifted(1, shift);
}

/// a * b for one use alone. A compiler contracts a product only if it can contract all of its uses, and it would find a
/// second a * b of the same numbers.
template <abut::scalar T>
ABUT_HD T product(T a, T b) {
    return abut::detail::at_run_time(a) * abut::detail::at_run_time(b);
}

template <abut::scalar T>
ABUT_HD void check(std::uint64_t seed, failures& f) {
    std::uint64_t s = seed;
    for (int i = 0; i < 2000; ++i) {
        const T a = draw<T>(s), b = draw<T>(s), c = draw<T>(s), d = draw<T>(s);
        const T ab = abut::detail::at_run_time(a * b), cd = abut::detail::at_run_time(c * d);

        const auto sum = abut::two_sum(product(a, b), c), difference = abut::two_diff(product(a, b), product(c, d));
        f.two_sum += !sum_is_exact<T>(ab, c, sum.value, sum.error);
        f.two_sum += !sum_is_exact<T>(ab, -cd, difference.value, difference.error);

        const auto p = abut::two_prod(a, b);
        const T more = p.value + c;  // must not pull the product in
        f.two_prod += !product_is_exact(a, b, p.value, p.error) || more != abut::detail::at_run_time(ab + c);

        const T up = abut::add_up(product(a, b), product(c, d)), down = abut::add_down(product(a, b), -product(c, d));
        f.directed += up != abut::add_up(ab, cd) || down != abut::add_down(ab, -cd);
        const auto exact_sum = abut::two_sum(ab, cd);
        f.directed += up < exact_sum.value || (exact_sum.error > 0) != (up > exact_sum.value);

        // The same point, once as a product: its distance from itself is 0, and not the error of the product.
        const abut::sphere<T> point{{product(a, b), c, d}, T(0)}, same{{ab, c, d}, T(0)};
        f.decisions += !abut::intersects(point, same) || !abut::intersects<abut::exact>(point, same);
        const abut::triangle<T> corner{{product(a, b), c, d}, {a, b, c}, {d, a, b}};
        f.decisions += !abut::intersects(vec(ab, c, d), corner) || !abut::intersects(same, corner);

        // A ball that touches a tilted triangle or not by a hair: the stages must agree.
        const abut::triangle<T> t{{a, b, c}, {b, c + 1, a}, {c - 1, a, b}};
        const abut::vec3<T> center{d, a - b, c};
        const abut::vec3<T> q = abut::detail::nearest_to_origin(t.a - center, t.b - center, t.c - center);
        const abut::sphere<T> ball{center, abut::detail::at_run_time(static_cast<T>(std::sqrt(abut::dot(q, q))))};
        const bool truth = abut::resolve(ball, t);
        f.decisions += abut::intersects(ball, t) != truth || abut::intersects<abut::exact>(ball, t) != truth;
    }
}

ABUT_HD void check_all(failures& f) {
    f.self_test += !abut::self_test().passed();
    check<float>(1, f);
    check<double>(2, f);
}

int report(const char* where, const failures& f) {
    const int all = f.two_sum + f.two_prod + f.directed + f.decisions + f.self_test;
    if (all != 0) {
        std::printf("%s: two_sum %d, two_prod %d, directed sums %d, decisions %d, self test %d\n", where, f.two_sum,
                    f.two_prod, f.directed, f.decisions, f.self_test);
    }
    return all;
}

}  // namespace

#if defined(__CUDACC__)
__global__ void run_on_device(failures* f) { check_all(*f); }
#endif

int main() {
    failures host;
    check_all(host);
    int failed = report("host", host);
#if defined(__CUDACC__)
    int devices = 0;
    if (cudaGetDeviceCount(&devices) != cudaSuccess || devices == 0) {
        std::printf("no device: its part is compiled, not run\n");
    } else {
        failures* there = nullptr;
        failures here;
        bool ok = cudaMalloc(&there, sizeof(failures)) == cudaSuccess &&
                  cudaMemcpy(there, &here, sizeof here, cudaMemcpyHostToDevice) == cudaSuccess;
        if (ok) {
            void* arguments[] = {&there};
            ok = cudaLaunchKernel(reinterpret_cast<const void*>(run_on_device), dim3(1), dim3(1), arguments, 0, nullptr) ==
                     cudaSuccess &&
                 cudaMemcpy(&here, there, sizeof here, cudaMemcpyDeviceToHost) == cudaSuccess;
        }
        cudaFree(there);
        if (!ok) std::printf("device: %s\n", cudaGetErrorString(cudaGetLastError()));
        failed += !ok + report("device", here);
        if (ok) std::printf("device: checked\n");
    }
#endif
    return failed == 0 ? 0 : 1;
}
