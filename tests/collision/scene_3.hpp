#pragma once

#include <tuple>

#include "oracle_3.hpp"

namespace carom::test::space {

/// Two random shapes of given kinds, placed at random: turned freely, or along the axes (`aligned`), now and
/// then with a tremble.
struct Scene {
    Scene(Kind kind_a, Kind kind_b, bool aligned, Random& random);

    Body3 oracle_a() const { return {a, a_placed}; }
    Body3 oracle_b() const { return {b, b_placed}; }

    /// Moves b along the axis of the widest gap: a deep overlap, a resting contact, a hair's breadth either
    /// way, a small gap, or as it is.
    void bring_to(Random& random);

    Geometry<3> a, b;
    Transform3 a_placed, b_placed;
};

/// The size of the smaller of two shapes; a plane has none.
double smaller_size(const Body3& a, const Body3& b);

/// For the names of tests.
std::string name_of_pair(const std::tuple<int, int>& pair);

}  // namespace carom::test::space
