#pragma once

#include <cstdint>

#include "fuzz/findings.hpp"

namespace carom::test {

/// Looks at some random placements of a convex shape of a given kind (see `sample_kinds`; no plane) over a
/// chain, mesh or height field of a few facets: number `n` of these. Each facet counts as a placement; those
/// that the first place of the shape makes are held against all oracles.
///
/// Of each facet, the gap that the engine names must be there along its axis, and no other axis that counts
/// may show a wider one. The ground as a whole is as near as its nearest facet. Manifolds are those of the
/// gap, and an axis to begin with, good or bad, does not change them.
template <int D>
Findings look_at_ground_case(int kind, std::uint64_t n, int places = 64);

}  // namespace carom::test
