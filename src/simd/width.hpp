#pragma once

namespace carom::detail {

/// Can this processor run lanes of this width? 1 always can; 4, 8 and 16 where they are built in and the
/// processor has the instructions.
bool can_run_lanes(int width);

/// How many lanes the solver uses: the most that can run, or what the environment variable CAROM_LANES asks
/// for (1, 4, 8 or 16) if that can run. Results do not depend on it.
int lane_width();

/// For tests: overrides the width from now on; 0 goes back to the choice above. It has to be one that can
/// run.
void set_lane_width(int width);

}  // namespace carom::detail
