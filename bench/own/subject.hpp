#pragma once

#include "carom/world.hpp"

/// What scenes and cases are built in: this engine. `bench/peers` has a header of the same name, whose worlds
/// hand on what they are told to another engine, so that the same sources can be built against either.
namespace carom::subject {

using carom::World;
using carom::World2;
using carom::World3;

}  // namespace carom::subject
