#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <string_view>

#include "fuzz/ground_case.hpp"
#include "fuzz/pair_case.hpp"

// Run with `--count=10000000` for as many placements of each pair, and with `--first=N` to begin at number N.

namespace carom::test {
namespace {

std::uint64_t first = 0, count = 2000;

template <int D>
void look_at_pairs() {
    constexpr int kinds = D == 2 ? 5 : 7, plane = 4, most_faults = 5;
    for (int a = 0; a < kinds; ++a) {
        for (int b = a; b < kinds; ++b) {
            if (a == plane && b == plane) continue;
            int faults = 0;
            for (std::uint64_t n = first; n < first + count && faults < most_faults; ++n) {
                const std::string fault = fault_of_case<D>(a, b, n);
                if (fault.empty()) continue;
                ++faults;
                ADD_FAILURE() << D << "D, kinds " << a << " and " << b << ", number " << n << ":\n" << fault;
            }
        }
    }
}

template <int D>
void look_at_ground() {
    constexpr int kinds = D == 2 ? 5 : 7, plane = 4, most_faults = 5;
    for (int kind = 0; kind < kinds; ++kind) {
        int faults = 0;
        for (std::uint64_t n = first; kind != plane && n < first + count && faults < most_faults; ++n) {
            const std::string fault = fault_of_ground_case<D>(kind, n);
            if (fault.empty()) continue;
            ++faults;
            ADD_FAILURE() << D << "D, kind " << kind << " on ground, number " << n << ":\n" << fault;
        }
    }
}

TEST(Fuzz, ground_in_the_plane_agrees_with_the_oracles) { look_at_ground<2>(); }
TEST(Fuzz, ground_in_space_agrees_with_the_oracles) { look_at_ground<3>(); }
/// What was wrong once.
TEST(Fuzz, cases_that_were_wrong_are_right) {
    struct Case {
        int kind_a, kind_b;
        std::uint64_t number;
    };
    for (const auto& [a, b, n] : {Case{1, 2, 3041},
                                  {1, 2, 12251},
                                  {2, 2, 83603},
                                  {2, 2, 165164},
                                  {2, 3, 76702},
                                  {2, 3, 96018},
                                  {2, 3, 96119},
                                  {2, 3, 194765},
                                  {3, 3, 28118},
                                  {3, 3, 180431}})
        EXPECT_EQ(fault_of_case<2>(a, b, n), "") << a << ", " << b << ", " << n;
    for (const auto& [a, b, n] : {Case{0, 3, 217275}, {1, 3, 538}, {1, 3, 1419}, {3, 3, 564}})
        EXPECT_EQ(fault_of_case<3>(a, b, n), "") << a << ", " << b << ", " << n;
}

TEST(Fuzz, pairs_in_the_plane_agree_with_the_oracles) { look_at_pairs<2>(); }
TEST(Fuzz, pairs_in_space_agree_with_the_oracles) { look_at_pairs<3>(); }

}  // namespace
}  // namespace carom::test

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        if (word.starts_with("--count=")) {
            carom::test::count = std::strtoull(argv[i] + 8, nullptr, 10);
        } else if (word.starts_with("--first=")) {
            carom::test::first = std::strtoull(argv[i] + 8, nullptr, 10);
        } else {
            std::cerr << "unknown: " << word << "; known are --count=N and --first=N\n";
            return 2;
        }
    }
    return RUN_ALL_TESTS();
}
