// A replay of a thousand bodies and 600 steps stays under 15 MB, however they move.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "decoder.hpp"
#include "io/replay_template.hpp"
#include "samples.hpp"

namespace carom::io {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t most = 15'000'000;

/// A gas: every body tumbles, and is hit hard about ten times a second, for ever.
Replay restless_replay() {
    std::mt19937_64 generator(1);
    const auto any = [&](double size) {
        return size * (2 * static_cast<double>(generator() >> 11) * 0x1p-53 - 1);
    };
    Replay replay;
    replay.bodies.resize(1000);
    replay.frames.resize(601);
    std::vector<ReplayState> states(1000);
    for (ReplayState& state : states) {
        state.present = true;
        state.position = {any(20), any(20), any(20)};
    }
    for (ReplayFrame& frame : replay.frames) {
        for (std::size_t b = 0; b < states.size(); ++b) {
            ReplayState& s = states[b];
            const bool hit = generator() % 6 == 0;
            double length = 0;
            const auto q = s.rotation;
            const auto& w = s.angular_velocity;
            s.rotation = {q[0] + (w[0] * q[3] + w[1] * q[2] - w[2] * q[1]) / 120,
                          q[1] + (w[1] * q[3] + w[2] * q[0] - w[0] * q[2]) / 120,
                          q[2] + (w[2] * q[3] + w[0] * q[1] - w[1] * q[0]) / 120,
                          q[3] - (w[0] * q[0] + w[1] * q[1] + w[2] * q[2]) / 120};
            for (const float c : s.rotation) length += c * c;
            for (float& c : s.rotation) c /= static_cast<float>(std::sqrt(length));
            for (int i = 0; i < 3; ++i) {
                s.velocity[i] = static_cast<float>(hit ? any(5) : s.velocity[i]);
                s.angular_velocity[i] = static_cast<float>(hit ? any(6) : s.angular_velocity[i] + any(0.02));
                s.position[i] += s.velocity[i] / 60;
            }
            for (int c = 0; c < 2; ++c)
                frame.contacts.push_back({static_cast<std::int32_t>(b),
                                          static_cast<std::int32_t>(generator() % 1000),
                                          s.position,
                                          {static_cast<float>(any(1)), static_cast<float>(any(1)), 0},
                                          static_cast<float>(std::exp(any(3)))});
        }
        frame.states = states;
    }
    return replay;
}

TEST(ReplaySize, AThousandRestlessBodiesStayUnderTheLimit) {
    const std::string html = replay_html(restless_replay(), bare_page);
    EXPECT_LT(html.size() + replay_template().size(), most);
}

/// Also writes the samples for the tests in a browser, to the folder that CAROM_SAMPLES names.
TEST(ReplaySamples, StayUnderTheLimit) {
    if (replay_template().empty()) GTEST_SKIP() << "the replay viewer is not built in";
    const char* named = std::getenv("CAROM_SAMPLES");
    const fs::path folder = named ? fs::path(named) : fs::path(testing::TempDir()) / "carom_replay_samples";
    fs::create_directories(folder);
    for (const int dimension : {2, 3}) {
        const std::string number = std::to_string(dimension);
        write_replay(sample_replay(dimension), folder / ("sample" + number + ".html"));
        write_replay(large_sample_replay(dimension), folder / ("large" + number + ".html"));
    }
    for (const fs::directory_entry& file : fs::directory_iterator(folder))
        EXPECT_LT(file.file_size(), most) << file.path();
    if (!named) fs::remove_all(folder);
}

}  // namespace
}  // namespace carom::io
