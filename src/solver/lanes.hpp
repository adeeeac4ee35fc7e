#pragma once

#include "solver/passes.hpp"

/// The passes of each width; CMake defines CAROM_WIDE_LANES where 8 and 16 lanes are built in.
namespace carom::detail {

const Passes<2>& passes_1_2();
const Passes<3>& passes_1_3();
const Passes<2>& passes_4_2();
const Passes<3>& passes_4_3();
const Passes<2>& passes_8_2();
const Passes<3>& passes_8_3();
const Passes<2>& passes_16_2();
const Passes<3>& passes_16_3();

}  // namespace carom::detail
