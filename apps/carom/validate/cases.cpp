#include "validate/cases.hpp"

namespace carom::app {

std::span<const Case> validation_cases() {
    static constexpr Case cases[] = {
        {"A1", "a projectile, by each integrator", projectile},
    };
    return cases;
}

}  // namespace carom::app
