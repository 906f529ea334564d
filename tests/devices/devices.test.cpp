// SPDX-License-Identifier: MIT
#include "devices/host_team.hpp"

#include "devices/device_cases.hpp"

#include <atomic>
#include <stdexcept>
#include <thread>

using namespace abut;

TEST_CASE("devices: several policies answer as one") {
    const int n = GENERATE(1, 2, 3, 5);
    test::check_devices<float>(test::host_team<serial>(n));
}

TEST_CASE("devices: in double, on several threads each") {
    const test::host_team<openmp> team(3, openmp{.threads = 2});
    test::device_cases::check_meshes<double>(team);
    test::device_cases::check_nearest<double>(team);
    test::device_cases::check_impacts<double>(team);
    test::device_cases::check_bodies<double>(team);
}

TEST_CASE("devices: errors") {
    test::device_cases::check_errors<float>(test::host_team<serial>(2), test::host_team<serial>(3));
}

TEST_CASE("devices: each is driven by a thread of its own, and what the first of those that fail throws comes out") {
    const test::host_team<serial> team(4);
    std::vector<std::thread::id> threads(4);
    execution::on_each(team, [&](int k) { threads[static_cast<std::size_t>(k)] = std::this_thread::get_id(); });
    CHECK(threads[0] == std::this_thread::get_id());
    std::sort(threads.begin(), threads.end());
    CHECK(std::adjacent_find(threads.begin(), threads.end()) == threads.end());

    std::atomic<int> ran{0};
    std::string message;
    try {
        execution::on_each(team, [&](int k) {
            ++ran;
            if (k >= 2) throw std::runtime_error(std::to_string(k));
        });
    } catch (const std::runtime_error& e) {
        message = e.what();
    }
    CHECK(message == "2");
    CHECK(ran == 4);
}

TEST_CASE("devices: threads of the caller share a team") {
    const test::host_team<serial> team(3);
    std::atomic<int> ran{0};
    std::vector<std::thread> callers;
    for (int i = 0; i < 4; ++i) {
        callers.emplace_back([&] {
            for (int n = 0; n < 200; ++n) execution::on_each(team, [&](int) { ++ran; });
        });
    }
    for (std::thread& t : callers) t.join();
    CHECK(ran == 4 * 200 * 3);
}

TEST_CASE("devices: long lists become one, also where they are one already") {
    constexpr std::uint32_t n = 1'100'000;
    const auto id = [](std::uint32_t i) { return index_pair{i / 3, i % 3}; };
    // So many of all, in the middle, are of the two lists by turns; if it is 1, two have changed places.
    for (const std::uint32_t mixed : {0u, 1u, n}) {
        const std::uint32_t half = n / 2, alone = half - mixed / 2;
        std::vector<index_pair> lists[3];
        for (std::uint32_t i = 0; i < n; ++i) {
            const bool second = i < alone ? false : i >= alone + 2 * (half - alone) ? true : (i - alone) % 2 == 0;
            lists[second ? 2 : 0].push_back(id(i));
        }
        if (mixed == 1) std::swap(lists[0].back(), lists[2].front());
        std::vector<std::size_t> first{0};
        execution::buffer<index_pair, host_space> all(serial{}, n);
        for (const auto& list : lists) {
            std::copy(list.begin(), list.end(), all.data() + first.back());
            first.push_back(first.back() + list.size());
        }
        const auto merged = to_host(detail::merged(serial{}, std::move(all), first, true));
        std::size_t wrong = 0;
        for (std::uint32_t i = 0; i < n; ++i) wrong += !(merged[i] == id(i));
        CHECK((merged.size() == n && wrong == 0));
    }
}

TEST_CASE("devices: parts of a search have each item once, and as many rows as the others") {
    for (const std::uint32_t parts : {1u, 2u, 3u, 7u}) {
        std::vector<int> items(100'000);
        for (std::uint32_t k = 0; k < parts; ++k) {
            const detail::search_part part{k, parts};
            std::size_t mine = 0;
            for (std::size_t i = 0; i < items.size(); ++i) {
                items[i] += part.has(i);
                mine += part.has(i);
            }
            CHECK(mine > items.size() / parts * 9 / 10);
            for (const std::size_t n : {std::size_t{0}, std::size_t{3}, std::size_t{10}, std::size_t{1001}}) {
                const std::size_t first = part.first_of(n), last = detail::search_part{k + 1, parts}.first_of(n);
                CHECK((first <= last && first % 4 == 0 && last - first <= n / parts + 8));
                CHECK((k > 0 || first == 0));
                CHECK((k + 1 < parts || last == n));
            }
            const detail::rows_of_part points{k, parts};
            for (const std::size_t n : {std::size_t{0}, std::size_t{5}, std::size_t{4096}, std::size_t{50'001}}) {
                const std::size_t some = points.count(n);
                CHECK((some == 0 || points(some - 1) < n));
            }
        }
        CHECK(std::all_of(items.begin(), items.end(), [](int n) { return n == 1; }));
        std::size_t all = 0;
        for (std::size_t k = 0; k < parts; ++k) all += detail::rows_of_part{k, parts}.count(50'001);
        CHECK(all == 50'001);
    }
}
