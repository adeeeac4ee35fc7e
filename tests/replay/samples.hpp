#pragma once

#include "io/replay.hpp"

namespace carom::io {

/// Recordings of toy worlds, in which every body bounces as a ball of about its size: every kind of shape,
/// body and link, names that are hard to write, sleep, contacts, bodies that come and go.
Replay sample_replay(int dimension);

/// A thousand bodies poured into a box, 600 steps.
Replay large_sample_replay(int dimension);

}  // namespace carom::io
