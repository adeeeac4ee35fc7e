#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <tuple>

#include "carom/error.hpp"
#include "decoder.hpp"
#include "io/replay.hpp"
#include "io/replay_template.hpp"
#include "samples.hpp"

namespace carom::io {
namespace {

namespace fs = std::filesystem;

Decoded written(const Replay& replay) { return decode(replay_html(replay, bare_page)); }

/// A body at the origin for so many frames, to be changed by a test.
Replay lone_body(int dimension, std::size_t frames) {
    Replay replay;
    replay.dimension = dimension;
    replay.bodies.emplace_back().name = "lone";
    replay.frames.resize(frames);
    for (ReplayFrame& frame : replay.frames) frame.states.emplace_back().present = true;
    return replay;
}

class ReplayOf : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Dimensions, ReplayOf, testing::Values(2, 3));

TEST_P(ReplayOf, KeepsTheMotionToItsResolution) {
    const Replay replay = sample_replay(GetParam());
    const Decoded decoded = written(replay);
    const bool flat = GetParam() == 2;
    ASSERT_EQ(decoded.header["frames"], replay.frames.size());
    ASSERT_EQ(decoded.header["bodies"].size(), replay.bodies.size());
    for (std::size_t f = 0; f < replay.frames.size(); ++f)
        for (std::size_t b = 0; b < replay.bodies.size(); ++b) {
            const ReplayState& state = replay.frames[f].states[b];
            const int flags = static_cast<int>(decoded.value("flags", b, f));
            ASSERT_EQ(flags & 1, state.present ? 1 : 0) << "body " << b << " frame " << f;
            if (!state.present) continue;
            ASSERT_EQ(flags >> 1 & 1, state.awake ? 1 : 0);
            ASSERT_EQ(flags >> 2 & 1, state.jumped ? 1 : 0);
            ASSERT_EQ(flags >> 3, state.sensing ? 1 : 0);
            for (int i = 0; i < GetParam(); ++i) {
                ASSERT_NEAR(decoded.place(i, b, f), state.position[i], 0.51e-4)
                    << "body " << b << " frame " << f;
                ASSERT_NEAR(decoded.value(std::string("v") + "xyz"[i], b, f), state.velocity[i], 0.51e-3);
            }
            if (flat) {
                const double angle = 2 * std::atan2(double(state.rotation[2]), double(state.rotation[3]));
                ASSERT_NEAR(std::remainder(decoded.value("angle", b, f) - angle, 2 * std::numbers::pi), 0,
                            0.6e-4);
                ASSERT_NEAR(decoded.value("w", b, f), state.angular_velocity[2], 0.51e-3);
                continue;
            }
            double same = 0;  // |cosine of half the angle between the two rotations|
            for (int i = 0; i < 4; ++i) {
                same += decoded.value(std::string("q") + "xyzw"[i], b, f) * state.rotation[i];
                if (i == 3) continue;
                ASSERT_NEAR(decoded.value(std::string("w") + "xyz"[i], b, f), state.angular_velocity[i],
                            0.51e-3);
            }
            ASSERT_NEAR(std::abs(same), 1, 1e-4);
        }
}

TEST_P(ReplayOf, KeepsContactsWithTheirBodies) {
    const Replay replay = sample_replay(GetParam());
    const Decoded decoded = written(replay);
    ASSERT_EQ(decoded.header["contacts"]["every"], 1);
    ASSERT_EQ(decoded.contacts.size(), replay.frames.size());
    std::size_t compared = 0;
    for (std::size_t f = 0; f < replay.frames.size(); ++f) {
        const ReplayFrame& frame = replay.frames[f];
        std::vector<ReplayContact> expected;
        for (const ReplayContact& contact : frame.contacts) {
            const bool fixed = replay.bodies[contact.a].type == ReplayBodyType::fixed;
            if (frame.states[fixed ? contact.b : contact.a].present) expected.push_back(contact);
        }
        std::stable_sort(expected.begin(), expected.end(),
                         [](const ReplayContact& x, const ReplayContact& y) {
                             return std::tie(x.a, x.b) < std::tie(y.a, y.b);
                         });
        ASSERT_EQ(decoded.contacts[f].size(), expected.size()) << "frame " << f;
        for (std::size_t i = 0; i < expected.size(); ++i, ++compared) {
            const DecodedContact& contact = decoded.contacts[f][i];
            ASSERT_EQ(contact.a, expected[i].a);
            ASSERT_EQ(contact.b, expected[i].b);
            for (std::size_t k = 0; k < contact.position.size(); ++k) {
                ASSERT_NEAR(contact.position[k], expected[i].position[k], 0.6e-3);
                ASSERT_NEAR(contact.normal[k], expected[i].normal[k], 0.51e-2);
            }
            ASSERT_NEAR(contact.impulse, expected[i].impulse, 0.023 * expected[i].impulse + 1e-5);
        }
    }
    EXPECT_GT(compared, 1000u);
}

TEST_P(ReplayOf, FarFromTheOriginIsAsGoodAsAtTheOrigin) {
    Replay replay = lone_body(GetParam(), 100);
    for (std::size_t f = 0; f < 100; ++f)
        replay.frames[f].states[0].position = {1e7 + 0.01 * static_cast<double>(f), -3e6, 0};
    const Decoded decoded = written(replay);
    for (std::size_t f = 0; f < 100; ++f)
        ASSERT_NEAR(decoded.place(0, 0, f), replay.frames[f].states[0].position[0], 0.51e-4);
}

TEST_P(ReplayOf, AWayTooLongForTheResolutionIsWrittenCoarser) {
    Replay replay = lone_body(GetParam(), 50);
    for (std::size_t f = 0; f < 50; ++f) replay.frames[f].states[0].position[0] = f % 2 ? 1e9 : -1e9;
    const Decoded decoded = written(replay);
    for (std::size_t f = 0; f < 50; ++f)
        ASSERT_NEAR(decoded.place(0, 0, f), replay.frames[f].states[0].position[0], 2.0);
}

TEST_P(ReplayOf, NumbersThatAreNotFiniteStayAsTheyWere) {
    Replay replay = lone_body(GetParam(), 10);
    for (std::size_t f = 0; f < 10; ++f) replay.frames[f].states[0].position[1] = static_cast<double>(f);
    replay.frames[0].states[0].position[1] = std::numeric_limits<double>::infinity();
    replay.frames[5].states[0].position[1] = std::numeric_limits<double>::quiet_NaN();
    replay.frames[6].states[0].velocity[0] = std::numeric_limits<float>::quiet_NaN();
    replay.frames[7].kinetic = std::numeric_limits<double>::quiet_NaN();
    replay.bodies[0].mass = std::numeric_limits<double>::infinity();
    const Decoded decoded = written(replay);
    const double expected[] = {1, 1, 2, 3, 4, 4, 4, 7, 8, 9};
    for (std::size_t f = 0; f < 10; ++f) EXPECT_NEAR(decoded.place(1, 0, f), expected[f], 1e-4);
    EXPECT_EQ(decoded.header["energy"]["kinetic"][7], 0);
    EXPECT_EQ(decoded.header["bodies"][0]["mass"], 0);
}

TEST(ReplayWriter, AFastWheelTurnsTheWayThatItTurns) {
    // 0.8 of a turn from frame to frame: the short way would be 0.2 of a turn backwards.
    Replay replay = lone_body(2, 60);
    const double turn = 2 * std::numbers::pi;
    for (std::size_t f = 0; f < 60; ++f) {
        ReplayState& state = replay.frames[f].states[0];
        const ReplayRotation q = replay_rotation(0.8 * turn * static_cast<double>(f));
        for (int i = 0; i < 4; ++i) state.rotation[i] = static_cast<float>(q[i]);
        state.angular_velocity[2] = static_cast<float>(0.8 * turn / replay.step);
    }
    const Decoded decoded = written(replay);
    for (std::size_t f = 0; f < 60; ++f)
        ASSERT_NEAR(decoded.value("angle", 0, f), 0.8 * turn * static_cast<double>(f), 2e-4);
}

TEST(ReplayWriter, ABodyThatIsNotThereYetWaitsWhereItWillBe) {
    Replay replay = lone_body(3, 20);
    for (std::size_t f = 0; f < 20; ++f) {
        replay.frames[f].states[0].position = {7, static_cast<double>(f), 0};
        if (f < 5) replay.frames[f].states.clear();
    }
    const Decoded decoded = written(replay);
    for (std::size_t f = 0; f < 20; ++f) {
        EXPECT_EQ(decoded.value("flags", 0, f) != 0, f >= 5);
        EXPECT_NEAR(decoded.place(1, 0, f), f < 5 ? 5.0 : static_cast<double>(f), 1e-4);
    }
}

TEST_P(ReplayOf, DescribesBodiesShapesAndLinks) {
    const Replay replay = sample_replay(GetParam());
    const nlohmann::json header = written(replay).header;
    EXPECT_EQ(header["carom_replay"], 1);
    EXPECT_EQ(header["dimension"], GetParam());
    EXPECT_EQ(header["name"], replay.name);
    EXPECT_EQ(header["gravity"].size(), static_cast<std::size_t>(GetParam()));
    EXPECT_EQ(header["links"].size(), 2u);
    EXPECT_EQ(header["links"][1]["a"], -1);
    EXPECT_EQ(header["energy"]["potential"].size(), replay.frames.size());
    std::map<std::string, int> types;
    for (const nlohmann::json& body : header["bodies"])
        for (const nlohmann::json& shape : body["shapes"]) {
            ++types[shape["type"]];
            EXPECT_TRUE(shape.contains(GetParam() == 2 ? "angle" : "rotation"));
            EXPECT_EQ(shape.contains("faces"), shape["type"] == "hull" && GetParam() == 3);
        }
    std::vector<std::string> expected{"ball", "box", "capsule", "hull", "plane"};
    if (GetParam() == 3) expected.insert(expected.end(), {"cylinder", "cone"});
    for (const std::string& type : expected) EXPECT_GT(types[type], 0) << type;
}

TEST_P(ReplayOf, TellsSensorsBeltsAndOneWayShapes) {
    const nlohmann::json header = written(sample_replay(GetParam())).header;
    std::map<std::string, nlohmann::json> found;
    for (const nlohmann::json& body : header["bodies"])
        for (const nlohmann::json& shape : body["shapes"])
            for (const std::string key : {"sensor", "one_way", "surface_velocity"})
                if (shape.contains(key)) {
                    EXPECT_FALSE(found.contains(key)) << "one of each is in the sample";
                    found[key] = shape[key];
                }
    const bool flat = GetParam() == 2;
    EXPECT_EQ(found["sensor"], true);
    EXPECT_EQ(found["one_way"], flat ? nlohmann::json({0, 1}) : nlohmann::json({0, 1, 0}));
    EXPECT_EQ(found["surface_velocity"], flat ? nlohmann::json({0.5, 0}) : nlohmann::json({0.5, 0, 0}));
}

TEST(ReplayWriter, NamesCannotBreakThePage) {
    Replay replay = lone_body(2, 1);
    replay.name = "</script><script>alert(1)</script><!-- @carom-motion@";
    replay.bodies[0].name = "caf\xc3\xa9 \xff\xfe \"quoted\" \\ \n\x01 &amp;";
    const std::string page = replay_html(replay, bare_page);
    const std::string header = page.substr(6, page.find("</head>") - 6);
    EXPECT_EQ(header.find('<'), std::string::npos);
    EXPECT_TRUE(std::all_of(header.begin(), header.end(), [](char c) { return c >= 0x20 && c < 0x7f; }));
    const Decoded decoded = decode(page);
    EXPECT_EQ(decoded.header["name"], replay.name);
    // What is not UTF-8 becomes the replacement character.
    EXPECT_EQ(decoded.header["bodies"][0]["name"],
              "caf\xc3\xa9 \xef\xbf\xbd\xef\xbf\xbd \"quoted\" \\ \n\x01 &amp;");
}

TEST(ReplayWriter, FewerFramesKeepTheirContactsWhereThereAreTooMany) {
    Replay replay = sample_replay(3);
    replay.contact_bytes = 4000;
    const std::string page = replay_html(replay, bare_page);
    const Decoded decoded = decode(page);
    const std::size_t every = decoded.header["contacts"]["every"];
    EXPECT_GT(every, 1u);
    EXPECT_EQ(decoded.contacts.size(), (replay.frames.size() + every - 1) / every);
    const std::size_t begin = page.find("<contacts>") + 10;
    EXPECT_LE(page.find("</contacts>") - begin, replay.contact_bytes);
}

TEST(ReplayWriter, AnEmptyWorldHasAReplay) {
    Replay replay;
    EXPECT_EQ(written(replay).header["bodies"].size(), 0u);
    replay.frames.resize(3);
    EXPECT_EQ(written(replay).header["frames"], 3);
}

/// The text of the error that writing the replay throws.
std::string refusal(const Replay& replay) {
    try {
        replay_html(replay, bare_page);
    } catch (const Error& error) {
        return error.what();
    }
    return "none";
}

TEST(ReplayWriter, RefusesWhatContradictsItself) {
    Replay replay = lone_body(3, 2);
    replay.dimension = 4;
    EXPECT_EQ(refusal(replay), "dimension: 4 is neither 2 nor 3");
    replay.dimension = 3;
    replay.step = 0;
    EXPECT_NE(refusal(replay).find("step: 0"), std::string::npos);
    replay.step = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(refusal(replay).find("step: "), std::string::npos);
    replay.step = 0.1;
    replay.links.push_back({"spring", -1, 1, {}, {}});
    EXPECT_EQ(refusal(replay), "links[0].b: 1 is not a body (there are 1)");
    replay.links.clear();
    replay.frames[1].contacts.push_back({-1, 0, {}, {}, 0});
    EXPECT_EQ(refusal(replay), "frames[1].contacts.a: -1 is not a body (there are 1)");
    replay.frames[1].contacts.clear();
    replay.frames[1].states.resize(2);
    EXPECT_EQ(refusal(replay), "frames[1].states: 2 are more than the 1 bodies");
    replay.frames[1].states.resize(1);
    EXPECT_EQ(refusal(replay), "none");
    EXPECT_THROW(replay_html(replay, "a page without places"), Error);
}

class ReplayFile : public testing::Test {
  protected:
    void SetUp() override { fs::create_directories(folder); }
    void TearDown() override { fs::remove_all(folder); }
    static std::size_t files_in(const fs::path& path) {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(path), fs::directory_iterator()));
    }
    const fs::path folder =
        fs::path(testing::TempDir()) / ("carom_replay_" + std::to_string(std::random_device{}()));
};

TEST_F(ReplayFile, IsWrittenWhole) {
    if (replay_template().empty()) GTEST_SKIP() << "the replay viewer is not built in";
    const Replay replay = lone_body(2, 3);
    const fs::path path = folder / "run.html";
    write_replay(replay, path);
    EXPECT_EQ(files_in(folder), 1u);
    EXPECT_EQ(fs::file_size(path), replay_html(replay, replay_template()).size());
}

TEST_F(ReplayFile, IsNotTouchedByAReplayThatIsRefused) {
    Replay replay = lone_body(2, 3);
    replay.step = -1;
    const fs::path path = folder / "run.html";
    std::ofstream(path) << "before";
    EXPECT_THROW(write_replay(replay, path), Error);
    EXPECT_EQ(files_in(folder), 1u);
    EXPECT_EQ(fs::file_size(path), 6u);
}

TEST_F(ReplayFile, SaysWhyItCannotBeWritten) {
    const fs::path path = folder / "missing" / "run.html";
    try {
        write_replay(lone_body(2, 3), path);
        FAIL() << "written into a folder that is not there";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace carom::io
