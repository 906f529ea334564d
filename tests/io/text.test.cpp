// SPDX-License-Identifier: MIT
#include <abut/io/text.hpp>

#include <cmath>
#include <limits>
#include <string>

#include "support/catch.hpp"

namespace io_test::text_cases {

using abut::io::detail::number;

namespace {

template <class T>
number take(std::string_view text, T& value) {
    return abut::io::detail::to_number(text, value);
}
template <class T>
T value_of(std::string_view text) {
    T value = 42;
    REQUIRE(take(text, value) == number::ok);
    return value;
}
template <class T>
number refused(std::string_view text) {
    T value = 42;
    const number how = take(text, value);
    CHECK(value == 42);
    return how;
}

}  // namespace

TEST_CASE("a decimal number is rounded to nearest, once") {
    CHECK(value_of<float>("0.1") == 0.1f);
    CHECK(value_of<double>("0.1") == 0.1);
    CHECK(value_of<double>("+1.5e+3") == 1500.0);
    CHECK(value_of<float>(".5") == 0.5f);
    CHECK(value_of<float>("2.") == 2.0f);
    CHECK(value_of<double>("-7E-1") == -0.7);
    // Just above the middle of two floats, in the middle of them once rounded to double: twice rounded it would be 1.
    CHECK(value_of<float>("1.000000059604644775390625000001") == std::nextafter(1.0f, 2.0f));
    CHECK(value_of<double>("4.9406564584124654e-324") == std::numeric_limits<double>::denorm_min());
    CHECK(value_of<float>("340282346638528859811704183484516925440") == std::numeric_limits<float>::max());
}

TEST_CASE("what is too small becomes a signed zero, what is too large is not finite") {
    CHECK(value_of<float>("1e-60") == 0.0f);
    CHECK(std::signbit(value_of<float>("-1e-60")));
    CHECK(value_of<double>("0.00001e-330") == 0.0);
    CHECK(value_of<double>("2.4703282292062327e-324") == 0.0);  // less than half of the least denormal
    CHECK(value_of<double>("2.4703282292062328e-324") == std::numeric_limits<double>::denorm_min());
    CHECK(value_of<float>("7.1e-46") == std::numeric_limits<float>::denorm_min());
    CHECK(value_of<float>("7e-46") == 0.0f);
    CHECK(value_of<double>("0e999999999999999999") == 0.0);
    CHECK(value_of<double>("1e-99999999999999999999999") == 0.0);
    CHECK(value_of<double>("1000e-400") == 0.0);
    CHECK(value_of<double>("0." + std::string(400, '0') + "1") == 0.0);
    CHECK(refused<float>("1e39") == number::not_finite);
    CHECK(refused<float>("-3.5e38") == number::not_finite);
    CHECK(refused<double>("1" + std::string(400, '0')) == number::not_finite);
    CHECK(refused<double>("0.0001e400") == number::not_finite);
    CHECK(refused<double>("1e99999999999999999999999") == number::not_finite);
    for (const char* word : {"nan", "NaN", "-nan", "inf", "-inf", "infinity"})
        CHECK(refused<float>(word) == number::not_finite);
}

TEST_CASE("what is no number, or more than one, is malformed") {
    for (const char* word : {"", "+", "-", ".", "e5", "+-1", "--1", "1e", "1,5", "1.2.3", "0x10", "1f", " 1", "1 ", "one"}) {
        INFO(word);
        CHECK(refused<float>(word) == number::malformed);
        CHECK(refused<double>(word) == number::malformed);
    }
    CHECK(refused<int>("1.0") == number::malformed);
    CHECK(refused<int>("2147483648") == number::out_of_range);
    CHECK(value_of<int>("-2147483648") == std::numeric_limits<int>::min());
    CHECK(value_of<int>("+7") == 7);
}

TEST_CASE("messages show what was found, without bytes that spoil a terminal") {
    using abut::io::detail::in_quotes;
    CHECK(in_quotes("abc") == "'abc'");
    CHECK(in_quotes(std::string_view("\x1b[2J\0", 5)) == "'\\x1b[2J\\x00'");
    CHECK(in_quotes("123456789012345678901234567890") == "'123456789012345678901234...'");
}

TEST_CASE("an io_error knows file, line and byte") {
    const abut::io_error whole("a.obj", "cannot be read");
    CHECK(std::string(whole.what()) == "a.obj: cannot be read");
    CHECK(whole.file() == "a.obj");
    CHECK_FALSE(whole.line());
    CHECK_FALSE(whole.byte());
    const auto line = abut::io_error::at_line("a.obj", 12, "expected x, found y");
    CHECK(std::string(line.what()) == "a.obj:12: expected x, found y");
    CHECK(line.line() == 12u);
    const auto byte = abut::io_error::at_byte("a.ply", 123, "expected x");
    CHECK(std::string(byte.what()) == "a.ply: byte 123: expected x");
    CHECK(byte.byte() == 123u);
    CHECK_FALSE(byte.line());
}

}  // namespace io_test::text_cases
