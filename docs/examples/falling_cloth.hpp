// SPDX-License-Identifier: MIT
#pragma once

// The embedded scene of cloth_ccd: a square of masses and springs above a ball, and where it wants to go in a step. It is
// there to have something that moves, and knows nothing of collisions.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <abut/shape/view.hpp>

namespace cloth_ccd {

inline constexpr double cloth_side = 2, ball_radius = 0.5;

template <abut::scalar T>
struct surface {
    std::vector<abut::vec3<T>> vertices;
    std::vector<abut::face> faces;
};

/// A ball around the origin: rings of vertices between two poles, facing outwards.
template <abut::scalar T>
surface<T> ball(std::uint32_t rings = 23, std::uint32_t around = 48) {
    constexpr double turn = 6.283185307179586;
    surface<T> made;
    const auto add = [&](double u, double v) {
        made.vertices.push_back({static_cast<T>(ball_radius * std::sin(v) * std::cos(u)),
                                 static_cast<T>(ball_radius * std::sin(v) * std::sin(u)),
                                 static_cast<T>(ball_radius * std::cos(v))});
    };
    add(0, 0);
    for (std::uint32_t i = 1; i <= rings; ++i) {
        for (std::uint32_t j = 0; j < around; ++j) add(turn * j / around, turn / 2 * i / (rings + 1));
    }
    add(0, turn / 2);
    const auto last = static_cast<std::uint32_t>(made.vertices.size() - 1);
    for (std::uint32_t j = 0; j < around; ++j) {
        const std::uint32_t next = (j + 1) % around, foot = 1 + (rings - 1) * around;
        made.faces.push_back({0, 1 + j, 1 + next});
        for (std::uint32_t i = 0; i + 1 < rings; ++i) {
            const std::uint32_t a = 1 + i * around + j, b = 1 + i * around + next;
            made.faces.push_back({a, a + around, b + around});
            made.faces.push_back({a, b + around, b});
        }
        made.faces.push_back({foot + j, last, foot + next});
    }
    return made;
}

/// Masses on a grid, held together by lengths to their neighbours, which are restored one after another (T. Jakobsen,
/// Advanced character physics, 2001). The same on every run.
template <abut::scalar T>
class falling_cloth {
public:
    /// `n` vertices a side, turned a little so that nothing is along an axis.
    explicit falling_cloth(int n) {
        const double step = cloth_side / (n - 1), x = std::cos(0.3), y = std::sin(0.3);
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                const double p = i * step - cloth_side / 2 + 0.05, q = j * step - cloth_side / 2 - 0.03;
                at_.push_back(
                    {static_cast<T>(x * p - y * q), static_cast<T>(y * p + x * q), static_cast<T>(ball_radius + 0.05)});
            }
        }
        const auto id = [n](int i, int j) { return static_cast<std::uint32_t>(i * n + j); };
        for (int i = 0; i < n; ++i) {
            for (int j = 0; j < n; ++j) {
                const auto join = [&](int k, int l) {
                    if (k < n && l >= 0 && l < n) springs_.push_back({id(i, j), id(k, l), step * std::hypot(k - i, l - j)});
                };
                join(i + 1, j), join(i, j + 1), join(i + 1, j + 1), join(i + 1, j - 1), join(i + 2, j), join(i, j + 2);
                if (i + 1 == n || j + 1 == n) continue;
                faces_.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
                faces_.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
            }
        }
        speed_.resize(at_.size());
    }

    [[nodiscard]] const std::vector<abut::vec3<T>>& positions() const { return at_; }
    [[nodiscard]] const std::vector<abut::face>& faces() const { return faces_; }

    /// Makes up its mind where to go next.
    void propose() {
        wanted_.clear();
        for (std::size_t v = 0; v < at_.size(); ++v) {
            const abut::vec3<double> fall{0, 0, -9.8 * seconds * seconds};
            wanted_.push_back(widened(at_[v]) + 0.99 * speed_[v] + fall);
        }
        for (int round = 0; round < 40; ++round) {
            for (const auto& s : springs_) {
                auto &p = wanted_[s.a], &q = wanted_[s.b];
                const auto between = q - p;
                const double length = std::sqrt(dot(between, between));
                if (length == 0) continue;
                const auto move = 0.5 * (1 - s.length / length) * between;
                p = p + move;
                q = q - move;
            }
        }
    }
    /// Where vertices are if each goes this part of its way.
    [[nodiscard]] std::vector<abut::vec3<T>> proposed(const std::vector<double>& part) const {
        std::vector<abut::vec3<T>> made(at_);
        for (std::size_t v = 0; v < made.size(); ++v) {
            if (part[v] == 0) continue;
            const auto p = widened(at_[v]) + part[v] * (wanted_[v] - widened(at_[v]));
            made[v] = {static_cast<T>(p.x), static_cast<T>(p.y), static_cast<T>(p.z)};
        }
        return made;
    }
    /// Goes there.
    void go(const std::vector<double>& part) {
        const auto next = proposed(part);
        for (std::size_t v = 0; v < next.size(); ++v) speed_[v] = widened(next[v]) - widened(at_[v]);
        at_ = next;
    }

private:
    struct spring {
        std::uint32_t a, b;
        double length;
    };
    static constexpr double seconds = 1.0 / 60;

    static abut::vec3<double> widened(const abut::vec3<T>& p) {
        return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
    }

    std::vector<abut::vec3<T>> at_;
    std::vector<abut::vec3<double>> wanted_, speed_;  // speeds are ways of a step
    std::vector<spring> springs_;
    std::vector<abut::face> faces_;
};

}  // namespace cloth_ccd
