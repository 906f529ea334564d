// SPDX-License-Identifier: MIT
#pragma once

// What a program that compares platforms writes down: for each kind of question a hash of all bits of all answers, how many
// were asked, and how many were yes. Nothing but integers and bits: no stream, no locale, no function of libm.

#include <bit>
#include <cinttypes>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <abut/arithmetic/arithmetic.hpp>
#include <abut/arithmetic/vec.hpp>

namespace platform {

/// A row of the table.
struct row {
    std::string kind;    ///< triangle-sphere, say
    std::string scalar;  ///< float or double
    std::string question;
    std::uint64_t asked = 0, yes = 0, hash = 0;

    [[nodiscard]] std::string name() const { return kind + " " + scalar + " " + question; }
};

/// What is to be printed in place of hashes: the first answers of one row, for bisection.
struct watched {
    std::string name;
    std::uint64_t first = 0;
};

/// Takes the answers of one question, one after another.
class answers {
public:
    answers(row* to, std::uint64_t printed) : to_(to), printed_(printed) {}

    /// The next answer.
    void next() {
        if (to_->asked < printed_) std::printf("%s%" PRIu64 ":", to_->asked == 0 ? "" : "\n", to_->asked);
        ++to_->asked;
    }
    void add(std::uint64_t bits) {
        to_->hash = (to_->hash ^ bits) * 0x9e3779b97f4a7c15u;
        to_->hash ^= to_->hash >> 32;
        if (to_->asked <= printed_) std::printf(" %" PRIx64, bits);
    }
    void add(bool yes) {
        to_->yes += yes;
        add(std::uint64_t{yes});
    }
    void add(std::uint32_t n) { add(std::uint64_t{n}); }
    // A NaN is no answer, but it has to be a difference of one kind on all processors.
    void add(float x) { add(std::uint64_t{x == x ? std::bit_cast<std::uint32_t>(x) : 0x7fc00000u}); }
    void add(double x) { add(x == x ? std::bit_cast<std::uint64_t>(x) : std::uint64_t{0x7ff8000000000000u}); }
    template <abut::scalar T>
    void add(const abut::vec3<T>& v) {
        add(v.x), add(v.y), add(v.z);
    }
    template <class E>
        requires std::is_enum_v<E>
    void add(E e) {
        add(static_cast<std::uint64_t>(e));
    }
    /// An element of a result, by the members that results of queries have.
    template <class R>
        requires std::is_class_v<R>
    void add_members(const R& r) {
        if constexpr (requires { r.pair; }) add(r.pair);
        if constexpr (requires { r.body_a; }) add(r.body_a), add(r.body_b);
        if constexpr (requires { r.ray; }) add(r.ray);
        if constexpr (requires { r.id; }) add(r.id);
        if constexpr (requires { r.a; }) add(r.a), add(r.b);
        if constexpr (requires { r.point; }) add(r.point);
        if constexpr (requires { r.normal; }) add(r.normal);
        if constexpr (requires { r.depth; }) add(r.depth);
        if constexpr (requires { r.point_a; }) add(r.point_a), add(r.point_b);
        if constexpr (requires { r.distance; }) add(r.distance);
        if constexpr (requires { r.t; }) add(r.t);
        if constexpr (requires { r.kind; }) add(r.kind);
        if constexpr (requires { r.vertices; }) {
            for (const std::uint32_t v : r.vertices) add(v);
        }
        if constexpr (requires { r.time; }) add(r.time);
    }
    /// All elements of a result; each is a yes.
    template <class List>
    void add_list(const List& list) {
        next();
        add(std::uint64_t{list.size()});
        to_->yes += list.size();
        for (const auto& element : list) {
            using element_type = std::remove_cvref_t<decltype(element)>;
            if constexpr (requires { add_members(element); }) {
                add_members(element);
            } else if constexpr (std::same_as<element_type, std::uint8_t>) {
                add(std::uint64_t{element});
            } else {
                add(element);
            }
        }
    }

private:
    row* to_;
    std::uint64_t printed_;
};

/// All rows of a run. Questions of one kind are answered in one loop, so rows have places that stay.
class table {
public:
    explicit table(watched w = {}, std::string only = {}) : watched_(std::move(w)), only_(std::move(only)) {}

    /// Whether this kind is asked about in this run.
    [[nodiscard]] bool asks(const std::string& kind) const { return only_.empty() || only_ == kind; }
    [[nodiscard]] answers of(const std::string& kind, const std::string& scalar, const std::string& question) {
        rows_.push_back(new row{kind, scalar, question});
        return {rows_.back(), rows_.back()->name() == watched_.name ? watched_.first : 0};
    }
    [[nodiscard]] const std::vector<row*>& rows() const { return rows_; }

private:
    watched watched_;
    std::string only_;
    std::vector<row*> rows_;  // one for each question of a program that ends soon after: never freed
};

template <abut::scalar T>
inline constexpr const char* name_of = std::same_as<T, float> ? "float" : "double";

}  // namespace platform
