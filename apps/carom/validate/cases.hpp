#pragma once

#include "validate/case.hpp"

namespace carom::app {

// One function a case; each lives in the file of its subject.
std::vector<Result> projectile();

}  // namespace carom::app
