#include "engine.hpp"
#include "scenes/builders.hpp"

// Humans are put together by a builder of Carom's, with springs and friction in their joints that other
// engines do not have: the scenes that they are in cannot be compared.

namespace carom::bench {

BenchWorld<2> rain_2() { throw peers::Unsupported("people"); }
BenchWorld<3> rain_3() { throw peers::Unsupported("people"); }
BenchWorld<3> ragdoll_pile() { throw peers::Unsupported("people"); }

}  // namespace carom::bench
