#pragma once

#include <cstdint>

#include "fuzz/findings.hpp"

namespace carom::test {

/// Looks at some random placements of two shapes of given kinds (see `sample_kinds`): pair number `n` of
/// them. What the engine says is compared with oracles that know the shapes' definitions alone. /// The first
/// placement is held against all oracles; the others, which take less time, against those that tell most: the
/// axis shows the gap that is named, the closest points are as far apart and stand out along no direction, a
/// few other axes show no wider gap, and the manifold is as deep.
///
/// The shapes are apart, hardly touching, deep in each other, thin, large beside small, tiny, huge, turned
/// alike but for a tremble, and 10 000 km from the origin. An answer is certified from both sides: the axis
/// shows a gap, so the shapes are at least that far apart; the closest points lie in the shapes, so they are
/// not further. Many other axes are tried as well.
template <int D>
Findings look_at_case(int kind_a, int kind_b, std::uint64_t n, int placements = 64);

}  // namespace carom::test
