#pragma once

#include <cstdint>
#include <string>

namespace carom::test {

/// Looks at one random placement of a convex shape of a given kind (see `sample_kinds`; no plane) and a
/// chain, mesh or height field of a few facets: number `n` of them. Returns what is wrong, or nothing.
///
/// Of each facet, the gap that the engine names must be there along its axis, and no other axis that counts
/// may show a wider one. The ground as a whole is as near as its nearest facet. Manifolds are those of the
/// gap, and an axis to begin with, good or bad, does not change them.
template <int D>
std::string fault_of_ground_case(int kind, std::uint64_t n);

}  // namespace carom::test
