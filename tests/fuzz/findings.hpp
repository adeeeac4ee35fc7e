#pragma once

#include <cstdint>
#include <string>

namespace carom::test {

/// What came of looking at some placements.
struct Findings {
    std::string fault;             ///< what is wrong, or nothing
    std::uint64_t placements = 0;  ///< of two shapes, or of a shape and a facet
    std::uint64_t thorough = 0;    ///< those of them that were held against all oracles

    void count(bool with_all_oracles) {
        ++placements;
        thorough += with_all_oracles;
    }
    Findings& operator+=(const Findings& other) {
        fault += other.fault;
        placements += other.placements;
        thorough += other.thorough;
        return *this;
    }
};

}  // namespace carom::test
