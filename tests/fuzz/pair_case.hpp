#pragma once

#include <cstdint>
#include <string>

namespace carom::test {

/// Looks at one random placement of two shapes of given kinds (see `sample_kinds`): number `n` of them. What
/// the engine says of it is compared with oracles that know the shapes' definitions alone. Returns what is
/// wrong, or nothing.
///
/// The shapes are apart, hardly touching, deep in each other, thin, large beside small, tiny, huge, turned
/// alike but for a tremble, and 10 000 km from the origin. An answer is certified from both sides: the axis
/// shows a gap, so the shapes are at least that far apart; the closest points lie in the shapes, so they are
/// not further. Many other axes are tried as well.
template <int D>
std::string fault_of_case(int kind_a, int kind_b, std::uint64_t n);

}  // namespace carom::test
