// SPDX-License-Identifier: MIT
#pragma once

// Two triangles in every configuration that the source of these tests (Maffina, 2012, figures 3.5 and 3.6) checked by eye,
// and in those that it leaves out. Written by hand in small integers, with what the two have in common;
// docs/numerics/triangles.md shows them drawn.
//
// A triangle is placed against the other's plane by how many of its corners lie above (+), on (0) and below (-) it; which
// side is above does not matter. What it shares with that plane lies on the line in which the planes meet: nothing, a
// corner, an edge, or a segment that ends inside two edges, or in a corner and inside the edge opposite. So much for either
// triangle; then it matters how the two parts of the line lie.
//
// Where the planes cross, the reference lies in z = 0, the other in y = 0, and the line is the x axis.

#include <string>
#include <vector>

#include <abut/arithmetic/vec.hpp>

namespace abut::test {

struct integer_triangle {
    vec3<int> a, b, c;
};

/// What two triangles have in common
enum class common { nothing, point, segment, area };

struct configuration {
    std::string name;
    integer_triangle reference, other;
    common part;
};

struct configuration_group {
    std::string title;
    std::vector<configuration> members;
};

// clang-format off
inline const std::vector<configuration_group> configuration_groups{
    {"Reference: off the plane (+++). Other: as named", {
        {"both off", {{0, -3, 0}, {9, -3, 0}, {3, -9, 0}}, {{0, 0, 3}, {8, 0, 3}, {4, 0, 8}}, common::nothing},
        {"other: corner on", {{0, -3, 0}, {9, -3, 0}, {3, -9, 0}}, {{4, 0, 0}, {1, 0, 5}, {6, 0, 6}}, common::nothing},
        {"other: edge on", {{0, -3, 0}, {9, -3, 0}, {3, -9, 0}}, {{0, 0, 0}, {8, 0, 0}, {5, 0, 6}}, common::nothing},
        {"other: cut", {{0, -3, 0}, {9, -3, 0}, {3, -9, 0}}, {{4, 0, 6}, {-2, 0, -3}, {10, 0, -3}}, common::nothing},
        {"other: cut at corner", {{0, -3, 0}, {9, -3, 0}, {3, -9, 0}}, {{0, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::nothing},
        {"both off, parallel", {{0, -4, 0}, {9, -4, 0}, {3, 4, 0}}, {{0, -4, 6}, {9, -4, 6}, {3, 4, 6}}, common::nothing},
    }},
    {"Other: corner on the plane (++0). Reference: as named", {
        {"corner on, apart", {{2, 0, 0}, {-2, -6, 0}, {5, -8, 0}}, {{7, 0, 0}, {4, 0, 5}, {9, 0, 6}}, common::nothing},
        {"corner on, equal", {{4, 0, 0}, {0, -6, 0}, {7, -8, 0}}, {{4, 0, 0}, {1, 0, 5}, {6, 0, 6}}, common::point},
        {"edge on, apart", {{0, 0, 0}, {8, 0, 0}, {3, -8, 0}}, {{11, 0, 0}, {8, 0, 5}, {13, 0, 6}}, common::nothing},
        {"edge on, at its end", {{0, 0, 0}, {8, 0, 0}, {3, -8, 0}}, {{8, 0, 0}, {5, 0, 5}, {10, 0, 6}}, common::point},
        {"edge on, inside", {{0, 0, 0}, {8, 0, 0}, {3, -8, 0}}, {{4, 0, 0}, {1, 0, 5}, {6, 0, 6}}, common::point},
        {"cut, apart", {{4, -8, 0}, {-2, 4, 0}, {10, 4, 0}}, {{11, 0, 0}, {8, 0, 5}, {13, 0, 6}}, common::nothing},
        {"cut, at its end", {{4, -8, 0}, {-2, 4, 0}, {10, 4, 0}}, {{8, 0, 0}, {5, 0, 5}, {10, 0, 6}}, common::point},
        {"cut, inside", {{4, -8, 0}, {-2, 4, 0}, {10, 4, 0}}, {{4, 0, 0}, {1, 0, 5}, {6, 0, 6}}, common::point},
        {"cut at corner, apart", {{0, 0, 0}, {9, 6, 0}, {7, -6, 0}}, {{11, 0, 0}, {8, 0, 5}, {13, 0, 6}}, common::nothing},
        {"cut at corner, at its end", {{0, 0, 0}, {9, 6, 0}, {7, -6, 0}}, {{8, 0, 0}, {5, 0, 5}, {10, 0, 6}}, common::point},
        {"cut at corner, inside", {{0, 0, 0}, {9, 6, 0}, {7, -6, 0}}, {{4, 0, 0}, {1, 0, 5}, {6, 0, 6}}, common::point},
    }},
    {"Both: edge on the plane (+00)", {
        {"apart", {{0, 0, 0}, {4, 0, 0}, {1, -8, 0}}, {{6, 0, 0}, {10, 0, 0}, {9, 0, 6}}, common::nothing},
        {"touching", {{0, 0, 0}, {4, 0, 0}, {1, -8, 0}}, {{4, 0, 0}, {8, 0, 0}, {7, 0, 6}}, common::point},
        {"overlapping", {{0, 0, 0}, {8, 0, 0}, {3, -8, 0}}, {{4, 0, 0}, {12, 0, 0}, {9, 0, 6}}, common::segment},
        {"equal", {{0, 0, 0}, {8, 0, 0}, {3, -8, 0}}, {{0, 0, 0}, {8, 0, 0}, {5, 0, 6}}, common::segment},
        {"contains", {{0, 0, 0}, {8, 0, 0}, {3, -8, 0}}, {{2, 0, 0}, {6, 0, 0}, {5, 0, 6}}, common::segment},
        {"contains, end shared", {{0, 0, 0}, {8, 0, 0}, {3, -8, 0}}, {{4, 0, 0}, {8, 0, 0}, {7, 0, 6}}, common::segment},
        {"inside", {{2, 0, 0}, {6, 0, 0}, {3, -8, 0}}, {{0, 0, 0}, {8, 0, 0}, {5, 0, 6}}, common::segment},
        {"inside, end shared", {{4, 0, 0}, {8, 0, 0}, {5, -8, 0}}, {{0, 0, 0}, {8, 0, 0}, {5, 0, 6}}, common::segment},
    }},
    {"Reference: edge on the plane (+00). Other: cut by the plane (++-)", {
        {"apart", {{0, 0, 0}, {4, 0, 0}, {1, -8, 0}}, {{8, 0, 6}, {5, 0, -3}, {11, 0, -3}}, common::nothing},
        {"touching", {{0, 0, 0}, {4, 0, 0}, {1, -8, 0}}, {{6, 0, 6}, {3, 0, -3}, {9, 0, -3}}, common::point},
        {"overlapping", {{0, 0, 0}, {8, 0, 0}, {3, -8, 0}}, {{8, 0, 6}, {2, 0, -3}, {14, 0, -3}}, common::segment},
        {"equal", {{0, 0, 0}, {8, 0, 0}, {3, -8, 0}}, {{4, 0, 6}, {-2, 0, -3}, {10, 0, -3}}, common::segment},
        {"contains", {{0, 0, 0}, {8, 0, 0}, {3, -8, 0}}, {{4, 0, 6}, {1, 0, -3}, {7, 0, -3}}, common::segment},
        {"contains, end shared", {{0, 0, 0}, {8, 0, 0}, {3, -8, 0}}, {{6, 0, 6}, {3, 0, -3}, {9, 0, -3}}, common::segment},
        {"inside", {{2, 0, 0}, {6, 0, 0}, {3, -8, 0}}, {{4, 0, 6}, {-2, 0, -3}, {10, 0, -3}}, common::segment},
        {"inside, end shared", {{4, 0, 0}, {8, 0, 0}, {5, -8, 0}}, {{4, 0, 6}, {-2, 0, -3}, {10, 0, -3}}, common::segment},
    }},
    {"Reference: edge on the plane (+00). Other: cut at a corner (+0-)", {
        {"apart", {{0, 0, 0}, {4, 0, 0}, {1, -8, 0}}, {{6, 0, 0}, {11, 0, 5}, {9, 0, -5}}, common::nothing},
        {"touching", {{0, 0, 0}, {4, 0, 0}, {1, -8, 0}}, {{4, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::point},
        {"overlapping", {{0, 0, 0}, {8, 0, 0}, {3, -8, 0}}, {{4, 0, 0}, {13, 0, 5}, {11, 0, -5}}, common::segment},
        {"equal", {{0, 0, 0}, {8, 0, 0}, {3, -8, 0}}, {{0, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::segment},
        {"contains", {{0, 0, 0}, {8, 0, 0}, {3, -8, 0}}, {{2, 0, 0}, {7, 0, 5}, {5, 0, -5}}, common::segment},
        {"contains, end shared", {{0, 0, 0}, {8, 0, 0}, {3, -8, 0}}, {{4, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::segment},
        {"inside", {{2, 0, 0}, {6, 0, 0}, {3, -8, 0}}, {{0, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::segment},
        {"inside, end shared", {{4, 0, 0}, {8, 0, 0}, {5, -8, 0}}, {{0, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::segment},
    }},
    {"Both: cut by the plane (++-)", {
        {"apart", {{2, -8, 0}, {-1, 4, 0}, {5, 4, 0}}, {{8, 0, 6}, {5, 0, -3}, {11, 0, -3}}, common::nothing},
        {"touching", {{2, -8, 0}, {-1, 4, 0}, {5, 4, 0}}, {{6, 0, 6}, {3, 0, -3}, {9, 0, -3}}, common::point},
        {"overlapping", {{4, -8, 0}, {-2, 4, 0}, {10, 4, 0}}, {{8, 0, 6}, {2, 0, -3}, {14, 0, -3}}, common::segment},
        {"equal", {{4, -8, 0}, {-2, 4, 0}, {10, 4, 0}}, {{4, 0, 6}, {-2, 0, -3}, {10, 0, -3}}, common::segment},
        {"contains", {{4, -8, 0}, {-2, 4, 0}, {10, 4, 0}}, {{4, 0, 6}, {1, 0, -3}, {7, 0, -3}}, common::segment},
        {"contains, end shared", {{4, -8, 0}, {-2, 4, 0}, {10, 4, 0}}, {{6, 0, 6}, {3, 0, -3}, {9, 0, -3}}, common::segment},
        {"inside", {{4, -8, 0}, {1, 4, 0}, {7, 4, 0}}, {{4, 0, 6}, {-2, 0, -3}, {10, 0, -3}}, common::segment},
        {"inside, end shared", {{6, -8, 0}, {3, 4, 0}, {9, 4, 0}}, {{4, 0, 6}, {-2, 0, -3}, {10, 0, -3}}, common::segment},
    }},
    {"Reference: cut by the plane (++-). Other: cut at a corner (+0-)", {
        {"apart", {{2, -8, 0}, {-1, 4, 0}, {5, 4, 0}}, {{6, 0, 0}, {11, 0, 5}, {9, 0, -5}}, common::nothing},
        {"touching", {{2, -8, 0}, {-1, 4, 0}, {5, 4, 0}}, {{4, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::point},
        {"overlapping", {{4, -8, 0}, {-2, 4, 0}, {10, 4, 0}}, {{4, 0, 0}, {13, 0, 5}, {11, 0, -5}}, common::segment},
        {"equal", {{4, -8, 0}, {-2, 4, 0}, {10, 4, 0}}, {{0, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::segment},
        {"contains", {{4, -8, 0}, {-2, 4, 0}, {10, 4, 0}}, {{2, 0, 0}, {7, 0, 5}, {5, 0, -5}}, common::segment},
        {"contains, end shared", {{4, -8, 0}, {-2, 4, 0}, {10, 4, 0}}, {{4, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::segment},
        {"inside", {{4, -8, 0}, {1, 4, 0}, {7, 4, 0}}, {{0, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::segment},
        {"inside, end shared", {{6, -8, 0}, {3, 4, 0}, {9, 4, 0}}, {{0, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::segment},
    }},
    {"Both: cut at a corner (+0-)", {
        {"apart", {{0, 0, 0}, {5, 6, 0}, {3, -6, 0}}, {{6, 0, 0}, {11, 0, 5}, {9, 0, -5}}, common::nothing},
        {"touching", {{0, 0, 0}, {5, 6, 0}, {3, -6, 0}}, {{4, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::point},
        {"overlapping", {{0, 0, 0}, {9, 6, 0}, {7, -6, 0}}, {{4, 0, 0}, {13, 0, 5}, {11, 0, -5}}, common::segment},
        {"equal", {{0, 0, 0}, {9, 6, 0}, {7, -6, 0}}, {{0, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::segment},
        {"contains", {{0, 0, 0}, {9, 6, 0}, {7, -6, 0}}, {{2, 0, 0}, {7, 0, 5}, {5, 0, -5}}, common::segment},
        {"contains, end shared", {{0, 0, 0}, {9, 6, 0}, {7, -6, 0}}, {{4, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::segment},
        {"inside", {{2, 0, 0}, {7, 6, 0}, {5, -6, 0}}, {{0, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::segment},
        {"inside, end shared", {{4, 0, 0}, {9, 6, 0}, {7, -6, 0}}, {{0, 0, 0}, {9, 0, 5}, {7, 0, -5}}, common::segment},
    }},
    {"Both in one plane (000)", {
        {"apart", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{10, 0, 1}, {15, 0, 1}, {12, 0, 7}}, common::nothing},
        {"apart, boxes overlap", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{8, 0, 2}, {10, 0, 8}, {6, 0, 8}}, common::nothing},
        {"apart, edges in line", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{10, 0, 0}, {15, 0, 0}, {12, 0, -5}}, common::nothing},
        {"corner on corner", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{8, 0, 0}, {13, 0, 2}, {11, 0, 7}}, common::point},
        {"corner on corner, in line", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{8, 0, 0}, {14, 0, 0}, {12, 0, 6}}, common::point},
        {"corner on edge", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{6, 0, 4}, {12, 0, 2}, {12, 0, 8}}, common::point},
        {"edge on edge, in part", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{6, 0, 4}, {3, 0, 10}, {11, 0, 9}}, common::segment},
        {"edge on edge, equal", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{8, 0, 0}, {4, 0, 8}, {12, 0, 7}}, common::segment},
        {"crossing, 1 corner inside", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{4, 0, 3}, {13, 0, 2}, {12, 0, 7}}, common::area},
        {"crossing, 2 corners inside", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{3, 0, 2}, {5, 0, 2}, {4, 0, -5}}, common::area},
        {"crossing, no corner inside", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{0, 0, 5}, {8, 0, 5}, {4, 0, -3}}, common::area},
        {"crossing, corner on corner", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{4, 0, 8}, {2, 0, -3}, {6, 0, -3}}, common::area},
        {"contains", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{3, 0, 1}, {5, 0, 1}, {4, 0, 5}}, common::area},
        {"contains, corner on corner", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{0, 0, 0}, {5, 0, 2}, {3, 0, 4}}, common::area},
        {"contains, edge on edge", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{2, 0, 0}, {6, 0, 0}, {4, 0, 4}}, common::area},
        {"identical", {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, {{0, 0, 0}, {8, 0, 0}, {4, 0, 8}}, common::area},
    }},
    {"The other is a segment, across the plane or beside it", {
        {"through the face", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{5, -2, -5}, {5, -2, 0}, {5, -2, 5}}, common::point},
        {"ends on the face", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{5, -2, 0}, {7, -2, 6}, {7, -2, 6}}, common::point},
        {"ends above the face", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{5, -2, 2}, {7, -2, 7}, {7, -2, 7}}, common::nothing},
        {"through an edge", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{5, -6, -4}, {5, -6, 0}, {5, -6, 4}}, common::point},
        {"ends on an edge", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{5, -6, 0}, {7, -8, 5}, {7, -8, 5}}, common::point},
        {"through a corner", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{12, -6, -4}, {12, -6, 0}, {12, -6, 4}}, common::point},
        {"ends on a corner", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{12, -6, 0}, {14, -6, 5}, {14, -6, 5}}, common::point},
        {"passes by", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{11, 0, -4}, {11, 0, 0}, {11, 0, 4}}, common::nothing},
    }},
    {"The other is a segment in the plane", {
        {"crosses", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{-2, -2, 0}, {6, -2, 0}, {14, -2, 0}}, common::segment},
        {"one end inside", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{5, -2, 0}, {14, -2, 0}, {14, -2, 0}}, common::segment},
        {"both ends inside", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{4, -4, 0}, {5, -2, 0}, {6, 0, 0}}, common::segment},
        {"along an edge", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{3, -6, 0}, {9, -6, 0}, {9, -6, 0}}, common::segment},
        {"ends on an edge", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{5, -6, 0}, {7, -10, 0}, {7, -10, 0}}, common::point},
        {"touches a corner", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{10, -10, 0}, {12, -6, 0}, {14, -2, 0}}, common::point},
        {"in edge's line", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{14, -6, 0}, {18, -6, 0}, {18, -6, 0}}, common::nothing},
        {"apart", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{10, 2, 0}, {14, -4, 0}, {14, -4, 0}}, common::nothing},
    }},
    {"The other is a point", {
        {"on the face", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{5, -2, 0}, {5, -2, 0}, {5, -2, 0}}, common::point},
        {"on an edge", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{5, -6, 0}, {5, -6, 0}, {5, -6, 0}}, common::point},
        {"on a corner", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{12, -6, 0}, {12, -6, 0}, {12, -6, 0}}, common::point},
        {"above the face", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{5, -2, 3}, {5, -2, 3}, {5, -2, 3}}, common::nothing},
        {"in plane, outside", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{11, 0, 0}, {11, 0, 0}, {11, 0, 0}}, common::nothing},
        {"in edge's line", {{0, -6, 0}, {12, -6, 0}, {4, 6, 0}}, {{15, -6, 0}, {15, -6, 0}, {15, -6, 0}}, common::nothing},
    }},
    {"Two segments", {
        {"crossing", {{0, 0, 0}, {4, 0, 0}, {8, 0, 0}}, {{4, 0, -4}, {4, 0, 0}, {4, 0, 4}}, common::point},
        {"end on the other", {{0, 0, 0}, {8, 0, 0}, {8, 0, 0}}, {{4, 0, 0}, {7, 0, 6}, {7, 0, 6}}, common::point},
        {"end on end", {{0, 0, 0}, {8, 0, 0}, {8, 0, 0}}, {{8, 0, 0}, {11, 0, 5}, {11, 0, 5}}, common::point},
        {"in one plane, apart", {{0, 0, 0}, {4, 0, 0}, {8, 0, 0}}, {{4, 0, 2}, {6, 0, 7}, {6, 0, 7}}, common::nothing},
        {"parallel", {{0, 0, 0}, {8, 0, 0}, {8, 0, 0}}, {{0, 0, 4}, {8, 0, 4}, {8, 0, 4}}, common::nothing},
        {"skew", {{0, 0, 0}, {8, 0, 0}, {8, 0, 0}}, {{0, -6, 4}, {4, 0, 4}, {8, 6, 4}}, common::nothing},
        {"in line, apart", {{0, 0, 0}, {8, 0, 0}, {8, 0, 0}}, {{10, 0, 0}, {15, 0, 0}, {15, 0, 0}}, common::nothing},
        {"in line, end on end", {{0, 0, 0}, {4, 0, 0}, {8, 0, 0}}, {{8, 0, 0}, {14, 0, 0}, {14, 0, 0}}, common::point},
        {"in line, overlapping", {{0, 0, 0}, {8, 0, 0}, {8, 0, 0}}, {{4, 0, 0}, {8, 0, 0}, {12, 0, 0}}, common::segment},
        {"in line, contains", {{0, 0, 0}, {4, 0, 0}, {8, 0, 0}}, {{2, 0, 0}, {6, 0, 0}, {6, 0, 0}}, common::segment},
        {"in line, equal", {{0, 0, 0}, {8, 0, 0}, {8, 0, 0}}, {{0, 0, 0}, {4, 0, 0}, {8, 0, 0}}, common::segment},
    }},
    {"A segment or a point, and a point", {
        {"on the segment", {{0, 0, 0}, {4, 0, 0}, {8, 0, 0}}, {{3, 0, 0}, {3, 0, 0}, {3, 0, 0}}, common::point},
        {"on its end", {{0, 0, 0}, {8, 0, 0}, {8, 0, 0}}, {{8, 0, 0}, {8, 0, 0}, {8, 0, 0}}, common::point},
        {"in its line", {{0, 0, 0}, {4, 0, 0}, {8, 0, 0}}, {{12, 0, 0}, {12, 0, 0}, {12, 0, 0}}, common::nothing},
        {"beside it", {{0, 0, 0}, {8, 0, 0}, {8, 0, 0}}, {{4, 0, 3}, {4, 0, 3}, {4, 0, 3}}, common::nothing},
        {"two points, equal", {{4, 0, 0}, {4, 0, 0}, {4, 0, 0}}, {{4, 0, 0}, {4, 0, 0}, {4, 0, 0}}, common::point},
        {"two points, apart", {{2, 0, 0}, {2, 0, 0}, {2, 0, 0}}, {{6, 0, 2}, {6, 0, 2}, {6, 0, 2}}, common::nothing},
    }},
};
// clang-format on

}  // namespace abut::test
